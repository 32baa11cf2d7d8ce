# SPDX-License-Identifier: Apache-2.0
"""A warehouse floor for tests: blocks of storage two deep, stations along its right edge; and the
check of the books of a shift."""

import numpy as np

from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.floor.stations import PICK, REPLENISH, Station
from warehouse_operations.stock.site import Site
from warehouse_operations.store import check

BLOCK, LANE = 5, 5  # cells


def site(robots=8, picking=2, replenishing=1, rows=4, blocks=4, filled=0.85, bins=5):
    """Robots park beneath units. Lanes are (entry) → … → service, up, ← … (exit)."""
    stations = picking + replenishing
    height = max(3 * rows + 1, 3 * stations + 1)
    street_x = np.arange(blocks + 1) * (BLOCK + 1)
    width = street_x[-1] + 1 + LANE
    passable = np.ones((height, width), bool)
    storage = np.zeros_like(passable)
    for y in range(rows):
        for x in street_x[:-1]:
            storage[3 * y + 1 : 3 * y + 3, x + 1 : x + 1 + BLOCK] = True
    made = []
    for i in range(stations):
        kind = PICK if i < picking else REPLENISH
        y, x = 3 * i, street_x[-1] + 1
        way = [(x + k, y) for k in range(LANE)] + [(x + k, y + 1) for k in range(LANE)[::-1]]
        cells = np.array([row * width + column for column, row in way], np.int32)
        made.append(Station(f"{kind.lower()}{i + 1}", kind, cells, LANE - 1))
    plan = FloorPlan.laid_out(
        origin=(0.0, 0.0),
        spacing=1.0,
        passable=passable,
        storage=storage,
        parking=np.zeros_like(passable),
        exits=np.full(passable.shape, 15, np.uint8),
        stations=made,
    )
    places = np.random.default_rng(7).permutation(np.flatnonzero(storage))
    units = {i + 1: int(cell) for i, cell in enumerate(places[: int(filled * len(places))])}
    items = [(f"item{bins * (u - 1) + k + 1}", u) for u in units for k in range(bins)]
    starts = {i + 1: int(cell) for i, cell in enumerate(places[:robots])}
    return Site(plan, starts, units, items, "test")


def stock_faults(ops):
    """Returns what does not balance in the database of a shift, up to now."""
    ops.shift.commit()
    ops.database.flush()
    with ops.database.reading():
        return check.faults(ops.database.engine)
