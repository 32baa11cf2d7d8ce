# SPDX-License-Identifier: Apache-2.0
"""The HTTP server: access control, tokens, connections and files. Imports no ROS."""
