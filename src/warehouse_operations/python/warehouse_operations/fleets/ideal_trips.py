# SPDX-License-Identifier: Apache-2.0
"""The trips of ideal robots: to the unit, lift, to the station, queue, service, back, lower."""

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

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
from warehouse_operations.fleets.activities import ACTIVITIES
from warehouse_operations.fleets.availability import Upkeep
from warehouse_operations.fleets.ideal_floor import IdealFloor, Lane
from warehouse_operations.stock.event_queue import EventQueue
from warehouse_operations.stock.protocols import Hooks, Task
from warehouse_operations.stock.travel import Travel

UNDER_WAY = ("to unit", "lift", "to station", "back")
OUT = "out of service"  # beside the ACTIVITIES
RETRY = 1.0  # pause of a robot without a free storage place before it looks again [s]


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
    halt: float = 0.0  # for how long it has to stand amid its way [s]
    able: float = 0.0  # when it can drive again, if it failed while it waited [s]


class Trips:
    """Transports from their start to their end, each phase an event of `queue`.

    time: simulated [s]. book: all transports, with the events that they cause. distance_m: driven
    by all robots. ways: how often each (service or end cell, other cell, outbound) was driven with
    a load. arrive: is called with each transport whose unit has come to its destination.
    """

    def __init__(
        self, floor: IdealFloor, robots: Mapping[int, int], kinematics: Kinematics, hooks: Hooks
    ) -> None:
        self.floor, self.kinematics, self.hooks = floor, kinematics, hooks
        self.travel, self.queue = floor.travel, EventQueue()
        self.time = self.distance_m = 0.0
        self.robots = [
            Robot(kiva_id, int(cell), index)
            for index, (kiva_id, cell) in enumerate(sorted(robots.items()))
        ]
        kiva_ids = [robot.kiva_id for robot in self.robots]
        self.book = TransportBook(kiva_ids, self, stations=floor.lanes)
        self.seconds = dict.fromkeys(ACTIVITIES, 0.0)
        self.arrive: Callable[[Transport], None] = lambda _transport: None
        self.ways: Counter[tuple[int, int, bool]] = Counter()
        self._idle = dict(enumerate(self.robots))  # by index
        self.upkeep: Upkeep | None = None

    def keep_up(self, upkeep: Upkeep) -> None:
        """Has robots charge, fail and be repaired from now on."""
        self.upkeep = upkeep
        self._schedule_failure(upkeep)

    def _schedule_failure(self, upkeep: Upkeep) -> None:
        wait = upkeep.next_failure(len(self.robots))
        if wait < np.inf:
            self.queue.schedule(self.time + wait, self._fail_by_chance, upkeep)

    def _fail_by_chance(self, upkeep: Upkeep) -> None:
        index, duration = upkeep.draw_failure(len(self.robots))
        if duration:
            self.fail(index, duration)
            upkeep.down_s += duration
        self._schedule_failure(upkeep)

    def _charge(self, upkeep: Upkeep) -> dict[int, Robot]:
        """Sends robots without work to charging places; returns those that may be given work."""
        is_wanted = bool(self.book.open)
        for index, robot in self._idle.items():
            upkeep.note(index, self.time, robot.there > self.time)
            if upkeep.is_full(index):
                upkeep.leave(index)
        wants = [index for index in self._idle if upkeep.wants(index, is_wanted)]
        for index in sorted(wants, key=lambda index: float(upkeep.charge[index])):
            cells = upkeep.free_cells(index)
            if not cells:
                break
            self._drive_to_charger(upkeep, index, cells)
        return {index: robot for index, robot in self._idle.items() if upkeep.may_work(index)}

    def _drive_to_charger(self, upkeep: Upkeep, index: int, cells: list[int]) -> None:
        robot = self._idle[index]
        seconds, metres = self.travel.unloaded([robot.cell], cells)
        at = int(seconds[0].argmin())
        self.distance_m += float(metres[0, at])
        robot.there = max(self.time, robot.there) + float(seconds[0, at])
        robot.cell = cells[at]
        able = upkeep.begin(index, robot.cell, robot.there)
        self.queue.schedule(max(able, self.time), _wake, None)

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

    def set_kinematics(self, kinematics: Kinematics) -> None:
        """Has robots drive otherwise from their next way on."""
        self.kinematics = kinematics
        self.travel = self.floor.travel = Travel(self.floor.plan, kinematics)

    def _schedule(
        self, delay: float, act: Callable[[Any], object], argument: Any, robot: Robot
    ) -> None:
        """Has a robot act after a delay [s], and as much later as it had to stand meanwhile."""
        delay += max(robot.able - self.time, 0.0)
        self.queue.schedule(self.time + delay, self._act, (act, argument, robot))

    def _act(self, planned: tuple[Callable[[Any], object], Any, Robot]) -> None:
        act, argument, robot = planned
        if robot.halt:
            halt, robot.halt = robot.halt, 0.0
            self.queue.schedule(self.time + halt, self._act, planned)
        else:
            act(argument)

    def _driver(self, transport: Transport) -> Robot:
        return self.robots[transport.robot]

    def _begin(self, robot: Robot, activity: str) -> None:
        if self.upkeep:
            self.upkeep.note(robot.index, self.time, robot.activity in UNDER_WAY)
        if robot.activity != OUT:
            self.seconds[robot.activity] += self.time - robot.since
        robot.activity, robot.since = activity, self.time

    def _match(self) -> None:
        """Gives robots without work the transports that wait."""
        if not self._idle:
            return
        if not self.book.open:
            if self.upkeep:
                self._charge(self.upkeep)
            return
        idle = self._charge(self.upkeep) if self.upkeep else self._idle
        if not idle:
            return
        waiting, robots = list(self.book.open), list(idle.values())
        indices = list(idle)
        seconds, metres = self.travel.unloaded(
            [self.floor.units[transport.shelf] for transport in waiting],
            [robot.cell for robot in robots],
        )
        # One that drives somewhere must come there first.
        seconds += np.array([max(robot.there - self.time, 0.0) for robot in robots])
        tasks = self._tasks(waiting)
        for task, robot in self.hooks.match_robots(tasks, [r.kiva_id for r in robots], seconds):
            self.distance_m += metres[task, robot]
            self._assign(waiting[task], indices[robot], seconds[task, robot])

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
            self.upkeep.leave(index)
        robot.cell, robot.there = self.floor.units[transport.shelf], self.time + seconds
        self.book.assign(transport, index)
        self.book.publish_event(transport, Kind.ASSIGNED)
        self._begin(robot, "to unit")
        self._schedule(seconds, self._reach_unit, transport, robot)

    def _reach_unit(self, transport: Transport) -> None:
        if transport.number not in self.book:
            return
        for step in (READY, LIFTING):
            self.book.go_on(transport, step)
        robot = self._driver(transport)
        self._begin(robot, "lift")
        self._schedule(self.kinematics.lift, self._lift, transport, robot)

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
        table = self.travel.loaded_to(transport.cell)
        self.distance_m += table.metres[home]
        self.ways[transport.cell, home, False] += 1
        self._schedule(table.seconds[home], self._reach_end, transport, self._driver(transport))

    def _reach_end(self, transport: Transport) -> None:
        self._driver(transport).cell = transport.cell
        if transport.step == STORING:  # was turned back
            self._store(transport)
        elif lane := self._lane(transport):
            self._begin(self._driver(transport), "queue")
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
        self._schedule(delay, self._arrive, lane.serving, self._driver(lane.serving))

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
        """Has a unit stored that is being brought: the robot drives on, and turns at the end."""
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
            self._schedule(RETRY, self._store, transport, robot)
            return
        place = int(self.hooks.choose_place(transport.shelf, cells, table.metres[cells]))
        self.floor.free[place] = False
        self._begin(robot, "back")
        self.distance_m += table.metres[place]
        self.ways[robot.cell, place, True] += 1
        self._schedule(table.seconds[place], self._lower, (transport, place), robot)

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
        self._schedule(self.kinematics.lift, self._drop, argument, robot)

    def _drop(self, argument: tuple[Transport, int]) -> None:
        transport, place = argument
        self.floor.units[transport.shelf] = place
        self.book.publish_event(transport, Kind.STORED)
        self.end(transport)

    def end(self, transport: Transport) -> None:
        """Removes a transport that is over; its robot is free."""
        self.book.remove(transport)
        if transport.robot == NOWHERE:
            return
        robot = self._driver(transport)
        if robot.halt:  # it failed just before
            robot.there, robot.halt = max(robot.there, self.time) + robot.halt, 0.0
        if not robot.in_service:
            self._begin(robot, OUT)
            return
        self._begin(robot, "idle")
        self._idle[transport.robot] = robot
        to = self.hooks.park(robot.kiva_id, robot.cell)
        if to is not None and to != robot.cell:
            seconds, metres = self.travel.unloaded([robot.cell], [to])
            self.distance_m += float(metres[0, 0])
            begin = max(self.time, robot.there)
            robot.cell, robot.there = int(to), begin + float(seconds[0, 0])


def _wake(_: object) -> None:
    """Does nothing: after it, robots that may work again are given work."""
