# SPDX-License-Identifier: Apache-2.0
"""Bins that fell off their units: out of stock while they lie on the floor."""

from collections.abc import Iterable

from warehouse_operations.shift.picking import Picking
from warehouse_operations.shift.replenishing import Replenishing
from warehouse_operations.shift.visits import Visits
from warehouse_operations.stock.inventory import Bin, Inventory


class Fallen:
    """The bins of an Inventory that lie on the floor; count: number of falls."""

    def __init__(
        self, inventory: Inventory, visits: Visits, picking: Picking, replenishing: Replenishing
    ) -> None:
        self._inventory, self._visits = inventory, visits
        self._picking, self._replenishing = picking, replenishing
        self._bins = {bin_.item: bin_ for bin_ in inventory.bins.values()}
        self._items = {bin_.item for bin_ in self._bins.values() if bin_.fallen is not None}
        self.count = 0

    def update(self, items: Iterable[str]) -> None:
        """Updates which bins lie on the floor, by the names of the items there; ignores other
        items."""
        items = self._bins.keys() & set(items)
        for item in sorted(items - self._items):
            self._falls(self._bins[item])
        for item in sorted(self._items - items):
            self._is_back(self._bins[item])
        self._items = items

    def forget(self, bin_: Bin) -> None:
        """Removes a bin that is no longer in the warehouse."""
        del self._bins[bin_.item]
        self._items.discard(bin_.item)

    def _falls(self, bin_: Bin) -> None:
        dropped = self._picking.drop_bin(bin_)
        self._replenishing.drop_bin(bin_)
        self._inventory.fall(bin_)
        self._picking.serve_otherwise(dropped)
        self.count += 1

    def _is_back(self, bin_: Bin) -> None:
        self._inventory.pick_up(bin_)
        self._visits.offer(bin_.unit)

    def figures(self) -> dict[str, int]:
        """Returns the figures for kpis.json; empty without falls."""
        if not self.count and not self._items:
            return {}
        return {
            "items_fallen": self.count,
            "items_on_floor": len(self._items),
            "pieces_on_floor": sum(self._bins[item].fallen or 0 for item in self._items),
        }
