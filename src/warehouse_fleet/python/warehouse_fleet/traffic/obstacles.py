# SPDX-License-Identifier: Apache-2.0
"""Things on the floor that are in the way of a fleet until a person takes them away."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from warehouse_fleet.transports.transports import Transports

PATIENCE = 15.0  # after which a person is asked for [s]


class ObstacleLog:
    """Notes since when something has stood in each cell."""

    def __init__(self) -> None:
        self._seen: dict[int, tuple[float, float]] = {}  # since, until [s]

    def note(self, cell: int, now: float, until: float) -> None:
        """Notes that something is taken to stand in a cell up to `until` [s]."""
        since, before = self._seen.get(cell, (now, now))
        self._seen[cell] = (since if before >= now else now), max(before, until)

    def lasting(self, now: float) -> set[int]:
        """Returns the cells in which something has stood for PATIENCE."""
        self._seen = {cell: seen for cell, seen in self._seen.items() if seen[1] >= now}
        return {cell for cell, seen in self._seen.items() if now - seen[0] >= PATIENCE}


def in_the_way(transports: "Transports") -> Iterator[str]:
    """Yields a sentence for each thing that has stood in the way for long: where it is [m], and
    what a person is to do."""
    plan, traffic, units = transports.plan, transports.traffic, transports.units
    cells = traffic.obstacles.lasting(traffic.time)
    for unit, crooked in sorted(units.crooked.items()):
        if cells & crooked.cells:
            where = f"({crooked.x:.1f}, {crooked.y:.1f})"
            yield f"storage_unit{unit} stands across cells at {where}: put it straight"
        cells -= crooked.cells
    for cell in units.left_in_streets(traffic.time - PATIENCE):
        x, y = plan.point_of(cell)
        name = f"storage_unit{units.unit_in[cell]}"
        yield f"{name} stands in a street at ({x:.1f}, {y:.1f}): bring it to a storage place"
    for cell in sorted(cells - set(traffic.zone.tolist())):
        x, y = plan.point_of(cell)
        yield f"something stands in the way at ({x:.1f}, {y:.1f}): take it away"
