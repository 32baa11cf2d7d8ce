# SPDX-License-Identifier: Apache-2.0
"""The trips of ideal robots: to the unit, lift, to the station, queue, service, back, lower."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_fleet.robots.robot_table import NOWHERE
from warehouse_fleet.transports.transport_book import (
    BRINGING,
    DROPPING,
    LIFTING,
    READY,
    STAY,
    STORING,
    Kind,
    Transport,
    TransportBook,
)
from warehouse_layout.floor.rides import JoinedTable, Leg, Ride
from warehouse_operations.fleets.activities import ACTIVITIES
from warehouse_operations.fleets.availability import Upkeep
from warehouse_operations.fleets.consumption import Consumption, MassOfItems, Way
from warehouse_operations.fleets.ideal_floor import IdealFloor, Lane
from warehouse_operations.fleets.ideal_lifts import Lifts
from warehouse_operations.fleets.odometer import Odometer, Stretch
from warehouse_operations.stock.event_queue import EventQueue
from warehouse_operations.stock.protocols import Hooks, Task
from warehouse_operations.stock.travel import Table, Travel

OUT = "out of service"  # beside the ACTIVITIES
DRIVES = frozenset(("to unit", "to station", "back"))  # activities of robots on the floor's streets
TAKEN = 10.0  # penalty on the distance to an occupied charging place [m]
WAYS = 100_000  # most ways of loaded robots whose energy is cached
DEAD = 30.0  # after which a broken robot loses its transport [s]; as recover.DEAD
TOWED = 60.0  # after which people tow a robot that is broken in a lane [s]; as world_fleet's
RETRY = 1.0  # pause of a robot between two searches for a free storage place [s]


class Approach(NamedTuple):
    """The way of a robot to a charger: its first cell, when it begins and ends [s]."""

    start: int
    begin: float
    there: float


@dataclass(eq=False)
class Robot:
    """A robot without extent."""

    kiva_id: int
    cell: int
    index: int = 0
    activity: str = "idle"  # one of ACTIVITIES
    since: float = 0.0  # when the activity began [s]
    there: float = 0.0  # when it reaches its cell, if it drives there [s]
    in_service: bool = True
    halt: float = 0.0  # time that it has to stand on its way [s]
    able: float = 0.0  # end of its repair, if it failed while it waited [s]
    plan: int = 0  # the number of times that a failure took its transport from it
    heading: int = 0  # the difference of cells ahead and here; 0: unknown
    place: int | None = None  # the storage place that is kept for its unit
    approach: Approach | None = None  # its last way, if that led to a charger


class Trips:
    """Transports from their start to their end, each phase an event of `queue`.

    time: simulated [s]. book: all transports, with the events that they cause. odometer: counts
    what all robots drive. ways: how often each (service or end cell, other cell, outbound, ride)
    was driven with a load. arrive: is called with each transport whose unit has come to its
    destination.
    """

    def __init__(
        self, floor: IdealFloor, robots: Mapping[int, int], kinematics: Kinematics, hooks: Hooks
    ) -> None:
        self.floor, self.kinematics, self.hooks = floor, kinematics, hooks
        self.travel, self.queue = floor.travel, EventQueue()
        self.time, self.odometer = 0.0, Odometer()
        self.robots = [
            Robot(kiva_id, int(cell), index)
            for index, (kiva_id, cell) in enumerate(sorted(robots.items()))
        ]
        kiva_ids = [robot.kiva_id for robot in self.robots]
        self.book = TransportBook(kiva_ids, self, stations=floor.lanes)
        self.seconds = dict.fromkeys(ACTIVITIES, 0.0)
        self.arrive: Callable[[Transport], None] = lambda _transport: None
        self.ways: Counter[tuple[int, int, bool, Ride | None]] = Counter()
        self._idle = dict(enumerate(self.robots))  # by index
        self.upkeep: Upkeep | None = None
        self._consumption: Consumption | None = None
        self._ways_loaded: dict[tuple[int, int, bool, Ride | None], tuple[Way, ...]] = {}
        self.lifts = Lifts(self, len(floor.plan.elevators))
        self._width = floor.plan.passable.shape[1]
        self._cells, self._driving = int(floor.plan.passable.sum()), 0  # robots

    def keep_up(self, upkeep: Upkeep, items: MassOfItems) -> None:
        """Has robots charge, fail and be repaired from now on. items: the mass of those on each
        unit."""
        self.upkeep = upkeep
        if upkeep.drain:
            self._consumption = Consumption(
                upkeep.drain,
                self.kinematics,
                items,
                self.floor.plan.spacing,
                upkeep.radio_delay,
            )
        self._schedule_failure(upkeep)

    def _schedule_failure(self, upkeep: Upkeep) -> None:
        wait = upkeep.next_failure(len(self.robots))
        if wait < np.inf:
            self.queue.schedule(self.time + wait, self._fail_by_chance, upkeep)

    def _fail_by_chance(self, upkeep: Upkeep) -> None:
        index, duration = upkeep.draw_failure(len(self.robots))
        if duration:
            upkeep.note_failure(self.time, duration)
            self._break_down(self.robots[index], duration)
        self._schedule_failure(upkeep)

    def _break_down(self, robot: Robot, duration: float) -> None:
        """Breaks a robot down: another one fetches a unit that it has not lifted; the transport of
        a unit on it fails, unless it is repaired within DEAD."""
        transport = self.book.of_robot.get(robot.index)
        if transport and transport.step <= READY:
            robot.plan += 1
            self.lifts.drop(robot, min(duration, TOWED))
            self.book.unassign(transport)
            self._free(robot)
            robot.there = self.time + duration
        elif transport and duration > DEAD:
            self.queue.schedule(self.time + DEAD, self._lose, (robot, transport, duration - DEAD))
            self.fail(robot.index, duration)
        else:
            self.fail(robot.index, duration)

    def _lose(self, lost: tuple[Robot, Transport, float]) -> None:
        """Ends the transport of a broken robot with its unit; people tow it out of a lane, and the
        unit is stored after the repair."""
        robot, transport, left = lost
        if self.book.of_robot.get(robot.index) is not transport:
            return  # it ended meanwhile
        robot.plan += 1
        robot.halt, robot.able = 0.0, 0.0
        self._leave_lane(transport, min(left, TOWED - DEAD))
        self.lifts.drop(robot, min(left, TOWED - DEAD))
        if robot.place is not None:
            self.floor.clear(robot.place)
            robot.place = None
        has_unit = transport.shelf not in self.floor.units
        self.book.publish_event(transport, Kind.FAILED, "its robot is broken")
        self.book.remove(transport)
        self._begin(robot, "idle")
        carried = transport.shelf if has_unit else None
        self.queue.schedule(self.time + left, self._repaired, (robot, carried))

    def _leave_lane(self, transport: Transport, delay: float) -> None:
        lane = self._lane(transport)
        if lane and transport in lane.queue:
            lane.queue.remove(transport)
        elif lane and lane.serving is transport:
            lane.serving, lane.free_from = None, self.time + delay
            self._serve_next(lane, float(self.kinematics.run(self.floor.plan.spacing)))

    def without_transport(self) -> dict[int, int]:
        """Returns the units that broken robots carry without a transport: the id of each robot."""
        events = (event.argument for event in self.queue if event.act == self._repaired)
        return {unit: robot.kiva_id for robot, unit in events if unit is not None}

    def _repaired(self, work: tuple[Robot, int | None]) -> None:
        """Puts a repaired robot that lost its transport back to work: it stores the unit that it
        still carries. A transport that asks for the unit is done after that."""
        robot, unit = work
        if unit is None:
            self._free(robot)
            return
        transport = self.book.add(unit, "", robot.cell)
        self.book.hand_over(transport, robot.index)
        self.book.go_on(transport, STORING)
        self.book.publish_event(transport, Kind.RECEIVED, "its robot was found with it")
        self._store(transport)

    def _charge(self, upkeep: Upkeep, is_wanted: bool) -> None:
        """Sends robots without work to charging places. is_wanted: whether transports wait."""
        for index in self._idle:
            upkeep.note(index, self.time)
            upkeep.release_full(index)
        wants = [index for index in self._idle if upkeep.wants(index, is_wanted)]
        for index in sorted(wants, key=lambda index: float(upkeep.charge[index])):
            cells = upkeep.free_cells(index)
            if not cells:
                break
            self._drive_to_charger(upkeep, index, cells)

    def _drive_to_charger(self, upkeep: Upkeep, index: int, cells: list[int]) -> None:
        robot = self._idle[index]
        cells = self._on_its_tier(robot, cells) or cells
        seconds, metres = self.travel.unloaded([robot.cell], cells)
        taken = np.array([cell != robot.cell and upkeep.is_taken(cell) for cell in cells])
        at = int((metres[0] + TAKEN * taken).argmin())
        begin = max(self.time, robot.there)
        robot.there = begin + float(seconds[0, at])
        self.odometer.begin(index, self.time, Stretch(begin, robot.there, float(metres[0, at])))
        self._spend_unloaded(robot, self.travel.unloaded_legs(robot.cell, cells[at]))
        robot.approach = Approach(robot.cell, begin, robot.there)
        robot.cell = cells[at]
        able = upkeep.begin(index, robot.cell, robot.there)
        self.queue.schedule(max(able, self.time), _wake, None)

    def _on_its_tier(self, robot: Robot, cells: list[int]) -> list[int]:
        """Returns the cells on a robot's tier: one without work rides no elevator to park."""
        if not self.floor.plan.elevators:
            return cells
        tier = self.floor.plan.tier.flat
        return [cell for cell in cells if tier[cell] == tier[robot.cell]]

    def _turn_off(self, robot: Robot) -> None:
        """Stops a robot on its way to a charger."""
        here, there = self._start(robot)
        if self.upkeep and robot.approach and here != robot.cell:
            self.odometer.stop(robot.index, self.time)
            legs = self.travel.unloaded_legs(here, robot.cell)
            self._spend_unloaded(replace(robot, cell=here), legs, back=True)
        robot.cell, robot.there, robot.approach = here, there, None

    def step_until(self, time: float) -> None:
        """Goes on to a time [s], or to the first event before it."""
        self._match()
        while not self.book.has_events and self.queue.next_time <= time:
            self.time = self.queue.next_time
            self.queue.run_next()
            self._match()
        if not self.book.has_events:
            self.time = max(self.time, time)

    def activities(self) -> dict[str, float]:
        """Returns the robot-seconds spent on each of ACTIVITIES up to now."""
        total = dict(self.seconds)
        for robot in self.robots:
            if robot.activity != OUT:
                total[robot.activity] += self.time - robot.since
        return total

    def set_in_service(self, index: int, in_service: bool) -> None:
        """Takes a robot out of service, once its transport is over, or back."""
        robot = self.robots[index]
        robot.in_service = in_service
        if not in_service and index in self._idle:
            del self._idle[index]
            self._begin(robot, OUT)
        elif in_service and robot.activity == OUT:
            self._begin(robot, "idle")
            self._idle[index] = robot

    def fail(self, index: int, duration: float) -> None:
        """Has a robot stand for a while [s], with its load if it has one."""
        robot = self.robots[index]
        if robot.activity in ("idle", OUT):
            robot.there = max(robot.there, self.time) + duration
        elif robot.activity in ("queue", "service"):
            robot.able = max(robot.able, self.time) + duration
        else:
            robot.halt += duration
            self.odometer.halt(index, self.time, duration)

    def set_kinematics(self, kinematics: Kinematics) -> None:
        """Sets the travel times of robots from their next way on."""
        self.kinematics = kinematics
        self.travel = self.floor.travel = Travel(self.floor.plan, kinematics)

    def _spend_unloaded(self, robot: Robot, legs: Sequence[Leg], back: bool = False) -> None:
        """Takes the energy of a way without a unit, along the floor's axes, from the battery, or
        puts it back where that way is not driven after all."""
        if not self.upkeep or not self._consumption:
            return
        spacing, density = self.floor.plan.spacing, self._driving / self._cells
        start = robot.cell
        for leg in legs:
            way = Way.along_axes(start, leg.end, self._width, spacing, robot.heading)
            energy = self._consumption.drive(way, robot.heading, None, density)
            self.upkeep.spend(robot.index, -energy if back else energy)
            robot.heading = way.last or robot.heading
            start = leg.ride.end if leg.ride else leg.end

    def _drive_loaded(
        self,
        transport: Transport,
        end: int,
        other: int,
        outbound: bool,
        act: Callable[[Any], object],
        argument: Any,
    ) -> None:
        """Begins the way with a unit from another cell to an end, or back if it is outbound."""
        table = self.travel.loaded_from(end) if outbound else self.travel.loaded_to(end)
        via = self.lifts.best(table.options(other))
        self._spend_loaded(transport, table, (end, other, outbound, via))
        legs = table.legs(other, end, via)
        self.ways[end, other, outbound, via] += 1
        self._drive(legs, act, argument, self._driver(transport))

    def _spend_loaded(
        self,
        transport: Transport,
        table: Table | JoinedTable,
        key: tuple[int, int, bool, Ride | None],
    ) -> None:
        """Takes the energy of a way with a unit, by a key of `ways`, from the battery."""
        if not self.upkeep or not self._consumption:
            return
        if key not in self._ways_loaded:
            if len(self._ways_loaded) >= WAYS:
                self._ways_loaded.clear()
            _, other, outbound, via = key
            runs = table.runs(other, via)
            runs = [run[::-1] for run in runs[::-1]] if outbound else runs
            spacing = self.floor.plan.spacing
            self._ways_loaded[key] = tuple(Way.along(run, spacing) for run in runs)
        robot, density = self._driver(transport), self._driving / self._cells
        for way in self._ways_loaded[key]:
            energy = self._consumption.drive(way, robot.heading, transport.shelf, density)
            self.upkeep.spend(robot.index, energy)
            robot.heading = way.last or robot.heading

    def _spend_in_lane(self, transport: Transport, lane: Lane) -> None:
        """Takes the energy of moving up cell by cell from the battery: a start and a stop for each
        robot that is ahead in the lane."""
        if not self.upkeep or not self._consumption:
            return
        ahead = min(len(lane.queue) + (lane.serving is not None), lane.station.service)
        spacing = self.floor.plan.spacing
        self.upkeep.spend(
            transport.robot, ahead * self._consumption.start(spacing, transport.shelf)
        )

    def stretched(self, seconds: float, act: Callable[[Any], object]) -> float:
        """Returns the time of a drive that ends with an act [s]; here as it is."""
        return seconds

    def _drive(
        self,
        legs: Sequence[Leg],
        act: Callable[[Any], object],
        argument: Any,
        robot: Robot,
        wait: float = 0.0,
    ) -> None:
        """Schedules an act at the end of a way that begins after a wait [s]."""
        if len(legs) > 1:
            self.lifts.begin(wait, legs, act, argument, robot)
        else:
            self.set_out(robot, wait, legs[0])
            self.schedule(wait + legs[0].seconds, act, argument, robot)

    def set_out(self, robot: Robot, wait: float, leg: Leg) -> None:
        """Has the odometer count a drive that begins after a wait [s]."""
        begin = self.time + wait + max(robot.able - self.time, 0.0)
        way = Stretch(begin, begin + leg.seconds, leg.metres)
        self.odometer.begin(robot.index, self.time, way)

    def schedule(
        self, delay: float, act: Callable[[Any], object], argument: Any, robot: Robot
    ) -> None:
        """Schedules an act of a robot after a delay [s], later by its halts meanwhile."""
        delay += max(robot.able - self.time, 0.0)
        planned = act, argument, robot, robot.plan
        self.queue.schedule(self.time + delay, self._act, planned)

    def _act(self, planned: tuple[Callable[[Any], object], Any, Robot, int]) -> None:
        act, argument, robot, plan = planned
        if plan != robot.plan:
            return
        if robot.halt:
            halt, robot.halt = robot.halt, 0.0
            self.queue.schedule(self.time + halt, self._act, planned)
        else:
            act(argument)

    def _driver(self, transport: Transport) -> Robot:
        return self.robots[transport.robot]

    def _begin(self, robot: Robot, activity: str) -> None:
        if self.upkeep:
            self.upkeep.note(robot.index, self.time)
        if robot.activity != OUT:
            self.seconds[robot.activity] += self.time - robot.since
        self._driving += (activity in DRIVES) - (robot.activity in DRIVES)
        robot.activity, robot.since = activity, self.time

    def _match(self) -> None:
        """Gives robots without work the transports that wait, and lets them charge otherwise."""
        if not self._idle:
            return
        if self.upkeep:
            self._charge(self.upkeep, is_wanted=True)
        if self.book.open:
            self._match_open()
        # What has just ended may lead to more work at once.
        if self.upkeep and not self.book.open and not self.book.has_events:
            self._charge(self.upkeep, is_wanted=False)

    def _match_open(self) -> None:
        upkeep = self.upkeep
        indices = [index for index in self._idle if not upkeep or upkeep.may_work(index)]
        # A unit that a broken robot carries can be asked for, and not be fetched.
        waiting = [asked for asked in self.book.open if asked.shelf in self.floor.units]
        if not indices or not waiting:
            return
        robots = [self._idle[index] for index in indices]
        starts = [self._start(robot) for robot in robots]
        cells = np.array([self.floor.units[transport.shelf] for transport in waiting])
        at = np.array([cell for cell, _ in starts])
        seconds, _ = self.travel.unloaded(cells, at)
        # A robot that drives somewhere must arrive first.
        seconds += np.array([max(there - self.time, 0.0) for _, there in starts])
        tasks, changes = self._tasks(waiting), self.travel.changes(cells[:, None], at)
        ids = [robot.kiva_id for robot in robots]
        for task, robot in self.hooks.match_robots(tasks, ids, seconds + changes):
            self._assign(waiting[task], indices[robot], seconds[task, robot])

    def _start(self, robot: Robot) -> tuple[int, float]:
        """Returns the cell from which an idle robot can start, and the time of its arrival there
        [s]."""
        approach = robot.approach
        if not approach or not self.time < robot.there == approach.there:
            return robot.cell, robot.there
        if not self._on_its_tier(robot, [approach.start]):
            return robot.cell, robot.there  # it rides, and goes on to the end
        left = min((robot.there - self.time) / (approach.there - approach.begin), 1.0)
        here = _between(approach.start, robot.cell, 1 - left, self._width)
        return here, max(self.time, approach.begin)

    def _tasks(self, waiting: list[Transport]) -> list[Task]:
        asked = Counter(transport.station for transport in waiting)
        coming = {name: self.book.waiting(name) + count for name, count in asked.items() if name}
        return [
            Task(
                transport.number,
                transport.shelf,
                transport.station,
                transport.priority,
                coming.get(transport.station, 0),
            )
            for transport in waiting
        ]

    def _assign(self, transport: Transport, index: int, seconds: float) -> None:
        robot = self._idle.pop(index)
        if self.upkeep:
            self._turn_off(robot)
            self.upkeep.leave(index)
        cell, wait = self.floor.units[transport.shelf], max(robot.there - self.time, 0.0)
        via = self.lifts.best(self.travel.unloaded_options(robot.cell, cell))
        legs = self.travel.unloaded_legs(robot.cell, cell, via)
        self._spend_unloaded(robot, legs)
        robot.cell, robot.there = cell, self.time + seconds
        self.book.assign(transport, index)
        self.book.publish_event(transport, Kind.ASSIGNED)
        self._begin(robot, "to unit")
        self._drive(legs, self._reach_unit, transport, robot, wait)

    def _reach_unit(self, transport: Transport) -> None:
        if transport.number not in self.book:
            return
        for step in (READY, LIFTING):
            self.book.go_on(transport, step)
        robot = self._driver(transport)
        self._begin(robot, "lift")
        if self.upkeep and self._consumption:
            self.upkeep.spend(robot.index, self._consumption.lift(transport.shelf))
        self.schedule(self.kinematics.lift, self._lift, transport, robot)

    def _lift(self, transport: Transport) -> None:
        home = self.floor.units.pop(transport.shelf)
        self.floor.clear(home)
        self.book.publish_event(transport, Kind.LIFTED)
        if transport.leave:  # was cancelled meanwhile
            self.book.go_on(transport, STORING)
            self._store(transport)
            return
        self.book.go_on(transport, BRINGING)
        self._begin(self._driver(transport), "to station")
        self._drive_loaded(transport, transport.cell, home, False, self._reach_end, transport)

    def _reach_end(self, transport: Transport) -> None:
        self._driver(transport).cell = transport.cell
        if transport.step == STORING:  # was turned back
            self._store(transport)
        elif lane := self._lane(transport):
            self._begin(self._driver(transport), "queue")
            self._spend_in_lane(transport, lane)
            lane.queue.append(transport)
            self._serve_next(lane, 0.0)
        else:
            self._arrive(transport)

    def _lane(self, transport: Transport) -> Lane | None:
        return self.floor.lanes.get(transport.station)

    def _serve_next(self, lane: Lane, moving_up: float) -> None:
        """Moves the first in the lane to the service cell as soon as that has been left."""
        if lane.serving or not lane.queue:
            return
        lane.serving = lane.queue.popleft()
        delay = max(lane.free_from - self.time, 0.0) + moving_up
        self.schedule(delay, self._arrive, lane.serving, self._driver(lane.serving))

    def _arrive(self, transport: Transport) -> None:
        if transport.step == STORING:  # was turned back
            self._clear_lane(transport)
            self._store(transport)
            return
        if lane := self._lane(transport):
            lane.waited += self.time - self._driver(transport).since
        self._begin(self._driver(transport), "service")
        self.arrive(transport)

    def turn_back(self, transport: Transport) -> None:
        """Stores a unit on its way to a station: the robot drives on, and turns at the end."""
        self.book.go_on(transport, STORING)

    def leave(self, transport: Transport) -> None:
        """Has a unit leave its station, or be lowered where it is."""
        self.book.publish_event(transport, Kind.RELEASED)
        self._clear_lane(transport)
        if transport.then == STAY:
            self.floor.free[transport.cell] = False
            self._lower((transport, transport.cell))
        else:
            self.book.go_on(transport, STORING)
            self._store(transport)

    def _clear_lane(self, transport: Transport) -> None:
        """Frees the service cell for when the robot with its unit has left it."""
        lane = self._lane(transport)
        if lane and lane.serving is transport:
            spacing = self.floor.plan.spacing
            lane.serving = None
            lane.free_from = self.time + self.kinematics.leaving(spacing)
            self._serve_next(lane, float(self.kinematics.run(spacing)))

    def _store(self, transport: Transport) -> None:
        """Sends a unit to a free place that the policy chooses."""
        robot = self._driver(transport)
        table = self.travel.loaded_from(robot.cell)
        free = self.free()
        cells = np.flatnonzero(free & np.isfinite(table.seconds))
        if not len(cells):
            self._begin(robot, "idle")
            self.schedule(RETRY, self._store, transport, robot)
            return
        place = int(self.hooks.choose_place(transport.shelf, cells, table.distance[cells]))
        self.floor.free[place] = False
        robot.place = place
        self._begin(robot, "back")
        argument = transport, place
        self._drive_loaded(transport, robot.cell, place, True, self._lower, argument)

    def free(self) -> np.ndarray:
        """Returns (cells,) bool: storage places where no unit stands or is to be brought."""
        free = self.floor.free
        if kept := self.book.destinations():
            free = free.copy()
            free[kept] = False
        return free

    def _lower(self, argument: tuple[Transport, int]) -> None:
        transport, place = argument
        robot = self._driver(transport)
        robot.cell = place
        self.book.go_on(transport, DROPPING)
        self._begin(robot, "lift")
        self.schedule(self.kinematics.lift, self._drop, argument, robot)

    def _drop(self, argument: tuple[Transport, int]) -> None:
        transport, place = argument
        self.floor.units[transport.shelf] = place
        self._driver(transport).place = None
        self.book.publish_event(transport, Kind.STORED)
        self.end(transport)

    def end(self, transport: Transport) -> None:
        """Removes a transport that is over; its robot is free."""
        self.book.remove(transport)
        if transport.robot == NOWHERE:
            return
        self._free(self._driver(transport))

    def _free(self, robot: Robot) -> None:
        """Makes a robot without a transport available for another one."""
        if robot.halt:  # it failed just before
            robot.there, robot.halt = max(robot.there, self.time) + robot.halt, 0.0
        if not robot.in_service:
            self._begin(robot, OUT)
            return
        self._begin(robot, "idle")
        self._idle[robot.index] = robot
        to = self.hooks.park(robot.kiva_id, robot.cell)
        if to is not None and to != robot.cell and self._on_its_tier(robot, [int(to)]):
            seconds, metres = self.travel.unloaded([robot.cell], [to])
            begin = max(self.time, robot.there)
            self._spend_unloaded(robot, self.travel.unloaded_legs(robot.cell, int(to)))
            robot.cell, robot.there = int(to), begin + float(seconds[0, 0])
            way = Stretch(begin, robot.there, float(metres[0, 0]))
            self.odometer.begin(robot.index, self.time, way)


def _wake(_: object) -> None:
    """Does nothing; as any event, it is followed by an assignment of work."""


def _between(start: int, end: int, share: float, width: int) -> int:
    """Returns the cell after a share of the way along the axes between two, along the row first."""
    (y, x), (to_y, to_x) = divmod(start, width), divmod(end, width)
    along = round(share * (abs(to_x - x) + abs(to_y - y)))
    in_row = min(along, abs(to_x - x))
    in_column = along - in_row
    x += in_row if to_x > x else -in_row
    y += in_column if to_y > y else -in_column
    return y * width + x
