# SPDX-License-Identifier: Apache-2.0
"""The stations of a shift, and the visits of units to them."""

import math
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from warehouse_layout.floor.stations import PICK
from warehouse_layout.message_enums import StationMode
from warehouse_operations.stock.inventory import Bin, Inventory
from warehouse_operations.stock.orders import Bundle, Line, Order
from warehouse_operations.stock.settings import Settings
from warehouse_operations.stock.totes import Totes
from warehouse_operations.stock.travel import LeadTime


@dataclass(eq=False)
class Pick:
    """Pieces of a bin that are reserved for an order line."""

    line: Line
    bin: Bin
    quantity: int
    sequence: int = 0  # of the task for a person


@dataclass(eq=False)
class Visit:
    """The visit of a unit to a station, from its request to its departure. Times are simulated
    [s]."""

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
    replenishes: bool = False  # brought for bundles, not for lines of orders

    @property
    def here(self) -> bool:
        """Whether it stands in the service cell."""
        return self.arrived is not None and self.released is None

    @property
    def pieces_to_pick(self) -> int:
        """The number of pieces still to be picked from its unit."""
        return sum(pick.quantity for pick in self.picks)

    def piece_to_pick(self, index: int) -> Pick:
        """Returns the Pick that the piece of this index is part of. Raises IndexError."""
        for pick in self.picks:
            if index < pick.quantity:
                return pick
            index -= pick.quantity
        raise IndexError(index)


class WorkStation:
    """A station for picking or replenishing; `place` is the floor's Station.

    settings: its own. picks, replenishes: the work there, one of them or both. began: begin of its
    shift [s]. on_hands_free: called with the station when its people can begin another task.
    """

    def __init__(
        self,
        place: Any,
        settings: Settings,
        inventory: Inventory,
        began: float = 0.0,
    ) -> None:
        self.name, self.kind = place.name, place.kind
        self.mode, self.inventory, self.settings = StationMode.AUTOMATIC, inventory, settings
        self.is_open, self._opened, self._open_s = True, began, 0.0
        self.picks = place.kind == PICK
        self.replenishes = settings.replenishes or not self.picks
        self.capacity = settings.slots if self.picks else 0
        self.seconds_a_piece, self.seconds_a_bundle = settings.piece_s, settings.bundle_s
        self.pick_seconds = min(settings.pick_s, settings.piece_s)
        self.seconds_a_line, self.pickers = settings.line_s, settings.pickers_at(0.0)
        self.most_pickers = max(settings.pickers, *settings.roster, 1)
        self.piece_sd, self._rng = settings.piece_sd, np.random.default_rng(1)
        self._picker_s, self._changed = 0.0, began  # picker-seconds while open
        self.orders: dict[int, Order] = {}  # by id
        self.totes = Totes(self.capacity)
        self.inbound: dict[int, Visit] = {}  # not over, by id, in the order of asking
        self._coming: dict[int, Visit] = {}  # those of them that have not been released
        self.refills_coming = 0  # of these, those for bundles
        self.at_work = 0  # pieces or bundles in hand
        self.reaching = 0  # of these, pieces still in their bins
        self.line: Line | None = None  # of the last piece begun
        self.busy_s = 0.0
        self.attended = 0.0  # time of a person's last action here [s]
        # Lines with pieces without a unit on its way, by (order, line).
        self.missing: dict[tuple[int, int], Line] = {}
        self.pieces = self.visits = 0  # done here
        self.lead_time = LeadTime()  # of units brought for picking
        self.on_hands_free: list[Callable[[WorkStation], object]] = []

    def set_open(self, is_open: bool, now: float) -> None:
        """Opens or closes the station at a time [s]."""
        self._note_pickers(now)
        self._open_s, self._opened = self.open_seconds(now), now
        self.is_open = is_open

    def set_pickers(self, pickers: int, now: float) -> None:
        """Sets how many people or robots pick here from a time on [s]; 0: a break."""
        self._note_pickers(now)
        self.pickers = pickers

    def set_pace(self, seconds_a_piece: float | tuple[float, float]) -> None:
        """Sets the time from a piece to the next [s]: a number, or a mean with its deviation."""
        mean, deviation = (
            seconds_a_piece if isinstance(seconds_a_piece, tuple) else (seconds_a_piece, 0.0)
        )
        self.seconds_a_piece, self.piece_sd = mean, deviation
        self.pick_seconds = min(self.pick_seconds, mean)

    @property
    def settings_now(self) -> Settings:
        """Its settings with its present pickers and their pace."""
        return replace(self.settings, pickers=self.pickers, piece_s=self.seconds_a_piece)

    def set_chance(self, rng: np.random.Generator) -> None:
        """Sets the generator of the times of pieces."""
        self._rng = rng

    def draw_times(self) -> tuple[float, float]:
        """Returns the time of a piece, and its part until the piece is out of its bin [s];
        log-normal with a piece_sd."""
        if not self.piece_sd:
            return self.seconds_a_piece, self.pick_seconds
        spread = math.log(1 + (self.piece_sd / self.seconds_a_piece) ** 2)
        factor = math.exp(math.sqrt(spread) * self._rng.standard_normal() - spread / 2)
        return factor * self.seconds_a_piece, factor * self.pick_seconds

    def _note_pickers(self, now: float) -> None:
        self._picker_s, self._changed = self.picker_seconds(now), now

    def picker_seconds(self, now: float) -> float:
        """Returns the picker-seconds until a time [s], while it was open."""
        return self._picker_s + (self.pickers * (now - self._changed) if self.is_open else 0.0)

    def open_seconds(self, now: float) -> float:
        """Returns its opening time until a time [s]."""
        return self._open_s + (now - self._opened if self.is_open else 0.0)

    def busy_fraction(self, now: float) -> float:
        """Returns the share of its pickers' hours in which they worked, until a time [s]."""
        time = self.picker_seconds(now)
        return self.busy_s / time if time else 0.0

    def next_work(self) -> None:
        """Starts the next work of its people."""
        for start in self.on_hands_free:
            start(self)

    def take_on(self, order: Order, again: bool = False) -> None:
        """Adds an order, in a tote of its own; `again`: in its former tote here."""
        self.orders[order.order_id] = order
        (self.totes.take_again if again else self.totes.take)(order)

    def let_go(self, order: Order) -> None:
        """Removes an order, and frees the place of its tote. Raises KeyError."""
        del self.orders[order.order_id]
        self.totes.leave(order)

    def add_visit(self, visit: Visit) -> None:
        """Adds a visit that is under way."""
        self.inbound[visit.visit_id] = visit
        if visit.released is None:
            self._coming[visit.visit_id] = visit
            self.refills_coming += visit.replenishes

    def release(self, visit: Visit, now: float) -> None:
        """Notes that the unit of a visit may leave, or need not come, from a time on [s]."""
        visit.released = now
        if self._coming.pop(visit.visit_id, None):
            self.refills_coming -= visit.replenishes

    def end_visit(self, visit: Visit) -> None:
        """Removes a visit that is over and was released. Raises KeyError."""
        del self.inbound[visit.visit_id]

    @property
    def free_slots(self) -> int:
        """The number of free slots for orders."""
        return self.capacity - len(self.orders)

    @property
    def here(self) -> Visit | None:
        """The Visit in the service cell, or None."""
        for visit in self._coming.values():
            if visit.arrived is not None:
                return visit
        return None

    @property
    def coming(self) -> list[Visit]:
        """The visits that have not been released."""
        return list(self._coming.values())

    def coming_for(self, replenishes: bool) -> list[Visit]:
        """Returns those of them for bundles, or for orders."""
        return [visit for visit in self._coming.values() if visit.replenishes == replenishes]

    def seconds_to_pick(self) -> float:
        """Returns how long its pickers work on what is reserved on those units [s]; infinite in a
        break, unless nothing is."""
        pieces = sum(pick.quantity for v in self.coming_for(replenishes=False) for pick in v.picks)
        if not pieces:
            return 0.0
        return pieces * self.seconds_a_piece / self.pickers if self.pickers else math.inf

    def waiting(self, now: float) -> float:
        """Returns the time that a task has waited for a person [s]; 0 without a task."""
        visit = self.here
        if self.mode != StationMode.MANUAL or not visit or visit.arrived is None:
            return 0.0
        if not (visit.picks or visit.puts):
            return 0.0
        return max(0.0, now - max(visit.arrived, self.attended))

    def stock_here(self) -> Mapping[str, int]:
        """Returns the pieces promised to no order, by SKU, on the unit in the service cell."""
        visit = self.here
        return self.inventory.stock_on(visit.unit) if visit and not visit.replenishes else {}

    def inbound_stock(self) -> Mapping[str, int]:
        """Returns the same for the unit here and those on their way."""
        stock: dict[str, int] = {}
        for visit in self.coming_for(replenishes=False):
            for sku, pieces in self.inventory.stock_on(visit.unit).items():
                stock[sku] = stock.get(sku, 0) + pieces
        return stock
