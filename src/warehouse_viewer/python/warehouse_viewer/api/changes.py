# SPDX-License-Identifier: Apache-2.0
"""Changes of orders, stock, stations and transports, and figures, in JSON over a WebSocket.

    /api/v1/changes?of=orders,stations&rate=2     messages of a kind a second at most, 0.1 … 10

First comes {"type": "shift", "runs": true}, and again whenever that changes. Stations, kpis,
throughput, coordinator, alarms, figures, forecasts, notices and heat come whole: as they are now,
then as often as they change.

    {"type": "stations", "stations": [{"name": "pick1", "shelf_id": 12, …}, …]}
    {"type": "kpis", "kpis": {"items_picked": 123, …}}

Messages of orders, stock and transports hold the rows that have changed, as the requests of those
names return them. Who opens the WebSocket before asking for a list misses nothing in between.

    {"type": "orders", "orders": [{"order_id": 7, "state": "COMPLETED", …}, …], "missed": false}

A slow reader misses states in between, never the newest. `missed`: there were more; read the
list again.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

from pydantic import BaseModel, Field
from starlette.websockets import WebSocket

from warehouse_viewer.api import catalogue, operations_json
from warehouse_viewer.api.backend import ApiBackend
from warehouse_viewer.api.schemas.fleet import Coordinator, Transport
from warehouse_viewer.api.schemas.forecasts import Forecast
from warehouse_viewer.api.schemas.operations import Heat, Order, Place, Station, Throughput
from warehouse_viewer.api.schemas.watch import Alarm, LeadingFigures
from warehouse_viewer.api.stream import until_gone
from warehouse_viewer.json_text import dumps

if TYPE_CHECKING:
    from warehouse_msgs.msg import CoordinatorState

ROWS = {
    "orders": operations_json.order,
    "stock": operations_json.plain,
    "transports": dict,
}  # each as JSON
OF_MONITOR = ("alarms", "figures")  # noted as JSON
WHOLE = (*operations_json.SHOWN, *OF_MONITOR, "coordinator")
WITHOUT_SHIFT = ("notices", "alarms")  # for example, why there is none
TOPICS = (*ROWS, *WHOLE)


class Shift(BaseModel):
    """Whether a shift runs: the first message, and one at each change."""

    type: Literal["shift"]
    runs: bool


class OrdersChanged(BaseModel):
    """Brings the orders that are new or have changed."""

    type: Literal["orders"]
    orders: list[Order]
    missed: bool = Field(description="there were more; read the list again")


class StockChanged(BaseModel):
    """Brings the places whose stock has changed."""

    type: Literal["stock"]
    stock: list[Place]
    missed: bool


class TransportsChanged(BaseModel):
    """Brings the transports that are new or have changed."""

    type: Literal["transports"]
    transports: list[Transport]
    missed: bool


class StationsNow(BaseModel):
    """Brings all stations as they are now."""

    type: Literal["stations"]
    stations: list[Station]


class KpisNow(BaseModel):
    """Brings the shift's figures as they are now."""

    type: Literal["kpis"]
    kpis: dict[str, float | int | str | dict[str, float]]


class ThroughputNow(BaseModel):
    """Brings what the stations did in the last hour."""

    type: Literal["throughput"]
    throughput: Throughput


class CoordinatorNow(BaseModel):
    """Brings the state of the fleet; null without a coordinator."""

    type: Literal["coordinator"]
    coordinator: Coordinator | None


class NoticesNow(BaseModel):
    """Brings the notices that hold now."""

    type: Literal["notices"]
    notices: list[str]


class AlarmsNow(BaseModel):
    """Brings the alarms that hold now, the worst first."""

    type: Literal["alarms"]
    alarms: list[Alarm]


class FiguresNow(BaseModel):
    """Brings the four leading figures with their last hour."""

    type: Literal["figures"]
    figures: LeadingFigures


class ForecastNow(BaseModel):
    """Brings the newest forecast once it is done."""

    type: Literal["forecasts"]
    forecasts: Forecast


class HeatNow(BaseModel):
    """Brings where robots drove and waited."""

    type: Literal["heat"]
    heat: Heat


MESSAGES = (
    Shift,
    OrdersChanged,
    StockChanged,
    TransportsChanged,
    StationsNow,
    KpisNow,
    ThroughputNow,
    CoordinatorNow,
    HeatNow,
    NoticesNow,
    AlarmsNow,
    FiguresNow,
    ForecastNow,
)


def topics(text: str) -> list[str]:
    """Returns the TOPICS in a list with commas; for an empty one all but the large heat map.

    Raises ValueError for one that does not exist.
    """
    names = [name for name in text.split(",") if name] or [t for t in TOPICS if t != "heat"]
    unknown = sorted(set(names) - set(TOPICS))
    if unknown:
        raise ValueError(f"no {', '.join(unknown)} to follow; there are {', '.join(TOPICS)}")
    return names


async def serve(socket: WebSocket, backend: ApiBackend, topics: Sequence[str], rate: float) -> None:
    """Serves one client until it disconnects: the TOPICS `wanted`, each at most `rate` times a
    second. The socket is accepted already."""
    await until_gone(socket, _Reader(socket, backend, topics).send_news, rate)


class _Reader:
    def __init__(self, socket: WebSocket, backend: ApiBackend, topics: Sequence[str]) -> None:
        self._socket, self._backend, self._topics = socket, backend, topics
        self._feed, self._book = backend.operations.feed, backend.changes
        self._read = {topic: self._book.last if topic in ROWS else 0 for topic in topics}
        self._runs: bool | None = None
        self._coordinator: CoordinatorState | tuple[()] | None = ()

    async def send_news(self) -> None:
        runs = self._feed.runs
        if runs != self._runs:
            self._runs = runs
            await self._send("shift", runs=runs)
        for topic in self._topics:
            if topic == "coordinator":
                await self._send_coordinator()
            elif topic in ROWS:
                await self._send_rows(topic)
            elif runs or topic in WITHOUT_SHIFT:
                await self._send_whole(topic)

    async def _send_rows(self, topic: str) -> None:
        now = self._book.last
        rows, missed = self._book.since(topic, self._read[topic])
        self._read[topic] = now
        if rows or missed:
            shown = [ROWS[topic](row) for row in rows]
            await self._send(topic, **{topic: shown}, missed=missed)

    async def _send_whole(self, topic: str) -> None:
        now = self._book.last
        rows, _ = self._book.since(topic, self._read[topic])
        if rows:
            self._read[topic] = now
            await self._send(topic, **{topic: self._shown(topic, rows[-1])})

    def _shown(self, topic: str, row: Any) -> object:
        """A row of the book as JSON."""
        if topic in OF_MONITOR:
            return row
        describe = self._backend.stations if topic == "stations" else operations_json.SHOWN[topic]
        return describe(row)

    async def _send_coordinator(self) -> None:
        self._backend.feed.subscribe(("coordinator", "fleet"))
        state = self._backend.feed.coordinator
        if state is not self._coordinator:
            self._coordinator = state
            fleet = self._backend.feed["fleet"]
            shown = catalogue.plain_coordinator(state, fleet) if state else None
            await self._send("coordinator", coordinator=shown)

    async def _send(self, kind: str, **fields: Any) -> None:
        await self._socket.send_text(dumps({"type": kind, **fields}))
