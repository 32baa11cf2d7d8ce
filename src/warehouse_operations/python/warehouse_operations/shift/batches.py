# SPDX-License-Identifier: Apache-2.0
"""Batches: how many of the waiting bundles could go along with each unit."""

from collections import Counter, defaultdict
from collections.abc import Collection

from warehouse_operations.stock.inventory import Bin, Inventory
from warehouse_operations.stock.orders import Bundle


def sizes(
    inventory: Inventory, units: Collection[int], bundles: Collection[Bundle]
) -> Counter[int]:
    """Returns for how many bundles there is a place on each of some units: in bins of their SKU,
    or in empty ones. Units without any are left out."""
    out: Counter[int] = Counter()
    quantities: dict[str, list[int]] = defaultdict(list)
    for bundle in bundles:
        quantities[bundle.sku].append(bundle.quantity)
    for sku, waiting in quantities.items():
        for bin_ in inventory.with_sku(sku):
            if bin_.unit in units and inventory.takes(bin_, sku, 0):
                out[bin_.unit] += _fitting(bin_, waiting)
    for unit, count in inventory.empties(units).items():
        out[unit] += count
    fits = {
        unit: min(size, len(bundles), inventory.bundles_that_fit(unit))
        for unit, size in out.items()
    }
    return Counter({unit: int(size) for unit, size in fits.items() if size})


def _fitting(bin_: Bin, quantities: list[int]) -> int:
    """Returns how many of some quantities fit in a bin, taken as they come."""
    room, count = bin_.room, 0
    for quantity in quantities:
        if quantity <= room:
            room -= quantity
            count += 1
    return count
