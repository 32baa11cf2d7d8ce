# SPDX-License-Identifier: Apache-2.0
"""The messages of a shift of operations, subscribed all the time: they are few."""

from types import ModuleType
from typing import Any

from genpy import Message

from warehouse_client.message_check import subscribe
from warehouse_msgs.msg import (
    ForecastResult,
    HeatMap,
    Kpis,
    Notices,
    OrderStatuses,
    StationStates,
    StockPlaces,
    Throughput,
)
from warehouse_viewer.api.change_book import ChangeBook
from warehouse_viewer.ros.forecast_book import ForecastBook

WHOLE = {
    "stations": StationStates,
    "kpis": Kpis,
    "throughput": Throughput,
    "heat": HeatMap,
    "notices": Notices,
    "forecasts": ForecastResult,
}


class ShiftFeed:
    """The newest message of each topic that is sent whole, None where no shift runs; changes go
    into a ChangeBook. `ros` is rospy; `forecasts` are all that are kept."""

    def __init__(self, ros: ModuleType, book: ChangeBook) -> None:
        self._book, self.forecasts = book, ForecastBook()
        self._messages: dict[str, Any] = {}
        self._seq: dict[str, int] = {}
        self._subscribers = {
            name: subscribe(ros, f"warehouse/{name}", kind, self._keep, name, queue_size=1)
            for name, kind in WHOLE.items()
        }
        for topic, kind, take in (
            ("warehouse/order_changes", OrderStatuses, self._take_orders),
            ("warehouse/stock_changes", StockPlaces, self._take_places),
        ):
            subscribe(ros, topic, kind, take, queue_size=10000)

    @property
    def runs(self) -> bool:
        """Whether a shift is running."""
        return self._subscribers["stations"].get_num_connections() > 0

    @property
    def forecast(self) -> ForecastResult | None:
        """The newest forecast of the shift as it is, without changes; None where no shift runs."""
        return self.forecasts.plain if self.runs else None

    def __getitem__(self, name: str) -> Any:
        is_current = self.runs or name == "notices"  # such as why there is no shift
        return self._messages.get(name) if is_current else None

    def _keep(self, message: Message, name: str) -> None:
        self._messages[name] = message
        if isinstance(message, ForecastResult):
            self.forecasts.take(message)
        self._book.note(name, name, message)

    def _take_orders(self, message: OrderStatuses) -> None:
        self._count("orders", message)
        for order in message.orders:
            self._book.note("orders", order.order_id, order)

    def _take_places(self, message: StockPlaces) -> None:
        self._count("stock", message)
        for place in message.places:
            self._book.note("stock", place.item, place)

    def _count(self, topic: str, message: OrderStatuses | StockPlaces) -> None:
        """Notes where a message was missed, or another shift has begun."""
        last, self._seq[topic] = self._seq.get(topic), message.header.seq
        if last is not None and message.header.seq != last + 1:
            self._book.miss(topic)
