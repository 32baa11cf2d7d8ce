# SPDX-License-Identifier: Apache-2.0
"""A fleet of ideal robots, which get in each other's way at the stations only.

Each drive takes what its way, turns, starts and stops cost (travel.py), each lift its time, and at
a station one unit is served after the other. So a shift runs hundreds of times faster than under
physics, and the difference between the two is what traffic costs.

    fleet = IdealFleet(plan, robots={1: 17}, units={1: 40})   # cells by id
    fleet.submit(1, "pick1")
    fleet.step_until(60.0)       # or to the first event before
    fleet.take_events()
"""

import itertools
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from warehouse_fleet.kinematics import Kinematics
from warehouse_fleet.transports import STORE, Answer, TransportEvent
from warehouse_layout.floor_plan import FloorPlan
from warehouse_operations.ideal_floor import IdealFloor, UnreachableError
from warehouse_operations.ideal_trips import Transport, Trips
from warehouse_operations.protocols import Hooks, Task
from warehouse_operations.travel import Travel


class NearestHooks:
    """The decisions of a fleet without policies: nearest place, nearest robot; see Hooks."""

    charging: object = None

    def choose_place(self, shelf_id: int, cells: np.ndarray, distances: np.ndarray) -> int:
        """Returns the nearest of `cells` (n,); distances (n,) [m]."""
        return int(cells[np.argmin(distances)])

    def match_robots(
        self, tasks: Sequence[Task], robots: Sequence[int], seconds: np.ndarray
    ) -> Iterator[tuple[int, int]]:
        """Yields (index of the task, index of the nearest free robot), tasks in their order."""
        free = np.ones(len(robots), bool)
        for task in range(min(len(tasks), len(robots))):
            robot = int(np.argmin(np.where(free, seconds[task], np.inf)))
            free[robot] = False
            yield task, robot

    def park(self, kiva_id: int, cell: int) -> None:
        """Returns None: a robot without work waits where it is."""


class IdealFleet:
    """Robots, units and stations of a FloorPlan, as protocols.Requests offers them.

    robots, units: the cell of each, by id. Raises ValueError where a unit's cell is not a storage
    place. collisions, blocked, watchdog, stuck, fallen_items, plan_ms and executed_over_planned are
    as if nothing ever went wrong.
    """

    def __init__(
        self,
        plan: FloorPlan,
        robots: Mapping[int, int],
        units: Mapping[int, int],
        *,
        kinematics: Kinematics | None = None,
    ) -> None:
        self.plan, self.kinematics = plan, kinematics or Kinematics()
        self.travel = Travel(plan, self.kinematics)
        self.collisions = self.blocked = self.watchdog = self.stuck = 0
        self.fallen_items: tuple[str, ...] = ()
        self.plan_ms: list[float] = []
        self.executed_over_planned = 1.0
        self._floor = IdealFloor(plan, units, self.travel)
        self._trips = Trips(self._floor, robots, self.kinematics, NearestHooks())
        self._ids = itertools.count(1)

    @property
    def transports(self) -> "IdealFleet":
        """The fleet itself, which offers protocols.Requests."""
        return self

    @property
    def robot_count(self) -> int:
        """How many robots there are."""
        return len(self._trips.robots)

    @property
    def time(self) -> float:
        """The simulated time [s]."""
        return self._trips.time

    @property
    def distance_m(self) -> float:
        """The metres that all robots have driven, or set off to drive."""
        return self._trips.distance_m

    # Requests.

    def submit(
        self,
        shelf_id: int,
        station: str = "",
        x: float | None = None,
        y: float | None = None,
        then: int = STORE,
        priority: int = 0,
    ) -> Answer:
        """Asks for a transport to a station, or to the cell at x, y in world [m]."""
        try:
            lane, cell = self._floor.target(shelf_id, station, x, y)
        except UnreachableError as error:
            return Answer(0, False, str(error))
        transport = Transport(next(self._ids), shelf_id, lane, cell, then, priority)
        self._trips.add(transport)
        return Answer(transport.transport_id, True, "")

    def release(self, transport_id: int) -> tuple[bool, str]:
        """Lets a unit leave its station. Returns success and the fault."""
        transport = self._trips.open.get(transport_id)
        if not transport:
            return False, f"transport {transport_id} is not under way"
        if not transport.arrived:
            return False, f"transport {transport_id} has not arrived"
        self._trips.release(transport)
        return True, ""

    def cancel(self, transport_id: int) -> tuple[bool, str]:
        """Ends a transport; a unit that is lifted is stored. Returns success and the fault."""
        transport = self._trips.open.get(transport_id)
        if not transport or transport.cancelled:
            return False, f"transport {transport_id} is not under way"
        if transport.arrived:
            return False, f"transport {transport_id} has arrived; release it"
        self._trips.cancel(transport)
        return True, ""

    def set_open(self, station: str, is_open: bool) -> None:
        """Opens or closes a station; transports on the way to a closed one are cancelled."""
        lane = self._floor.lanes[station]
        lane.is_open = is_open
        if not is_open:
            for transport in list(self._trips.open.values()):
                if transport.lane is lane and not transport.arrived:
                    self.cancel(transport.transport_id)

    def take_events(self) -> list[TransportEvent]:
        """Returns what happened since the last call, in order."""
        events, self._trips.events = self._trips.events, []
        return events

    # The driver.

    def step_until(self, time: float) -> None:
        """Goes on to `time` [s], or to the first event before it."""
        self._trips.step_until(time)

    def set_hooks(self, hooks: Hooks) -> None:
        """Sets the decisions from now on; see protocols.Hooks."""
        self._trips.hooks = hooks

    def close(self) -> None:
        """Does nothing; a fleet under physics has threads to end."""

    # Figures.

    def unit_cell(self, shelf_id: int) -> int | None:
        """Returns the cell where a unit stands; None while it is carried."""
        return self._floor.units.get(shelf_id)

    def waiting(self, station: str) -> int:
        """Returns how many units are at a station or on their way to it."""
        return self._floor.lanes[station].inbound

    def activities(self) -> dict[str, float]:
        """Returns the robot-seconds spent on each of ACTIVITIES up to now."""
        return self._trips.activities()

    def passages(self) -> np.ndarray:
        """Returns how often a robot with a load drove through each cell, (h, w)."""
        count = np.zeros(self.plan.passable.size)
        for (station, cell, outbound), times in sorted(self._trips.ways.items()):
            table = self.travel.loaded_from if outbound else self.travel.loaded_to
            np.add.at(count, table(station).cells(cell), times)
        return count.reshape(self.plan.passable.shape)

    def waiting_map(self) -> np.ndarray:
        """Returns robot-seconds in lanes before stations, spread over their cells, (h, w)."""
        seconds = np.zeros(self.plan.passable.size)
        for lane in self._floor.lanes.values():
            cells = lane.station.cells[: lane.station.service]
            seconds[cells] += lane.waited / max(len(cells), 1)
        return seconds.reshape(self.plan.passable.shape)
