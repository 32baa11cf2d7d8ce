# SPDX-License-Identifier: Apache-2.0
"""The warehouse behind ROS: the topics that the viewer reads and the services that it calls."""
