# SPDX-License-Identifier: Apache-2.0
"""The hub: warehouses on request, without a terminal and without a ROS master.

wish         a request for a simulation: its fields, checked before anything starts
process      a roslaunch with a master, ports, a ROS_HOME and a log of its own
simulation   one simulation: its wish, its process, its state
guest        a warehouse that was launched elsewhere, and shows itself in the hub
simulations  all of them: limits, persistence, the look at each once a second
insertion    adds a world to a simulation that runs
forms        launch arguments as fields, with their documentation
proxy        passes what comes beneath /s/NAME/ on to that simulation's pages
assistant    starts the assistant's server, which answers at /mcp
routes       the HTTP API
application  all of it behind one address
"""
