# SPDX-License-Identifier: Apache-2.0
"""A working warehouse: orders, stock, stations and policies over a fleet.

from kiva_plugin_cpp import World
from warehouse_operations import Operations

ops = Operations(World.preset("large"), orders="fill", seed=1, physics=False)
ops.run(hours=1)
print(ops.kpis()["item_score"])

Rooms, from the lowest; a module imports from its own room and from lower ones:

    goods     SKUs by weight, the sizes of bundles and orders
    stock     SKUs, bins, orders, stations, where units stand
    document  pages: style, sheets, charts on a canvas
    policies  decisions: which order, unit, bin, place, robot
    shift     a shift at work: picking, replenishing, visits, manual stations
    store     the database: written, read back, searched, checked
    fleets    robots for a shift in one process: ideal ones, or those of a simulated world
    runs      whole shifts in folders: simulate, sweep
    demand    a day of orders, described: its peak, its oddities
    reports   figures, comparisons, charts, pages
    slotting  which SKUs lie together, and what that gains
    sizing    numbers of robots and stations for a wish or a day, with costs
    design    layouts that a search finds
    forecast  what comes of a shift that runs, by many runs ahead
    calibrate  what recordings say of robots and stations
    ros       the nodes
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from warehouse_operations.policies import Policies, PolicyError
    from warehouse_operations.runs.operations import Operations
    from warehouse_operations.shift.shift import Settings, Shift
    from warehouse_operations.stock.site import Site

__all__ = ["Operations", "Policies", "PolicyError", "Settings", "Shift", "Site"]
_HOMES = {
    "Operations": "runs.operations",
    "Policies": "policies",
    "PolicyError": "policies",
    "Settings": "shift.shift",
    "Shift": "shift.shift",
    "Site": "stock.site",
}


def __getattr__(name: str) -> Any:
    """Imports what is asked for: who needs one room alone does not pay for all (30 MB)."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_HOMES[name]}"), name)
