# SPDX-License-Identifier: Apache-2.0
"""What the page in the browser shows, and how it is brought there. Imports no ROS."""
