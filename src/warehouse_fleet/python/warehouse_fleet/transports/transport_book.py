# SPDX-License-Identifier: Apache-2.0
"""The records of transports: the requests, the progress of each, and the events."""

import bisect
import collections
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE
from warehouse_fleet.transports.contracts import Clock
from warehouse_layout.message_enums import Then, TransportEventKind

STORE, STAY = Then.STORE, Then.STAY  # what becomes of the unit afterwards
Kind = TransportEventKind


ENDS = frozenset((Kind.STORED, Kind.FAILED))


class TransportEvent(NamedTuple):
    """An event, as the message of this name."""

    stamp: float  # simulated [s]
    transport_id: int
    kind: Kind
    kiva_id: int  # 0: no robot
    shelf_id: int
    station: str
    text: str


class TransportAnswer(NamedTuple):
    """The answer to a request; `transport_id` is 0 if it was refused."""

    transport_id: int
    accepted: bool
    message: str


class Step(IntEnum):
    """The progress of a transport."""

    OPEN = 0  # no robot yet
    FETCHING = 1  # the robot drives beneath the unit
    READY = 2  # and waits there until its station has room for it
    LIFTING = 3
    BRINGING = 4
    WAITING = 5  # at its destination, until it is released
    STORING = 6  # on the way to a storage place
    DROPPING = 7


class Leave(IntEnum):
    """Whether a unit may leave its destination, or need not go there."""

    NO = 0
    RELEASED = 1
    CANCELLED = 2


# A member of an enumeration is found by a slow search; these are looked at for each robot.
OPEN, FETCHING, READY, LIFTING, BRINGING, WAITING, STORING, DROPPING = Step
# What may follow each step. A robot may be found with a unit, lose its way or its transport, lift
# again, be sent to another storage place, and put a unit back that is fetched again later.
FOLLOWS: dict[Step, frozenset[Step]] = {
    OPEN: frozenset((FETCHING, STORING)),
    FETCHING: frozenset((READY, OPEN)),
    READY: frozenset((LIFTING, OPEN)),
    LIFTING: frozenset((LIFTING, BRINGING, STORING, FETCHING)),
    BRINGING: frozenset((WAITING, STORING)),
    WAITING: frozenset((STORING, DROPPING)),
    STORING: frozenset((DROPPING, STORING)),
    DROPPING: frozenset((DROPPING, STORING, OPEN)),
}
FETCHED, INBOUND = frozenset((FETCHING, READY)), frozenset((LIFTING, BRINGING, WAITING))


@dataclass(eq=False)
class Transport:
    """One transport; cells are the floor's, times simulated [s]."""

    number: int
    shelf: int
    station: str
    cell: int  # its destination
    then: int = STORE
    priority: int = 0
    step: Step = OPEN
    robot: int = NOWHERE  # an index
    leave: Leave = Leave.NO
    since: float = 0.0  # the step began
    attempts: int = 0  # at lifting
    place: int = NOWHERE  # the storage cell that is kept for it while it is under way
    turn: int = 0  # its number among those that were given to robots
    is_put_back: bool = False  # its unit is stored, and is fetched again later


@dataclass
class Totals:
    """What all robots have done so far."""

    delivered: int = 0  # units that came to their destination
    stored: int = 0
    failed: int = 0
    cells: int = 0
    shortest: int = 0  # cells of the same journeys on the shortest ways
    driven: float = 0.0  # [s]
    planned: float = 0.0  # [s]

    @property
    def executed_over_planned(self) -> float:
        """Seconds driven over those planned, of all journeys; 1 before there is one."""
        return self.driven / self.planned if self.planned else 1.0


def _urgency(transport: Transport) -> tuple[int, int]:
    return -transport.priority, transport.number


class TransportBook:
    """All transports that are not over, by number, robot and unit. `kiva_ids`: of the robots, by
    index. Numbers begin after `last`.

    Arrays by robot, (n,): `step_of` (the Step of its transport; NOWHERE: it has none), `place_of`
    (the storage cell that is kept for its unit), `station_of` (an index into `stations`).

    `open`: those without a robot, the most urgent first. By station, `ready` lists those at step
    READY, in the order in which they came to it, `fetched` counts units that robots drive to or
    wait beneath, `inbound` those that are lifted, until they leave it.
    """

    def __init__(
        self,
        kiva_ids: Sequence[int] | np.ndarray,
        clock: Clock,
        last: int = 0,
        stations: Iterable[str] = (),
    ) -> None:
        self._kiva_ids, self._clock = kiva_ids, clock
        self.totals = Totals()
        self.step_of = np.full(len(kiva_ids), NOWHERE, np.int8)
        self.place_of = np.full(len(kiva_ids), NOWHERE, np.int32)
        self.station_of = np.full(len(kiva_ids), NOWHERE, np.int32)
        self._station = {name: i for i, name in enumerate(stations)}
        self._turns = 0
        self.open: list[Transport] = []
        self.ready: dict[str, list[Transport]] = {name: [] for name in ("", *self._station)}
        self.of_robot: dict[int, Transport] = {}
        self.of_unit: dict[int, Transport] = {}
        self.inbound: collections.Counter[str] = collections.Counter()
        self.fetched: collections.Counter[str] = collections.Counter()
        self._by_number: dict[int, Transport] = {}
        self._to_cells: dict[int, Transport] = {}  # by number: those that go to no station
        self._last = last
        self._events: list[TransportEvent] = []

    def __iter__(self) -> Iterator[Transport]:
        return iter(list(self._by_number.values()))

    def __contains__(self, number: object) -> bool:
        return number in self._by_number

    @property
    def time(self) -> float:
        """The simulated time [s]."""
        return self._clock.time

    def get(self, number: int) -> Transport | None:
        """Returns the transport of that number; None if it is over, or never was."""
        return self._by_number.get(number)

    def assigned(self) -> list[Transport]:
        """Returns the transports that a robot does."""
        return list(self.of_robot.values())

    def add(
        self, shelf: int, station: str, cell: int, then: int = STORE, priority: int = 0
    ) -> Transport:
        """Adds a transport to a cell, with the next number."""
        self._last += 1
        transport = Transport(self._last, shelf, station, cell, then, priority)
        self._register(transport)
        return transport

    def _register(self, transport: Transport) -> None:
        self._by_number[transport.number] = self.of_unit[transport.shelf] = transport
        if not transport.station:
            self._to_cells[transport.number] = transport

    def restore(self, transport: Transport, robot: int = NOWHERE) -> None:
        """Adds a transport of another book, at its step, done by a robot of that index."""
        self._last = max(self._last, transport.number)
        self._register(transport)
        if robot == NOWHERE:
            self.enqueue(transport)
            return
        self.hand_over(transport, robot)
        self._count(transport, 1)

    def enqueue(self, transport: Transport) -> None:
        """Adds a transport to those without a robot."""
        bisect.insort(self.open, transport, key=_urgency)

    def _dequeue(self, transport: Transport) -> None:
        at = bisect.bisect_left(self.open, _urgency(transport), key=_urgency)
        if at < len(self.open) and self.open[at] is transport:
            del self.open[at]

    def sort_open(self) -> None:
        """Sorts the transports without a robot by priority, then by number."""
        self.open.sort(key=_urgency)

    def assign(self, transport: Transport, robot: int) -> None:
        """Gives an open transport to a robot, which fetches the unit."""
        self._dequeue(transport)
        self.hand_over(transport, robot)
        self.go_on(transport, FETCHING)

    def hand_over(self, transport: Transport, robot: int) -> None:
        """Notes that a robot does a transport."""
        self._turns += 1
        transport.robot, transport.turn = robot, self._turns
        self.of_robot[robot] = transport
        self.step_of[robot] = transport.step
        self.station_of[robot] = self._station.get(transport.station, NOWHERE)

    def go_on(self, transport: Transport, step: Step) -> None:
        """Brings a transport that a robot does to a step. Raises ValueError where that step does
        not follow."""
        if step not in FOLLOWS[transport.step]:
            text = f"{step.name} can't follow {transport.step.name}"
            raise ValueError(f"transport {transport.number}: {text}")
        self._count(transport, -1)
        transport.step, transport.since = step, self.time
        self.step_of[transport.robot] = step
        self._count(transport, 1)

    def _count(self, transport: Transport, change: int) -> None:
        """Adds a transport at its step to those of its station, or takes it away there."""
        if transport.step == READY:
            ready = self.ready.setdefault(transport.station, [])
            ready.append(transport) if change > 0 else ready.remove(transport)
        if transport.step in FETCHED:
            self.fetched[transport.station] += change
        elif transport.step in INBOUND:
            self.inbound[transport.station] += change

    def keep(self, transport: Transport, place: int) -> None:
        """Keeps a storage cell for the unit of a transport that a robot does."""
        transport.place = self.place_of[transport.robot] = place

    def _leave_robot(self, transport: Transport) -> None:
        robot = transport.robot
        if self.of_robot.get(robot) is transport:
            del self.of_robot[robot]
            self.step_of[robot] = self.place_of[robot] = self.station_of[robot] = NOWHERE

    def unassign(self, transport: Transport) -> None:
        """Takes a transport from its robot before the unit is lifted: another one fetches it."""
        self.go_on(transport, OPEN)
        self._leave_robot(transport)
        transport.robot = transport.place = NOWHERE
        self.enqueue(transport)

    def remove(self, transport: Transport) -> None:
        """Removes a transport that is over."""
        self._count(transport, -1)
        if transport.robot == NOWHERE:
            self._dequeue(transport)
        self._leave_robot(transport)
        if self.of_unit.get(transport.shelf) is transport:
            del self.of_unit[transport.shelf]
            for asked in self.open:
                if asked.shelf == transport.shelf:
                    self.of_unit[asked.shelf] = asked
        self._by_number.pop(transport.number, None)
        self._to_cells.pop(transport.number, None)

    def waiting(self, station: str) -> int:
        """Returns how many units are at a station or on the way to it."""
        return self.inbound[station] + self.fetched[station]

    def open_for(self, station: str) -> int:
        """Returns how many transports to a station have no robot yet."""
        return sum(transport.station == station for transport in self.open)

    def destinations(self) -> list[int]:
        """Returns the cells to which units are to be brought that go to no station."""
        going = (OPEN, FETCHING, READY, LIFTING, BRINGING, WAITING)
        return [t.cell for t in self._to_cells.values() if t.step in going]

    def kept_places(self) -> np.ndarray:
        """Returns the storage cells that are kept for units under way."""
        return self.place_of[self.place_of != NOWHERE]

    def publish_event(self, transport: Transport, kind: Kind, text: str = "") -> None:
        """Adds an event of a transport for take_events()."""
        robot = transport.robot
        kiva_id = int(self._kiva_ids[robot]) if robot != NOWHERE else 0
        number, shelf, station = transport.number, transport.shelf, transport.station
        self._events.append(TransportEvent(self.time, number, kind, kiva_id, shelf, station, text))

    @property
    def has_events(self) -> bool:
        """Whether there are events to be taken."""
        return bool(self._events)

    @property
    def pending_events(self) -> list[TransportEvent]:
        """The events to be taken yet, in order."""
        return list(self._events)

    def add_events(self, events: Iterable[TransportEvent]) -> None:
        """Adds events that are to be taken yet."""
        self._events += events

    def take_events(self) -> list[TransportEvent]:
        """Returns all events since the last call, in order."""
        events, self._events = self._events, []
        return events
