# SPDX-License-Identifier: Apache-2.0
"""Bins that fell off their units: out of stock while they lie on the floor."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

from warehouse_operations.stock.inventory import Bin

if TYPE_CHECKING:
    from warehouse_operations.shift.shift import Shift


class Fallen:
    """The part of a Shift that knows which of its bins lie on the floor."""

    def __init__(self, shift: "Shift") -> None:
        self.shift = shift
        self._bins = {one.item: one for one in shift.inventory.bins.values()}
        self._items = {one.item for one in self._bins.values() if one.fallen is not None}
        self.count = 0  # how often one fell

    def update(self, items: Iterable[str]) -> None:
        """Updates which bins lie on the floor, by the names of the items there; ignores other
        items."""
        items = self._bins.keys() & set(items)
        for item in sorted(items - self._items):
            self._falls(self._bins[item])
        for item in sorted(self._items - items):
            self._is_back(self._bins[item])
        self._items = items

    def forget(self, one: Bin) -> None:
        """Removes a bin that is no longer in the warehouse."""
        del self._bins[one.item]
        self._items.discard(one.item)

    def _falls(self, one: Bin) -> None:
        dropped = self.shift.picking.drop_bin(one)
        self.shift.replenishing.drop_bin(one)
        self.shift.inventory.fall(one)
        self.shift.picking.serve_otherwise(dropped)
        self.count += 1

    def _is_back(self, one: Bin) -> None:
        self.shift.inventory.pick_up(one)
        if one.unit in self.shift.free_units:
            self.shift.picking.on_unit_free(one.unit)
            self.shift.replenishing.on_unit_free()

    def figures(self) -> dict[str, int]:
        """Returns the figures for kpis.json; empty if nothing fell."""
        if not self.count and not self._items:
            return {}
        return {
            "items_fallen": self.count,
            "items_on_floor": len(self._items),
            "pieces_on_floor": sum(self._bins[item].fallen or 0 for item in self._items),
        }
