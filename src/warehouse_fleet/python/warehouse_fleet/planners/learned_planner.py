# SPDX-License-Identifier: Apache-2.0
"""A planner that was learnt: a small network scores the cells that each robot could enter next, by
what is near it, and priority inheritance with backtracking keeps robots apart.

    planner: learned
    options: {file: mine.npz}   # without one, the network that comes along

The network orders a robot's candidates, its own cell and four neighbours; PIBT (Okumura et al.,
Artificial Intelligence 310, 2022) takes the best one that leaves a cell for all others. So what the
network says can be slow, but never unsafe (CS-PIBT: Veerapaneni et al., 2024). A plan is the same
step, repeated up to the horizon of the commands.
"""

from typing import Any

import numpy as np

from warehouse_fleet import Fleet, Rules
from warehouse_fleet.planners import scorer
from warehouse_fleet.planners.local_view import LocalView, Scene
from warehouse_fleet.planners.pibt import NOWHERE, Pibt
from warehouse_fleet.planners.plan_loop import HORIZON
from warehouse_fleet.planners.planner_plugins import FREE
from warehouse_layout import Floor

ROLE = "planner"
WAIT, FORWARD, POSITIVE, NEGATIVE = range(4)  # Action
TURN = np.array([FORWARD, POSITIVE, POSITIVE, NEGATIVE], np.uint8)  # by quarters to the next cell
QUARTERS = np.array([0, 0, 1, 3])  # by Action

# Straight weights that come along, learnt from EPIBT by
# examples/planner_train.py --size medium large --rounds 3 --minutes 2 --hidden 0.
TRAINED = (
    *(4.471, -2.806, -1.731, 1.089, -0.127, -2.830, -7.829, 1.473),
    *(-0.297, -0.586, 4.337, -4.186, 0.0, -0.373, -0.993, 0.0),
)


class Learned:
    """A planner class as of planner_plugins, whose plan() answers with actions."""

    def __init__(self, file: str = "", horizon: int = HORIZON) -> None:
        if not 1 <= horizon <= 32:
            raise ValueError(f"horizon is {horizon}; 1 to 32 ticks were expected")
        self.scorer = (
            scorer.load(file, ROLE, LocalView.FEATURES) if file else scorer.linear(TRAINED)
        )
        self.horizon = horizon

    def start(self, floor: Floor, rules: Rules, seed: int) -> None:
        """Prepares for planning on a floor."""
        self.view, self.rules = LocalView(floor), rules
        self.waited = np.zeros(0)

    def plan(self, fleet: Fleet) -> np.ndarray:
        """Returns the plan, (robots, horizon) of Action."""
        if len(self.waited) != len(fleet):
            self.waited = np.zeros(len(fleet))
        rollout = Rollout(self.view, fleet, self.rules, self.waited)
        ticks = max(self.horizon, fleet.committed.shape[1])
        plan = np.stack([rollout.tick(self._candidates) for _ in range(ticks)], axis=1)
        has_way = (fleet.goal != NOWHERE) & (fleet.cell != fleet.goal)
        self.waited = np.where(has_way, self.waited + 1, 0)
        return plan

    def _candidates(self, scene: Scene) -> np.ndarray:
        """(robots, 5) scores; -inf: not to be entered."""
        rows, possible = self.view.rows(scene)
        return np.where(possible, self.scorer.scores(rows), -np.inf)


class Rollout:
    """The fleet from now on, tick by tick, each robot by the scores of its next cells."""

    def __init__(self, view: LocalView, fleet: Fleet, rules: Rules, waited: np.ndarray) -> None:
        self.fleet, self.rules, self.view = fleet, rules, view
        self.scene = Scene(fleet, waited)
        self._committed = fleet.committed
        self._closed = set(fleet.closed.tolist())
        self.at = 0

    def is_free(self) -> np.ndarray:
        """Returns (robots,) bool: which robots can still take a command in this tick."""
        n = len(self.fleet)
        stopped = self.fleet.stopped.astype(bool) if self.fleet.stopped.size else np.zeros(n, bool)
        if self.at >= self._committed.shape[1]:
            return ~stopped
        return ~stopped & (self._committed[:, self.at] == FREE)

    def tick(self, score: Any) -> np.ndarray:
        """Advances by one tick; returns the robots' actions, (robots,) of Action.

        score(scene): (robots, 5), of staying and of the neighbours in the directions of headings.
        """
        free, scene = self.is_free(), self.scene
        scores = score(scene)
        targets = self.view.targets(scene)
        pibt = Pibt(scene.cell, targets, free, self._closed, scene.goal)
        wishes = pibt.assign(scores, self.view.ranks(scene))
        actions = self._towards(wishes, free)
        if self.at < self._committed.shape[1]:
            kept = self._committed[:, self.at]
            actions = np.where(kept != FREE, kept, actions)
        if self.fleet.stopped.size:
            actions = np.where(self.fleet.stopped, WAIT, actions).astype(np.uint8)
        self.perform(actions)
        scene.intent = wishes
        return actions

    def perform(self, actions: np.ndarray) -> None:
        """Applies the robots' actions, (robots,) of Action."""
        scene = self.scene
        ahead = scene.cell + self.view.step[scene.heading]
        cell = np.where(actions == FORWARD, ahead, scene.cell)
        scene.move(cell, (scene.heading + QUARTERS[actions]) & 3)
        self.at += 1

    def _towards(self, cells: np.ndarray, free: np.ndarray) -> np.ndarray:
        scene = self.scene
        facing = (cells - scene.cell)[:, None] == self.view.step
        quarters = (facing.argmax(1) - scene.heading) & 3
        moves = free & (cells != scene.cell)
        actions = np.where(moves, TURN[quarters], WAIT).astype(np.uint8)
        late = (actions == FORWARD) & ~self._can_go(cells, actions == FORWARD)
        actions[late] = WAIT
        return actions

    def _can_go(self, cells: np.ndarray, forward: np.ndarray) -> np.ndarray:
        """(robots,) bool: whose next cell is empty, or left in time by one that can go itself.

        A ring never reaches an empty cell, so none of its robots moves.
        """
        holder = {int(cell): robot for robot, cell in enumerate(self.scene.cell)}
        goes = np.zeros(len(cells), bool)
        behind: dict[int, list[int]] = {}
        for robot in np.flatnonzero(forward).tolist():
            behind.setdefault(int(cells[robot]), []).append(robot)
        ready = [cell for cell in behind if cell not in holder]
        while ready:
            cell = ready.pop()
            first = behind[cell][0]
            goes[first] = True
            left = int(self.scene.cell[first])
            if self.rules.following and left in behind:
                ready.append(left)
        return goes
