# SPDX-License-Identifier: Apache-2.0
"""Clients of a running warehouse, shared by all nodes: services, models, messages."""

MOST_THREADS = 256  # of a world, as kMostThreads of kiva_plugin_cpp says, and of a planner
