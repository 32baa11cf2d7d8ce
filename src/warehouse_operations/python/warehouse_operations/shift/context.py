# SPDX-License-Identifier: Apache-2.0
"""The common ground of the parts of a shift: clock, inventory, journal and tally."""

import hashlib
from collections.abc import Collection
from typing import Any

from warehouse_operations.goods.kinds import Goods
from warehouse_operations.shift.journal import Journal
from warehouse_operations.shift.tally import Tally
from warehouse_operations.stock.event_queue import Clock
from warehouse_operations.stock.inventory import Bin, Inventory, Reason


class Context:
    """The clock of a shift, its stock, and the records of what happens in it.

    inventory: the bins, whose moves are recorded. journal: receives every change. tally: counts
    for the KPIs. goods: see Inventory.
    """

    def __init__(
        self, clock: Clock, bins: Collection[Bin], journal: Journal, goods: Goods | None = None
    ) -> None:
        self.clock, self.journal, self.tally = clock, journal, Tally()
        self.inventory = Inventory(bins, self._on_move, goods)
        self._hash = hashlib.blake2b(digest_size=8)

    def state_hash(self) -> str:
        """Returns a hash of all events: runs with equal hashes were equal to the last event."""
        return self._hash.hexdigest()

    def update_hash(self, *values: object) -> None:
        """Adds an event to the state hash, with the time."""
        self._hash.update(repr((round(self.clock.now, 6), *values)).encode())

    def commit(self) -> None:
        """Marks everything recorded since the last call as one consistent state."""
        self.journal.commit(self.clock.now, self.inventory.take_changed())

    def _on_move(self, bin_: Bin, quantity: int, reason: Reason, about: dict[str, Any]) -> None:
        station = about.get("station")
        self.update_hash("move", bin_.bin_id, bin_.sku, quantity, reason.value)
        name, visit = station.name if station else "", about.get("visit")
        self.journal.move(self.clock.now, bin_, quantity, reason, about.get("line"), name, visit)
