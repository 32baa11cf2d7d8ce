# SPDX-License-Identifier: Apache-2.0
"""Goods-in: the ordered bundles without a bin."""

import itertools

from warehouse_operations.stock.orders import Bundle


class GoodsIn:
    """The bundles without a bin, with their pieces of each SKU.

    bundles: by id, in the order in which they came. pieces: in all of them. pieces_of: the same by
    SKU. changed: the SKUs of which the pieces have changed since the set was last cleared.
    """

    def __init__(self) -> None:
        self.bundles: dict[int, Bundle] = {}
        self.pieces = 0
        self.pieces_of: dict[str, int] = {}
        self.changed: set[str] = set()
        self._ids = itertools.count(1)

    def order(self, sku: str, quantity: int, now: float) -> Bundle:
        """Adds a new bundle that arrives at a time [s], and returns it."""
        bundle = Bundle(next(self._ids), sku, quantity, now)
        self.add(bundle)
        return bundle

    def add(self, bundle: Bundle) -> None:
        """Adds a bundle as the last one."""
        self.bundles[bundle.bundle_id] = bundle
        self._count(bundle.sku, bundle.quantity)

    def remove(self, bundle: Bundle) -> None:
        """Removes a bundle. Raises KeyError."""
        del self.bundles[bundle.bundle_id]
        self._count(bundle.sku, -bundle.quantity)

    def _count(self, sku: str, pieces: int) -> None:
        self.pieces += pieces
        self.pieces_of[sku] = self.pieces_of.get(sku, 0) + pieces
        self.changed.add(sku)
