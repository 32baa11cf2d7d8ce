# SPDX-License-Identifier: Apache-2.0
"""Plans one tick after another, on a thread of its own."""

import concurrent.futures
import os
import time as clock
from typing import Any

import numpy as np

from warehouse_fleet import Execution, Planner, Rules, epibt
from warehouse_fleet.planners.plan_times import PlanTimes
from warehouse_fleet.planners.planner_plugins import (
    PlanRefusedError,
    ValidatedPlanner,
    make_planner,
)

HORIZON = 7  # ticks
GUIDANCE = {  # measured
    "turn_ticks": 2,
    "crowd": 10,
    "resting": 8,
    "at_lanes": 1,
    "streets": 0,  # a warehouse's own have their directions
    "memory": 50,
    "patience": 15,
}
ROUNDING = 1e-9  # [s]


class PlanLoop:
    """Begins a plan every `tick` [s] and has Execution adopt it `lag` [s] later, ready or not: so a
    run does not depend on how fast the machine is.

    `planner` is a YAML file's description, see planner_plugins; None: the one of this package, on
    `threads` threads (0: one less than the machine's cores), with the same plans for any number.
    `whole_up_to`: the cells of the largest floor whose tables are whole; 0: the planner's own.
    `refused` counts plans that were refused, `alarm` says why the last one was.
    """

    def __init__(
        self,
        floor: Any,
        execution: Execution,
        robot_names: list[str],
        *,
        tick: float,
        lag: float,
        seed: int,
        planner: Any = None,
        attempts: int = 0,
        threads: int = 0,
        whole_up_to: int = 0,
    ) -> None:
        # Execution arbitrates turning; the planner may assume that every turn succeeds.
        rules = Rules(turning=True)
        self.planner: Planner | ValidatedPlanner
        if planner is None:
            threads = threads or max(1, (os.cpu_count() or 1) - 1)
            options = {**GUIDANCE, **({"whole_up_to": whole_up_to} if whole_up_to else {})}
            self.planner = epibt(floor, rules, seed, horizon=HORIZON, threads=threads, **options)
        else:
            self.planner = make_planner(floor, rules, seed, planner, robot_names)
        self.refused, self.alarm = 0, ""
        self.seconds = PlanTimes()
        self.tick, self._lag, self._attempts = tick, lag, attempts
        self._execution = execution
        self._thread = concurrent.futures.ThreadPoolExecutor(1, "planner")
        self._thread.submit(self.planner.prepare)
        self._plan: concurrent.futures.Future | None = None
        self._due = self._next = 0.0

    def close(self) -> None:
        """Ends the planner's thread."""
        self._thread.shutdown()

    def adopt_due(self, time: float) -> None:
        """Has Execution adopt the plan that is due at that time [s]. Robots whose plan was refused
        go on with the one before."""
        if self._plan is None or time < self._due - ROUNDING:
            return
        plan, self._plan = self._plan, None
        self.alarm = ""
        try:
            self._execution.adopt(plan.result())
        except PlanRefusedError as error:
            self.alarm = f"a plan was refused: {error}"
            self.refused += 1

    def begin_due(self, time: float, goal: np.ndarray, home: np.ndarray) -> None:
        """Begins a plan for these goals and homes, (n,) cells, if one is due at that time [s]."""
        if self._plan is not None or time < self._next - ROUNDING:
            return
        fleet = self._execution.fleet(goal, home, HORIZON)
        self._next = max(self._next + self.tick, time)
        if len(fleet):
            self._plan = self._thread.submit(self._compute, fleet)
            self._due = time + self._lag

    def _compute(self, fleet: Any) -> np.ndarray:
        begin = clock.thread_time()
        actions = self.planner.plan(fleet, attempts=self._attempts)
        self.seconds.append(clock.thread_time() - begin)
        return actions
