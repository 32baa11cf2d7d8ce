# SPDX-License-Identifier: Apache-2.0
"""The trips of ideal robots: to the unit, lift, to the station, queue, service, back, lower."""

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from warehouse_fleet.kinematics import Kinematics
from warehouse_fleet.transports import STAY, Kind, TransportEvent
from warehouse_operations.activities import ACTIVITIES
from warehouse_operations.event_queue import EventQueue
from warehouse_operations.ideal_floor import IdealFloor, Lane
from warehouse_operations.protocols import Hooks, Task

RETRY = 1.0  # after which a robot that found no free storage place looks for one again [s]


@dataclass(eq=False)
class Robot:
    """A robot without extent."""

    kiva_id: int
    cell: int
    activity: str = "idle"  # one of ACTIVITIES
    since: float = 0.0  # when the activity began [s]
    parked: float = 0.0  # when it reaches its cell, if it drives there without a task [s]


@dataclass(eq=False)
class Transport:
    """A unit's way to a station or cell, and back."""

    transport_id: int
    shelf_id: int
    lane: Lane | None  # None: to a cell
    cell: int  # where it ends: the lane's service cell, or another
    then: int  # STORE or STAY
    priority: int
    robot: Robot | None = None
    arrived: bool = False
    cancelled: bool = False

    @property
    def driver(self) -> Robot:
        """The robot of a transport under way."""
        assert self.robot is not None
        return self.robot


class Trips:
    """Transports from their start to their end, each phase an event of `queue`.

    time: simulated [s]. open: all transports, by id; waiting: those without a robot. events: what
    has happened since they were last taken. distance_m: driven by all robots. ways: how often each
    (service or end cell, other cell, outbound) was driven with a load.
    """

    def __init__(
        self, floor: IdealFloor, robots: Mapping[int, int], kinematics: Kinematics, hooks: Hooks
    ) -> None:
        self.floor, self.kinematics, self.hooks = floor, kinematics, hooks
        self.travel, self.queue = floor.travel, EventQueue()
        self.time = self.distance_m = 0.0
        self.robots = {i: Robot(i, int(cell)) for i, cell in sorted(robots.items())}
        self.seconds = dict.fromkeys(ACTIVITIES, 0.0)
        self.open: dict[int, Transport] = {}
        self.waiting: dict[int, Transport] = {}
        self.events: list[TransportEvent] = []
        self.ways: Counter[tuple[int, int, bool]] = Counter()
        self._idle = dict(self.robots)

    def add(self, transport: Transport) -> None:
        """Takes a new transport, which waits for a robot."""
        self.open[transport.transport_id] = self.waiting[transport.transport_id] = transport
        self.floor.busy.add(transport.shelf_id)
        if transport.lane:
            transport.lane.inbound += 1
        elif transport.then == STAY:
            self.floor.free[transport.cell] = False
        self._add_event(Kind.RECEIVED, transport)

    def cancel(self, transport: Transport) -> None:
        """Cancels a transport that has not arrived; a unit that is lifted is stored."""
        self._add_event(Kind.CANCELLED, transport)
        transport.cancelled = True
        if transport.lane:
            transport.lane.inbound -= 1
        elif transport.then == STAY:
            self.floor.clear(transport.cell)
        if not transport.robot:
            del self.waiting[transport.transport_id]
            self._end(transport)

    def step_until(self, time: float) -> None:
        """Goes on to a time [s], or to the first event before it."""
        self._match()
        while not self.events and self.queue.next_time <= time:
            self.time = self.queue.next_time
            self.queue.run_next()
            self._match()
        if not self.events:
            self.time = max(self.time, time)

    def activities(self) -> dict[str, float]:
        """Returns the robot-seconds spent on each of ACTIVITIES up to now."""
        total = dict(self.seconds)
        for robot in self.robots.values():
            total[robot.activity] += self.time - robot.since
        return total

    def _schedule(self, delay: float, act: Callable[[Any], object], argument: Any) -> None:
        self.queue.schedule(self.time + delay, act, argument)

    def _add_event(self, kind: Kind, transport: Transport) -> None:
        self.events.append(
            TransportEvent(
                self.time,
                transport.transport_id,
                kind,
                transport.robot.kiva_id if transport.robot else 0,
                transport.shelf_id,
                transport.lane.name if transport.lane else "",
                "",
            )
        )

    def _begin(self, robot: Robot, activity: str) -> None:
        self.seconds[robot.activity] += self.time - robot.since
        robot.activity, robot.since = activity, self.time

    def _match(self) -> None:
        """Gives robots without work the transports that wait."""
        if not self.waiting or not self._idle:
            return
        waiting = sorted(self.waiting.values(), key=lambda one: (-one.priority, one.transport_id))
        robots = list(self._idle.values())
        seconds, metres = self.travel.unloaded(
            [self.floor.units[one.shelf_id] for one in waiting], [robot.cell for robot in robots]
        )
        # One that drives to where it parks must come there first.
        seconds += np.array([max(robot.parked - self.time, 0.0) for robot in robots])
        tasks = [_task(one) for one in waiting]
        for task, robot in self.hooks.match_robots(tasks, [r.kiva_id for r in robots], seconds):
            self._assign(waiting[task], robots[robot], seconds[task, robot], metres[task, robot])

    def _assign(self, transport: Transport, robot: Robot, seconds: float, metres: float) -> None:
        del self.waiting[transport.transport_id], self._idle[robot.kiva_id]
        transport.robot = robot
        self.distance_m += metres
        self._add_event(Kind.ASSIGNED, transport)
        self._begin(robot, "to unit")
        self._schedule(seconds, self._reach_unit, transport)

    def _reach_unit(self, transport: Transport) -> None:
        transport.driver.cell = self.floor.units[transport.shelf_id]
        if transport.cancelled:
            self._free_robot(transport)
            return
        self._begin(transport.driver, "lift")
        self._schedule(self.kinematics.lift, self._lift, transport)

    def _lift(self, transport: Transport) -> None:
        home = self.floor.units.pop(transport.shelf_id)
        self.floor.clear(home)
        self._add_event(Kind.LIFTED, transport)
        self._begin(transport.driver, "to station")
        table = self.travel.loaded_to(transport.cell)
        self.distance_m += table.metres[home]
        self.ways[transport.cell, home, False] += 1
        self._schedule(table.seconds[home], self._reach_end, transport)

    def _reach_end(self, transport: Transport) -> None:
        transport.driver.cell = transport.cell
        if transport.cancelled:
            self._store(transport)
        elif transport.lane:
            self._begin(transport.driver, "queue")
            transport.lane.queue.append(transport)
            self._serve_next(transport.lane, 0.0)
        else:
            self._arrive(transport)

    def _serve_next(self, lane: Lane, moving_up: float) -> None:
        """Moves the first in the lane to the service cell as soon as that has been left."""
        if lane.serving or not lane.queue:
            return
        lane.serving = lane.queue.popleft()
        delay = max(lane.free_from - self.time, 0.0) + moving_up
        self._schedule(delay, self._arrive, lane.serving)

    def _arrive(self, transport: Transport) -> None:
        if transport.cancelled:
            self._leave(transport)
            self._store(transport)
            return
        transport.arrived = True
        if transport.lane:
            transport.lane.waited += self.time - transport.driver.since
        self._begin(transport.driver, "service")
        self._add_event(Kind.ARRIVED, transport)
        if not transport.lane and transport.then == STAY:
            self.release(transport)

    def release(self, transport: Transport) -> None:
        """Lets a unit that has arrived leave its station, or be lowered where it is."""
        transport.arrived = False
        self._add_event(Kind.RELEASED, transport)
        if transport.lane:
            transport.lane.inbound -= 1
            self._leave(transport)
        if transport.then == STAY:
            self._lower((transport, transport.driver.cell))
        else:
            self._store(transport)

    def _leave(self, transport: Transport) -> None:
        """Frees the service cell for when the robot with its unit has left it."""
        lane = transport.lane
        if lane and lane.serving is transport:
            spacing = self.floor.plan.spacing
            lane.serving = None
            lane.free_from = self.time + self.kinematics.leaving(spacing)
            self._serve_next(lane, float(self.kinematics.run(spacing)))

    def _store(self, transport: Transport) -> None:
        """Sends a unit to a free place that the policy chooses."""
        start = transport.driver.cell
        table = self.travel.loaded_from(start)
        cells = np.flatnonzero(self.floor.free & np.isfinite(table.seconds))
        if not len(cells):
            self._begin(transport.driver, "idle")
            self._schedule(RETRY, self._store, transport)
            return
        place = int(self.hooks.choose_place(transport.shelf_id, cells, table.metres[cells]))
        self.floor.free[place] = False
        self._begin(transport.driver, "back")
        self.distance_m += table.metres[place]
        self.ways[start, place, True] += 1
        self._schedule(table.seconds[place], self._lower, (transport, place))

    def _lower(self, argument: Any) -> None:
        transport, place = argument
        transport.driver.cell = place
        self._begin(transport.driver, "lift")
        self._schedule(self.kinematics.lift, self._drop, argument)

    def _drop(self, argument: Any) -> None:
        transport, place = argument
        self.floor.units[transport.shelf_id] = place
        self._add_event(Kind.STORED, transport)
        self._free_robot(transport)

    def _free_robot(self, transport: Transport) -> None:
        robot = transport.driver
        self._end(transport)
        self._begin(robot, "idle")
        self._idle[robot.kiva_id] = robot
        to = self.hooks.park(robot.kiva_id, robot.cell)
        if to is not None and to != robot.cell:
            seconds, metres = self.travel.unloaded([robot.cell], [to])
            self.distance_m += float(metres[0, 0])
            robot.cell, robot.parked = int(to), self.time + float(seconds[0, 0])

    def _end(self, transport: Transport) -> None:
        del self.open[transport.transport_id]
        self.floor.busy.discard(transport.shelf_id)


def _task(one: Transport) -> Task:
    name, inbound = (one.lane.name, one.lane.inbound) if one.lane else ("", 0)
    return Task(one.transport_id, one.shelf_id, name, one.priority, inbound)
