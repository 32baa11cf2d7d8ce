# SPDX-License-Identifier: Apache-2.0
"""What nodes share to talk to a running warehouse: its services, its models, its messages."""

MOST_THREADS = 256  # of a world, as kMostThreads of kiva_plugin_cpp says, and of a planner
