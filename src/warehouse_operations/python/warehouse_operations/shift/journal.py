# SPDX-License-Identifier: Apache-2.0
"""The interface for the records of a shift; database_journal writes them."""

from collections.abc import Collection
from typing import Any

from warehouse_layout.message_enums import OrderEventKind
from warehouse_operations.shift.task_reports import Answer, Report
from warehouse_operations.stock.inventory import Bin, Reason
from warehouse_operations.stock.orders import Line, Order
from warehouse_operations.stock.stations import Visit


class Journal:
    """Receives every change of a shift, and drops it; times are simulated [s].

    The changes between two calls of commit() belong together.
    """

    def move(
        self,
        now: float,
        bin_: Bin,
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

    def report(self, now: float, report: Report, answer: Answer) -> None:
        """Records a person's Report that has an id, and the Answer that it got."""

    def heat(self, slot: int, began: float, maps: bytes) -> None:
        """Records a part of the FloorHeat, in place of the one in that slot."""

    def commit(self, now: float, bins: Collection[Bin]) -> None:
        """Marks everything recorded since the last call as one consistent state.

        bins: those whose figures have changed since then.
        """

    def flush(self) -> None:
        """Waits until all commits are written."""

    def end(self, now: float, bins: Collection[Bin], figures: dict[str, Any]) -> None:
        """Records the end of the run, with the figures of kpis.json, and commits."""
