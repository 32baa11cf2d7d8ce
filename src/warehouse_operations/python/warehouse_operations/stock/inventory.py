# SPDX-License-Identifier: Apache-2.0
"""Every piece in the warehouse: bins on storage units, each of one SKU.

Stock changes by moves alone, which are reported to the journal: the quantity of a bin is the
sum of its moves. Reserved pieces are promised to a pick; expected ones are on their way.
"""

from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterable
from enum import StrEnum
from typing import Any

import numpy as np

ROOMY = 12  # pieces, of the largest bundle


class Reason(StrEnum):
    """Why a move was made."""

    INITIAL = "initial"
    PICK = "pick"
    PUT = "put"
    SHORT = "short"  # fewer were found than the books said
    DAMAGED = "damaged"
    FELL = "fell"  # they lie on the floor, with their bin,
    PICKED_UP = "picked up"  # or are back
    UNDONE = "undone"  # they were picked, put in or written off by mistake
    GONE = "gone"  # with their bin, which is not in the warehouse any more


class StockError(ValueError):
    """A move that can't be: more than there is, or another SKU's bin."""


class Bin:
    """A place for one SKU on a unit; `sku` is of what lies there, or is expected, or last lay.

    `fallen`: None, or the pieces with which it lies on the floor: they are not in stock.
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
        """Pieces that can be put in beside those that are expected."""
        return 0 if self.fallen is not None else self.capacity - self.quantity - self.expected

    @property
    def empty(self) -> bool:
        """Whether another SKU may move in."""
        return not self.quantity and not self.expected and self.fallen is None


class Inventory:
    """The bins, by unit and by SKU. Calls on_move(bin, quantity, reason, context) for each move."""

    def __init__(self, bins: Collection[Bin], on_move: Callable[..., object] | None = None) -> None:
        self.bins = {one.bin_id: one for one in bins}
        self.of_unit: dict[int, list[Bin]] = defaultdict(list)
        self._of_sku: dict[str, dict[int, Bin]] = defaultdict(dict)
        self.capacity = self.total = self.expected = 0
        self.empty: dict[int, Bin] = {}  # bins without anything, by id
        self._kept_for = Counter(one.sku for one in bins)  # bins by the SKU they have or had last
        # SKUs without a bin, by the bin that is theirs once it is empty.
        self._heirs: dict[int, str] = {}
        # Bins with room for a bundle of any size, by SKU.
        self.roomy: dict[str, int] = defaultdict(int)
        self.room_changed: set[str] = set()  # SKUs whose number of those has changed
        self._roomy: set[int] = set()
        self._available: dict[str, int] = defaultdict(int)
        # Available pieces by row, a row a bin; and of each SKU, while none comes or goes, its rows
        # by unit with the units and where each begins.
        self._row = {one.bin_id: row for row, one in enumerate(bins)}
        self._pieces = np.zeros(len(bins), np.int32)
        self._rows_of: dict[str, tuple[np.ndarray, np.ndarray, np.ndarray]] = {}
        self._incoming: dict[str, int] = defaultdict(int)
        self.blocked: set[int] = set()  # units out of service
        self._on_move = on_move or (lambda *_: None)
        self.changed: set[Bin] = set()  # bins whose figures are not written down yet
        for one in bins:
            self.of_unit[one.unit].append(one)
            self.capacity += one.capacity
            self.total += one.quantity
            self._index(one)
            self._available[one.sku] += one.available
            self._pieces[self._row[one.bin_id]] = one.available
            self._measure(one)

    @property
    def level(self) -> float:
        """Pieces over room for pieces."""
        return self.total / self.capacity if self.capacity else 0.0

    def available(self, sku: str) -> int:
        """Returns the pieces of a SKU promised to no order, units out of service included."""
        return self._available.get(sku, 0)

    def incoming(self, sku: str) -> int:
        """Returns the pieces of a SKU for which room in a bin is kept."""
        return self._incoming.get(sku, 0)

    def with_sku(self, sku: str) -> Collection[Bin]:
        """Returns the bins in which pieces of a SKU lie."""
        return self._of_sku[sku].values()

    def by_unit(self, sku: str) -> tuple[np.ndarray, np.ndarray]:
        """Returns (units, pieces), (n,) each: where pieces of a SKU lie that are promised to no
        order, and how many on each unit, by ascending units."""
        if sku not in self._rows_of:
            self._rows_of[sku] = self._sorted_rows(sku)
        rows, units, begins = self._rows_of[sku]
        if not len(units):
            return units, units
        pieces = np.add.reduceat(self._pieces[rows], begins)
        some = pieces > 0
        return units[some], pieces[some]

    def _sorted_rows(self, sku: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        bins = self._of_sku[sku].values()
        unit_of = np.array([one.unit for one in bins], np.int64)
        rows = np.array([self._row[one.bin_id] for one in bins], np.int64)
        order = np.argsort(unit_of, kind="stable")
        units, begins = np.unique(unit_of[order], return_index=True)
        return rows[order], units, begins

    def takes(self, one: Bin, sku: str, quantity: int) -> bool:
        """Returns whether so many pieces of a SKU can be put into a bin.

        The last bin of a SKU is kept for it: else it could never be refilled.
        """
        if one.bin_id in self._heirs:
            return one.empty and self._heirs[one.bin_id] == sku
        may_move_in = one.empty and self._kept_for[one.sku] > 1
        return one.room >= quantity and (one.sku == sku or may_move_in)

    def move(self, one: Bin, sku: str, quantity: int, reason: Reason, **context: Any) -> None:
        """Puts pieces into a bin, or takes them out; raises StockError."""
        if quantity > 0 and one.quantity and one.sku != sku:
            raise StockError(f"{one.item} holds {one.sku}, {sku} can't be put in")
        if one.quantity + quantity < one.reserved:
            raise StockError(
                f"{-quantity} of {one.item}'s {one.quantity} pieces, {one.reserved} reserved"
            )
        if quantity > 0:
            self._rename(one, sku)
        one.quantity += quantity
        self.total += quantity
        self._available[one.sku] += quantity
        self._pieces[self._row[one.bin_id]] += quantity
        self._index(one)
        self._measure(one)
        self.changed.add(one)
        self._on_move(one, quantity, reason, context)

    def take_changed(self) -> set[Bin]:
        """Returns the bins whose figures have changed since the last call."""
        changed, self.changed = self.changed, set()
        return changed

    def reserve(self, one: Bin, quantity: int) -> None:
        """Promises pieces of a bin; a negative number takes the promise back."""
        if not 0 <= one.reserved + quantity <= one.quantity:
            raise StockError(
                f"{one.reserved} + {quantity} reserved of {one.quantity} in {one.item}"
            )
        one.reserved += quantity
        self._available[one.sku] -= quantity
        self._pieces[self._row[one.bin_id]] -= quantity
        self.changed.add(one)

    def pick(self, one: Bin, quantity: int, **context: Any) -> None:
        """Takes reserved pieces out."""
        self.reserve(one, -quantity)
        self.move(one, one.sku, -quantity, Reason.PICK, **context)

    def expect(self, one: Bin, sku: str, quantity: int) -> None:
        """Keeps room in a bin for pieces on their way."""
        if not self.takes(one, sku, quantity):
            raise StockError(f"{one.item} does not take {quantity} of {sku}")
        self._rename(one, sku)
        self._expect(one, sku, quantity)

    def unexpect(self, one: Bin, sku: str, quantity: int) -> None:
        """Frees the room kept for pieces that will not come."""
        self._expect(one, sku, -quantity)

    def put(self, one: Bin, sku: str, quantity: int, **context: Any) -> None:
        """Puts expected pieces into a bin."""
        self._expect(one, sku, -quantity)
        self.move(one, sku, quantity, Reason.PUT, **context)

    def fall(self, one: Bin) -> None:
        """Takes a bin that lies on the floor out of stock; its promises and expectations end."""
        pieces, one.fallen = one.quantity, one.quantity
        if pieces:
            self.move(one, one.sku, -pieces, Reason.FELL)
        self._measure(one)

    def pick_up(self, one: Bin) -> None:
        """Puts a bin back into stock, on its unit."""
        pieces, one.fallen = one.fallen, None
        if pieces:
            self.move(one, one.sku, pieces, Reason.PICKED_UP)
        self._measure(one)

    def house(self, skus: Iterable[str]) -> None:
        """Gives each SKU that has lost all its bins a bin of a SKU with several: the emptiest,
        which is not refilled before it is empty."""
        for sku in (one for one in skus if not self._kept_for[one]):
            free = (b for b in self.bins.values() if b.bin_id not in self._heirs)
            bins = [one for one in free if self._kept_for[one.sku] > 1 and one.fallen is None]
            if not bins:
                return
            one = min(bins, key=lambda one: (one.quantity + one.expected, one.bin_id))
            if one.empty:
                self._rename(one, sku)
                self.changed.add(one)
            else:
                self._keep_for(one, sku)
                self._heirs[one.bin_id] = sku

    def write_off(self, one: Bin) -> None:
        """Removes a bin with its pieces, of which none are promised or expected any more."""
        if one.fallen is not None:
            self.pick_up(one)
        if one.quantity:
            self.move(one, one.sku, -one.quantity, Reason.GONE)
        self.capacity -= one.capacity
        self._kept_for[one.sku] -= 1
        self._forget_room(one)
        self.empty.pop(one.bin_id, None)
        del self.bins[one.bin_id]
        self.of_unit[one.unit].remove(one)
        if not self.of_unit[one.unit]:
            del self.of_unit[one.unit]

    def _expect(self, one: Bin, sku: str, quantity: int) -> None:
        one.expected += quantity
        self.expected += quantity
        self._incoming[sku] += quantity
        self._measure(one)

    def _index(self, one: Bin) -> None:
        bins = self._of_sku[one.sku]
        if bool(one.quantity) == (one.bin_id in bins):
            return
        self._rows_of.pop(one.sku, None)
        if one.quantity:
            bins[one.bin_id] = one
        else:
            del bins[one.bin_id]

    def _rename(self, one: Bin, sku: str) -> None:
        """Assigns another SKU to an empty bin."""
        if one.sku != sku:
            self._forget_room(one)
        if one.sku != sku and not self._heirs.pop(one.bin_id, ""):
            self._keep_for(one, sku)
        one.sku = sku

    def _keep_for(self, one: Bin, sku: str) -> None:
        self._kept_for[one.sku] -= 1
        self._kept_for[sku] += 1

    def _measure(self, one: Bin) -> None:
        if one.empty:
            self.empty[one.bin_id] = one
        else:
            self.empty.pop(one.bin_id, None)
        if one.room < ROOMY:
            self._forget_room(one)
        elif one.bin_id not in self._roomy:
            self._roomy.add(one.bin_id)
            self.roomy[one.sku] += 1
            self.room_changed.add(one.sku)

    def _forget_room(self, one: Bin) -> None:
        if one.bin_id in self._roomy:
            self._roomy.discard(one.bin_id)
            self.roomy[one.sku] -= 1
            self.room_changed.add(one.sku)
