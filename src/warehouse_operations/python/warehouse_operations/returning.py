# SPDX-License-Identifier: Apache-2.0
"""What a warehouse has lost and gained since a database has seen it."""

import itertools
from collections import Counter
from dataclasses import dataclass

from warehouse_operations.assortment import CAPACITY
from warehouse_operations.inventory import Bin


class SiteError(ValueError):
    """The database is of another warehouse."""


@dataclass(frozen=True)
class Changes:
    """gone: Bins of the database that the warehouse has no more; new: empty Bins that the database
    does not have yet; moved: those that are on another unit now."""

    gone: list
    new: list
    moved: list

    def __str__(self):
        told = []
        if self.gone:
            pieces = sum(one.quantity + (one.fallen or 0) for one in self.gone)
            told.append(f"{_named(self.gone)} gone: {pieces} pieces are written off")
        if self.new:
            told.append(f"{_named(self.new)} new, and still empty")
        if self.moved:
            told.append(f"{_named(self.moved)} on another storage unit than before")
        return "; ".join(told)


def layout_of(site):
    """What a warehouse is known by again: its stations with their places [m], sorted texts."""
    plan = site.plan
    places = ((one.name, *plan.point_of(int(one.cells[one.service]))) for one in plan.stations)
    return sorted(f"{name} at ({x:.2f}, {y:.2f})" for name, x, y in places)


def changes(site, stored, url):
    """The Changes of a Site since it was Stored; raises SiteError where it is another one."""
    here, there = dict(site.items), {one.item for one in stored.bins}
    gone = [one for one in stored.bins if one.item not in here]
    moved = [one for one in stored.bins if one.unit != here.get(one.item, one.unit)]
    _check(layout_of(site), stored, len(gone), len(moved), url)
    for one in moved:
        one.unit = here[one.item]
    items = [(item, unit) for item, unit in here.items() if item not in there]
    return Changes(gone, _new_bins(items, stored, here), moved)


def _new_bins(items, stored, here):
    """Each for the SKU with the fewest bins."""
    count = Counter(one.sku for one in stored.bins if one.item in here)
    rank = {sku: rank for rank, sku in enumerate(stored.assortment.skus)}
    numbers, result = itertools.count(stored.last_bin + 1), []
    for item, unit in items:
        number = stored.former.get(item) or next(numbers)
        sku = min(rank, key=lambda one: (count[one], rank[one]))
        count[sku] += 1
        result.append(Bin(number, item, unit, CAPACITY, sku))
    return result


def _check(layout, stored, gone, moved, url):
    """A warehouse may lose stations and units, or gain some, but not most of them at once."""
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


def _named(bins):
    """A few of them by name, with a verb."""
    units = sorted({one.unit for one in bins})
    names = ", ".join(map(str, units[:5])) + (f" and {len(units) - 5} more" if units[5:] else "")
    which = f"{len(bins)} bins" if len(bins) > 1 else bins[0].item
    where = f"storage unit{'s' if len(units) > 1 else ''} {names}"
    return f"{which} of {where} {'are' if len(bins) > 1 else 'is'}"
