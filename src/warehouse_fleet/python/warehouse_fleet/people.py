# SPDX-License-Identifier: Apache-2.0
"""People on the floor: the cells that are closed for their sake, and what they cost."""

from types import SimpleNamespace

import numpy as np

REACH = 0.9  # from a person's way to the middles of the cells that are closed; in cells


def people_in(world):
    """Who walks in a kiva_plugin_cpp.World, and which robots mind: as warehouse_msgs/People."""
    people = world.people
    if not people:
        return SimpleNamespace(name=[], x=[], y=[], ahead_x=[], ahead_y=[], slowed=[], stopped=[])
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


def zone_around(plan, people):
    """The cells of a FloorPlan where people are, or will be if they go straight on: int32."""
    zone = [
        _along(plan, np.array((x, y)), np.array((to_x, to_y)))
        for x, y, to_x, to_y in zip(people.x, people.y, people.ahead_x, people.ahead_y)
    ]
    return np.unique(np.concatenate(zone)) if zone else np.zeros(0, np.int32)


def _along(plan, begin, end):
    """Cells whose middles are within reach of the way from `begin` to `end` [m]."""
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
    """How long people were on the floor, and robots slow or standing for their sake."""

    def __init__(self):
        self.person_s = 0.0  # seconds of people
        self.slowed_s = self.stopped_s = self.robot_s = 0.0  # seconds of robots
        self._time, self._before = None, (0, 0, 0)

    def observe(self, time, people, robots):
        """Takes in who is there at that time [s], and which of so many robots mind."""
        elapsed = 0.0 if self._time is None else max(0.0, time - self._time)
        there, slowed, stopped = self._before
        self._time = time
        self._before = len(people.name), len(people.slowed), len(people.stopped)
        self.robot_s += elapsed * robots
        self.person_s += elapsed * there
        self.slowed_s += elapsed * slowed
        self.stopped_s += elapsed * stopped

    def figures(self):
        """As kpis.json has them; empty where nobody came."""
        if not self.person_s:
            return {}
        return {
            "person_hours": self.person_s / 3600,
            "slowed_fraction": self.slowed_s / self.robot_s,
            "stopped_fraction": self.stopped_s / self.robot_s,
        }
