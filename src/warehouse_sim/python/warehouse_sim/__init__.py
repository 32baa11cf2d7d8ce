# SPDX-License-Identifier: Apache-2.0
"""The warehouse around the simulated world: layouts, tracking, names. Imports no rospy."""
