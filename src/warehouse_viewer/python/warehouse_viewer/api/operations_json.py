# SPDX-License-Identifier: Apache-2.0
"""The messages of a shift as JSON."""

import math
from collections.abc import Callable
from typing import Any

import genpy

from warehouse_layout.message_enums import OrderEventKind
from warehouse_msgs import msg
from warehouse_viewer.api.schemas.operations import MODES, STATES

QUANTILES = ("p10", "p50", "p90")


def plain(message: Any) -> Any:
    """Returns a message as JSON, without its header."""
    if isinstance(message, genpy.Message):
        return {n: plain(getattr(message, n)) for n in message.__slots__ if n != "header"}
    if isinstance(message, list | tuple):
        return [plain(part) for part in message]
    return message


def order(status: msg.OrderStatus) -> dict[str, Any]:
    """Returns an OrderStatus as JSON."""
    lines = zip(status.lines, status.picked)
    out = plain(status)
    del out["picked"]
    return out | {
        "state": STATES[status.state],
        "lines": [plain(line) | {"picked": picked} for line, picked in lines],
    }


def past_event(event: msg.OrderEvent) -> dict[str, Any]:
    """Returns an OrderEvent as JSON."""
    return {
        "time": round(event.header.stamp.to_sec(), 1),
        "kind": OrderEventKind(event.kind).name,
        "sku": event.sku,
        "quantity": event.quantity,
        "station": event.station,
        "storage_unit": f"storage_unit{event.shelf_id}" if event.shelf_id else "",
        "text": event.text,
    }


def stations(message: msg.StationStates) -> list[dict[str, Any]]:
    """Returns the stations of StationStates as JSON."""
    return [plain(station) | {"mode": MODES[station.mode]} for station in message.stations]


def notices(message: msg.Notices) -> list[str]:
    """Returns the sentences of Notices."""
    return list(message.notices)


def forecast(result: msg.ForecastResult) -> dict[str, Any]:
    """Returns a ForecastResult as JSON."""
    out = plain(result)
    for name in ("done", "open", "late", "pieces_per_hour", "finish"):
        out[name] = {quantile: out.pop(f"{name}_{quantile}") for quantile in QUANTILES}
    ends = out["finish"].items()
    finish = {quantile: None if math.isnan(end) else end for quantile, end in ends}
    return out | {"finish": finish, "state": "DONE"}


# Functions that turn messages of a shift's topics into JSON.
SHOWN: dict[str, Callable[[Any], Any]] = {
    "stations": stations,
    "kpis": plain,
    "throughput": plain,
    "heat": plain,
    "notices": notices,
    "forecasts": forecast,
}
