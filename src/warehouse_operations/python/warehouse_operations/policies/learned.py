# SPDX-License-Identifier: Apache-2.0
"""Policies that were learnt: of a shortlist of candidates that the best score is taken, by a small
network that was trained in KivaOperations-v0, or by one of your own.

    units: {name: learned, file: units.npz}

A Decision is what such a policy sees: a row of FEATURES numbers for each candidate. See
doc/how-to/learning.md for what they mean.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from warehouse_operations.candidates import Candidates
from warehouse_operations.orders import Order
from warehouse_operations.policies.order_assignment import PileOn
from warehouse_operations.policies.unit_choice import MostLines
from warehouse_operations.protocols import Task
from warehouse_operations.stations import WorkStation

if TYPE_CHECKING:
    from warehouse_operations.view import View

SHORTLIST = 16  # candidates that are looked at
FEATURES = 8
FORMAT = "kiva-dispatcher 1"
WAY = 60.0  # that counts as 1 [s]
LATE = 1800.0  # until an order is due, or since it came, that counts as 1 [s]


class Decision(NamedTuple):
    """What is to be decided: `role`, and of what may be chosen, `keys`, `rows` (n, FEATURES).

    usual: the index that the default policy of the role would take.
    """

    role: str
    keys: Sequence[Any]
    rows: np.ndarray
    usual: int


# Straight weights that come along, learnt from the default policies by
# examples/operations_train.py --size medium --robots 8 --imitated 4 --generations 0.
TRAINED = {
    "orders": (7.274, 2.849, -2.778, -0.439, 4.38, -3.059, 17.897, -4.093),
    "units": (-0.288, 24.193, 5.427, 6.569, -14.594, -25.425, -7.004, 0.0),
    "robots": (-10.842, -10.842, -1.383, -6.428, -26.658, 0.0, 0.0, 0.0),
}

Choose = Callable[[Decision], int]  # returns an index into keys


class Units:
    """Chooses the unit for a station: the nearest ones, and those that complete most lines."""

    def __init__(self, choose: Choose) -> None:
        self._choose = choose

    def choose(self, station: WorkStation, candidates: Candidates, view: "View") -> int:
        """Returns the unit, one of candidates, that is brought to a station."""
        decision = decision_on_unit(station, candidates, view)
        return int(decision.keys[self._choose(decision)])


class Orders:
    """Chooses a station's next order: those that its units on the way serve, and urgent ones."""

    def __init__(self, choose: Choose) -> None:
        self._choose = choose

    def choose(self, station: WorkStation, view: "View") -> Order | None:
        """Returns the order that a station gets, or None."""
        decision = decision_on_order(station, view)
        if not decision.keys:
            return None
        return decision.keys[self._choose(decision)]


class Robots:
    """Chooses a robot for each task, in their order: those that are there first."""

    def __init__(self, choose: Choose) -> None:
        self._choose = choose

    def match(
        self, tasks: Sequence[Task], robots: Sequence[int], seconds: np.ndarray, view: "View"
    ) -> Iterable[tuple[int, int]]:
        """Yields pairs (index of the task, index of the robot); seconds: (tasks, robots)."""
        seconds = np.minimum(seconds, 1e6)
        count, free = min(seconds.shape), np.ones(seconds.shape[1], bool)
        for task in range(count):
            decision = decision_on_robot(tasks[task], seconds[task:count], np.flatnonzero(free))
            robot = int(decision.keys[self._choose(decision)])
            free[robot] = False
            yield task, robot


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
    """Returns the Decision which order a station takes on; the last key is None: none for now."""
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
    """Up to SHORTLIST - 1 orders in stock, the default's first, then those of inbound SKUs."""
    found: dict[int, Order] = {} if usual is None else {usual.order_id: usual}
    served = (order for sku in station.inbound_stock() for order in view.backlog.with_sku(sku))
    for source, most in ((served, SHORTLIST // 2), (view.backlog.by_urgency(), SHORTLIST - 1)):
        for order in source:
            if len(found) >= most:
                break
            if order.order_id not in found and view.in_stock(order):
                found[order.order_id] = order
    return list(found.values())


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
    """Returns indices, ascending: `usual`, and of the least by each of the ranks as many as fit."""
    if len(ranks[0]) <= SHORTLIST:
        return np.arange(len(ranks[0]))
    most = (SHORTLIST - 1) // len(ranks)
    least = [np.argsort(rank, kind="stable")[:most] for rank in ranks]
    return np.unique(np.concatenate([[usual], *least]))


class Scorer:
    """A network that scores candidates: FEATURES numbers, a layer of tanh, a score.

    weights: (FEATURES, hidden), (hidden,), (hidden,): into the layer, its biases, out of it; and
    (FEATURES,), from a row straight to its score. The best score is taken.
    """

    def __init__(self, weights: Sequence[np.ndarray]) -> None:
        self.into, self.bias, self.out, self.straight = weights

    def __call__(self, decision: Decision) -> int:
        """Returns the index of the candidate with the best score; the first of equals."""
        return int(self.scores(decision.rows).argmax())

    def scores(self, rows: np.ndarray) -> np.ndarray:
        """Returns (n,) of rows (n, FEATURES)."""
        return np.tanh(rows @ self.into + self.bias) @ self.out + rows @ self.straight

    def save(self, path: str | Path, role: str, about: str = "") -> None:
        """Writes it for policies of a role; `about`: how it was made."""
        np.savez_compressed(
            path,
            format=FORMAT,
            role=role,
            about=about,
            into=self.into,
            bias=self.bias,
            out=self.out,
            straight=self.straight,
        )


def scorer_of(file: str | Path, role: str) -> Scorer:
    """Returns the Scorer of a file, or, without one, that which comes along. Raises ValueError."""
    if file:
        return load(file, role)
    return linear(TRAINED[role])


def linear(weights: Sequence[float]) -> Scorer:
    """Returns a Scorer whose scores are linear in what a candidate is like, (FEATURES,) weights."""
    nothing = np.zeros((FEATURES, 1)), np.zeros(1), np.zeros(1)
    return Scorer([*nothing, np.array(weights, float)])


SHAPES = {"into": (FEATURES, -1), "bias": (-1,), "out": (-1,), "straight": (FEATURES,)}


def load(path: str | Path, role: str) -> Scorer:
    """Returns the Scorer of a file for a role. Raises ValueError that names what is wrong."""
    try:
        with np.load(path, allow_pickle=False) as content:
            if str(content["format"]) != FORMAT:
                raise ValueError(f"its format is not {FORMAT!r}")
            if str(content["role"]) != role:
                raise ValueError(f"it was learnt for the role {content['role']}, not {role}")
            return Scorer([_checked(content[name], name) for name in SHAPES])
    except (OSError, KeyError, EOFError, ValueError) as error:
        raise ValueError(f"file: {path}: {error}") from error


def _checked(array: np.ndarray, name: str) -> np.ndarray:
    expected = SHAPES[name]
    fits = array.ndim == len(expected) and array.dtype.kind == "f" and np.isfinite(array).all()
    if not fits or (expected[0] == FEATURES and array.shape[0] != FEATURES):
        raise ValueError(f"{name} is {array.dtype} of shape {array.shape}, not numbers {expected}")
    return array


class LearnedUnits(Units):
    """Takes the unit that a trained network scores best.

    file: .npz, as examples/operations_train.py writes it for `units`; without one, the network
    that comes along.
    """

    def __init__(self, file: str = "") -> None:
        super().__init__(scorer_of(file, "units"))


class LearnedOrders(Orders):
    """Takes the order that a trained network scores best, or none for now.

    file: .npz, as examples/operations_train.py writes it for `orders`; without one, the network
    that comes along.
    """

    def __init__(self, file: str = "") -> None:
        super().__init__(scorer_of(file, "orders"))


class LearnedRobots(Robots):
    """Gives each task the robot that a trained network scores best.

    file: .npz, as examples/operations_train.py writes it for `robots`; without one, the network
    that comes along.
    """

    def __init__(self, file: str = "") -> None:
        super().__init__(scorer_of(file, "robots"))
