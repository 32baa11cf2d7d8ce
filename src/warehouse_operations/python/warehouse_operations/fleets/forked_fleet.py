# SPDX-License-Identifier: Apache-2.0
"""Ideal robots that go on from the state of a fleet, and drive as slowly as that one has driven."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_fleet.robots.robot_table import NOWHERE
from warehouse_fleet.transports.transport_book import (
    BRINGING,
    FETCHING,
    LIFTING,
    OPEN,
    READY,
    STORING,
    WAITING,
    Transport,
)
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_operations.fleets.availability import Availability
from warehouse_operations.fleets.consumption import MassOfItems
from warehouse_operations.fleets.fleet_now import FleetNow, RobotNow, TransportNow
from warehouse_operations.fleets.ideal import IdealFleet, NearestHooks
from warehouse_operations.fleets.ideal_trips import Robot, Trips

UNLOADED, LOADED = "_reach_unit", ("_reach_end", "_lower")  # what ends drives


@dataclass(frozen=True)
class Pace:
    """How much longer drives take than those of robots without traffic: a factor for robots with a
    unit, and one for those without."""

    loaded: float = 1.0
    unloaded: float = 1.0


class PacedTrips(Trips):
    """Trips whose drives are stretched by a Pace."""

    pace = Pace()

    def schedule(
        self, delay: float, act: Callable[[Any], object], argument: Any, robot: Robot
    ) -> None:
        """Schedules an act of a robot after a delay [s], which is stretched if it is a drive."""
        super().schedule(self.stretched(delay, act), act, argument, robot)

    def stretched(self, seconds: float, act: Callable[[Any], object]) -> float:
        """Returns the time of a drive that ends with an act [s]."""
        if act.__name__ in LOADED:
            return seconds * self.pace.loaded
        return seconds * self.pace.unloaded if act.__name__ == UNLOADED else seconds

    def resume(self, now: FleetNow, repair: Callable[[], float]) -> None:
        """Goes on with the transports of a fleet. repair: draws how long a broken robot still
        stands [s]."""
        self.time = now.time
        index_of = {robot.kiva_id: robot for robot in self.robots}
        for robot in self.robots:
            robot.since = now.time
            if now.robots[robot.kiva_id].broken:
                robot.able = robot.there = now.time + repair()
        for under_way in now.transports:
            driver = index_of.get(under_way.kiva_id)
            if driver is None or under_way.step == OPEN:
                self.book.restore(replace(under_way, step=OPEN).transport())
                continue
            transport = under_way.transport()
            self._idle.pop(driver.index, None)
            self.book.restore(transport, driver.index)
            self._go_on(transport, under_way, driver)
        for unit, kiva_id in now.carried.items():
            if now.robots[kiva_id].in_service:
                self._carry_on(unit, index_of[kiva_id])
        for lane in self.floor.lanes.values():
            if lane.queue:
                self._serve_next(lane, 0.0)
        self.book.add_events(now.events)
        for robot in self.robots:
            if not now.robots[robot.kiva_id].in_service:
                self.set_in_service(robot.index, False)

    def _carry_on(self, unit: int, robot: Robot) -> None:
        """Has a robot store a unit that is on it without a transport, once it is repaired."""
        if robot.index not in self.book.of_robot:
            self._idle.pop(robot.index, None)
            self.queue.schedule(max(robot.able, self.time), self._repaired, (robot, unit))

    def _go_on(self, transport: Transport, under_way: TransportNow, robot: Robot) -> None:
        """Schedules the end of the step at which a transport is."""
        step = transport.step
        if step in (FETCHING, READY):
            self._fetch_on(transport, under_way, robot)
        elif step == LIFTING:
            self.floor.units.setdefault(transport.shelf, robot.cell)
            self._begin(robot, "lift")
            self._act_after(under_way, self._lift_left(under_way), self._lift, transport, robot)
        elif step == BRINGING:
            self._begin(robot, "to station")
            seconds = self._rolling(self.travel.loaded_to(transport.cell).seconds[robot.cell])
            self._act_after(under_way, seconds, self._reach_end, transport, robot)
        elif step == WAITING:
            robot.cell = transport.cell
            if lane := self._lane(transport):
                lane.serving = transport
            self._begin(robot, "service")
            if transport.leave:
                self.leave(transport)
        elif step == STORING:
            self._store_on(transport, under_way, robot)
        else:
            place = under_way.place if under_way.place != NOWHERE else robot.cell
            self._keep(place, robot)
            self._begin(robot, "lift")
            left = self._lift_left(under_way)
            self._act_after(under_way, left, self._drop, (transport, place), robot)

    def _fetch_on(self, transport: Transport, under_way: TransportNow, robot: Robot) -> None:
        self._begin(robot, "to unit")
        cell = self.floor.units.setdefault(transport.shelf, robot.cell)
        seconds, _ = self.travel.unloaded([robot.cell], [cell])
        if transport.step == READY:  # which ideal robots skip
            transport.step = FETCHING
            self.book.step_of[robot.index] = FETCHING
        robot.cell = cell
        left = self._rolling(float(seconds[0, 0]))
        self._act_after(under_way, left, self._reach_unit, transport, robot)

    def _store_on(self, transport: Transport, under_way: TransportNow, robot: Robot) -> None:
        place = under_way.place
        if place == NOWHERE or not np.isfinite(self.travel.loaded_from(robot.cell).seconds[place]):
            self._store(transport)
            return
        lane = self._lane(transport)
        if lane and robot.cell == lane.station.cells[lane.station.service]:
            lane.free_from = self.time + self.kinematics.leaving(self.floor.plan.spacing)
        self._keep(place, robot)
        self._begin(robot, "back")
        seconds = self._rolling(self.travel.loaded_from(robot.cell).seconds[place])
        self._act_after(under_way, seconds, self._lower, (transport, place), robot)

    def _act_after(
        self,
        under_way: TransportNow,
        seconds: float,
        act: Callable[[Any], object],
        argument: Any,
        robot: Robot,
    ) -> None:
        if math.isfinite(under_way.left):
            planned = act, argument, robot, robot.plan
            self.queue.schedule(self.time + max(under_way.left, 0.0), self._act, planned)
        else:
            self.schedule(seconds, act, argument, robot)

    def _keep(self, place: int, robot: Robot) -> None:
        self.floor.free[place] = False
        robot.place = place

    def _lift_left(self, under_way: TransportNow) -> float:
        return max(self.kinematics.lift - (self.time - under_way.since), 0.0)

    def _rolling(self, seconds: float) -> float:
        """Returns the time of a way [s] for a robot that is in motion already, on the average
        without half of a start and of a first turn."""
        saved = self.kinematics.start_stop / 2 + self.kinematics.quarter_turn / 2
        return max(float(seconds) - saved, 0.0)


class ForkedFleet(IdealFleet):
    """Ideal robots from the state of a fleet on; they stand still until resume().

    spare: cells of further robots, by id, which are out of service at first.
    """

    def __init__(
        self,
        plan: FloorPlan,
        now: FleetNow,
        *,
        kinematics: Kinematics | None = None,
        pace: Pace | None = None,
        spare: Mapping[int, int] | None = None,
    ) -> None:
        spare = spare or {}
        robots = dict(now.robots) | {
            kiva_id: RobotNow(cell, in_service=False) for kiva_id, cell in spare.items()
        }
        inside = {kiva_id: max(robot.cell, 0) for kiva_id, robot in robots.items()}
        storage = np.asarray(plan.storage, bool).ravel()
        stored = {unit: cell for unit, cell in now.units.items() if storage[cell]}
        self._now = replace(now, robots=robots)
        super().__init__(plan, inside, _one_a_cell(stored), kinematics=kinematics)
        self._floor.units.update(now.units)
        self._paced.time, self._paced.pace = now.time, pace or Pace()
        for station in now.closed:
            self.is_open[station] = False

    @property
    def _paced(self) -> PacedTrips:
        assert isinstance(self._trips, PacedTrips)
        return self._trips

    def resume(self, repair: Callable[[], float] = lambda: 0.0) -> None:
        """Goes on with what robots do, by the hooks that are set. repair: draws how long a broken
        robot still stands [s]."""
        self._paced.resume(self._now, repair)

    def keep_up(
        self, availability: Availability, rng: np.random.Generator, items: MassOfItems
    ) -> None:
        """Has robots charge, fail and be repaired from now on, with the batteries of the fleet that
        they go on from."""
        super().keep_up(availability, rng, items)
        upkeep, chargers = self._trips.upkeep, set(np.asarray(self.plan.charging, int).tolist())
        assert upkeep is not None
        for robot in self._trips.robots:
            upkeep.note(robot.index, self.time)
            if robot.activity == "idle" and robot.cell in chargers and upkeep.energy:
                upkeep.begin(robot.index, robot.cell, self.time)
        self.set_charges({kiva_id: robot.charge for kiva_id, robot in self._now.robots.items()})

    def _make_trips(self, robots: Mapping[int, int]) -> Trips:
        return PacedTrips(self._floor, robots, self.kinematics, NearestHooks())


def _one_a_cell(units: Mapping[int, int]) -> dict[int, int]:
    """Returns the units without those in the cell of another one."""
    by_cell = {cell: unit for unit, cell in units.items()}
    return {unit: cell for cell, unit in by_cell.items()}
