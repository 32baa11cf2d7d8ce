# SPDX-License-Identifier: Apache-2.0
"""Transports: a storage unit is fetched, brought to a station or a cell, waits there until it is
let go, and is stored again. Neither ROS nor physics: `fleet` lifts, `traffic` drives."""

import collections
import itertools
from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple

import numpy as np

from warehouse_fleet.charging import Charging
from warehouse_fleet.failures import EMPTY
from warehouse_fleet.traffic import IDLE, NOWHERE, STAYS, Mode

STORE, STAY = 0, 1  # what becomes of the unit afterwards
LIFT_PATIENCE = 3.0  # a lift that has not begun within this is asked for again [s]
LIFT_ATTEMPTS = 8  # of ten messages one may be lost, and thousands of units are lifted
CROOKED = 0.05  # from the middle of its cell, and farther: a unit can't be lifted there [m]
UNIT_REACH = 0.48  # of a unit's sides, with room for who turns beside it [m]
URGENT = 255  # the highest priority
DEAD = 30.0  # a robot that does not move for so long has its transport taken from it [s]
SEEN_LATE = 0.5  # what is seen of units may lag behind by so much [s]
FETCHED = 4  # units a station that are fetched before they may be lifted
LIFTED = 6  # units a station under way to it at the most: more only crowd the streets before it


class Kind(IntEnum):
    """What happened to a transport."""

    RECEIVED = 0
    ASSIGNED = 1
    LIFTED = 2
    ARRIVED = 3
    RELEASED = 4
    STORED = 5
    FAILED = 6
    CANCELLED = 7


ENDS = frozenset((Kind.STORED, Kind.FAILED))


class TransportEvent(NamedTuple):
    """As the message of this name."""

    stamp: float
    transport_id: int
    kind: Kind
    kiva_id: int
    shelf_id: int
    station: str
    text: str


class Answer(NamedTuple):
    """To a request; `transport_id` is 0 if it was refused."""

    transport_id: int
    accepted: bool
    message: str


class Step(IntEnum):
    """How far a transport is."""

    OPEN = 0  # no robot yet
    FETCHING = 1  # the robot drives beneath the unit
    READY = 2  # and waits there until its station has room for it
    LIFTING = 3
    BRINGING = 4
    WAITING = 5  # at its destination, until it is let go
    STORING = 6  # on the way to a storage place
    DROPPING = 7


@dataclass
class Transport:
    """One transport; cells are the floor's, times simulated [s]."""

    number: int
    shelf: int
    station: str
    cell: int  # where it is to be brought
    then: int
    priority: int
    step: Step = Step.OPEN
    robot: int = NOWHERE  # an index
    let_go: bool = False
    since: float = 0.0  # the step began
    attempts: int = 0  # at lifting
    place: int = NOWHERE  # the storage cell that is kept for it while it is under way


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
    def executed_over_planned(self):
        """Seconds driven over those planned, of all journeys; 1 before there is one."""
        return self.driven / self.planned if self.planned else 1.0


def _urgency(transport):
    return -transport.priority, transport.number


class Transports:
    """All transports and who does them.

    `lift(kiva_id, shelf_id, up)` sends the command. Decisions can be made by others:
    `match_robots(asked, free)` yields pairs of a Transport of those `asked` for and a robot of the
    indices `free`; `choose_place(shelf_id, cell, free)` is one of the cells `free` for a unit that
    is in `cell`; `park(robot)` is the cell for a robot that has no more work, or None: it waits
    where it is; `charging.policy` decides who is charged when. Transports get the numbers after
    `last`. Nothing is known of units until look() is told.
    """

    def __init__(self, plan, traffic, lift, last=0):
        self.plan, self.traffic, self._lift = plan, traffic, lift
        self.match_robots, self.choose_place = self._nearest_robots, self._nearest_place
        self.park = lambda robot: None
        self.stations = {station.name: station for station in plan.stations}
        self.is_open = dict.fromkeys(self.stations, True)
        self.left_out = frozenset()  # names of stations on the floor that no robot can reach
        self.totals = Totals()
        self.cell_of_unit = {}  # NOWHERE: not in a cell, or carried
        self._unit_in = {}  # those that stand, by cell
        self._places = np.flatnonzero(plan.storage)
        self._aside = (plan.storage | plan.parking).ravel()  # where nobody is in the way
        self._ready = []  # transports at step READY, in the order in which they came to it
        self._open = []  # transports without a robot, the most urgent first
        self._transports = {}
        self._of_robot = {}
        self._of_unit = {}
        self._inbound = collections.Counter()  # lifted units on their way to a station or there
        self._fetched = collections.Counter()  # units that are fetched for it
        self._events = []
        self._last = last
        self._put_down = {}  # when each unit was put down last [s]
        self._lost = set()  # units whose robots were lost: to be stored, wherever they are
        self._freed = []  # robots that have ended a transport since somebody looked
        self._shortest = {}  # of the journey that a robot is on, in cells
        self.charging = Charging(plan, traffic, self._far)

    # What is asked of it.

    def submit(self, shelf_id, station="", x=None, y=None, then=STORE, priority=0):
        """Asks for a unit to be brought to a station, or to the cell at (x, y) [m]. An Answer."""
        if shelf_id not in self.cell_of_unit:
            return Answer(0, False, f"there is no storage unit {shelf_id}")
        if not self._is_in_reach(self.cell_of_unit[shelf_id]):
            return Answer(0, False, f"no robot can come to storage unit {shelf_id} and back")
        if shelf_id in self._of_unit:
            number = self._of_unit[shelf_id].number
            return Answer(0, False, f"storage unit {shelf_id} has transport {number} already")
        if then not in (STORE, STAY):
            return Answer(0, False, f"then is {then}; 0 (STORE) or 1 (STAY) was expected")
        try:
            cell = self._destination(shelf_id, station, x, y)
        except ValueError as error:
            return Answer(0, False, str(error))
        transport = self._add(shelf_id, station, cell, then, priority)
        self._enqueue(transport)
        self._tell(transport, Kind.RECEIVED)
        return Answer(transport.number, True, "")

    def _is_in_reach(self, cell):
        return cell == NOWHERE or bool(self.plan.passable.flat[cell])

    def out_of_reach(self):
        """The units that no robot can come to, ascending."""
        return sorted(u for u, cell in self.cell_of_unit.items() if not self._is_in_reach(cell))

    def _add(self, shelf_id, station, cell, then=STORE, priority=0):
        self._last += 1
        transport = Transport(self._last, shelf_id, station, cell, then, priority)
        self._transports[self._last] = self._of_unit[shelf_id] = transport
        return transport

    def _destination(self, shelf_id, station, x, y):
        if station:
            if station in self.left_out:
                raise ValueError(f"no robot can come to station {station} and back")
            if station not in self.stations:
                raise ValueError(f"there is no station {station!r}")
            if not self.is_open[station]:
                raise ValueError(f"station {station} is closed")
            return self.stations[station].service_cell
        if x is None or y is None or not np.isfinite([x, y]).all():
            raise ValueError(f"neither a station nor a point: ({x}, {y})")
        cell = self.plan.cell_of(x, y)
        if cell == NOWHERE or not self.plan.passable.flat[cell]:
            raise ValueError(f"no robot can stand at ({x:g}, {y:g})")
        if self.plan.lane.flat[cell]:
            raise ValueError(f"({x:g}, {y:g}) is in the lane of a station; name the station")
        if cell in self._taken() and self._unit_in.get(cell) != shelf_id:
            raise ValueError(f"({x:g}, {y:g}) is taken")
        return cell

    def release(self, transport_id):
        """The station is done with the unit. (success, message)."""
        transport = self._transports.get(transport_id)
        if transport is None:
            return False, f"there is no transport {transport_id} under way"
        if transport.step != Step.WAITING:
            return False, f"transport {transport_id} has not arrived yet"
        if transport.let_go:
            return False, f"transport {transport_id} has been released already"
        transport.let_go = True
        return True, ""

    def cancel(self, transport_id):
        """Ends a transport; a unit that is lifted already is stored again. (success, message)."""
        transport = self._transports.get(transport_id)
        if transport is None:
            return False, f"there is no transport {transport_id} under way"
        if transport.step <= Step.READY:
            self._tell(transport, Kind.CANCELLED)
            self._end(transport)
        elif transport.step in (Step.LIFTING, Step.BRINGING, Step.WAITING):
            self._tell(transport, Kind.CANCELLED)
            transport.then, transport.let_go = STORE, True
            if transport.step == Step.BRINGING:
                self._store(transport)
        return True, ""

    def set_open(self, station, is_open):
        """A closed station gets no more units; those on the way there are stored again."""
        self.is_open[station] = is_open
        if is_open:
            return
        for transport in list(self._transports.values()):
            if transport.station == station and transport.step < Step.WAITING:
                self.cancel(transport.number)

    def refuge(self, kiva_id):
        """The nearest cell where a broken or lost robot would be in nobody's way, with what it
        carries. Raises ValueError: it works, or there is none."""
        traffic = self.traffic
        robot = traffic.index(kiva_id)
        if robot == NOWHERE:
            raise ValueError(f"there is no kiva{kiva_id}")
        if not (traffic.broken[robot] or traffic.lost[robot]):
            raise ValueError(f"kiva{kiva_id} is not broken")
        out = set(traffic.closed.tolist()) | set(traffic.cell.tolist()) | set(traffic.goal.tolist())
        out |= self._taken() if traffic.loaded[robot] else set()
        # Nor may anybody be about to pass there.
        cells = self._refuges(robot).tolist()
        free = [c for c in cells if c not in out and traffic.holder(c) == NOWHERE]
        cell = self._nearest(int(traffic.cell[robot]), free)
        if cell == NOWHERE:
            raise ValueError("there is no place for it")
        return cell

    def _refuges(self, robot):
        """Cells where nobody passes: with a unit, places for one; with an empty battery, those
        where it is charged."""
        if self.traffic.loaded[robot]:
            return self._places
        if self.traffic.failures[robot] >> EMPTY & 1 and len(self.plan.charging):
            return np.asarray(self.plan.charging)
        return np.flatnonzero(self._aside)

    def in_the_way(self, robots):
        """Which of those, (n,) bool, stand in a street or a lane."""
        cell = self.traffic.cell
        return robots & ~self.traffic.gone & ((cell == NOWHERE) | ~self._aside[cell])

    def take_events(self):
        """All TransportEvents since the last call."""
        events, self._events = self._events, []
        return events

    def waiting(self, station):
        """How many units are at a station or on the way to it."""
        return self._inbound[station] + self._fetched[station]

    def open_for(self, station):
        """How many of its transports have no robot yet."""
        return sum(transport.station == station for transport in self._open)

    def capacity(self, station):
        """How many may be lifted at a time: no more than have room in its lane."""
        return min(LIFTED, self.stations[station].service + 1)

    def __iter__(self):
        return iter(self._transports.values())

    def assigned(self):
        """Those that a robot does."""
        return self._of_robot.values()

    def in_lane(self, transport):
        """Whether its robot is in the lane of the station that it goes to."""
        station = self.stations.get(transport.station)
        return station is not None and self.traffic.cell[transport.robot] in station.queue

    def __contains__(self, transport_id):
        return transport_id in self._transports

    def look(self, shelf_id, x, y, yaw, carried, stamp):
        """Where all units stood at that time: arrays in world [m, rad], [s]; others move units as
        well. Nobody fetches one that stands across cells, nor passes there."""
        plan = self.plan
        cells = plan.cell_of(x, y)
        centre_x, centre_y = plan.point_of(cells)
        off = np.hypot(x - centre_x, y - centre_y)
        crooked = (off > CROOKED) | (
            abs(np.remainder(yaw + np.pi / 4, np.pi / 2) - np.pi / 4) > 0.1
        )
        crooked &= ~carried & (cells != NOWHERE)
        for unit in np.flatnonzero(crooked):
            half = UNIT_REACH * (abs(np.cos(yaw[unit])) + abs(np.sin(yaw[unit])))
            for dx, dy in itertools.product((-half, 0, half), repeat=2):
                self.traffic.shut(int(plan.cell_of(x[unit] + dx, y[unit] + dy)), stamp + STAYS)
        cells = np.where(carried | crooked, NOWHERE, cells)
        self.see(dict(zip(shelf_id.tolist(), cells.tolist())), stamp)

    def see(self, cells, stamp):
        """Where units stood at that time [s], {number: cell}. Those of transports under way, and
        those put down since then, are known better."""
        better = {t.shelf for t in self._of_robot.values() if t.step >= Step.LIFTING}
        better |= {shelf for shelf, time in self._put_down.items() if time >= stamp - SEEN_LATE}
        kept = {s: cell for s, cell in self.cell_of_unit.items() if s in better and s in cells}
        self.cell_of_unit = {**cells, **kept}
        self._unit_in = {cell: unit for unit, cell in self.cell_of_unit.items() if cell != NOWHERE}
        for transport in list(self._transports.values()):
            if transport.shelf not in self.cell_of_unit:
                self._fail(transport, f"storage unit {transport.shelf} is gone")
        self._recover()
        self._tell_traffic()

    def _recover(self):
        """Units that were left in the streets are put away again, before all else."""
        for shelf in sorted(self._lost & self.cell_of_unit.keys()):
            cell = self.cell_of_unit[shelf]
            if cell == NOWHERE or not self._is_in_reach(cell):
                continue
            self._lost.discard(shelf)
            if self.plan.storage.flat[cell]:
                continue
            if shelf in self._of_unit:
                self._of_unit[shelf].priority = URGENT
                self._open.sort(key=_urgency)
                continue
            transport = self._add(shelf, "", cell, priority=URGENT)
            self._enqueue(transport)
            self._tell(transport, Kind.RECEIVED, "its robot was lost")

    def _taken(self):
        """Cells with a unit, or kept for one that is under way."""
        return self._unit_in.keys() | {t.place for t in self._of_robot.values()}

    def _tell_traffic(self):
        storage = self.plan.storage.flat
        self.traffic.set_units([cell for cell in self._unit_in if not storage[cell]])

    def adopt(self, robot, shelf_id):
        """A robot that carries a unit, nobody knows why, stores it. Who has asked for the unit gets
        it then."""
        asked = self._of_unit.get(shelf_id)
        if robot in self._of_robot or (asked is not None and asked.robot != NOWHERE):
            return
        transport = self._add(shelf_id, "", int(self.traffic.cell[robot]))
        transport.robot = robot
        self._of_robot[robot] = transport
        self.cell_of_unit[shelf_id] = NOWHERE
        self.traffic.loaded[robot] = True
        self._tell(transport, Kind.RECEIVED, "its robot was found with it")
        self._store(transport, is_inbound=False)

    # What it does.

    def advance(self, report):
        """Goes on with all of them, by what robots report: the arrays of FleetState."""
        self._drop_lost()
        self._adopt_loaded(report)
        self._avoid(set(self.traffic.closed.tolist()))
        busy = np.flatnonzero(self.traffic.busy)
        for robot in busy:
            self._watch_lift(int(robot), report)
        for robot in self.traffic.arrived:
            self._arrive(int(robot))
        for transport in list(self._of_robot.values()):
            if transport.step == Step.WAITING and transport.let_go:
                self._leave(transport)
        self._admit()
        self.charging.advance(self._without_work(), True)
        self._assign()
        self.charging.advance(self._without_work(), bool(self._open))
        self._park()

    def _drop_lost(self):
        """Robots that somebody else commands now, or that are broken, have lost their
        transports."""
        traffic = self.traffic
        lost = self._are_lost()
        broken = traffic.broken | traffic.lifts_not
        for robot in np.flatnonzero(lost | broken):
            transport = self._of_robot.get(int(robot))
            if transport is None:
                continue
            if transport.step <= Step.READY:
                self._unassign(transport)
                continue
            if not lost[robot]:  # it may soon go on
                continue
            self._lost.add(transport.shelf)
            self._fail(transport, self._why_lost(robot))

    def _are_lost(self):
        """Which robots nobody waits for any longer, (n,) bool."""
        traffic = self.traffic
        return (traffic.mode != Mode.AUTOMATIC) | (traffic.time - traffic.stalled_since > DEAD)

    def _avoid(self, closed):
        """Units that can't get to the place that was chosen for them go to another."""
        for transport in list(self._of_robot.values()):
            is_away = self.traffic.cell[transport.robot] != transport.place
            if transport.step == Step.STORING and transport.place in closed and is_away:
                self._store(transport, is_inbound=False)

    def _why_lost(self, robot):
        if self.traffic.gone[robot]:
            return "its robot is gone"
        if self.traffic.broken[robot]:
            return "its robot is broken"
        if self.traffic.mode[robot] == Mode.AUTOMATIC:
            return "its robot does not move"
        return f"its robot is {Mode(self.traffic.mode[robot]).name} now"

    def _adopt_loaded(self, report):
        """Robots that have a unit without a transport: they were found so, or given back."""
        traffic = self.traffic
        shelf = np.asarray(report.shelf_id)
        loaded = shelf != 0
        known = np.fromiter(self._of_robot, int, len(self._of_robot))
        without = np.ones(len(loaded), bool)
        without[known] = False
        traffic.loaded[without] = loaded[without]
        # Who broke while it lifted, or stood at a station, and lost its transport, is free again.
        traffic.busy[without & ~traffic.broken & (np.asarray(report.status) == IDLE)] = False
        ready = without & loaded & traffic.stands & ~traffic.broken & ~self._are_lost()
        for robot in np.flatnonzero(ready):
            self.adopt(int(robot), int(shelf[robot]))

    def _watch_lift(self, robot, report):
        transport = self._of_robot.get(robot)
        if transport is None or transport.step not in (Step.LIFTING, Step.DROPPING):
            return
        is_up = transport.step == Step.LIFTING
        if report.status[robot] != 0:
            return
        if report.shelf_id[robot] == (transport.shelf if is_up else 0):
            self.traffic.busy[robot] = False
            self._bring(transport) if is_up else self._stored(transport)
        elif self.traffic.astray[robot]:  # lifts again when it is back in the middle
            self.traffic.busy[robot] = False
            transport.step = Step.FETCHING if is_up else Step.STORING
            if is_up:
                self._inbound[transport.station] -= 1
                self._fetched[transport.station] += 1
        elif self.traffic.time - transport.since > LIFT_PATIENCE:
            if transport.attempts < LIFT_ATTEMPTS:
                self._begin_lift(transport, transport.step)
            else:
                self.traffic.busy[robot] = False
                self._fail(transport, "its robot does not lift" if is_up else "it can't be dropped")

    def _begin_lift(self, transport, step):
        robot = transport.robot
        transport.step, transport.since = step, self.traffic.time
        transport.attempts += 1
        self.traffic.busy[robot] = True
        self._lift(int(self.traffic.kiva_ids[robot]), transport.shelf, step == Step.LIFTING)

    def _arrive(self, robot):
        transport = self._of_robot.get(robot)
        if transport is None:
            return
        if transport.step in (Step.FETCHING, Step.BRINGING, Step.STORING):
            self._count(robot)
        if transport.step == Step.FETCHING:
            transport.step, transport.since = Step.READY, self.traffic.time
            self._ready.append(transport)
        elif transport.step == Step.BRINGING:
            transport.step, transport.since = Step.WAITING, self.traffic.time
            self.traffic.busy[robot] = True
            self.totals.delivered += 1
            self._tell(transport, Kind.ARRIVED)
            if not transport.station:
                transport.let_go = True
        elif transport.step == Step.STORING:
            transport.attempts = 0
            self._begin_lift(transport, Step.DROPPING)

    def _count(self, robot):
        driven, planned, cells = self.traffic.journey(robot)
        self.totals.driven += driven
        self.totals.planned += planned
        self.totals.cells += cells
        self.totals.shortest += self._shortest.pop(robot, cells)

    def _send(self, transport, cell, home=NOWHERE):
        traffic, robot = self.traffic, transport.robot
        traffic.journey(robot)
        loaded = home != NOWHERE
        begin = int(traffic.cell[robot])
        self._shortest[robot] = traffic.floor.shortest(begin, int(cell), loaded=loaded)
        traffic.send(robot, cell, home)

    def _bring(self, transport):
        """The unit is lifted."""
        place = self.cell_of_unit[transport.shelf]
        self._unit_in.pop(place, None)
        self.cell_of_unit[transport.shelf] = NOWHERE
        self._tell_traffic()
        self.traffic.loaded[transport.robot] = True
        self._tell(transport, Kind.LIFTED)
        if transport.let_go:  # was cancelled meanwhile
            self._store(transport)
            return
        transport.step, transport.since = Step.BRINGING, self.traffic.time
        # The place stays reserved: there is always one to return to.
        transport.place = place
        self._send(transport, transport.cell, self._home(transport, place))

    def _home(self, transport, place):
        """What it may enter with its load: one storage place, that it leaves or goes to."""
        if self.plan.storage.flat[transport.cell]:
            return transport.cell
        return place

    def _leave(self, transport):
        """The unit is let go."""
        self.traffic.busy[transport.robot] = False
        self._tell(transport, Kind.RELEASED)
        self._inbound[transport.station] -= 1
        if transport.then == STAY:
            if self.plan.storage.flat[transport.cell]:
                transport.place = transport.cell
            transport.attempts = 0
            self._begin_lift(transport, Step.DROPPING)
        else:
            self._store(transport, is_inbound=False)

    def _store(self, transport, is_inbound=True):
        if is_inbound:
            self._inbound[transport.station] -= 1
        robot = transport.robot
        transport.place = NOWHERE
        out = self._taken() | set(self.traffic.closed.tolist())
        free = np.array([cell for cell in self._places.tolist() if cell not in out])
        place = int(self.choose_place(transport.shelf, int(self.traffic.cell[robot]), free))
        transport.place = place
        transport.step, transport.since = Step.STORING, self.traffic.time
        self._send(transport, place, place)

    def _stored(self, transport):
        robot = transport.robot
        cell = int(self.traffic.cell[robot])
        self.traffic.loaded[robot] = False
        self.cell_of_unit[transport.shelf] = cell
        self._unit_in[cell] = transport.shelf
        self._put_down[transport.shelf] = self.traffic.time
        self._tell_traffic()
        self.totals.stored += 1
        self._tell(transport, Kind.STORED)
        transport.step = Step.DROPPING
        self._end(transport)

    def _fail(self, transport, text):
        self.totals.failed += 1
        self._tell(transport, Kind.FAILED, text)
        if Step.READY < transport.step < Step.STORING:
            self._inbound[transport.station] -= 1
        self._end(transport)

    def _end(self, transport):
        if transport.step in (Step.FETCHING, Step.READY):
            self._fetched[transport.station] -= 1
        if transport in self._open:
            self._open.remove(transport)
        if transport.robot != NOWHERE:
            self._of_robot.pop(transport.robot, None)
            self._freed.append(transport.robot)
            self.traffic.goal[transport.robot] = NOWHERE
            self.traffic.home[transport.robot] = NOWHERE
        if self._of_unit.get(transport.shelf) is transport:
            del self._of_unit[transport.shelf]
            for asked in self._open:
                if asked.shelf == transport.shelf:
                    self._of_unit[asked.shelf] = asked
        self._transports.pop(transport.number, None)

    def _unassign(self, transport):
        """Another robot will fetch it."""
        self._fetched[transport.station] -= 1
        self._of_robot.pop(transport.robot, None)
        transport.robot, transport.step = NOWHERE, Step.OPEN
        self._enqueue(transport)

    def _enqueue(self, transport):
        self._open.append(transport)
        self._open.sort(key=_urgency)

    def _admit(self):
        """Lifts units for whose station there is room; who was there first comes first."""
        traffic = self.traffic
        waiting, self._ready = self._ready, []
        for transport in waiting:
            if transport.step != Step.READY:
                continue
            station, robot = transport.station, transport.robot
            is_full = station and self._inbound[station] >= self.capacity(station)
            is_there = traffic.stands[robot] and traffic.cell[robot] == traffic.goal[robot]
            if is_full or not is_there:
                self._ready.append(transport)
                continue
            self._fetched[station] -= 1
            self._inbound[station] += 1
            transport.attempts = 0
            self._begin_lift(transport, Step.LIFTING)

    def _without_work(self):
        traffic = self.traffic
        idle = (traffic.mode == Mode.AUTOMATIC) & ~traffic.busy & ~traffic.loaded
        idle &= traffic.cell != NOWHERE
        idle[list(self._of_robot)] = False
        return idle

    def _assign(self):
        """Robots for what waits, a few more than stations have room for."""
        if not self._open:
            return
        traffic = self.traffic
        able = ~traffic.stalled & ~traffic.lifts_not & ~self.charging.kept()
        free = np.flatnonzero(self._without_work() & able)
        asked = self._fetchable() if free.size else []
        for transport, robot in self.match_robots(asked, free) if asked else ():
            self._open.remove(transport)
            transport.robot, transport.step = int(robot), Step.FETCHING
            transport.since = self.traffic.time
            self._of_robot[transport.robot] = transport
            self._fetched[transport.station] += 1
            self._tell(transport, Kind.ASSIGNED)
            self._send(transport, self.cell_of_unit[transport.shelf])

    def _fetchable(self):
        """Transports without a robot that may have one now, the most urgent first."""
        found, fetched = [], self._fetched.copy()
        for transport in self._open:
            station = transport.station
            is_full = station and fetched[station] >= FETCHED
            if not is_full and self.cell_of_unit[transport.shelf] != NOWHERE:
                fetched[station] += 1
                found.append(transport)
        return found

    def _park(self):
        """Robots without work go where they are to wait; those that stand in a street or a lane go
        beneath a stored unit."""
        traffic = self.traffic
        idle = self._without_work()
        idle[list(self.charging.cell_of)] = False
        traffic.goal[idle & (traffic.goal == traffic.cell)] = NOWHERE
        # Whoever has work there comes first, and stays.
        traffic.goal[idle & np.isin(traffic.goal, traffic.goal[~idle])] = NOWHERE
        freed, self._freed = self._freed, []
        for robot in freed:
            cell = self.park(robot) if idle[robot] else None
            if cell is None or cell in traffic.goal:
                continue
            if cell != traffic.cell[robot] and self._aside[cell]:
                traffic.send(robot, cell)
        in_the_way = idle & (traffic.goal == NOWHERE) & ~self._aside[traffic.cell]
        if not in_the_way.any():
            return
        kept = set(traffic.goal.tolist()) | set(traffic.cell.tolist())
        places = [cell for cell in self._unit_in if self._aside[cell] and cell not in kept]
        for robot in np.flatnonzero(in_the_way):
            place = self._nearest(int(traffic.cell[robot]), places)
            if place != NOWHERE:
                places.remove(place)
                traffic.send(robot, place)

    def _nearest(self, cell, cells):
        if not len(cells):
            return NOWHERE
        cells = np.asarray(cells)
        return int(cells[self._far(cell, cells).argmin()])

    def _far(self, cell, cells):
        width = self.plan.passable.shape[1]
        (y, x), (ys, xs) = divmod(cell, width), np.divmod(cells, width)
        return np.abs(xs - x) + np.abs(ys - y)

    def _nearest_robots(self, asked, free):
        for transport in asked[: len(free)]:
            far = self._far(self.cell_of_unit[transport.shelf], self.traffic.cell[free])
            robot = free[far.argmin()]
            free = free[free != robot]
            yield transport, robot

    def _nearest_place(self, _shelf_id, cell, free):
        return self._nearest(cell, free)

    def _tell(self, transport, kind, text=""):
        robot = transport.robot
        kiva_id = int(self.traffic.kiva_ids[robot]) if robot != NOWHERE else 0
        self._events.append(
            TransportEvent(
                self.traffic.time,
                transport.number,
                kind,
                kiva_id,
                transport.shelf,
                transport.station,
                text,
            )
        )
