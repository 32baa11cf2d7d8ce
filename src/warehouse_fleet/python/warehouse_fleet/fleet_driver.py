# SPDX-License-Identifier: Apache-2.0
"""A whole warehouse at work in one process: the world, and the fleet that moves its units.

driver = FleetDriver(World.preset("huge"))
driver.transports.submit(17, "pick3")
driver.step_until(3600)
"""

import numpy as np

from warehouse_fleet.failures import FailureLog, heard
from warehouse_fleet.people import PeopleLog, people_in
from warehouse_fleet.towing import Towing
from warehouse_fleet.traffic import STAYS, Traffic
from warehouse_fleet.transports import Transports
from warehouse_layout.floor_plan import FloorPlan

UPDATE = 0.1  # between two releases [s]
REFUSED, COLLISION, FELL, PICKED_UP = 1, 6, 13, 14  # EventKind


def square(yaw):
    """The nearest heading along an axis [rad]."""
    return round(yaw / (np.pi / 2)) * np.pi / 2


class FleetDriver:
    """Drives all robots of a kiva_plugin_cpp.World. `transports` is what it is told to do.

    The same world, seed and requests give the same run. Events of the world that are about
    something else than driving go to `events`, if that is a list. Robots that are lost, or broken
    in others' way, are towed `tow_after` [s] later; None: when tow() is called.
    """

    def __init__(self, world, seed=1, planner=None, kinematics=None, tow_after=None):
        self.world = world
        self.plan = FloorPlan.of_world(world)
        self.plan.check(obstructed=False)
        self.traffic = Traffic(self.plan, world.fleet.kiva_id, kinematics, seed, planner)
        self.transports = Transports(self.plan, self.traffic, self._lift)
        self._towing = None if tow_after is None else Towing(self.transports, self.tow, tow_after)
        self._see_units()
        self.traffic.loaded[:] = world.fleet.shelf_id != 0
        for cell in np.flatnonzero(self.plan.obstructed):
            self.traffic.shut(int(cell), STAYS)
        self.events = None
        self.collisions = 0
        self.refusals = []  # texts
        self.failures = FailureLog()
        self.people = PeopleLog()
        self.fallen = world.fallen_items["item_id"]  # items that lie on the floor
        self._steps = max(1, round(UPDATE / world.step_size))

    def close(self):
        """Ends the planner's thread."""
        self.traffic.close()

    def _lift(self, kiva_id, shelf_id, up):
        if up:
            self.world.carry(kiva_id, shelf_id)
        else:
            self.world.drop(kiva_id, shelf_id)

    def tow(self, kiva_id):
        """People move a broken or lost robot out of the way. Raises as Transports.refuge does."""
        x, y = self.plan.point_of(self.transports.refuge(kiva_id))
        yaw = self.world.fleet.yaw[self.world.fleet.index(kiva_id)]
        self.world.set_pose(f"kiva{kiva_id}", float(x), float(y), yaw=square(yaw))

    @property
    def time(self):
        """Simulated [s]."""
        return self.world.time

    @property
    def stations(self):
        """The floor's Stations."""
        return self.plan.stations

    def step(self):
        """Goes on by 0.1 s."""
        self._hear()
        if not self.traffic.is_stale(self.world.time):
            self._drive()
        self.world.step(self._steps)

    def _drive(self):
        gone = self.traffic.gone
        report = self.traffic.aligned(heard(self.world))
        self.traffic.observe(self.world.time, report)
        self.failures.observe(self.world.time, report.failures)
        self._see_people()
        if self._towing:
            self._towing.advance()
        self.traffic.see_fallen(len(self.fallen))
        looks = self.traffic.wants_map
        if looks:
            self.traffic.see(self.world.occupancy()[3])
        self.transports.advance(report)
        if looks or not np.array_equal(gone, self.traffic.gone):
            self._see_units()
        releases = self.traffic.releases()
        if len(releases[0]):
            self.world.follow(*releases)

    def _see_people(self):
        people = people_in(self.world)
        self.people.observe(self.world.time, people, len(self.traffic.kiva_ids))
        self.traffic.see_people(people)

    def step_until(self, time):
        """Goes on until that simulated time [s]."""
        while self.world.time < time - 1e-9:
            self.step()

    def _see_units(self):
        """Takes in where units stand, when somebody else may have moved some."""
        units = self.world.storage_units
        self.transports.look(
            units["shelf_id"],
            units["x"],
            units["y"],
            units["yaw"],
            units["kiva_id"] != 0,
            self.world.time,
        )

    def _hear(self):
        events = self.world.events()
        if self.events is not None:
            self.events.append(events)
        kinds = events["kind"]
        self.failures.note(kinds)
        if np.isin(kinds, (FELL, PICKED_UP)).any():
            self.fallen = self.world.fallen_items["item_id"]
        self.collisions += int(np.count_nonzero(kinds == COLLISION))
        for event in events[kinds == REFUSED]:
            self.refusals.append(f"{event['model']}: {event['text']}")
            self.traffic.refused(event["model"])

    @property
    def blocked(self):
        """How often a robot was BLOCKED."""
        return self.traffic.blocked

    @property
    def watchdog(self):
        """How often a robot made no progress for 30 s."""
        return self.traffic.watchdog

    @property
    def distance_m(self):
        """Driven with a plan by all robots, in whole journeys [m]."""
        return self.transports.totals.cells * self.plan.spacing

    @property
    def executed_over_planned(self):
        """Seconds that robots drove over those of their plans; 1 before anybody has arrived."""
        return self.transports.totals.executed_over_planned

    @property
    def plan_ms(self):
        """Computing time of each plan [ms]."""
        return [1e3 * seconds for seconds in self.traffic.plan_seconds]
