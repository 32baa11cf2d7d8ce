# SPDX-License-Identifier: Apache-2.0
"""The figures of a shift, and the formulas behind them."""

import math
from collections.abc import Collection, Iterable, Sequence
from typing import Any

import numpy as np

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_operations.shift.context import Context
from warehouse_operations.shift.tally import Tally
from warehouse_operations.stock.orders import Order
from warehouse_operations.stock.settings import Settings
from warehouse_operations.stock.stations import WorkStation


def upper_bound(
    pile_on: float, settings: Settings, kinematics: Kinematics, spacing: float = 1.0
) -> float:
    """Returns the most pieces an hour that a picking station can reach.

    pile_on: pieces p picked from each unit. spacing: of the cells [m].

    The formula is p * 3600 / (max(in + turn + out + pick - transfer, 0) + p * transfer / pickers):
    the next unit may come while the last piece of a unit is handled.
    """
    cell = 2 * math.sqrt(spacing / kinematics.acceleration)
    top = kinematics.speed**2 / kinematics.acceleration
    if spacing > top:
        cell = spacing / kinematics.speed + kinematics.start_stop
    change = 2 * cell + kinematics.quarter_turn + settings.pick_s - settings.piece_s
    pieces = max(pile_on, 1.0)
    return pieces * 3600 / (max(change, 0.0) + pieces * settings.piece_s / settings.pickers)


def of_shift(
    context: Context,
    stations: Collection[WorkStation],
    orders: Collection[Order],
    spacing: float,
    *,
    fleet: Any,
    kinematics: Kinematics,
    wall_s: float,
) -> dict[str, Any]:
    """Returns the content of kpis.json, but the figures of fallen bins.

    orders: those that are not over. spacing: of the cells [m]. fleet: an IdealFleet, a WorldFleet,
    or what has the same figures. wall_s: how long the shift took to simulate [s].
    """
    tally, now = context.tally, context.clock.now
    elapsed = now - context.clock.began
    hours = max(elapsed, 1e-9) / 3600
    # Stations that were closed all the time do not count.
    picking = [s for s in stations if s.picks and (s.is_open or s.visits)]
    pile_on = tally.items_picked / max(served_visits(tally, stations)[0], 1)
    bound = sum(
        upper_bound(pile_on, station.settings, kinematics, spacing)
        * (station.open_seconds(now) / elapsed if elapsed else 1.0)
        for station in picking
    )
    throughput = tally.items_picked / hours
    overdue = sum(bool(order.due) and order.due < now for order in orders)
    busy = sum(station.busy_s for station in picking)
    attended = sum(station.picker_seconds(now) for station in picking)
    return {
        "simulated_s": elapsed,
        "wall_s": wall_s,
        "real_time_factor": elapsed / wall_s if wall_s else 0.0,
        "robots": fleet.robot_count,
        "pick_stations": len(picking),
        "replenish_stations": sum(station.replenishes for station in stations),
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
        "state_hash": context.state_hash(),
        **getattr(fleet, "elevators", {}),
    } | _of_troubles(fleet, tally.items_picked)


def served_visits(tally: Tally, stations: Iterable[WorkStation]) -> tuple[int, int]:
    """Returns the numbers of visits for picking, and of those to put bundles in: those that are
    over, and those during which that has begun."""
    begun = [v.replenishes for s in stations for v in s.inbound.values() if v.pieces]
    put_in = sum(begun)
    picks, others = tally.pick_visits, tally.trips - tally.pick_visits
    return picks + len(begun) - put_in, others + put_in


def _of_troubles(fleet: Any, items_picked: int) -> dict[str, Any]:
    """Returns the costs of failures, charging and people; empty without any of these."""
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
    """Returns the pieces that robots would have picked in their time `away`, at the rate of their
    other time."""
    return items_picked * away / max(1 - away, 1e-9)


def quantiles(values: Sequence[float]) -> dict[str, float]:
    """Returns p25, median, p75 and p95 of values; zeros without values."""
    names = ("p25", "median", "p75", "p95")
    return dict(zip(names, np.percentile(values or [0.0], (25, 50, 75, 95)).tolist()))


def _planning(milliseconds: Sequence[float]) -> dict[str, float]:
    values = np.asarray(milliseconds if len(milliseconds) else [0.0])
    median, late = np.percentile(values, (50, 99))
    return {"p50": float(median), "p99": float(late), "max": float(values.max())}
