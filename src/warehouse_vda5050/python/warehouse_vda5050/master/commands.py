# SPDX-License-Identifier: Apache-2.0
"""The commands of this project to a robot, as plain values."""

from dataclasses import dataclass

from warehouse_vda5050.driver import Point


class RefusedError(ValueError):
    """A command that a vehicle can't be given; the message is for a person."""


@dataclass(frozen=True)
class Follow:
    """As warehouse_msgs/FollowPath: points in the frame world [m]."""

    path_id: int
    first: int
    points: tuple[Point, ...]
    released: int


@dataclass(frozen=True)
class Lift:
    """As warehouse_msgs/Lift; shelf_id 0: what it carries."""

    up: bool
    shelf_id: int


@dataclass(frozen=True)
class Cancel:
    """As warehouse_msgs/Cancel."""


@dataclass(frozen=True)
class Stop:
    """As warehouse_msgs/Stop."""

    stop: bool


@dataclass(frozen=True)
class Other:
    """A command that has no counterpart in VDA 5050."""

    what: str


Command = Follow | Lift | Cancel | Stop | Other
