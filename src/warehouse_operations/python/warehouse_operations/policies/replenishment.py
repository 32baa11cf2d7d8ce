# SPDX-License-Identifier: Apache-2.0
"""When stock is refilled, and with what."""

from warehouse_operations.demand import BUNDLE_LEAST, BUNDLE_MOST

AHEAD = 10 * BUNDLE_MOST  # pieces of a SKU at the door, at most, when orders lack more than that


class Threshold:
    """Refills from when the stock falls below `begin` until it reaches `stop`, shares of its room.

    What orders lack comes at once, however much in portions: the next when the first is in its
    bins. waiting: bundles that wait at the stations' door at most.
    """

    def __init__(self, begin=0.65, stop=0.85, waiting=200):
        if not 0 <= begin <= stop <= 1:
            raise ValueError(f"begin {begin} and stop {stop}; 0 <= begin <= stop <= 1 was expected")
        self.begin, self.stop, self.waiting = begin, stop, waiting
        self.on = True  # as a shift begins, until the stock has been full once

    def bundles(self, view):
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
            if missing < quantity or sku is None:
                return
            missing -= quantity
            yield sku, quantity

    def _shortages(self, view):
        for sku, lacking in sorted(view.shortages().items()):
            pieces = min(lacking, AHEAD - view.pieces_at_door(sku))
            whole = -(-pieces // BUNDLE_MOST) * BUNDLE_MOST
            wanted = whole if view.inventory.roomy[sku] else pieces
            for begun in range(0, wanted, BUNDLE_MOST):
                yield sku, min(BUNDLE_MOST, wanted - begun)


class Never:
    """Nothing but what comes of itself."""

    def bundles(self, view):
        return ()


NAMES = {"threshold": Threshold, "never": Never}
