# SPDX-License-Identifier: Apache-2.0
"""Simulates one shift of a point, and writes down each minute of it.

An empty warehouse fills first (the run-in); then come the minutes that count. Afterwards the shift
goes on until each of their orders is complete or due: so even in a short shift every order is
judged.
"""

import time as clock
from collections import Counter
from dataclasses import asdict, dataclass, field
from typing import Any

from warehouse_layout.file import layout_file
from warehouse_layout.message_enums import OrderEventKind
from warehouse_operations.runs import minute_log
from warehouse_operations.runs.operations import Operations
from warehouse_operations.sizing import sites
from warehouse_operations.stock import order_mix
from warehouse_operations.stock.orders import Order

MINUTE = 60.0  # [s]
MOST_AFTER = 24 * 60  # longest wait for orders that are not due yet [min]
PATIENCE = order_mix.DUE_LATER  # after which an order without a due time is late [s]
# Orders by the minute of their arrival: completed in time, or late.
FATES = ("in_time", "missed")
SERIES = (*minute_log.SERIES, *FATES)


@dataclass(frozen=True)
class Point:
    """A shift to be simulated, with all that decides its outcome.

    layout: the text of a layout file. minutes: the length of the shift after the run-in.
    """

    robots: int
    stations: int
    seed: int
    physics: bool
    layout: str
    orders: str
    run_in: int
    minutes: int
    policies: dict[str, Any] = field(default_factory=dict)
    realism: str = ""


@dataclass(frozen=True)
class Record:
    """A shift of a point, minute by minute: a list for each of SERIES.

    faults: sentences, of physics. wall_s, cpu_s: its duration, and the CPU time of the process [s].
    """

    robots: int
    stations: int
    seed: int
    physics: bool
    series: dict[str, list[float]]
    faults: list[str]
    wall_s: float
    cpu_s: float = 0.0

    def to_json(self) -> dict[str, Any]:
        """Returns the arguments of Record(**…) as JSON can hold them."""
        return asdict(self)


def simulate(point: Point) -> Record:
    """Simulates the shift of a Point. Raises what sites.open_shift raises."""
    began, began_cpu = clock.monotonic(), clock.process_time()
    file = layout_file.parse(point.layout)
    with sites.open_shift(
        file,
        robots=point.robots,
        stations=point.stations,
        orders=point.orders,
        seed=point.seed,
        physics=point.physics,
        policies=point.policies,
        realism=point.realism,
    ) as ops:
        fates = _Fates()
        ops.shift.on_order_event = fates.on_order
        whole = after = point.run_in + point.minutes
        ops.step_until(whole * MINUTE)
        series = {name: values[:whole] for name, values in ops.log.series.items()}
        faults = _faults(ops)
        while fates.open_of(point.run_in, whole, ops.time) and after < whole + MOST_AFTER:
            after += 1
            ops.step_until(after * MINUTE)
        series |= fates.series(whole, ops.time)
        return Record(
            point.robots,
            point.stations,
            point.seed,
            point.physics,
            series,
            faults,
            clock.monotonic() - began,
            clock.process_time() - began_cpu,
        )


class _Fates:
    """Counts the orders of each minute of a shift by their outcome."""

    def __init__(self) -> None:
        self._open: dict[int, Order] = {}  # by id
        self._in_time: Counter[int] = Counter()  # by minute
        self._late: Counter[int] = Counter()

    def on_order(self, order: Order, kind: OrderEventKind, *_: object) -> None:
        """Takes in an event of an order; see Shift.on_order_event."""
        minute = int(order.created // MINUTE)
        if kind == OrderEventKind.RECEIVED:
            self._open[order.order_id] = order
        elif kind == OrderEventKind.COMPLETED:
            del self._open[order.order_id]
            (self._in_time if order.completed <= _due(order) else self._late)[minute] += 1

    def open_of(self, begin: int, end: int, now: float) -> bool:
        """Returns whether any order that came between two minutes may still be in time."""
        return any(
            begin <= order.created // MINUTE < end and now <= _due(order)
            for order in self._open.values()
        )

    def series(self, minutes: int, now: float) -> dict[str, list[float]]:
        """Returns how many orders of each minute were in time, and how many late by now [s]."""
        late = self._late + Counter(
            int(order.created // MINUTE) for order in self._open.values() if now > _due(order)
        )
        counts = dict(zip(FATES, (self._in_time, late)))
        return {name: [float(of[i]) for i in range(minutes)] for name, of in counts.items()}


def _due(order: Order) -> float:
    return order.due or order.created + PATIENCE


def _faults(ops: Operations) -> list[str]:
    kinds = (("collisions", ops.fleet.collisions), ("robots that are stuck", ops.fleet.stuck))
    return [f"{count} {what}" for what, count in kinds if count]
