# SPDX-License-Identifier: Apache-2.0
"""A server of the Model Context Protocol: digital assistants start, ask and operate warehouses.

It talks HTTP with a hub, and needs neither ROS nor another package of this workspace; its packages
of PyPI lie in an environment of its own (scripts/assistant).

    python3 -m warehouse_assistant [--hub URL] [--allow commands] [--port PORT]

    words            quoted data, bounded replies
    hub_client       the hub's HTTP API and that of each simulation, with errors that say what helps
    library          pages of the documentation, and their search
    floor_picture    the floor as PNG
    toolbox          how a tool is registered; which of them change something
    tools            the tools, a module for each subject
    resources        layouts and documentation as resources
    server           all of these as a server, over stdio or streamable HTTP
"""
