# SPDX-License-Identifier: Apache-2.0
"""What a shift knows of its stations, and of the units that visit them."""

from collections import defaultdict, deque
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from warehouse_operations.inventory import Bin, Inventory
from warehouse_operations.message_enums import Mode
from warehouse_operations.orders import Bundle, Line, Order


@dataclass(eq=False)
class Pick:
    """Pieces of a bin that are reserved for an order line."""

    line: Line
    bin: Bin
    quantity: int
    sequence: int = 0  # of the task for a person


@dataclass(eq=False)
class Visit:
    """A unit brought to a station: asked for, there, or leaving. Times are simulated [s]."""

    visit_id: int
    transport_id: int
    unit: int
    station: "WorkStation"
    requested: float
    picks: deque[Pick] = field(default_factory=deque)
    puts: deque[Bundle] = field(default_factory=deque)  # Bundles, each with its bin
    lifted: float | None = None
    arrived: float | None = None
    released: float | None = None
    ended: float | None = None
    outcome: str = ""
    pieces: int = 0  # picked from it, or put into it
    stored: bool = False  # whether a journal has it

    @property
    def here(self) -> bool:
        """Whether it stands in the service cell."""
        return self.arrived is not None and self.released is None


class WorkStation:
    """A station for picking or replenishing; `place` is the floor's Station.

    capacity: open orders. seconds_a_piece, pick_seconds [s]: see Settings.
    """

    def __init__(
        self,
        place: Any,
        capacity: int,
        seconds_a_piece: float,
        pick_seconds: float,
        inventory: Inventory,
    ) -> None:
        self.name, self.kind = place.name, place.kind
        self.is_open, self.mode = True, Mode.AUTOMATIC
        self.capacity, self.inventory = capacity, inventory
        self.seconds_a_piece, self.pick_seconds = seconds_a_piece, pick_seconds
        self.orders: dict[int, Order] = {}  # by id
        self.inbound: dict[int, Visit] = {}  # not over, by id, in the order of asking
        self.at_work = False  # on a piece or a bundle
        self.busy_s = 0.0
        self.attended = 0.0  # when a person last did something here [s]
        # Lines with pieces for which no unit comes, by (order, line).
        self.missing: dict[tuple[int, int], Line] = {}
        self.pieces = self.visits = 0  # done here

    @property
    def free_slots(self) -> int:
        """How many more orders can be open here."""
        return self.capacity - len(self.orders)

    @property
    def here(self) -> Visit | None:
        """The Visit in the service cell, or None."""
        return next((visit for visit in self.inbound.values() if visit.here), None)

    @property
    def coming(self) -> list[Visit]:
        """The visits that have not been released."""
        return [visit for visit in self.inbound.values() if visit.released is None]

    def waiting(self, now: float) -> float:
        """Returns how long a task has waited for a person [s]; 0 without one."""
        visit = self.here
        if self.mode != Mode.MANUAL or not visit or visit.arrived is None:
            return 0.0
        if not (visit.picks or visit.puts):
            return 0.0
        return max(0.0, now - max(visit.arrived, self.attended))

    def stock_here(self) -> dict[str, int]:
        """Returns the pieces promised to no order, by SKU, on the unit in the service cell."""
        visit = self.here
        return self._stock([visit] if visit else [])

    def inbound_stock(self) -> dict[str, int]:
        """Returns the same on the unit that is here and on those on their way."""
        return self._stock(self.coming)

    def _stock(self, visits: Iterable[Visit]) -> dict[str, int]:
        stock: dict[str, int] = defaultdict(int)
        for visit in visits:
            for one in self.inventory.of_unit[visit.unit]:
                if one.available:
                    stock[one.sku] += one.available
        return stock
