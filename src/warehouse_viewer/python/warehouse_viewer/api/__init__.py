# SPDX-License-Identifier: Apache-2.0
"""The HTTP API of a warehouse behind ROS, and the application that serves it beside the page."""
