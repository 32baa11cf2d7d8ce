# SPDX-License-Identifier: Apache-2.0
"""The robots that could be given work."""

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE, RobotTable
from warehouse_fleet.transports.transport_book import TransportBook


def idle_robots(robots: RobotTable, book: TransportBook) -> np.ndarray:
    """Returns (n,) bool: robots that the fleet commands, and that have no work and no unit."""
    idle = robots.automatic & ~robots.busy & ~robots.loaded & (robots.cell != NOWHERE)
    return idle & (book.step_of == NOWHERE)
