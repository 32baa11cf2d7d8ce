# SPDX-License-Identifier: Apache-2.0
"""What links with masters and vehicles say and hear over ROS."""
