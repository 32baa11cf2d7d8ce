# SPDX-License-Identifier: Apache-2.0
"""Opens shifts on the floor of a layout file, with so many robots and open picking stations."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from warehouse_layout import generator, layout_file, placement
from warehouse_layout.layout import Layout
from warehouse_layout.layout_file import LayoutFile
from warehouse_layout.request import PRESETS
from warehouse_operations.operations import Operations
from warehouse_operations.settings import Settings
from warehouse_operations.site import Site
from warehouse_operations.stations import WorkStation

if TYPE_CHECKING:
    from kiva_plugin_cpp import World

# A setting of a station in a layout file, and its name in Settings.
OF_STATION = {"capacity": "slots", "seconds_a_piece": "piece_s", "pick_seconds": "pick_s"}


def file_of(layout: str) -> LayoutFile:
    """Returns the layout file of a path, or of a preset's name. Raises LayoutFileError."""
    if layout in PRESETS and not Path(layout).exists():
        return generator.of_request(PRESETS[layout], layout)
    return layout_file.read(layout)


def open_shift(
    file: LayoutFile,
    *,
    robots: int,
    stations: int,
    orders: str,
    seed: int,
    physics: bool,
    policies: Mapping[str, Any] | None = None,
) -> Operations:
    """Opens a shift with so many robots, and the first so many picking stations open.

    All replenishing stations are open. Raises LayoutFileError, DemandError, PolicyError, SiteError.
    """
    laid = placement.place(file, seed, robots)
    world = _world(laid, seed) if physics else None
    site = Site.of_world(world, file.title) if world is not None else _site(laid, file.title)
    settings = settings_of(file)
    closed = picking_stations(file)[stations:]
    working = len(site.plan.stations) - len(closed)
    ops = Operations(
        world,
        site=site,
        orders=orders,
        seed=seed,
        policies=file.policies if policies is None else policies,
        physics=physics,
        settings=replace(settings, units_per_station=settings.units_at(robots, working)),
    )
    for name in closed:
        ops.shift.set_station(name, False, ops.shift.station(name).mode)
    return ops


def picking_stations(file: LayoutFile) -> list[str]:
    """Returns the names of the picking stations, in the order in which they are opened."""
    return [one.name for one in file.stations if one.kind == "pick"]


def open_stations(ops: Operations, kind: str) -> list[WorkStation]:
    """Returns the open stations of a kind, PICK or REPLENISH."""
    return [one for one in ops.shift.stations if one.is_open and one.kind == kind]


def settings_of(file: LayoutFile) -> Settings:
    """Returns the settings of a layout file's stations."""
    given = {
        one.name: {OF_STATION[key]: value for key, value in one.settings.items()}
        for one in file.stations
        if one.settings
    }
    return Settings(by_station=given)


def _world(laid: Layout, seed: int) -> "World":
    from kiva_plugin_cpp import World

    return World.of_layout(laid, own_models=True, seed=seed)


def _site(laid: Layout, name: str) -> Site:
    plan = laid.plan
    assert plan is not None

    def cells(points: Any) -> dict[int, int]:
        found = plan.cell_of(points[:, 0], points[:, 1]).tolist()
        return dict(enumerate(found, start=1))

    items = [(f"item{n}", int(unit) + 1) for n, unit in enumerate(laid.item_unit, start=1)]
    return Site(plan, cells(laid.robots), cells(laid.units), items, name)
