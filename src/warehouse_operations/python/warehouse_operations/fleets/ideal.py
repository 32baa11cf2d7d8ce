# SPDX-License-Identifier: Apache-2.0
"""A fleet of ideal robots, which delay each other only at stations.

The time of a drive is that of its way, turns, starts and stops (travel.py); each lift takes a
constant time, and a station serves one unit after the other. A shift runs hundreds of times faster
than with physics, and the difference between the two is the cost of traffic.

    fleet = IdealFleet(plan, robots={1: 17}, units={1: 40})   # cells by id
    fleet.submit(1, "pick1")
    fleet.step_until(60.0)       # or to the first event before
    fleet.take_events()
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_fleet.traffic import elevator_rules
from warehouse_fleet.transports.transport_book import Transport
from warehouse_fleet.transports.transport_requests import TransportRequests
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_operations.fleets.availability import Availability, Upkeep
from warehouse_operations.fleets.consumption import MassOfItems
from warehouse_operations.fleets.ideal_floor import IdealFloor
from warehouse_operations.fleets.ideal_trips import Trips
from warehouse_operations.stock.protocols import Hooks, Task
from warehouse_operations.stock.travel import Travel


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
        """Returns None: an idle robot waits in place."""


class IdealFleet(TransportRequests):
    """Robots, units and stations of a FloorPlan, as protocols.Requests offers them.

    robots, units: the cell of each, by id. Raises ValueError where a unit's cell is not a storage
    place. collisions, blocked, watchdog, stuck, fallen_items, plan_ms and executed_over_planned
    have the values of a shift without any fault.
    """

    def __init__(
        self,
        plan: FloorPlan,
        robots: Mapping[int, int],
        units: Mapping[int, int],
        *,
        kinematics: Kinematics | None = None,
    ) -> None:
        self.kinematics = kinematics or Kinematics()
        self.travel = Travel(plan, self.kinematics)
        self.collisions = self.blocked = self.watchdog = self.stuck = 0
        self.fallen_items: tuple[str, ...] = ()
        self.plan_ms: list[float] = []
        self.executed_over_planned = 1.0
        self._floor = IdealFloor(plan, units, self.travel)
        self._trips = self._make_trips(robots)
        self._trips.arrive = self.arrive
        super().__init__(plan, self._trips.book)

    def _make_trips(self, robots: Mapping[int, int]) -> Trips:
        return Trips(self._floor, robots, self.kinematics, NearestHooks())

    @property
    def trips(self) -> Trips:
        """The trips of its robots."""
        return self._trips

    @property
    def transports(self) -> "IdealFleet":
        """The fleet itself, which offers protocols.Requests."""
        return self

    @property
    def robot_count(self) -> int:
        """The number of robots."""
        return len(self._trips.robots)

    @property
    def time(self) -> float:
        """The simulated time [s]."""
        return self._trips.time

    @property
    def distance_m(self) -> float:
        """The distance that all robots have driven [m]."""
        return self._trips.odometer.read(self._trips.time)

    # The fleet of TransportRequests.

    @property
    def cell_of_unit(self) -> Mapping[int, int]:
        """The cell of each unit that is not carried."""
        return self._floor.units

    def check_reach(self, shelf_id: int, cell: int) -> None:
        """Raises ValueError if no way leads from a unit to a cell."""
        if not np.isfinite(self.travel.loaded_to(cell).seconds[self._floor.units[shelf_id]]):
            x, y = self.plan.point_of(cell)
            raise ValueError(f"no way leads from storage unit {shelf_id} to ({x:g}, {y:g})")

    def taken(self) -> np.ndarray:
        """Returns (cells,) bool: cells with a unit, or kept for a unit under way."""
        taken = np.asarray(self.plan.storage, bool).ravel() & ~self._trips.free()
        taken[list(self._floor.units.values())] = True
        taken[self.book.destinations()] = True
        return taken

    def end(self, transport: Transport) -> None:
        """Removes a transport that is over; its robot is free."""
        self._trips.end(transport)

    def turn_back(self, transport: Transport) -> None:
        """Turns a unit on its way to a station back into storage."""
        self._trips.turn_back(transport)

    def leave(self, transport: Transport) -> None:
        """Sends a unit away from its destination now."""
        self._trips.leave(transport)

    # The driver.

    def step_until(self, time: float) -> None:
        """Goes on to `time` [s], or to the first event before it."""
        self._trips.step_until(time)

    def set_hooks(self, hooks: Hooks) -> None:
        """Sets the decisions from now on; see protocols.Hooks."""
        self._trips.hooks = hooks

    def close(self) -> None:
        """Does nothing; a simulated fleet has threads to end."""

    # Events of a scenario.

    def set_in_service(self, kiva_id: int, in_service: bool) -> None:
        """Takes a robot out of service, once its transport is over, or back."""
        self._trips.set_in_service(self._index(kiva_id), in_service)

    def fail(self, kiva_id: int, duration: float) -> None:
        """Has a robot stand for a while [s]."""
        self._trips.fail(self._index(kiva_id), duration)

    def set_speed(self, share: float) -> None:
        """Sets the robots' top speed, over that at first."""
        speed = share * self.kinematics.speed
        self._trips.set_kinematics(replace(self.kinematics, speed=speed))
        self.travel = self._trips.travel

    def _index(self, kiva_id: int) -> int:
        return next(i for i, robot in enumerate(self._trips.robots) if robot.kiva_id == kiva_id)

    # Availability.

    def keep_up(
        self, availability: Availability, rng: np.random.Generator, items: MassOfItems
    ) -> None:
        """Has robots charge, fail and be repaired from now on. items: the mass of those on each
        unit."""
        count, cells = len(self._trips.robots), np.asarray(self.plan.charging, int)
        policy = self._trips.hooks.charging
        self._trips.keep_up(Upkeep(availability, count, cells, rng, policy), items)

    def set_charges(self, charges: Mapping[int, float]) -> None:
        """Sets the states of charge of robots, by id."""
        if upkeep := self._trips.upkeep:
            for kiva_id, charge in charges.items():
                upkeep.charge[self._index(kiva_id)] = charge

    @property
    def energy(self) -> dict[str, float]:
        """The state of batteries, and the shares of their time that robots charged and could work;
        empty at full availability."""
        upkeep = self._trips.upkeep
        if not upkeep:
            return {}
        for index in range(self.robot_count):
            upkeep.note(index, self.time)
        time = max(self.time * self.robot_count, 1e-9)
        out = {"availability": 1 - upkeep.down_s(self.time) / time} if upkeep.failures else {}
        if upkeep.energy:
            out |= {
                "charge_mean": float(upkeep.charge.mean()),
                "charge_least": float(upkeep.charge.min()),
                "charging_fraction": upkeep.charging_s / time,
            }
        return out

    # Figures.

    @property
    def elevators(self) -> dict[str, float]:
        """The figures of elevators, as elevator_rules.figures(); empty without any."""
        return elevator_rules.figures(self._trips.lifts.all, self.time)

    def unit_cell(self, shelf_id: int) -> int | None:
        """Returns the cell where a unit stands; None while it is carried."""
        return self._floor.units.get(shelf_id)

    def activities(self) -> dict[str, float]:
        """Returns the robot-seconds spent on each of ACTIVITIES so far."""
        return self._trips.activities()

    def passages(self) -> np.ndarray:
        """Returns the number of passes of loaded robots through each cell, (h, w)."""
        count = np.zeros(self.plan.passable.size)
        for (end, cell, outbound, via), times in self._trips.ways.items():
            table = self.travel.loaded_from(end) if outbound else self.travel.loaded_to(end)
            for run in table.runs(cell, via):
                np.add.at(count, run, times)
        return count.reshape(self.plan.passable.shape)

    def waiting_map(self) -> np.ndarray:
        """Returns robot-seconds in lanes before stations, spread over their cells, (h, w)."""
        seconds = np.zeros(self.plan.passable.size)
        for lane in self._floor.lanes.values():
            cells = lane.station.cells[: lane.station.service]
            seconds[cells] += lane.waited / max(len(cells), 1)
        return seconds.reshape(self.plan.passable.shape)
