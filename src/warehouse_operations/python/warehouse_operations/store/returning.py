# SPDX-License-Identifier: Apache-2.0
"""Finds the bins that a warehouse lost and gained since a database was written."""

import itertools
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

from warehouse_operations.stock.assortment import CAPACITY
from warehouse_operations.stock.inventory import Bin
from warehouse_operations.stock.site import Site
from warehouse_operations.stock.stored_warehouse import Changes, Stored


class SiteError(ValueError):
    """Raised for a database of another warehouse."""


def layout_of(site: Site) -> list[str]:
    """Returns the stations with their places [m], sorted: they identify a warehouse."""
    plan = site.plan
    places = (
        (station.name, *plan.point_of(int(station.cells[station.service])))
        for station in plan.stations
    )
    return sorted(f"{name} at ({x:.2f}, {y:.2f})" for name, x, y in places)


def changes(site: Site, stored: Stored, url: str) -> Changes:
    """Returns the changes of a Site since it was Stored, and moves bins to their present units.

    Raises SiteError if the database at url is of another warehouse.
    """
    here, there = dict(site.items), {bin_.item for bin_ in stored.bins}
    gone = [bin_ for bin_ in stored.bins if bin_.item not in here]
    moved = [bin_ for bin_ in stored.bins if bin_.unit != here.get(bin_.item, bin_.unit)]
    _check(layout_of(site), stored, len(gone), len(moved), url)
    for bin_ in moved:
        bin_.unit = here[bin_.item]
    items = [(item, unit) for item, unit in here.items() if item not in there]
    return Changes(gone, _new_bins(items, stored, here), moved)


def _new_bins(
    items: Iterable[tuple[str, int]], stored: Stored, here: Mapping[str, int]
) -> list[Bin]:
    """Returns empty bins for items, each kept for the SKU with the fewest bins."""
    count = Counter(bin_.sku for bin_ in stored.bins if bin_.item in here)
    rank = {sku: rank for rank, sku in enumerate(stored.assortment.skus)}
    numbers, result = itertools.count(stored.last_bin + 1), []
    for item, unit in items:
        number = stored.former.get(item) or next(numbers)
        sku = min(rank, key=lambda name: (count[name], rank[name]))
        count[sku] += 1
        result.append(Bin(number, item, unit, CAPACITY, sku))
    return result


def _check(layout: Sequence[str], stored: Stored, gone: int, moved: int, url: str) -> None:
    """Raises SiteError if most bins differ, or the stations do otherwise than by added or by
    removed ones."""
    other = f"{url} is of another warehouse"
    if stored.layout is not None and not (
        set(layout) <= set(stored.layout) or set(stored.layout) <= set(layout)
    ):
        station = min(set(layout) ^ set(stored.layout))
        where = "the warehouse" if station in layout else "the database"
        raise SiteError(f"{other}: the station {station} is only in {where}")
    bins = len(stored.bins)
    if 2 * (gone + moved) > bins:
        raise SiteError(
            f"{other}: of its {bins} bins, {gone} are not here and {moved} are on other storage "
            "units; choose another database, or bring the storage units back"
        )
