# SPDX-License-Identifier: Apache-2.0
"""A whole warehouse at work in one process: the world, and the fleet that moves its units.

driver = FleetDriver(World.preset("huge"))
driver.transports.submit(17, "pick3")
driver.step_until(3600)
"""

from typing import Any

import numpy as np

from warehouse_fleet.hosts.controller import Decision, FleetController, Observation
from warehouse_fleet.robots.failures import FailureLog, heard
from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_fleet.robots.robot_table import columns_of
from warehouse_fleet.traffic import elevator_rules
from warehouse_fleet.traffic.elevators import Move
from warehouse_fleet.traffic.people import PeopleLog, people_in
from warehouse_fleet.transports.towing import TowOrder
from warehouse_fleet.transports.unit_map import UnitPoses
from warehouse_layout.floor import plan_reader
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.floor.served_part import with_ways_back
from warehouse_layout.message_enums import EventKind

UPDATE = 0.1  # time between two updates [s]
FELL, PICKED_UP = int(EventKind.FELL), int(EventKind.PICKED_UP)
COLLISION, REFUSED = int(EventKind.COLLISION), int(EventKind.REFUSED)


def square(yaw: float) -> float:
    """Returns the nearest heading along an axis [rad]."""
    return round(yaw / (np.pi / 2)) * np.pi / 2


def _driven(plan: FloorPlan) -> FloorPlan:
    """Returns the plan without the steps that robots with bodies leave out. Raises FloorError where
    they could come to a deadlock."""
    driven, _ = with_ways_back(plan)
    driven.check(obstructed=False)
    return driven


class FleetDriver:
    """Hosts a FleetController in the process of a kiva_plugin_cpp.World.

    The same world, seed and requests give the same run. Events of the world go to `events` as well,
    if that is a list. Robots that are lost, or broken in others' way, are towed `tow_after` [s]
    later; None: when tow() is called. `threads`: see PlanLoop. `collisions` counts, `refusals` are
    texts, `fallen` the items on the floor; `failures` and `people` sum up what those cost. `plan`:
    of the world as it is; None: is read from it. takes_over_at: see FleetController.
    """

    def __init__(
        self,
        world: Any,
        seed: int = 1,
        planner: Any = None,
        kinematics: Kinematics | None = None,
        tow_after: float | None = None,
        threads: int = 0,
        plan: FloorPlan | None = None,
        takes_over_at: float | None = None,
    ) -> None:
        self.world = world
        self.plan = _driven(plan or plan_reader.of_world(world))
        self.controller = FleetController(
            self.plan,
            world.fleet.kiva_id,
            kinematics,
            seed,
            planner,
            tow_after=tow_after,
            takes_over_at=takes_over_at,
            threads=threads,
        )
        self.traffic, self.transports = self.controller.traffic, self.controller.transports
        self.robots = self.controller.robots
        self.transports.update_units(self._units())
        self.robots.loaded[:] = world.fleet.shelf_id != 0
        self.events: list[np.ndarray] | None = None
        self.collisions = 0
        self.refusals: list[str] = []
        self.failures, self.people = FailureLog(), PeopleLog()
        self.fallen = world.fallen_items["item_id"]
        self._steps = max(1, round(UPDATE / world.step_size))

    def close(self) -> None:
        """Ends the planner's thread."""
        self.controller.close()

    @property
    def time(self) -> float:
        """Simulated [s]."""
        return self.world.time

    def step_until(self, time: float) -> None:
        """Steps until a simulated time [s]."""
        while self.world.time < time - 1e-9:
            self.step()

    def step(self) -> None:
        """Advances by 0.1 s."""
        refused = self._take_events()
        if not self.controller.is_stale(self.world.time):
            self._carry_out(self.controller.tick(self._observe(refused)))
        self.world.step(self._steps)

    def _observe(self, refused: list[str]) -> Observation:
        time, reports, people = (
            self.world.time,
            columns_of(heard(self.world)),
            people_in(self.world),
        )
        self.failures.update(time, reports["failures"])
        self.people.update(time, people, len(self.robots))
        return Observation(
            time,
            reports,
            people,
            fallen=len(self.fallen),
            refused=refused,
            look_at_map=lambda: self.world.occupancy()[3],
            look_at_units=self._units,
        )

    def _carry_out(self, decision: Decision) -> None:
        world = self.world
        for tow in decision.tows:
            self._set_down(tow)
        for move in decision.moves:
            self._set_down(move)
        for kiva_id, shelf_id, up in decision.lifts:
            world.carry(kiva_id, shelf_id) if up else world.drop(kiva_id, shelf_id)
        if decision.cancels:
            world.cancel(decision.cancels)
        if len(decision.releases.kiva_id):
            world.follow(*decision.releases)

    def tow(self, kiva_id: int) -> None:
        """Moves a broken or lost robot out of the way. Raises ValueError as
        FleetController.tow()."""
        self._set_down(self.controller.tow(kiva_id))

    def _set_down(self, order: TowOrder | Move) -> None:
        yaw = self.world.fleet.yaw[self.world.fleet.index(order.kiva_id)]
        self.world.set_pose(f"kiva{order.kiva_id}", order.x, order.y, yaw=square(yaw))

    def _units(self) -> UnitPoses:
        units = self.world.storage_units
        carried = units["kiva_id"] != 0
        x, y, yaw = units["x"], units["y"], units["yaw"]
        return UnitPoses(units["shelf_id"], x, y, yaw, carried, self.world.time)

    def _take_events(self) -> list[str]:
        """Applies the world's events; returns the models of robots that refused a path."""
        events = self.world.events()
        if self.events is not None:
            self.events.append(events)
        if not len(events):
            return []
        kinds = events["kind"]
        self.failures.note(kinds)
        counts = np.bincount(kinds, minlength=len(EventKind)).tolist()
        if counts[FELL] or counts[PICKED_UP]:
            self.fallen = self.world.fallen_items["item_id"]
        self.collisions += counts[COLLISION]
        if not counts[REFUSED]:
            return []
        refused = events[kinds == REFUSED]
        self.refusals += [f"{event['model']}: {event['text']}" for event in refused]
        return [event["model"] for event in refused]

    @property
    def elevators(self) -> dict[str, float]:
        """The figures of elevators, as elevator_rules.figures(); empty without any."""
        elevators = self.traffic.elevators
        return elevator_rules.figures(elevators.cars, self.time) if elevators else {}

    @property
    def blocked(self) -> int:
        """How often a robot was BLOCKED."""
        return self.traffic.blocked

    @property
    def watchdog(self) -> int:
        """How often a robot made no progress for watchdog.NO_PROGRESS."""
        return self.traffic.watchdog.count

    @property
    def executed_over_planned(self) -> float:
        """Seconds that robots drove over those of their plans; 1 before the first has arrived."""
        return self.transports.totals.executed_over_planned

    @property
    def distance_m(self) -> float:
        """Metres driven with a plan by all robots, in whole journeys."""
        return self.transports.totals.cells * self.plan.spacing

    @property
    def plan_ms(self) -> list[float]:
        """Computing time of each plan [ms]."""
        return (1e3 * self.traffic.plans.seconds.all()).tolist()
