# SPDX-License-Identifier: Apache-2.0
"""Policies that order bundles to refill the stock."""

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from warehouse_operations.stock.demand import BUNDLE_LEAST, BUNDLE_MOST

if TYPE_CHECKING:
    from warehouse_operations.policies.view import View

AHEAD = 10 * BUNDLE_MOST  # most pieces of a SKU without a bin, however many more orders lack


class Threshold:
    """Refills once the stock falls below `begin`, until it reaches `stop`, shares of its room.

    Pieces that customers' orders lack are ordered at once, up to AHEAD; the rest follows once these
    are in bins. waiting: most bundles that wait for a bin. Raises ValueError unless 0 <= begin <=
    stop <= 1.
    """

    def __init__(self, begin: float = 0.65, stop: float = 0.85, waiting: int = 200) -> None:
        if not 0 <= begin <= stop <= 1:
            raise ValueError(f"begin {begin} and stop {stop}; 0 <= begin <= stop <= 1 was expected")
        self.begin, self.stop, self.waiting = begin, stop, waiting
        self.on = True  # from the begin of a shift until the stock is full

    def bundles(self, view: "View") -> Iterator[tuple[str, int]]:
        """Yields (SKU, pieces) of the bundles to be ordered now."""
        yield from self._shortages(view)
        level = view.inventory.level
        self.on = level < (self.stop if self.on else self.begin)
        if not self.on:
            return
        coming = view.pieces_ordered
        missing = self.stop * view.inventory.capacity - view.inventory.total - coming
        for _ in range(self.waiting - len(view.bundles)):
            quantity = int(view.rng.integers(BUNDLE_LEAST, BUNDLE_MOST + 1))
            sku = view.sku_to_refill()
            if sku is not None:
                quantity = view.usual_bundle(sku) or quantity
            if missing < quantity or sku is None:
                return
            missing -= quantity
            yield sku, quantity

    def _shortages(self, view: "View") -> Iterator[tuple[str, int]]:
        for sku, lacking in sorted(view.shortages().items()):
            bundle = view.usual_bundle(sku)
            most = bundle or BUNDLE_MOST
            pieces = min(lacking, AHEAD - view.pieces_at_door(sku))
            whole = -(-pieces // most) * most
            total = whole if bundle or view.inventory.roomy[sku] else pieces
            for begun in range(0, total, most):
                yield sku, min(most, total - begun)


class Never:
    """Orders no bundles; those of the demand come all the same."""

    def bundles(self, view: "View") -> Iterable[tuple[str, int]]:
        """Returns no bundles."""
        return ()


NAMES: dict[str, type] = {"threshold": Threshold, "never": Never}
