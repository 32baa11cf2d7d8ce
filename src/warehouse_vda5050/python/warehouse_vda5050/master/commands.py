# SPDX-License-Identifier: Apache-2.0
"""The commands of this project to a robot, as plain values."""

import math
from dataclasses import dataclass

from warehouse_vda5050.driver import Point


class RefusedError(ValueError):
    """A command that a vehicle can't be given; the message is for a person."""


class UnfitError(RefusedError):
    """A unit that a vehicle can't carry, at any time: others have to."""

    def __init__(self, text: str, unit: int) -> None:
        super().__init__(text)
        self.unit = unit


@dataclass(frozen=True)
class Follow:
    """A path or a change of one, as warehouse_msgs/FollowPath: points in the frame world [m].
    speeds: as warehouse_msgs/LimitedPath has them, none for no limits [m/s]."""

    path_id: int
    first: int
    points: tuple[Point, ...]
    released: int
    speeds: tuple[float, ...] = ()

    @property
    def is_limited(self) -> bool:
        """Whether it has a speed limit."""
        return any(map(math.isfinite, self.speeds))


@dataclass(frozen=True)
class Lift:
    """A lift or a drop, as warehouse_msgs/Lift; shelf_id 0: the unit that the robot carries."""

    up: bool
    shelf_id: int


@dataclass(frozen=True)
class Cancel:
    """The end of a command, as warehouse_msgs/Cancel."""


@dataclass(frozen=True)
class Stop:
    """An emergency stop or its end, as warehouse_msgs/Stop."""

    stop: bool


@dataclass(frozen=True)
class Other:
    """A command that has no counterpart in VDA 5050."""

    what: str


Command = Follow | Lift | Cancel | Stop | Other
