# SPDX-License-Identifier: Apache-2.0
"""Refuses a Description before anything runs, where it names what its warehouse does not have."""

import functools

import numpy as np

from warehouse_layout.generate import layout_choice
from warehouse_layout.place import placement
from warehouse_operations.runs import layout_site, simulation
from warehouse_operations.runs.names import Names
from warehouse_operations.runs.opening import assortment_of
from warehouse_operations.runs.rawsim import read_instance
from warehouse_operations.runs.simulation import Description
from warehouse_operations.stock import orders_text
from warehouse_operations.stock.demand import make_demand
from warehouse_operations.stock.site import Site


def check(description: Description, is_new: bool = True) -> None:
    """Raises one of simulation.ERRORS if events, orders or settings name a station, a robot or a
    SKU that there is not, or more stations or robots than there is room for.

    is_new: whether it begins with a new stock. A warehouse that is generated for its units, and the
    SKUs of a stock that a database holds, are checked when the shift opens.
    """
    file = orders_text.file_of(description.orders)
    named = description.events or description.stations or description.robots or file
    if not named or description.units:
        return
    whole, _ = simulation.with_spare_robots(description)
    site = _site(whole.layout or whole.size, whole.instance, whole.robots, _version(whole))
    simulation.check_stations(description, site)
    rng = np.random.default_rng(1)
    assortment = assortment_of(description.orders, site, rng) if is_new else None
    names = Names(
        [station.name for station in site.plan.stations],
        site.robots,
        set(assortment.skus) if assortment else None,
        not description.physics,
    )
    for event in description.events:
        names.check(event)
    if file:
        make_demand(description.orders, assortment, (1, 1), rng)


def _version(description: Description) -> int:
    """Returns when the file of a warehouse was changed [ns]; 0 for a preset."""
    name = description.instance or description.layout
    if not name or layout_choice.is_preset(name):
        return 0
    path = layout_choice.path_of(name)
    return path.stat().st_mtime_ns if path.exists() else 0


@functools.lru_cache(16)
def _site(layout: str, instance: str, robots: int, _: int) -> Site:
    """Returns the warehouse of a file of that version, without its bodies."""
    if instance:
        return read_instance(instance)
    file = layout_choice.chosen(layout)
    placed = placement.place(file, robots=robots or None)
    return layout_site.of_file(Site.of_layout(placed, file.title), file)
