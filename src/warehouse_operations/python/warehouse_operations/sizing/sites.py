# SPDX-License-Identifier: Apache-2.0
"""Opens shifts on the floor of a layout file with a number of robots and open picking stations."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from warehouse_layout.file.layout_file import LayoutFile
from warehouse_layout.place import placement
from warehouse_operations.fleets import availability, measured
from warehouse_operations.runs import layout_site
from warehouse_operations.runs.operations import Operations
from warehouse_operations.stock.site import Site

if TYPE_CHECKING:
    from kiva_plugin_cpp import World


def open_shift(
    file: LayoutFile,
    *,
    robots: int,
    stations: int,
    orders: str,
    seed: int,
    physics: bool,
    policies: Mapping[str, Any] | None = None,
    realism: str = "",
) -> Operations:
    """Opens a shift with a number of robots, and of open picking stations, the first ones.

    All replenishing stations are open. Raises LayoutFileError, DemandError, PolicyError, SiteError.
    """
    world = _world(file, robots, seed, realism) if physics else None
    if world is not None:
        site = Site.of_world(world, file.title)
    else:
        site = Site.of_layout(placement.place(file, seed, robots), file.title)
    site = measured.read(realism).at(layout_site.of_file(site, file))
    ops = Operations(
        world,
        site=site,
        orders=orders,
        seed=seed,
        policies=file.policies if policies is None else policies,
        physics=physics,
        availability=None if physics else availability.read(realism),
    )
    ops.shift.open_picking(stations)
    return ops


def picking_stations(file: LayoutFile) -> list[str]:
    """Returns the names of the picking stations, in the order in which they are opened."""
    return [station.name for station in file.stations if station.kind != "replenish"]


def _world(file: LayoutFile, robots: int, seed: int, realism: str) -> "World":
    from kiva_plugin_cpp import World

    return World.layout(file, robots=robots, seed=seed, realism=realism or None)
