# SPDX-License-Identifier: Apache-2.0
"""What each robot did, summed up from the fleet's poses and the events."""

import math
from collections import defaultdict
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from types import ModuleType

from warehouse_client.message_check import subscribe
from warehouse_msgs.msg import Event, FleetState

COLUMNS = {
    "commands": (Event.ACCEPTED,),
    "lifts": (Event.LIFTED, Event.DROPPED),
    "blocked": (Event.BLOCKED,),
    "refused": (Event.REFUSED,),
    "collisions": (Event.COLLISION,),
}


@dataclass
class Odometer:
    """Sums up one robot's way."""

    metres: float = 0.0
    radians: float = 0.0
    last: tuple[float, float, float] | None = None

    def add(self, x: float, y: float, yaw: float) -> None:
        """Adds the way from the last pose to this one [m, rad]."""
        if self.last:
            self.metres += math.dist((x, y), self.last[:2])
            self.radians += abs(math.remainder(yaw - self.last[2], math.tau))
        self.last = (x, y, yaw)


class FleetStatistics:
    """`ros` is rospy."""

    def __init__(self, ros: ModuleType) -> None:
        self._odometers: dict[int, Odometer] = defaultdict(Odometer)
        subscribe(ros, "warehouse/fleet", FleetState, self._measure, queue_size=100)

    def _measure(self, fleet: FleetState) -> None:
        for kiva, x, y, yaw in zip(fleet.kiva_id, fleet.x, fleet.y, fleet.yaw):
            self._odometers[kiva].add(x, y, yaw)

    def table(self, kivas: Iterable[int], events: Collection[Event]) -> str:
        """Returns a line of text for each of the robots `kivas`, from these Event messages."""
        titles = ["robot", "metres", "quarter turns", *COLUMNS]
        lines = [[f"kiva{k}", *self._way(k), *_counts(f"kiva{k}", events)] for k in kivas]
        wide = [max(len(title), 6) for title in titles]
        rows = [titles, ["-" * w for w in wide], *lines]
        return "\n".join("  ".join(f"{c:>{w}}" for c, w in zip(row, wide)) for row in rows)

    def _way(self, kiva: int) -> tuple[str, str]:
        way = self._odometers[kiva]
        return f"{way.metres:.1f}", f"{way.radians / (math.pi / 2):.0f}"


def _counts(model: str, events: Iterable[Event]) -> list[str]:
    # The other body of a collision took part in it as well.
    kinds = [e.kind for e in events if model in (e.model, e.kind == Event.COLLISION and e.other)]
    return [str(sum(kind in column for kind in kinds)) for column in COLUMNS.values()]
