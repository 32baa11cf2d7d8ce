# SPDX-License-Identifier: Apache-2.0
"""Every piece in the warehouse: bins on storage units, each of one SKU.

Stock changes by moves alone, which are reported to the journal: the quantity of a bin is the
sum of its moves. Reserved pieces are promised to a pick; expected ones are on their way.
"""

from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterable, Mapping
from enum import StrEnum
from typing import Any

import numpy as np

from warehouse_operations.goods.empty_bins import EmptyBins
from warehouse_operations.goods.kinds import Goods

ROOMY = 12  # pieces, of the largest bundle
TOLERANCE = 1e-6  # of weights that fit on a unit
STOCKS_KEPT = 4096  # units whose available pieces are kept, at most: those at stations, and more


class Reason(StrEnum):
    """The reason of a move."""

    INITIAL = "initial"
    PICK = "pick"
    PUT = "put"
    SHORT = "short"  # fewer pieces than recorded
    DAMAGED = "damaged"
    FELL = "fell"  # they lie on the floor with their bin
    PICKED_UP = "picked up"  # they are back with their bin
    UNDONE = "undone"  # they were picked, put in or written off by mistake
    GONE = "gone"  # with their bin, which has left the warehouse


class StockError(ValueError):
    """Raised for an impossible move: of more pieces than the bin has, or into another SKU's bin."""


class Bin:
    """A place for one SKU on a unit; `sku` is that of its content, its expected content, or its
    last one.

    `fallen`: the pieces in it, which are not in stock, while it lies on the floor; else None.
    """

    __slots__ = (
        *("bin_id", "item", "unit", "sku", "capacity"),
        *("quantity", "reserved", "expected", "fallen"),
    )

    def __init__(self, bin_id: int, item: str, unit: int, capacity: int, sku: str = "") -> None:
        self.bin_id, self.item, self.unit = bin_id, item, unit
        self.capacity, self.sku = capacity, sku
        self.quantity = self.reserved = self.expected = 0
        self.fallen: int | None = None

    @property
    def available(self) -> int:
        """Pieces promised to no order."""
        return self.quantity - self.reserved

    @property
    def room(self) -> int:
        """Pieces that can be put in besides the expected ones."""
        return 0 if self.fallen is not None else self.capacity - self.quantity - self.expected

    @property
    def empty(self) -> bool:
        """Whether another SKU may move in."""
        return not self.quantity and not self.expected and self.fallen is None


class Inventory:
    """The bins, by unit and by SKU. Calls on_move(bin, quantity, reason, context) for each move.

    goods: the weights of pieces and what each unit holds of them; None: a unit is full by its bins.
    """

    def __init__(
        self,
        bins: Collection[Bin],
        on_move: Callable[..., object] | None = None,
        goods: Goods | None = None,
    ) -> None:
        self.goods = goods
        self._load: dict[int, float] = defaultdict(float)  # weight on a unit or expected, by id
        self._weight = 0.0  # of all pieces
        self.bins = {bin_.bin_id: bin_ for bin_ in bins}
        self.of_unit: dict[int, list[Bin]] = defaultdict(list)
        self._of_sku: dict[str, dict[int, Bin]] = defaultdict(dict)
        self.capacity = self.total = self.expected = 0
        self._empty = EmptyBins(bins)
        self._kept_for = Counter(bin_.sku for bin_ in bins)  # bins by present or last SKU
        # SKUs without a bin, by the bin that they get once it is empty.
        self._heirs: dict[int, str] = {}
        # Bins with room for a bundle of any size, by SKU.
        self.roomy: dict[str, int] = defaultdict(int)
        self.room_changed: set[str] = set()  # SKUs whose number of such bins has changed
        self._roomy: set[int] = set()
        self._available: dict[str, int] = defaultdict(int)
        # Available pieces, a row for each bin; and for each SKU, until its bins change, its rows by
        # unit, the units, and the first row of each.
        self._row = {bin_.bin_id: row for row, bin_ in enumerate(bins)}
        self._pieces = np.zeros(len(bins), np.int32)
        self._rows_of: dict[str, tuple[np.ndarray, np.ndarray, np.ndarray]] = {}
        # Available pieces by SKU, of units that were asked for and have not changed since.
        self._stock_on: dict[int, dict[str, int]] = {}
        self._incoming: dict[str, int] = defaultdict(int)
        self._on_move = on_move or (lambda *_: None)
        self.changed: set[Bin] = set()  # bins whose figures are not recorded yet
        self.on_weight: Callable[[Bin], object] = lambda _: None  # called after each move
        for bin_ in bins:
            self.of_unit[bin_.unit].append(bin_)
            self.capacity += bin_.capacity
            self.total += bin_.quantity
            self._index(bin_)
            self._available[bin_.sku] += bin_.available
            self._pieces[self._row[bin_.bin_id]] = bin_.available
            self._measure(bin_)
        if goods:
            self.capacity = int(goods.limit / goods.mean_weight)
            for bin_ in bins:
                self._add_weight(bin_, bin_.sku, bin_.quantity, there=True)

    @property
    def level(self) -> float:
        """The number of pieces over the capacity of all bins; by weight where units have limits."""
        if self.goods:
            return self._weight / self.goods.limit
        return self.total / self.capacity if self.capacity else 0.0

    def available(self, sku: str) -> int:
        """Returns the pieces of a SKU promised to no order."""
        return self._available.get(sku, 0)

    def incoming(self, sku: str) -> int:
        """Returns the pieces of a SKU for which room in a bin is kept."""
        return self._incoming.get(sku, 0)

    def with_sku(self, sku: str) -> Collection[Bin]:
        """Returns the bins in which pieces of a SKU lie."""
        return self._of_sku[sku].values()

    def stock_on(self, unit: int) -> Mapping[str, int]:
        """Returns the pieces on a unit promised to no order, by SKU; later changes give another
        mapping."""
        stock = self._stock_on.get(unit)
        if stock is None:
            if len(self._stock_on) >= STOCKS_KEPT:
                self._stock_on.clear()
            stock = self._stock_on[unit] = self._sum_up(unit)
        return stock

    def _sum_up(self, unit: int) -> dict[str, int]:
        stock: dict[str, int] = {}
        for bin_ in self.of_unit.get(unit, ()):
            if bin_.available:
                stock[bin_.sku] = stock.get(bin_.sku, 0) + bin_.available
        return stock

    def by_unit(self, sku: str) -> tuple[np.ndarray, np.ndarray]:
        """Returns (units, pieces), (n,) each: the units with pieces of a SKU promised to no order,
        ascending, and their numbers of these."""
        if sku not in self._rows_of:
            self._rows_of[sku] = self._sorted_rows(sku)
        rows, units, begins = self._rows_of[sku]
        if not len(units):
            return units, units
        pieces = np.add.reduceat(self._pieces[rows], begins)
        some = pieces > 0
        if first := self._to_empty(sku):
            some &= np.isin(units, first)
        return units[some], pieces[some]

    def _to_empty(self, sku: str) -> list[int]:
        """Returns the units with pieces of a SKU in a bin that another SKU gets once it is empty.
        Picks come from these first: from others, which are topped up, they might never."""
        bins = [bin_ for heir in self._heirs if (bin_ := self.bins[heir]).sku == sku]
        return [bin_.unit for bin_ in bins if bin_.available > 0]

    def _sorted_rows(self, sku: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        bins = self._of_sku[sku].values()
        unit_of = np.array([bin_.unit for bin_ in bins], np.int64)
        rows = np.array([self._row[bin_.bin_id] for bin_ in bins], np.int64)
        order = np.argsort(unit_of, kind="stable")
        units, begins = np.unique(unit_of[order], return_index=True)
        return rows[order], units, begins

    def places(self, sku: str, quantity: int, units: Collection[int]) -> list[Bin]:
        """Returns the bins on some units that take a quantity of a SKU: those with pieces of it,
        then empty ones. Where units have limits, a unit's empty bins are alike, and the first of
        them stands for all: looking at each would take longer than the rest of a shift."""
        with_it = [
            bin_
            for bin_ in self.with_sku(sku)
            if bin_.unit in units and self.takes(bin_, sku, quantity)
        ]
        return [*with_it, *self._empty_places(sku, quantity, units)]

    def _empty_places(self, sku: str, quantity: int, units: Collection[int]) -> list[Bin]:
        if not self.goods:
            bins = (bin_ for bin_ in self._empty if bin_.unit in units)
            return [bin_ for bin_ in bins if self.takes(bin_, sku, quantity)]
        roomy = self._empty.units_with(quantity * self.goods.weight(sku) - TOLERANCE)
        firsts = (self._empty.first_on(unit) for unit in roomy if unit in units)
        return [bin_ for bin_ in firsts if self.takes(bin_, sku, quantity)]

    def empties(self, units: Collection[int]) -> dict[int, int]:
        """Returns the numbers of empty bins on those of some units that have any, by unit."""
        return {unit: count for unit, count in self._empty.counts() if unit in units}

    def takes(self, bin_: Bin, sku: str, quantity: int) -> bool:
        """Returns whether a quantity of a SKU can be put into a bin.

        The last bin of a SKU is kept for it, or it could never be refilled.
        """
        if self.goods:
            has_room = self._weight_fits(bin_.unit, sku, quantity) and bin_.room >= quantity
            return has_room and (bin_.sku == sku or bin_.empty)
        if bin_.bin_id in self._heirs:
            return bin_.empty and self._heirs[bin_.bin_id] == sku
        may_move_in = bin_.empty and self._kept_for[bin_.sku] > 1
        return bin_.room >= quantity and (bin_.sku == sku or may_move_in)

    def _weight_fits(self, unit: int, sku: str, quantity: int) -> bool:
        return (
            self.goods is None
            or quantity * self.goods.weight(sku) <= self.room_on(unit) + TOLERANCE
        )

    def room_on(self, unit: int) -> float:
        """Returns the room on a unit, besides what is expected: by weight where units have limits,
        else the pieces that its bins take."""
        if self.goods:
            return self.goods.limits.get(unit, 0.0) - self._load[unit]
        return sum(bin_.room for bin_ in self.of_unit[unit])

    def bundles_that_fit(self, unit: int) -> float:
        """Returns how many bundles of a mean weight a unit takes; inf without limits."""
        if self.goods is None:
            return float("inf")
        return round(self.room_on(unit) / self.goods.bundle_weight)

    def _add_weight(self, bin_: Bin, sku: str, quantity: int, there: bool) -> None:
        """Counts pieces on a unit, or on their way to it."""
        if self.goods:
            weight = quantity * self.goods.weight(sku)
            self._load[bin_.unit] += weight
            self._empty.set_room(bin_.unit, self.room_on(bin_.unit))
            self._weight += weight if there else 0.0

    def move(self, bin_: Bin, sku: str, quantity: int, reason: Reason, **context: Any) -> None:
        """Puts pieces into a bin, or takes them out; raises StockError."""
        if quantity > 0 and bin_.quantity and bin_.sku != sku:
            raise StockError(f"{bin_.item} holds {bin_.sku}, {sku} can't be put in")
        if bin_.quantity + quantity < bin_.reserved:
            raise StockError(
                f"{-quantity} of {bin_.item}'s {bin_.quantity} pieces, {bin_.reserved} reserved"
            )
        if quantity > 0:
            self._rename(bin_, sku)
        bin_.quantity += quantity
        self.total += quantity
        self._add_weight(bin_, bin_.sku, quantity, there=True)
        self._add_available(bin_, quantity)
        self._index(bin_)
        self._measure(bin_)
        self.changed.add(bin_)
        self._on_move(bin_, quantity, reason, context)
        self.on_weight(bin_)

    def take_changed(self) -> set[Bin]:
        """Returns the bins whose figures have changed since the last call."""
        changed, self.changed = self.changed, set()
        return changed

    def reserve(self, bin_: Bin, quantity: int) -> None:
        """Promises pieces of a bin; a negative number withdraws the promise."""
        if not 0 <= bin_.reserved + quantity <= bin_.quantity:
            raise StockError(
                f"{bin_.reserved} + {quantity} reserved of {bin_.quantity} in {bin_.item}"
            )
        bin_.reserved += quantity
        self._add_available(bin_, -quantity)
        self.changed.add(bin_)

    def _add_available(self, bin_: Bin, quantity: int) -> None:
        self._available[bin_.sku] += quantity
        self._pieces[self._row[bin_.bin_id]] += quantity
        self._stock_on.pop(bin_.unit, None)

    def pick(self, bin_: Bin, quantity: int, **context: Any) -> None:
        """Removes reserved pieces."""
        self.reserve(bin_, -quantity)
        self.move(bin_, bin_.sku, -quantity, Reason.PICK, **context)

    def expect(self, bin_: Bin, sku: str, quantity: int) -> None:
        """Keeps room in a bin for pieces on their way."""
        if not self.takes(bin_, sku, quantity):
            raise StockError(f"{bin_.item} does not take {quantity} of {sku}")
        self._rename(bin_, sku)
        self._expect(bin_, sku, quantity)

    def unexpect(self, bin_: Bin, sku: str, quantity: int) -> None:
        """Frees the room kept for pieces that will not come."""
        self._expect(bin_, sku, -quantity)

    def put(self, bin_: Bin, sku: str, quantity: int, **context: Any) -> None:
        """Puts expected pieces into a bin."""
        self._expect(bin_, sku, -quantity)
        self.move(bin_, sku, quantity, Reason.PUT, **context)

    def fall(self, bin_: Bin) -> None:
        """Removes a bin on the floor from stock; its promises and expectations end."""
        pieces, bin_.fallen = bin_.quantity, bin_.quantity
        if pieces:
            self.move(bin_, bin_.sku, -pieces, Reason.FELL)
        self._measure(bin_)

    def pick_up(self, bin_: Bin) -> None:
        """Puts a bin back into stock, on its unit."""
        pieces, bin_.fallen = bin_.fallen, None
        if pieces:
            self.move(bin_, bin_.sku, pieces, Reason.PICKED_UP)
        self._measure(bin_)

    def house(self, skus: Iterable[str]) -> None:
        """Gives each SKU that has lost all its bins the emptiest bin of a SKU with several; that
        bin is not refilled before it is empty. Where units have limits, bins are of no SKU."""
        for sku in skus:
            if self._kept_for[sku] or self.goods:
                continue
            free = (b for b in self.bins.values() if b.bin_id not in self._heirs)
            bins = [bin_ for bin_ in free if self._kept_for[bin_.sku] > 1 and bin_.fallen is None]
            if not bins:
                return
            bin_ = min(bins, key=lambda bin_: (bin_.quantity + bin_.expected, bin_.bin_id))
            if bin_.empty:
                self._rename(bin_, sku)
                self.changed.add(bin_)
            else:
                self._keep_for(bin_, sku)
                self._heirs[bin_.bin_id] = sku

    def write_off(self, bin_: Bin) -> None:
        """Removes a bin with its pieces; it has no promised or expected ones."""
        if bin_.fallen is not None:
            self.pick_up(bin_)
        if bin_.quantity:
            self.move(bin_, bin_.sku, -bin_.quantity, Reason.GONE)
        self.capacity -= 0 if self.goods else bin_.capacity
        self._kept_for[bin_.sku] -= 1
        self._forget_room(bin_)
        self._empty.discard(bin_)
        del self.bins[bin_.bin_id]
        self.of_unit[bin_.unit].remove(bin_)
        if not self.of_unit[bin_.unit]:
            del self.of_unit[bin_.unit]

    def _expect(self, bin_: Bin, sku: str, quantity: int) -> None:
        bin_.expected += quantity
        self._add_weight(bin_, sku, quantity, there=False)
        self.expected += quantity
        self._incoming[sku] += quantity
        self._measure(bin_)

    def _index(self, bin_: Bin) -> None:
        bins = self._of_sku[bin_.sku]
        if bool(bin_.quantity) == (bin_.bin_id in bins):
            return
        self._rows_of.pop(bin_.sku, None)
        if bin_.quantity:
            bins[bin_.bin_id] = bin_
        else:
            del bins[bin_.bin_id]

    def _rename(self, bin_: Bin, sku: str) -> None:
        """Assigns another SKU to an empty bin."""
        if bin_.sku != sku:
            self._forget_room(bin_)
        if bin_.sku != sku and not self._heirs.pop(bin_.bin_id, ""):
            self._keep_for(bin_, sku)
        bin_.sku = sku

    def _keep_for(self, bin_: Bin, sku: str) -> None:
        self._kept_for[bin_.sku] -= 1
        self._kept_for[sku] += 1

    def _measure(self, bin_: Bin) -> None:
        if bin_.empty:
            self._empty.add(bin_)
        else:
            self._empty.discard(bin_)
        if bin_.room < ROOMY:
            self._forget_room(bin_)
        elif bin_.bin_id not in self._roomy:
            self._roomy.add(bin_.bin_id)
            self.roomy[bin_.sku] += 1
            self.room_changed.add(bin_.sku)

    def _forget_room(self, bin_: Bin) -> None:
        if bin_.bin_id in self._roomy:
            self._roomy.discard(bin_.bin_id)
            self.roomy[bin_.sku] -= 1
            self.room_changed.add(bin_.sku)
