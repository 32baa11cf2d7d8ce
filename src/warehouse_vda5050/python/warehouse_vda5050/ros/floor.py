# SPDX-License-Identifier: Apache-2.0
"""The floor of the running warehouse as cells where vehicles drive."""

from typing import Any

import numpy as np
import rospy
from nav_msgs.srv import GetMap

from warehouse_layout.floor.plan_reader import is_taken, occupancy_of
from warehouse_vda5050.grid import Grid


def read_map() -> Any:
    """Returns the nav_msgs/OccupancyGrid of the floor now. Raises rospy.ServiceException."""
    return rospy.ServiceProxy("warehouse/map", GetMap)().map


def grid_of(grid: Any) -> Grid:
    """Returns the Grid of a nav_msgs/OccupancyGrid."""
    corner, spacing = grid.info.origin.position, grid.info.resolution
    rows, columns = np.nonzero(is_taken(occupancy_of(grid)))
    blocked = frozenset(zip(columns.tolist(), rows.tolist()))
    x, y = corner.x + spacing / 2, corner.y + spacing / 2
    return Grid(x, y, spacing, grid.info.width, grid.info.height, blocked)
