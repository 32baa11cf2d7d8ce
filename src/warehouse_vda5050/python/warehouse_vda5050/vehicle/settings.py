# SPDX-License-Identifier: Apache-2.0
"""What a vehicle may do differently from another."""

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class VehicleSettings:
    """interval: at the latest so long after the last state comes the next [s]; moving: the same
    while it drives; visualization: between two positions of a robot that moves [s], 0: none.
    linger: so long after an order the robot is given back [s]. first_path: the number of its first
    path. begins_at_zero: whether a new order has to, as in 3.0. logs: where reports that masters
    ask for are stored, under names that begin with `name`; None: nowhere."""

    interval: float = 30.0
    moving: float = 1.0
    visualization: float = 1.0
    linger: float = 3.0
    first_path: int = 1
    begins_at_zero: bool = False
    logs: Path | None = None
    name: str = "vehicle"
