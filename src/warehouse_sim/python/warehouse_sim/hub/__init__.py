# SPDX-License-Identifier: Apache-2.0
"""The hub: warehouses on request, without a terminal and without a ROS master.

wish         a request for a simulation: its fields, checked before anything starts
process      a roslaunch with a master, ports, a ROS_HOME and a log of its own
simulation   one simulation: its wish, its process, its state
guest        a warehouse that was launched elsewhere, and shows itself in the hub
simulations  all of them: limits, persistence, the look at each once a second
what_if      the what-if page's requests
insertion    adds a world to a simulation that runs
saving       saves the world of a simulation that runs
worlds       worlds by name, and those that were saved
keeping      keeps the last hour of a simulation as a recording
recordings   recordings that are played, without a simulation that runs
journal      what was changed by whom
forms        launch arguments as fields, with their documentation
assistant    starts the assistant's server, which answers at /mcp
sizing       how many robots and stations a warehouse needs: the program `size` in a folder
sizings      all of these
api          requests and their description; what comes beneath /s/NAME/ is passed on
application  all of it behind one address
"""
