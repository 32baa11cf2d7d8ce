# SPDX-License-Identifier: Apache-2.0
"""What who asks for transports sees of who drives them, and which decisions it is asked for.

transports.Transports (simulated or real robots) and ideal.IdealFleet both offer it. Times are
simulated seconds.
"""

from typing import Any, NamedTuple, Protocol

from warehouse_fleet.transports import STORE, Answer, TransportEvent


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

    charging: Any  # who is charged when: a policy, see policies.ChargingPolicy

    def park(self, kiva_id, cell):
        """The cell to which a robot without work goes; None: it waits where it is."""


class Requests(Protocol):
    """What a fleet is asked for. CANCELLED of a unit that is lifted is followed by STORED."""

    def submit(self, shelf_id, station="", x=None, y=None, then=STORE, priority=0) -> Answer:
        """Asks for a transport to a station, or to the cell at x, y in world [m]."""

    def release(self, transport_id) -> tuple[bool, str]:
        """The station is done with the unit."""

    def cancel(self, transport_id) -> tuple[bool, str]:
        """Ends a transport; a unit that is lifted is stored."""

    def set_open(self, station, is_open) -> None:
        """A closed station gets no more units; those on the way there are cancelled."""

    def take_events(self) -> list[TransportEvent]:
        """What happened since the last call, in order."""
