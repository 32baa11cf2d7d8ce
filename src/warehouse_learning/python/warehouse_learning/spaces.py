# SPDX-License-Identifier: Apache-2.0
"""Spaces that environments share."""

from collections.abc import Sequence

import numpy as np
from gymnasium import spaces

from warehouse_learning.options import Options

# Of a vector environment's reset: one number, or one for each, where None goes on.
Seed = int | Sequence[int | None] | np.ndarray | None

WHEELS = 3  # left, right, lift


def robot_action_space(options: Options) -> spaces.Space:
    """Returns the action space of one robot."""
    if options.continuous:
        return spaces.Box(-1, 1, (WHEELS,), np.float32)
    return spaces.Discrete(5)


def joint_action_space(options: Options) -> spaces.Space:
    """Returns the action space of one policy for all robots of a warehouse."""
    if options.continuous:
        return spaces.Box(-1, 1, (options.robots * WHEELS,), np.float32)
    return spaces.MultiDiscrete(np.full(options.robots, 5))
