# SPDX-License-Identifier: Apache-2.0
"""People on the floor: the cells that are closed around them, and what that costs."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from warehouse_layout.floor.floor_plan import FloorPlan

REACH = 0.9  # from a person's way to the middles of the cells that are closed; in cells


NO_PEOPLE = SimpleNamespace(name=[], x=[], y=[], ahead_x=[], ahead_y=[], slowed=[], stopped=[])


def people_in(world: Any) -> SimpleNamespace:
    """Returns the people in a kiva_plugin_cpp.World, and the robots that slow down or stop for
    them: as warehouse_msgs/People."""
    people = world.people
    if not people:
        return NO_PEOPLE
    columns = {
        key: [float(person[key]) for person in people.values()]
        for key in ("x", "y", "ahead_x", "ahead_y")
    }
    fleet = world.fleet
    stands = (fleet.curtained != 0) | (fleet.allowed_speed == 0)
    slow = ~stands & np.isfinite(fleet.allowed_speed)
    return SimpleNamespace(
        name=list(people), slowed=fleet.kiva_id[slow], stopped=fleet.kiva_id[stands], **columns
    )


def zone_around(plan: FloorPlan, people: Any) -> np.ndarray:
    """Returns the cells (n,) int32 where people are, or will be if they go straight on."""
    zone = [
        _along(plan, np.array((x, y)), np.array((to_x, to_y)))
        for x, y, to_x, to_y in zip(people.x, people.y, people.ahead_x, people.ahead_y)
    ]
    return np.unique(np.concatenate(zone)) if zone else np.zeros(0, np.int32)


def _along(plan: FloorPlan, begin: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Returns the cells whose middles are within reach of the way from `begin` to `end` [m]."""
    height, width = plan.shape
    reach = REACH * plan.spacing
    low = np.floor((np.minimum(begin, end) - reach - plan.origin) / plan.spacing).astype(int)
    high = np.ceil((np.maximum(begin, end) + reach - plan.origin) / plan.spacing).astype(int)
    columns = np.arange(max(0, low[0]), min(width, high[0] + 1))
    rows = np.arange(max(0, low[1]), min(height, high[1] + 1))
    cells = np.add.outer(rows * width, columns).ravel().astype(np.int32)
    middles = np.stack(plan.point_of(cells), axis=-1)
    way = end - begin
    part = np.clip((middles - begin) @ way / max(way @ way, 1e-12), 0, 1)
    nearest = begin + part[:, None] * way
    return cells[np.hypot(*(middles - nearest).T) < reach]


class PeopleLog:
    """Sums up how long people were on the floor, and robots slowed down or stopped for them."""

    def __init__(self) -> None:
        self.person_s = 0.0  # seconds of people
        self.slowed_s = self.stopped_s = self.robot_s = 0.0  # seconds of robots
        self._time: float | None = None
        self._before = (0, 0, 0)

    def update(self, time: float, people: Any, robots: int) -> None:
        """Updates from the people at a time [s]; `robots` is the count of robots."""
        elapsed = 0.0 if self._time is None else max(0.0, time - self._time)
        there, slowed, stopped = self._before
        self._time = time
        self._before = len(people.name), len(people.slowed), len(people.stopped)
        self.robot_s += elapsed * robots
        self.person_s += elapsed * there
        self.slowed_s += elapsed * slowed
        self.stopped_s += elapsed * stopped

    def figures(self) -> dict[str, float]:
        """Returns the figures for kpis.json; none where no person came."""
        if not self.person_s:
            return {}
        return {
            "person_hours": self.person_s / 3600,
            "slowed_fraction": self.slowed_s / self.robot_s,
            "stopped_fraction": self.stopped_s / self.robot_s,
        }
