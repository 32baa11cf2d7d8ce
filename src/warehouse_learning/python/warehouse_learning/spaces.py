# SPDX-License-Identifier: Apache-2.0
"""Spaces that environments share."""

import numpy as np
from gymnasium import spaces

WHEELS = 3  # left, right, lift


def robot_action_space(options):
    """Of one robot."""
    if options.continuous:
        return spaces.Box(-1, 1, (WHEELS,), np.float32)
    return spaces.Discrete(5)


def joint_action_space(options):
    """Of all robots of a warehouse by one policy."""
    if options.continuous:
        return spaces.Box(-1, 1, (options.robots * WHEELS,), np.float32)
    return spaces.MultiDiscrete(np.full(options.robots, 5))
