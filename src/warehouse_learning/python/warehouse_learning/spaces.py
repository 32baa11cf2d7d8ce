# SPDX-License-Identifier: Apache-2.0
"""Spaces that environments share."""

from typing import Any

import numpy as np
from gymnasium import spaces

from warehouse_learning.options import Options

WHEELS = 3  # left, right, lift


def robot_action_space(options: Options) -> Any:
    """Returns the action space of one robot."""
    if options.continuous:
        return spaces.Box(-1, 1, (WHEELS,), np.float32)
    return spaces.Discrete(5)


def joint_action_space(options: Options) -> Any:
    """Returns the action space of one policy for all robots of a warehouse."""
    if options.continuous:
        return spaces.Box(-1, 1, (options.robots * WHEELS,), np.float32)
    return spaces.MultiDiscrete(np.full(options.robots, 5))
