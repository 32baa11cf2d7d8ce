# SPDX-License-Identifier: Apache-2.0
"""Traffic: from the goal of each robot to the cells that are released to it."""
