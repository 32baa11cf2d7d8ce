# SPDX-License-Identifier: Apache-2.0
"""The first stock of units that are full by weight: bundles on random units."""

import numpy as np

from warehouse_operations.goods.kinds import ROUNDING, Goods
from warehouse_operations.stock.assortment import Assortment
from warehouse_operations.stock.inventory import Bin

TRIES = 50  # most bundles in a row for which no unit has room


def assortment(goods: Goods, rng: np.random.Generator) -> Assortment:
    """Returns the SKUs of which a bundle fits on some unit, with their shares of the demand."""
    drawn, popularity = Assortment.draw(len(goods.skus), rng), goods.kinds.popularity
    shares = np.array([popularity.get(sku, 0.0) for sku in goods.skus])
    if not shares.sum() > 0:
        return Assortment(goods.skus, drawn.popularity)
    return Assortment(goods.skus, shares / shares.sum())


def stocked(
    goods: Goods,
    items: list[tuple[str, int]],
    rng: np.random.Generator,
    level: float,
    assortment: Assortment,
) -> list[tuple[Bin, int]]:
    """Returns the bins with the pieces in each: bundles on random units, up to a level."""
    names = rng.choice(assortment.skus, len(items), p=assortment.popularity).tolist()
    largest = max(map(goods.bundle, assortment.skus))
    bins = [
        Bin(i + 1, item, unit, largest, sku)
        for i, ((item, unit), sku) in enumerate(zip(items, names))
    ]
    filler = _Filler(goods, bins)
    sums = np.cumsum(assortment.popularity)
    failures, aim = 0, level * goods.limit
    while filler.weight < aim and failures < TRIES:
        at = np.searchsorted(sums, rng.random() * sums[-1], side="right")
        sku = assortment.skus[min(int(at), len(sums) - 1)]
        failures = 0 if filler.add(sku, rng) else failures + 1
    return [(bin_, filler.pieces[bin_.bin_id]) for bin_ in bins]


class _Filler:
    """Lays bundles on units that have room for them."""

    def __init__(self, goods: Goods, bins: list[Bin]) -> None:
        self._goods = goods
        self.pieces = {bin_.bin_id: 0 for bin_ in bins}
        self._of_unit: dict[int, list[Bin]] = {}
        for bin_ in bins:
            self._of_unit.setdefault(bin_.unit, []).append(bin_)
        self._units = np.array([*self._of_unit])
        self._room = np.array([goods.limits[unit] for unit in self._of_unit], float)
        self.weight = 0.0  # of all pieces

    def add(self, sku: str, rng: np.random.Generator) -> bool:
        """Lays a bundle on a unit, drawn from those with room; returns whether there is any."""
        quantity = self._goods.bundle(sku)
        weight = quantity * self._goods.weight(sku)
        fitting = np.flatnonzero(self._room >= weight - ROUNDING)
        if not len(fitting):
            return False
        row = int(rng.choice(fitting))
        bins = self._of_unit[int(self._units[row])]
        place = self._place(bins, sku, quantity)
        if place is None:
            self._room[row] = 0.0  # all its bins have something
            return False
        place.sku = sku
        self.pieces[place.bin_id] += quantity
        self._room[row] -= weight
        self.weight += weight
        return True

    def _place(self, bins: list[Bin], sku: str, quantity: int) -> Bin | None:
        """Returns a bin of a SKU with room for pieces, else an empty one, else None."""
        for bin_ in bins:
            pieces = self.pieces[bin_.bin_id]
            if pieces and bin_.sku == sku and pieces + quantity <= bin_.capacity:
                return bin_
        return next((bin_ for bin_ in bins if not self.pieces[bin_.bin_id]), None)
