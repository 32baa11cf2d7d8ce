# SPDX-License-Identifier: Apache-2.0
"""Simulates one shift of a point, and writes down each minute of it."""

import time as clock
from dataclasses import asdict, dataclass, field
from typing import Any

from warehouse_layout import layout_file
from warehouse_operations.kpis import upper_bound
from warehouse_operations.message_enums import OrderEventKind
from warehouse_operations.operations import Operations
from warehouse_operations.orders import Order
from warehouse_operations.sizing import sites

MINUTE = 60.0  # [s]
# What is written down, each as a count since the last minute, but `open` and `overdue` as they are.
SERIES = (
    "arrived",  # orders that came
    "completed",  # orders
    "late",  # of these
    "open",  # orders that are not complete
    "overdue",  # of these, those that are late already
    "pieces",
    "visits",  # units that were at picking stations
    "picking_s",  # station-seconds that the pickers of open stations worked, on the average
    "replenishing_s",  # the same of replenishing stations
    "idle_s",  # robot-seconds without work
    "queue_s",  # robot-seconds before stations
    "metres",
)


@dataclass(frozen=True)
class Point:
    """What decides the outcome of a shift. layout: the text of a layout file."""

    robots: int
    stations: int
    seed: int
    physics: bool
    layout: str
    orders: str
    minutes: int
    policies: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Record:
    """A shift of a point, minute by minute: a list for each of SERIES.

    bound_per_hour: the most pieces an hour that the open picking stations can do, with as many
    pieces picked from each unit. faults: sentences, of physics. wall_s: what it took [s].
    """

    robots: int
    stations: int
    seed: int
    physics: bool
    series: dict[str, list[float]]
    replenishing: int  # open stations
    bound_per_hour: float
    faults: list[str]
    wall_s: float

    def to_json(self) -> dict[str, Any]:
        """Returns what JSON can hold, and Record(**…) is made of."""
        return asdict(self)


def simulate(point: Point) -> Record:
    """Simulates the shift of a Point. Raises what sites.open_shift raises."""
    began = clock.monotonic()
    file = layout_file.parse(point.layout)
    with sites.open_shift(
        file,
        robots=point.robots,
        stations=point.stations,
        orders=point.orders,
        seed=point.seed,
        physics=point.physics,
        policies=point.policies,
    ) as ops:
        log = _Log(ops)
        for minute in range(1, point.minutes + 1):
            ops.step_until(minute * MINUTE)
            log.minute()
        return Record(
            point.robots,
            point.stations,
            point.seed,
            point.physics,
            log.series,
            len(sites.open_stations(ops, "REPLENISH")),
            _bound(ops),
            _faults(ops),
            clock.monotonic() - began,
        )


class _Log:
    """Writes down the minutes of a shift."""

    def __init__(self, ops: Operations) -> None:
        self._ops = ops
        self.series: dict[str, list[float]] = {name: [] for name in SERIES}
        self._arrived = 0
        self._last: dict[str, float] = dict.fromkeys(SERIES, 0.0)
        ops.shift.on_order_event = self._on_order

    def _on_order(self, _: Order, kind: OrderEventKind, *__: object) -> None:
        self._arrived += kind == OrderEventKind.RECEIVED

    def minute(self) -> None:
        """Adds a minute that is over to each series."""
        shift = self._ops.shift
        totals = self._totals()
        for name, total in totals.items():
            self.series[name].append(round(float(total - self._last[name]), 3))
        self._last = totals
        self.series["open"].append(len(shift.orders))
        overdue = sum(bool(one.due) and one.due < shift.now for one in shift.orders.values())
        self.series["overdue"].append(overdue)

    def _totals(self) -> dict[str, float]:
        ops, tally = self._ops, self._ops.shift.tally
        activities = ops.fleet.activities()
        return {
            "arrived": self._arrived,
            "completed": tally.orders_completed,
            "late": tally.late_orders,
            "pieces": tally.items_picked,
            "visits": tally.pick_visits,
            "picking_s": sum(one.busy_s / one.pickers for one in sites.open_stations(ops, "PICK")),
            "replenishing_s": sum(one.busy_s for one in sites.open_stations(ops, "REPLENISH")),
            "idle_s": activities["idle"],
            "queue_s": activities["queue"],
            "metres": ops.fleet.distance_m,
        }


def _bound(ops: Operations) -> float:
    shift, site = ops.shift, ops.site
    pile_on = shift.tally.items_picked / max(shift.tally.pick_visits, 1)
    return sum(
        upper_bound(pile_on, shift.settings.of(one.name), site.kinematics, site.plan.spacing)
        for one in sites.open_stations(ops, "PICK")
    )


def _faults(ops: Operations) -> list[str]:
    kinds = (("collisions", ops.fleet.collisions), ("robots that are stuck", ops.fleet.stuck))
    return [f"{count} {what}" for what, count in kinds if count]
