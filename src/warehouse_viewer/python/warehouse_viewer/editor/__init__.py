# SPDX-License-Identifier: Apache-2.0
"""The server's side of the layout editor, the page /layout. Imports no ROS.

The page draws; what it has drawn it sends as the text of a layout file, which is read here alone.
"""
