# SPDX-License-Identifier: Apache-2.0
"""Recordings of a warehouse: written by the running viewer, by simulate and from bags, and played
by the page. doc/how-to/replay.md has the format. Imports no ROS but in bag.py."""
