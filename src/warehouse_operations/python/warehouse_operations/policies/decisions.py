# SPDX-License-Identifier: Apache-2.0
"""The input of a learned policy: a shortlist of candidates, and numbers of each.

See doc/how-to/learning.md for what the numbers mean.
"""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from warehouse_operations.policies.order_assignment import PileOn
from warehouse_operations.policies.unit_choice import MostLines
from warehouse_operations.stock.candidates import Candidates
from warehouse_operations.stock.orders import Order
from warehouse_operations.stock.protocols import Task
from warehouse_operations.stock.stations import WorkStation

if TYPE_CHECKING:
    from warehouse_operations.policies.view import View

SHORTLIST = 16  # candidates of a decision
FEATURES = 8
WAY = 60.0  # travel time that is scaled to 1 [s]
LATE = 1800.0  # time to or since an order's due time or arrival, scaled to 1 [s]


class Decision(NamedTuple):
    """A choice of a role: `keys` are the candidates, `rows` (n, FEATURES) their numbers.

    usual: the index that the role's default policy chooses.
    """

    role: str
    keys: Sequence[Any]
    rows: np.ndarray
    usual: int


def decision_on_unit(station: WorkStation, candidates: Candidates, view: "View") -> Decision:
    """Returns the Decision which unit comes to a station."""
    units = candidates.units
    seconds = np.minimum(view.seconds_to_all(station.name, units), 1e4)
    lines, pieces = candidates.completes, candidates.pieces
    usual = int(np.searchsorted(units, MostLines().choose(station, candidates, view)))
    kept = _shortlist(usual, seconds, -(lines * 1000 + np.minimum(pieces, 999)))
    work = np.array([view.work(unit) for unit in units[kept].tolist()], float)
    idle = float(not station.coming)
    rows = np.column_stack(
        [
            seconds[kept] / WAY,
            lines[kept] / 4,
            pieces[kept] / 8,
            work / 16,
            seconds[kept] / WAY * idle,
            lines[kept] / 4 * idle,
            work / 16 * idle,
            np.full(len(kept), len(station.coming) / 6),
        ]
    ).astype(np.float32)
    return Decision("units", units[kept].tolist(), rows, int(np.searchsorted(kept, usual)))


def decision_on_order(station: WorkStation, view: "View") -> Decision:
    """Returns the Decision which order a station takes on; the last key, None, stands for no order
    now."""
    usual = PileOn().choose(station, view)
    orders = _orders_near(station, view, usual)
    if not orders:
        return Decision("orders", [], np.zeros((0, FEATURES), np.float32), 0)
    inbound, here = station.inbound_stock(), station.stock_here()
    rows = [_order_row(order, inbound, here, view.now) for order in orders]
    full = 1 - station.free_slots / max(station.capacity, 1)
    rows.append([0, 0, 0, 0, 0, 0, full, 1])
    keys = [*orders, None]
    return Decision("orders", keys, np.array(rows, np.float32), keys.index(usual))


def _orders_near(station: WorkStation, view: "View", usual: Order | None) -> list[Order]:
    """Returns SHORTLIST - 1 orders in stock or fewer: the default's, then those of inbound SKUs."""
    nearest: dict[int, Order] = {} if usual is None else {usual.order_id: usual}
    lines = (line for sku in station.inbound_stock() for line in view.backlog.lines_of(sku))
    served = (line.order for line in lines)
    for source, most in ((served, SHORTLIST // 2), (view.backlog.by_urgency(), SHORTLIST - 1)):
        for order in source:
            if len(nearest) >= most:
                break
            if order.order_id not in nearest and view.in_stock(order):
                nearest[order.order_id] = order
    return list(nearest.values())


def _order_row(
    order: Order, inbound: Mapping[str, int], here: Mapping[str, int], now: float
) -> list[float]:
    pieces = max(order.pieces, 1)
    served = sum(min(line.open, inbound.get(line.sku, 0)) for line in order.lines)
    at_once = sum(min(line.open, here.get(line.sku, 0)) for line in order.lines)
    due = np.clip((order.due - now) / LATE, -1, 1) if order.due else 1.0
    return [
        served / pieces,
        at_once / pieces,
        served / 4,
        (pieces - served) / 4,
        due,
        min((now - order.created) / LATE, 1),
        order.priority / 4,
        0,
    ]


def decision_on_robot(task: Task, seconds: np.ndarray, free: np.ndarray) -> Decision:
    """Returns the Decision which of the robots `free`, (k,) indices, gets a task.

    seconds: (tasks, robots), of this task and of those that wait after it.
    """
    kept = free[np.argsort(seconds[0, free], kind="stable")[:SHORTLIST]]
    way, n = seconds[0, kept], len(kept)
    other = seconds[1:, kept].min(0) if len(seconds) > 1 else np.full(n, 10 * WAY)
    rows = np.column_stack(
        [
            way / WAY,
            (way - way[0]) / WAY,
            np.minimum(other / WAY, 10),
            np.maximum(way - other, 0) / WAY,
            np.arange(n) / SHORTLIST,
            np.full(n, task.priority / 4),
            np.full(n, task.inbound / 6),
            np.full(n, len(seconds) / len(free)),
        ]
    )
    return Decision("robots", kept.tolist(), rows.astype(np.float32), 0)


def _shortlist(usual: int, *ranks: np.ndarray) -> np.ndarray:
    """Returns ascending indices: `usual`, and an equal number of the lowest of each rank."""
    if len(ranks[0]) <= SHORTLIST:
        return np.arange(len(ranks[0]))
    most = (SHORTLIST - 1) // len(ranks)
    least = [np.argsort(rank, kind="stable")[:most] for rank in ranks]
    return np.unique(np.concatenate([[usual], *least]))
