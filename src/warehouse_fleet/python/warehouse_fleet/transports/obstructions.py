# SPDX-License-Identifier: Apache-2.0
"""What a person is to take out of the fleet's way."""

from collections.abc import Iterator

from warehouse_fleet.traffic.obstacles import PATIENCE
from warehouse_fleet.traffic.traffic import Traffic
from warehouse_fleet.transports.unit_map import UnitMap
from warehouse_layout.floor.floor_plan import FloorPlan


def in_the_way(plan: FloorPlan, traffic: Traffic, units: UnitMap) -> Iterator[str]:
    """Yields a sentence for each thing that has stood in the way for long: where it is [m], and
    what a person is to do."""
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
    for cell in sorted(cells - set(traffic.people_zone.tolist())):
        x, y = plan.point_of(cell)
        yield f"something stands in the way at ({x:.1f}, {y:.1f}): take it away"
