# SPDX-License-Identifier: Apache-2.0
"""A fleet of ideal robots: nobody stands in anybody's way except at the stations.

Each drive takes what its way, turns, starts and stops cost (travel.py), each lift its time, and at
a station one unit is served after the other. So a shift runs hundreds of times faster than under
physics, and the difference between the two is what traffic costs.

    fleet = IdealFleet(plan, robots={1: 17}, units={1: 40})   # cells by id
    fleet.submit(1, "pick1")
    fleet.step_until(60.0)       # or to the first event before
    fleet.take_events()
"""

import heapq
import itertools
from collections import Counter, deque

import numpy as np

from warehouse_fleet.kinematics import Kinematics
from warehouse_fleet.transports import STAY, STORE, Answer, Kind, TransportEvent
from warehouse_operations.activities import ACTIVITIES
from warehouse_operations.protocols import Task
from warehouse_operations.travel import Travel


class NearestHooks:
    """What a fleet does that no policy advises."""

    def choose_place(self, shelf_id, cells, distances):
        return cells[np.argmin(distances)]

    def match_robots(self, tasks, robots, seconds):
        free = np.ones(len(robots), bool)
        for task in range(min(len(tasks), len(robots))):
            robot = int(np.argmin(np.where(free, seconds[task], np.inf)))
            free[robot] = False
            yield task, robot

    def park(self, kiva_id, cell):
        return None


class _Robot:
    def __init__(self, kiva_id, cell):
        self.kiva_id, self.cell = kiva_id, cell
        self.activity, self.since = "idle", 0.0
        self.transport = None
        self.parked = 0.0  # when it reaches its cell, if it drives there without a task [s]


class _Transport:
    def __init__(self, transport_id, shelf_id, station, cell, then, priority):
        self.transport_id, self.shelf_id = transport_id, shelf_id
        self.station, self.cell = station, cell  # a _Lane, or None and a cell
        self.then, self.priority = then, priority
        self.robot = None
        self.lifted = self.arrived = self.cancelled = False


class _Lane:
    """A station's service cell and who waits before it."""

    def __init__(self, station):
        self.station = station
        self.cell = int(station.cells[station.service])
        self.is_open, self.inbound = True, 0
        self.queue = deque()
        self.serving = None  # the transport in the service cell, or on the last metre to it
        self.free_from = 0.0  # when the service cell has been left [s]
        self.waited = 0.0  # by all [s]


class IdealFleet:
    """Robots, units and stations of a FloorPlan; offers what protocols.Requests says.

    robots, units: the cell of each, by id. Cells of units must be storage places.
    """

    def __init__(self, plan, robots, units, *, kinematics=None):
        self.plan, self.kinematics = plan, kinematics or Kinematics()
        self.travel = Travel(plan, self.kinematics)
        self.hooks = NearestHooks()
        self.time = 0.0
        self.distance_m = 0.0
        self.collisions = self.blocked = self.watchdog = self.stuck = 0
        self.fallen_items = ()
        self.plan_ms = []
        self.executed_over_planned = 1.0
        self.robot_seconds = dict.fromkeys(ACTIVITIES, 0.0)
        self._lanes = {one.name: _Lane(one) for one in plan.stations}
        self._robots = {i: _Robot(i, int(cell)) for i, cell in sorted(robots.items())}
        self._units = {i: int(cell) for i, cell in sorted(units.items())}
        self._idle = dict(self._robots)
        self._free = np.asarray(plan.storage, bool).ravel().copy()
        for shelf_id, cell in self._units.items():
            if not self._free[cell]:
                raise ValueError(
                    f"storage unit {shelf_id} stands in cell {cell}: no storage place, or not free"
                )
            self._free[cell] = False
        self._open, self._waiting, self._busy_units = {}, {}, set()
        self._events, self._due = [], []
        self._ids, self._order = itertools.count(1), itertools.count()
        self._ways = Counter()

    @property
    def transports(self):
        return self

    @property
    def robot_count(self):
        """How many robots there are."""
        return len(self._robots)

    # What it is asked for.

    def submit(self, shelf_id, station="", x=None, y=None, then=STORE, priority=0):
        reason, lane, cell = self._target(shelf_id, station, x, y)
        if reason:
            return Answer(0, False, reason)
        transport = _Transport(next(self._ids), shelf_id, lane, cell, then, priority)
        self._open[transport.transport_id] = self._waiting[transport.transport_id] = transport
        self._busy_units.add(shelf_id)
        if lane:
            lane.inbound += 1
        elif then == STAY:
            self._free[cell] = False
        self._tell(Kind.RECEIVED, transport)
        return Answer(transport.transport_id, True, "")

    def release(self, transport_id):
        transport = self._open.get(transport_id)
        if not transport:
            return False, f"transport {transport_id} is not under way"
        if not transport.arrived:
            return False, f"transport {transport_id} has not arrived"
        self._release(transport)
        return True, ""

    def cancel(self, transport_id):
        transport = self._open.get(transport_id)
        if not transport or transport.cancelled:
            return False, f"transport {transport_id} is not under way"
        if transport.arrived:
            return False, f"transport {transport_id} has arrived; release it"
        self._tell(Kind.CANCELLED, transport)
        transport.cancelled = True
        if transport.station:
            transport.station.inbound -= 1
        elif transport.then == STAY:
            self._free[transport.cell] = self.plan.storage.flat[transport.cell]
        if not transport.robot:
            del self._waiting[transport_id]
            self._end(transport)
        return True, ""

    def set_open(self, station, is_open):
        lane = self._lanes[station]
        lane.is_open = is_open
        if not is_open:
            for transport in list(self._open.values()):
                if transport.station is lane and not transport.arrived:
                    self.cancel(transport.transport_id)

    def take_events(self):
        events, self._events = self._events, []
        return events

    def waiting(self, station):
        return self._lanes[station].inbound

    # The driver.

    def step_until(self, time):
        """Goes on to `time` [s], or to the first moment before it in which something is told."""
        self._match()
        while not self._events and self._due and self._due[0][0] <= time:
            self.time, _, act, argument = heapq.heappop(self._due)
            act(argument)
            self._match()
        if not self._events:
            self.time = max(self.time, time)

    def set_hooks(self, hooks):
        """Who decides from now on; see protocols.Hooks."""
        self.hooks = hooks

    def close(self):
        """Nothing is to be ended here."""

    def passages(self):
        """How often a robot with a load came through each cell, (h, w)."""
        count = np.zeros(self.plan.passable.size)
        for (station, cell, outbound), times in sorted(self._ways.items()):
            table = self.travel.loaded_from if outbound else self.travel.loaded_to
            np.add.at(count, table(station).cells(cell), times)
        return count.reshape(self.plan.passable.shape)

    def waiting_map(self):
        """Robot-seconds spent in lanes before a station, spread over their cells, (h, w)."""
        seconds = np.zeros(self.plan.passable.size)
        for lane in self._lanes.values():
            cells = lane.station.cells[: lane.station.service]
            seconds[cells] += lane.waited / max(len(cells), 1)
        return seconds.reshape(self.plan.passable.shape)

    def activities(self):
        """Robot-seconds spent on each of ACTIVITIES up to now."""
        total = dict(self.robot_seconds)
        for robot in self._robots.values():
            total[robot.activity] += self.time - robot.since
        return total

    def unit_cell(self, shelf_id):
        """Where a unit stands; None while it is carried."""
        return self._units.get(shelf_id)

    def _target(self, shelf_id, station, x, y):
        """Why not, the lane and the cell of a transport's end."""
        if shelf_id not in self._units and shelf_id not in self._busy_units:
            return f"there is no storage unit {shelf_id}", None, None
        if shelf_id in self._busy_units:
            return f"storage unit {shelf_id} is on a transport", None, None
        if station:
            lane = self._lanes.get(station)
            if not lane:
                return f"there is no station '{station}'", None, None
            if not lane.is_open:
                return f"station {station} is closed", None, None
            unreachable = not np.isfinite(
                self.travel.loaded_to(lane.cell).seconds[self._units[shelf_id]]
            )
            return f"no way leads from the unit to {station}" * unreachable, lane, None
        if x is None or y is None:
            return "a station, or x and y, was expected", None, None
        cell = self.plan.cell_of(x, y)
        if not 0 <= cell < self.plan.passable.size or not self.plan.passable.flat[cell]:
            return f"({x}, {y}) is no cell to drive to", None, None
        if self.plan.storage.flat[cell] and not self._free[cell]:
            return f"the storage place at ({x}, {y}) is taken", None, None
        if not np.isfinite(self.travel.loaded_to(cell).seconds[self._units[shelf_id]]):
            return f"no way leads from the unit to ({x}, {y})", None, None
        return "", None, int(cell)

    def _tell(self, kind, transport, text=""):
        self._events.append(
            TransportEvent(
                self.time,
                transport.transport_id,
                kind,
                transport.robot.kiva_id if transport.robot else 0,
                transport.shelf_id,
                transport.station.station.name if transport.station else "",
                text,
            )
        )

    def _at(self, delay, act, argument):
        heapq.heappush(self._due, (self.time + delay, next(self._order), act, argument))

    def _does(self, robot, activity):
        self.robot_seconds[robot.activity] += self.time - robot.since
        robot.activity, robot.since = activity, self.time

    def _match(self):
        """Robots without work get the transports that wait."""
        if not self._waiting or not self._idle:
            return
        waiting = sorted(self._waiting.values(), key=lambda one: (-one.priority, one.transport_id))
        robots = list(self._idle.values())
        seconds, metres = self.travel.unloaded(
            [self._units[one.shelf_id] for one in waiting], [robot.cell for robot in robots]
        )
        # One that drives to where it parks must come there first.
        seconds += np.array([max(robot.parked - self.time, 0.0) for robot in robots])
        tasks = [self._task(one) for one in waiting]
        for task, robot in self.hooks.match_robots(tasks, [r.kiva_id for r in robots], seconds):
            self._assign(waiting[task], robots[robot], seconds[task, robot], metres[task, robot])

    def _task(self, one):
        lane = one.station
        name, inbound = (lane.station.name, lane.inbound) if lane else ("", 0)
        return Task(one.transport_id, one.shelf_id, name, one.priority, inbound)

    def _assign(self, transport, robot, seconds, metres):
        del self._waiting[transport.transport_id], self._idle[robot.kiva_id]
        transport.robot, robot.transport = robot, transport
        self.distance_m += metres
        self._tell(Kind.ASSIGNED, transport)
        self._does(robot, "to unit")
        self._at(seconds, self._beneath, transport)

    def _beneath(self, transport):
        transport.robot.cell = self._units[transport.shelf_id]
        if transport.cancelled:
            return self._free_robot(transport)
        self._does(transport.robot, "lift")
        return self._at(self.kinematics.lift, self._lift, transport)

    def _lift(self, transport):
        transport.lifted = True
        home = self._units.pop(transport.shelf_id)
        self._free[home] = self.plan.storage.flat[home]
        self._tell(Kind.LIFTED, transport)
        self._does(transport.robot, "to station")
        end = transport.station.cell if transport.station else transport.cell
        table = self.travel.loaded_to(end)
        self.distance_m += table.metres[home]
        self._ways[end, home, False] += 1
        self._at(table.seconds[home], self._reach, transport)

    def _reach(self, transport):
        transport.robot.cell = transport.station.cell if transport.station else transport.cell
        if transport.cancelled:
            return self._store(transport)
        if not transport.station:
            return self._arrive(transport)
        lane = transport.station
        self._does(transport.robot, "queue")
        lane.queue.append(transport)
        return self._next(lane, 0.0)

    def _next(self, lane, moving_up):
        """The first in the lane comes to the service cell as soon as that has been left."""
        if lane.serving or not lane.queue:
            return
        lane.serving = lane.queue.popleft()
        delay = max(lane.free_from - self.time, 0.0) + moving_up
        self._at(delay, self._arrive, lane.serving)

    def _arrive(self, transport):
        if transport.cancelled:
            self._leave(transport)
            return self._store(transport)
        transport.arrived = True
        if transport.station:
            transport.station.waited += self.time - transport.robot.since
        self._does(transport.robot, "service")
        self._tell(Kind.ARRIVED, transport)
        if not transport.station and transport.then == STAY:
            self._release(transport)
        return None

    def _release(self, transport):
        transport.arrived = False
        self._tell(Kind.RELEASED, transport)
        if transport.station:
            transport.station.inbound -= 1
            self._leave(transport)
        if transport.then == STAY:
            self._does(transport.robot, "lift")
            return self._at(self.kinematics.lift, self._drop, (transport, transport.robot.cell))
        return self._store(transport)

    def _leave(self, transport):
        """The service cell becomes free when the robot with its unit has left it."""
        lane = transport.station
        if lane and lane.serving is transport:
            lane.serving = None
            lane.free_from = self.time + self.kinematics.leaving(self.plan.spacing)
            self._next(lane, float(self.kinematics.run(self.plan.spacing)))

    def _store(self, transport):
        """To a free place that the policy chooses."""
        start = transport.robot.cell
        table = self.travel.loaded_from(start)
        cells = np.flatnonzero(self._free & np.isfinite(table.seconds))
        if not len(cells):
            self._does(transport.robot, "idle")
            return self._at(1.0, self._store, transport)
        place = int(self.hooks.choose_place(transport.shelf_id, cells, table.metres[cells]))
        self._free[place] = False
        self._does(transport.robot, "back")
        self.distance_m += table.metres[place]
        self._ways[start, place, True] += 1
        return self._at(table.seconds[place], self._lower, (transport, place))

    def _lower(self, argument):
        transport, place = argument
        transport.robot.cell = place
        self._does(transport.robot, "lift")
        self._at(self.kinematics.lift, self._drop, argument)

    def _drop(self, argument):
        transport, place = argument
        self._units[transport.shelf_id] = place
        self._tell(Kind.STORED, transport)
        self._free_robot(transport)

    def _free_robot(self, transport):
        robot = transport.robot
        self._end(transport)
        robot.transport = None
        self._does(robot, "idle")
        self._idle[robot.kiva_id] = robot
        to = self.hooks.park(robot.kiva_id, robot.cell)
        if to is not None and to != robot.cell:
            seconds, metres = self.travel.unloaded([robot.cell], [to])
            self.distance_m += float(metres[0, 0])
            robot.cell, robot.parked = int(to), self.time + float(seconds[0, 0])

    def _end(self, transport):
        del self._open[transport.transport_id]
        self._busy_units.discard(transport.shelf_id)
