# SPDX-License-Identifier: Apache-2.0
"""What whoever asks for transports and whoever drives them say to each other.

A transport fetches a storage unit, brings it to a station or a cell, waits there until it is
released, and stores it. Ids count from 1; 0 is none. Times are simulated seconds.
"""

from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple, Protocol


class Kind(IntEnum):
    """Of a TransportEvent."""

    RECEIVED = 0
    ASSIGNED = 1
    LIFTED = 2
    ARRIVED = 3
    RELEASED = 4
    STORED = 5
    FAILED = 6
    CANCELLED = 7


ENDS = frozenset((Kind.STORED, Kind.FAILED, Kind.CANCELLED))


class Then(IntEnum):
    """What becomes of the unit when it has been released."""

    STORE = 0
    STAY = 1


class Mode(IntEnum):
    """Whether a station works by itself or waits for a person."""

    AUTOMATIC = 0
    MANUAL = 1


class TransportEvent(NamedTuple):
    stamp: float
    transport_id: int
    kind: Kind
    kiva_id: int
    shelf_id: int
    station: str
    text: str


class Answer(NamedTuple):
    transport_id: int
    accepted: bool
    message: str


@dataclass
class Gate:
    """A station as the fleet knows it: whether units are taken there, and who serves them."""

    name: str
    kind: str  # "PICK" or "REPLENISH"
    open: bool = True
    mode: Mode = Mode.AUTOMATIC


class Task(NamedTuple):
    """A transport that waits for a robot."""

    transport_id: int
    shelf_id: int
    station: str
    priority: int
    inbound: int  # units at its station or on the way to it


class Hooks(Protocol):
    """What the fleet asks of the policies."""

    def choose_place(self, shelf_id, cells, distances):
        """The cell, one of `cells`, in which a unit is stored; they are (n,), with metres each."""

    def match_robots(self, tasks, robots, seconds):
        """Pairs (index of the task, index of the robot), each at most once.

        seconds: (tasks, robots), until that robot is beneath the unit of that task.
        """

    def park(self, kiva_id, cell):
        """The cell to which a robot without work goes; None: it waits where it is."""


class Transports(Protocol):
    """Who drives them."""

    hooks: Hooks

    def submit(self, shelf_id, station="", x=None, y=None, then=Then.STORE, priority=0) -> Answer:
        """Asks for a transport to a station, or to the cell at x, y in world [m]."""

    def release(self, transport_id) -> tuple[bool, str]:
        """The station is done with the unit."""

    def cancel(self, transport_id) -> tuple[bool, str]:
        """Ends a transport; CANCELLED is told when its unit stands in a storage place."""

    def take_events(self) -> list[TransportEvent]:
        """What happened since the last call, in order."""

    def waiting(self, station) -> int:
        """How many units are at a station or on the way to it, by the station's name."""
