# SPDX-License-Identifier: Apache-2.0
"""The interface by which a shift records what it does; database_journal keeps the records."""

from typing import TYPE_CHECKING, Any

from warehouse_operations.stock.inventory import Bin, Reason
from warehouse_operations.stock.message_enums import OrderEventKind
from warehouse_operations.stock.orders import Line, Order
from warehouse_operations.stock.stations import Visit

if TYPE_CHECKING:
    from warehouse_operations.shift.shift import Shift
    from warehouse_operations.shift.tasks import Answer, Report


class Journal:
    """Receives every change of a shift and keeps none; times are simulated [s].

    The changes between two calls of commit() belong together.
    """

    def move(
        self,
        now: float,
        one: Bin,
        quantity: int,
        reason: Reason,
        line: Line | None,
        station: str,
        visit: Visit | None,
    ) -> None:
        """Records pieces that went into a Bin, or out of it where quantity is negative."""

    def order(self, order: Order) -> None:
        """Records a new Order, or the new state of a known one."""

    def line(self, line: Line) -> None:
        """Records how many pieces of an order's Line are picked."""

    def assigned(self, order: Order) -> None:
        """Records the assignment of an Order to its station."""

    def unassigned(self, order: Order, now: float) -> None:
        """Records that a station gave an Order back unfinished."""

    def visit(self, visit: Visit) -> None:
        """Records a new Visit, or the new state of a known one."""

    def unit(self, unit: int, in_service: bool) -> None:
        """Records that a storage unit goes out of service, or returns to it."""

    def event(
        self,
        now: float,
        kind: OrderEventKind,
        order_id: int,
        sku: str,
        quantity: int,
        station: str,
        unit: int,
        text: str,
    ) -> None:
        """Records an event of an order."""

    def report(self, now: float, report: "Report", answer: "Answer") -> None:
        """Records a person's Report that has an id, and the Answer that it got."""

    def heat(self, slot: int, began: float, maps: bytes) -> None:
        """Records a part of the FloorHeat, in place of the one in that slot."""

    def commit(self, shift: "Shift") -> None:
        """Marks everything recorded since the last call as one consistent state."""

    def flush(self) -> None:
        """Waits until everything that was committed is kept."""

    def end(self, shift: "Shift", figures: dict[str, Any]) -> None:
        """Records the end of the run, with the figures of kpis.json."""
