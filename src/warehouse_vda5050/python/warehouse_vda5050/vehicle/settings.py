# SPDX-License-Identifier: Apache-2.0
"""What a vehicle may do differently from another."""

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class VehicleSettings:
    """interval: longest time between two state messages [s]; moving: the same while the vehicle
    drives. visualization: time between two positions of a moving robot [s], 0: none. linger: time
    from the end of an order until the robot is given back [s]. first_path: the number of its first
    path. begins_at_zero: whether the first update of an order has to be 0, as in 3.0. zones:
    whether it takes zone sets, which 3.0 alone has. logs: the folder of reports that masters ask
    for, whose names begin with `name`; None: not stored."""

    interval: float = 30.0
    moving: float = 1.0
    visualization: float = 1.0
    linger: float = 3.0
    first_path: int = 1
    begins_at_zero: bool = False
    zones: bool = False
    logs: Path | None = None
    name: str = "vehicle"
