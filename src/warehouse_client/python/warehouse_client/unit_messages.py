# SPDX-License-Identifier: Apache-2.0
"""Numbers and poses of storage units, read from WarehouseObjects and UnitStates."""

from typing import Any

import numpy as np

PREFIX = "storage_unit"  # of their models' names


def unit_ids(objects: Any) -> list[int]:
    """Returns the number of each unit of a WarehouseObjects."""
    return [int(name.removeprefix(PREFIX)) for name in objects.storage_units]


def unit_poses(states: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Arrays (x, y, yaw) of a UnitStates, in world [m, rad]: the units of the WarehouseObjects of
    the same revision."""
    poses = np.reshape(states.pose, (-1, 7))
    return poses[:, 0], poses[:, 1], 2 * np.arctan2(poses[:, 5], poses[:, 6])
