# SPDX-License-Identifier: Apache-2.0
"""The figures of a shift, and the formulas behind them."""

import math
from collections import defaultdict
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_operations.stock.orders import Bundle, Line, Order
from warehouse_operations.stock.settings import Settings
from warehouse_operations.stock.stations import Visit

if TYPE_CHECKING:
    from warehouse_operations.shift.shift import Shift

INTERVAL = 60.0  # of the series [s]


class Tally:
    """Counts what happens in a shift; times are simulated [s]."""

    def __init__(self) -> None:
        self.items_picked = self.lines_picked = self.orders_completed = 0
        self.bundles_stored = self.pieces_stored = self.late_orders = self.orders_received = 0
        self.trips = self.pick_visits = 0  # units that were at a station, at a picking one
        self.turnover_s: list[float] = []
        self.throughput_s: list[float] = []
        self.completed_s: list[float] = []  # when each of these orders was complete
        self.picked_in: dict[int, int] = defaultdict(int)  # by INTERVAL
        self.stored_in: dict[int, int] = defaultdict(int)
        self.completed_in: dict[int, int] = defaultdict(int)
        self.late_in: dict[int, int] = defaultdict(int)  # late orders, when they were due

    def picked(self, now: float, pieces: int, line: Line) -> None:
        """Counts pieces that were picked for an order line."""
        self.items_picked += pieces
        self.lines_picked += not line.open
        self.picked_in[int(now // INTERVAL)] += pieces

    def stored(self, now: float, bundle: Bundle) -> None:
        """Counts a bundle that was put into its bin."""
        self.bundles_stored += 1
        self.pieces_stored += bundle.quantity
        self.stored_in[int(now // INTERVAL)] += bundle.quantity

    def unpicked(self, when: float, pieces: int, line: Line) -> None:
        """Counts pieces no longer that were picked at a time [s]; the line still has them."""
        self.items_picked -= pieces
        self.lines_picked -= not line.open
        self.picked_in[int(when // INTERVAL)] -= pieces

    def unstored(self, when: float, bundle: Bundle) -> None:
        """Counts a bundle no longer that was put in at a time [s]."""
        self.bundles_stored -= 1
        self.pieces_stored -= bundle.quantity
        self.stored_in[int(when // INTERVAL)] -= bundle.quantity

    def completed(self, order: Order) -> None:
        """Counts an order that is complete."""
        self.orders_completed += 1
        self._late(order, 1)
        self.turnover_s.append(order.completed - order.created)
        self.throughput_s.append(order.completed - order.assigned)
        self.completed_s.append(order.completed)
        self.completed_in[int(order.completed // INTERVAL)] += 1

    def reopened(self, order: Order) -> None:
        """Counts an order no longer that was complete. Raises ValueError if it was not counted."""
        self.orders_completed -= 1
        self._late(order, -1)
        times = order.completed - order.created, order.completed - order.assigned, order.completed
        counted = self.turnover_s, self.throughput_s, self.completed_s
        at = list(zip(*counted)).index(times)
        for series in counted:
            del series[at]
        self.completed_in[int(order.completed // INTERVAL)] -= 1

    def _late(self, order: Order, sign: int) -> None:
        """Counts an order if it was late."""
        if order.due and order.completed > order.due:
            self.late_orders += sign
            self.late_in[int(order.due // INTERVAL)] += sign

    def visited(self, visit: Visit) -> None:
        """Counts a visit that is over, if its unit reached the station."""
        if visit.arrived is not None:
            self.trips += 1
            self.pick_visits += not visit.replenishes


def upper_bound(
    pile_on: float, settings: Settings, kinematics: Kinematics, spacing: float = 1.0
) -> float:
    """Returns the most pieces an hour that a picking station can reach.

    pile_on: pieces p picked from each unit. spacing: of the cells [m].

    The formula is p * 3600 / (max(in + turn + out + pick - transfer, 0) + p * transfer / pickers):
    the next unit may come while the last piece of a unit is still being handled.
    """
    cell = 2 * math.sqrt(spacing / kinematics.acceleration)
    top = kinematics.speed**2 / kinematics.acceleration
    if spacing > top:
        cell = spacing / kinematics.speed + kinematics.start_stop
    change = 2 * cell + kinematics.quarter_turn + settings.pick_s - settings.piece_s
    pieces = max(pile_on, 1.0)
    return pieces * 3600 / (max(change, 0.0) + pieces * settings.piece_s / settings.pickers)


def of_shift(shift: "Shift", fleet: Any, kinematics: Kinematics, wall_s: float) -> dict[str, Any]:
    """Returns the content of kpis.json.

    fleet: an IdealFleet, a WorldFleet, or what has the same figures. wall_s: how long the shift
    took to simulate [s].
    """
    tally, elapsed = shift.tally, shift.now - shift.began
    hours = max(elapsed, 1e-9) / 3600
    # A station that was closed all the time is as if it were not there.
    picking = [s for s in shift.picking.stations if s.is_open or s.visits]
    replenishing = shift.replenishing.stations
    picks = sum(len([v for v in s.inbound.values() if v.pieces]) for s in picking)
    pile_on = tally.items_picked / max(tally.pick_visits + picks, 1)
    spacing = shift.floor.plan.spacing
    bound = sum(
        upper_bound(pile_on, shift.settings.of(station.name), kinematics, spacing)
        * (station.open_seconds(shift.now) / elapsed if elapsed else 1.0)
        for station in picking
    )
    throughput = tally.items_picked / hours
    overdue = sum(bool(order.due) and order.due < shift.now for order in shift.orders.values())
    busy = sum(station.busy_s for station in picking)
    attended = sum(station.picker_seconds(shift.now) for station in picking)
    return {
        "simulated_s": elapsed,
        "wall_s": wall_s,
        "real_time_factor": elapsed / wall_s if wall_s else 0.0,
        "robots": fleet.robot_count,
        "pick_stations": len(picking),
        "replenish_stations": len(replenishing),
        "items_picked": tally.items_picked,
        "lines_picked": tally.lines_picked,
        "orders_completed": tally.orders_completed,
        "bundles_stored": tally.bundles_stored,
        "item_throughput_per_hour": throughput,
        "order_throughput_per_hour": tally.orders_completed / hours,
        "item_upper_bound_per_hour": bound,
        "item_score": throughput / bound if bound else 0.0,
        "pile_on": pile_on,
        "station_idle_fraction": 1 - busy / attended if busy else 1.0,
        "order_turnover_s": quantiles(tally.turnover_s),
        "order_throughput_s": quantiles(tally.throughput_s),
        "late_orders_fraction": (tally.late_orders + overdue)
        / max(tally.orders_completed + overdue, 1),
        "distance_m": fleet.distance_m,
        "distance_per_item_m": fleet.distance_m / max(tally.items_picked, 1),
        "trips": tally.trips,
        "collisions": fleet.collisions,
        "blocked": fleet.blocked,
        "watchdog": fleet.watchdog,
        "plan_ms": _planning(fleet.plan_ms),
        "executed_over_planned": fleet.executed_over_planned,
        "state_hash": shift.state_hash(),
    } | (shift.fallen.figures() | _of_troubles(fleet, tally.items_picked))


def _of_troubles(fleet: Any, items_picked: int) -> dict[str, Any]:
    """Returns what failures, charging and people cost; empty where there were none."""
    log = getattr(fleet, "failures", None)
    figures: dict[str, Any] = log.figures() if log else {}
    figures |= getattr(fleet, "energy", {})
    if "availability" in figures:
        down = 1 - figures["availability"]
        figures["items_lost_to_failures"] = _lost(items_picked, down)
    people = getattr(fleet, "people", None)
    figures |= people.figures() if people else {}
    if "stopped_fraction" in figures:
        figures["items_lost_to_people"] = _lost(items_picked, figures["stopped_fraction"])
    return figures


def _lost(items_picked: int, away: float) -> float:
    """Returns how many pieces robots would have picked in the part of their time that they were
    `away`, at the pace of the rest of it."""
    return items_picked * away / max(1 - away, 1e-9)


def quantiles(values: Sequence[float]) -> dict[str, float]:
    """Returns p25, median, p75 and p95 of values; zeros where there are none."""
    names = ("p25", "median", "p75", "p95")
    return dict(zip(names, np.percentile(values or [0.0], (25, 50, 75, 95)).tolist()))


def _planning(milliseconds: Sequence[float]) -> dict[str, float]:
    values = np.asarray(milliseconds if len(milliseconds) else [0.0])
    median, late = np.percentile(values, (50, 99))
    return {"p50": float(median), "p99": float(late), "max": float(values.max())}
