# SPDX-License-Identifier: Apache-2.0
"""Shifts as ROS nodes: messages, services, and the fleet of a running warehouse."""
