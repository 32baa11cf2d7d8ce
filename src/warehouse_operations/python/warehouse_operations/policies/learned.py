# SPDX-License-Identifier: Apache-2.0
"""Learned policies: each takes the candidate of a shortlist with the best score, computed by a
small network that was trained in KivaOperations-v0, or by one of your own.

    units: {name: learned, file: units.npz}

The input of such a policy is a Decision: a row of FEATURES numbers for each candidate.
"""

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from warehouse_fleet.planners.scorer import Scorer, linear, load
from warehouse_operations.policies.decisions import (
    FEATURES,
    Decision,
    decision_on_order,
    decision_on_robot,
    decision_on_unit,
)
from warehouse_operations.stock.candidates import Candidates
from warehouse_operations.stock.orders import Order
from warehouse_operations.stock.protocols import Task
from warehouse_operations.stock.stations import WorkStation

if TYPE_CHECKING:
    from warehouse_operations.policies.view import View

# The default weights, of linear scores, learnt from the default policies by
# examples/operations_train.py --size medium --robots 8 --imitated 4 --generations 0.
TRAINED = {
    "orders": (7.274, 2.849, -2.778, -0.439, 4.38, -3.059, 17.897, -4.093),
    "units": (-0.288, 24.193, 5.427, 6.569, -14.594, -25.425, -7.004, 0.0),
    "robots": (-10.842, -10.842, -1.383, -6.428, -26.658, 0.0, 0.0, 0.0),
}

Choose = Callable[[Decision], int]  # returns an index into keys


class Units:
    """Chooses the unit for a station among the nearest ones and those that complete most lines."""

    def __init__(self, choose: Choose) -> None:
        self._choose = choose

    def choose(self, station: WorkStation, candidates: Candidates, view: "View") -> int:
        """Returns the unit, one of candidates, that is brought to a station."""
        decision = decision_on_unit(station, candidates, view)
        return int(decision.keys[self._choose(decision)])


class Orders:
    """Chooses a station's next order among those for its units on the way, and urgent ones."""

    def __init__(self, choose: Choose) -> None:
        self._choose = choose

    def choose(self, station: WorkStation, view: "View") -> Order | None:
        """Returns the order that a station gets, or None."""
        decision = decision_on_order(station, view)
        if not decision.keys:
            return None
        return decision.keys[self._choose(decision)]


class Robots:
    """Chooses a robot for each task, in their order, among those that arrive first."""

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


def best_of(scorer: Scorer) -> Choose:
    """Returns a Choose that takes the candidate with the best score, the first of equals."""
    return lambda decision: int(scorer.scores(decision.rows).argmax())


def scorer_of(file: str, role: str) -> Scorer:
    """Returns the Scorer of a file, or the default one without a file. Raises ValueError."""
    return load(file, role, FEATURES) if file else linear(TRAINED[role])


class LearnedUnits(Units):
    """Takes the unit that a trained network scores best.

    file: .npz, as examples/operations_train.py writes it for `units`; without one, the network
    that comes along.
    """

    def __init__(self, file: str = "") -> None:
        super().__init__(best_of(scorer_of(file, "units")))


class LearnedOrders(Orders):
    """Takes the order that a trained network scores best, or none for now.

    file: .npz, as examples/operations_train.py writes it for `orders`; without one, the network
    that comes along.
    """

    def __init__(self, file: str = "") -> None:
        super().__init__(best_of(scorer_of(file, "orders")))


class LearnedRobots(Robots):
    """Gives each task the robot that a trained network scores best.

    file: .npz, as examples/operations_train.py writes it for `robots`; without one, the network
    that comes along.
    """

    def __init__(self, file: str = "") -> None:
        super().__init__(best_of(scorer_of(file, "robots")))
