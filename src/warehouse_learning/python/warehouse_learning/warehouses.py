# SPDX-License-Identifier: Apache-2.0
"""The task itself, in many warehouses at once: n worlds of equally many robots.

A unit that is requested is to be fetched from beneath, brought to a station (a picking station's
service cell) and then put back on any free storage place. Arrays have the leading dimensions
(n, robots). Everything is decided by what the physics says: where robots stand, what they carry.
"""

from collections.abc import Callable, Iterable
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from warehouse_layout.floor import plan_reader
from warehouse_learning import building
from warehouse_learning._core import Task
from warehouse_learning.grid import Grid
from warehouse_learning.options import Options

LONGEST_ACTION = 20.0  # a decision ends then, whatever robots are at [s]
TOP_SPEED, WHEEL_RADIUS = 1.5, 0.1  # of the Kiva in worlds/models [m/s, m]
SHOWN_EVERY = 0.1  # interval at which a viewer of one warehouse is updated [s]
STANDS = 0.02  # and slower: it can lift [m/s]


class Action(IntEnum):
    """The actions of a robot; numbered as in RWARE."""

    WAIT = 0
    FORWARD = 1  # one cell
    LEFT = 2  # a quarter turn
    RIGHT = 3
    LIFT = 4  # lift the unit above, or put down the one that is carried


class ActionError(ValueError):
    """Raised for invalid actions; the message names the robot and what was expected."""


class Warehouses:
    """n warehouses of the same Options. `threads` as of kiva_plugin_cpp.Worlds."""

    def __init__(self, n: int, options: Options, threads: int = 0) -> None:
        self.n, self.options = n, options
        self.worlds, self._checkpoint = building.build(n, options, threads)
        plan = plan_reader.of_world(self.worlds[0])
        self.grid = grid = Grid(plan, options.radius)
        if not len(grid.stations):
            raise ValueError("there is no picking station on this floor")
        self.robots, self.units = options.robots, options.shelves
        self._kiva_id = self.worlds[0].fleet.kiva_id
        units = self.worlds.storage_units[0]
        self._shelf_id = units["shelf_id"].copy()
        self._street = np.flatnonzero(grid.street)
        self._first_cells = grid.cell_of(units["x"], units["y"])
        self.task = Task(
            grid.native,
            n,
            kiva_id=self._kiva_id,
            shelf_id=units["shelf_id"],
            radius=options.radius,
            reserve=options.reserve,
        )
        # What is the case, as views of the task: see it for what they hold.
        self.cell, self.heading, self.busy = self.task.cell, self.task.heading, self.task.busy
        self.load, self.goal = self.task.load, self.task.goal
        self.unit_cell, self.requested = self.task.unit_cell, self.task.requested
        self._all = np.arange(n, dtype=np.int32)
        now = self.worlds
        self._robots = now.x, now.y, now.yaw, now.status, now.shelf_id  # views, as of Worlds
        self._counts = now.counts
        self._masks: np.ndarray | None = None  # of the present state, computed on demand
        self.cycle = np.zeros(n, np.int64)
        self.delivered = np.zeros((n, self.robots), np.int64)  # in this episode
        self._random: list[Any] = [None] * n
        self._limit = max(1, round(LONGEST_ACTION / options.physics_step))
        self._fixed = (
            0
            if options.decision == "action"
            else max(1, round(float(options.decision) / options.physics_step))
        )
        seconds = 0 if not self._fixed else self._fixed * options.physics_step
        self.decision_seconds = seconds  # 0: as long as it takes
        # Called with what happened in the first world, as of Worlds.events(), as time passes.
        self.on_moved: Callable[[list[Any]], Any] | None = None
        self._shown_every = max(1, round(SHOWN_EVERY / options.physics_step))
        self._rewards = options.rewards
        self.top_wheel_speed = TOP_SPEED / WHEEL_RADIUS  # [rad/s]

    # --- episodes

    def reset(self, which: ArrayLike, seeds: Iterable[int]) -> None:
        """Begins new episodes in the worlds `which`, (k,) indices, from k seeds."""
        which = np.asarray(which, np.int32)
        self.worlds.restore(which, self._checkpoint)
        cells = np.empty((len(which), self.robots), np.int32)
        headings = np.empty((len(which), self.robots), np.int32)
        requested = np.zeros((len(which), self.units), bool)
        for i, (w, seed) in enumerate(zip(which.tolist(), seeds)):
            self._random[w] = random = np.random.default_rng(seed)
            cells[i] = random.choice(
                self._street, self.robots, replace=len(self._street) < self.robots
            )
            headings[i] = random.integers(4, size=self.robots)
            requested[i, random.choice(self.units, self.options.requests, replace=False)] = True
        self._place(which, cells, headings)
        self._see(which)
        for w, asked in zip(which.tolist(), requested):
            self.task.begin_episode(w, self._first_cells, asked)
        self.task.renew_goals()
        self.cycle[which] = 0
        self.delivered[which] = 0

    def _place(self, which: np.ndarray, cells: np.ndarray, headings: np.ndarray) -> None:
        x, y = self.grid.point_of(cells)
        ids = np.tile(self._kiva_id, len(which))
        rows = np.repeat(which, self.robots)
        self.worlds.place(rows, ids, x.ravel(), y.ravel(), headings.ravel() * np.pi / 2)

    # --- decisions

    def masks(self) -> np.ndarray:
        """Returns (n, robots, 5) bool, read-only: which actions are possible now."""
        if self._masks is None:
            self._masks = self.task.possible()
            self._masks.flags.writeable = False
        return self._masks

    def units_requested(self, w: int) -> list[int]:
        """Returns the numbers of the storage units that are requested in world w."""
        return self._shelf_id[self.requested[w]].tolist()

    def check(self, actions: ArrayLike) -> np.ndarray:
        """Returns actions as (n, robots) or, for wheels, (n, robots, 3). Raises ActionError."""
        values = np.asarray(actions)
        if self.options.continuous:
            return self._check_wheels(values)
        if values.shape != (self.n, self.robots):
            raise ActionError(
                f"actions: shape {(self.n, self.robots)} was expected, one for each robot of each"
                f" world, not {values.shape}"
            )
        if values.dtype.kind not in "iuf":
            raise ActionError(self._complaint(values, np.ones(values.shape, bool)))
        # NaN is unequal to itself.
        if values.dtype.kind == "f" and (values != np.rint(values)).any():
            raise ActionError(self._complaint(values, values != np.rint(values)))
        if values.min() < 0 or values.max() > 4:
            raise ActionError(self._complaint(values, (values < 0) | (values > 4)))
        return values.astype(np.int8)

    def _check_wheels(self, actions: np.ndarray) -> np.ndarray:
        if actions.shape != (self.n, self.robots, 3) or actions.dtype.kind not in "iuf":
            raise ActionError(
                f"actions: numbers of shape {(self.n, self.robots, 3)} were expected, left wheel,"
                f" right wheel and lift, not {actions.dtype} of shape {actions.shape}"
            )
        bad = ~(np.isfinite(actions) & (np.abs(actions) <= 1)).all(-1)
        if bad.any():
            raise ActionError(self._complaint(actions, bad, "three numbers from -1 to 1"))
        return actions.astype(float)

    def _complaint(
        self, actions: np.ndarray, bad: np.ndarray, expected: str = "a whole number from 0 to 4"
    ) -> str:
        w, robot = np.argwhere(bad)[0]
        action = actions.tolist()[w][robot]  # as its caller would write it
        return f"robot_{robot + 1} of world {w}: action {action!r}; {expected} was expected"

    def step(self, actions: ArrayLike) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        """Makes one decision of every robot.

        Returns rewards (n, robots) and what happened by robot, {name: (n, robots)}. Raises
        ActionError for an invalid action.
        """
        actions = self.check(actions)
        done = (self._begin_wheels if self.options.continuous else self._begin)(actions)
        goal = self.goal.copy()
        before = self.task.distance() if self._rewards["approached"] else 0
        counts = self._pass_time()
        self._see(self._all)
        self.cycle += 1
        happened = self._happened(done, counts)
        self.task.renew_goals()
        rewards = self._reward(happened)
        if self._rewards["approached"]:
            nearer = np.where(goal == self.goal, before - self.task.distance(), 0)
            rewards += np.float32(self._rewards["approached"]) * nearer
        return rewards, happened

    def _pass_time(self) -> np.ndarray:
        """Steps all worlds for one decision; returns the event counts."""
        steps, until_idle = self._fixed or self._limit, not self._fixed
        if not self.on_moved:
            self.worlds.step(steps, until_idle=until_idle)
            return self._counts
        counts = np.zeros_like(self._counts)
        # Of several worlds those that are ready would make another step at each call.
        each = self._shown_every if self.n == 1 else steps
        while steps > 0:
            self.worlds.step(min(steps, each), until_idle=until_idle)
            counts += self._counts
            steps -= each
            self.on_moved([event[1:] for event in self.worlds.events() if event[0] == 0])
            if until_idle and not self.worlds.status.any():
                break
        return counts

    def _reward(self, happened: dict[str, np.ndarray]) -> np.ndarray:
        rewards = np.full((self.n, self.robots), self._rewards["step"], np.float32)
        for name, events in happened.items():
            if self._rewards[name] and events.any():
                rewards += np.float32(self._rewards[name]) * events
        return rewards

    def _begin(self, actions: np.ndarray) -> np.ndarray:
        """Posts the possible actions; returns which robots execute theirs, (n, robots) bool."""
        done, world, commands = self.task.begin(actions)
        self.worlds.post(world, commands)
        return done

    def _begin_wheels(self, actions: np.ndarray) -> np.ndarray:
        """The same of wheel speeds; a robot that is to lift or put down stops for it."""
        standing = np.hypot(self.worlds.vx, self.worlds.vy) < STANDS
        loaded = self.load >= 0
        up = (actions[..., 2] > 0.5) & ~loaded
        down = (actions[..., 2] < -0.5) & loaded
        wants = (up | down) & ~self.busy
        speeds = np.where(wants[..., None], 0, actions[..., :2]) * self.top_wheel_speed
        self.worlds.drive(speeds[..., 0], speeds[..., 1])
        lift = np.where(wants & standing, Action.LIFT, Action.WAIT)
        return self._begin(lift.astype(np.int8))

    # --- results

    def _see(self, which: np.ndarray) -> None:
        """Updates the robots' cells and loads in the worlds `which`."""
        self.task.update(which, *self._robots)
        self._masks = None

    def _happened(self, done: np.ndarray, counts: np.ndarray) -> dict[str, np.ndarray]:
        """{name: (n, robots) bool} in the last decision; `done`: which robots executed theirs."""
        refused, collided, hit = self.task.take_events(done, counts)
        for w in hit:
            self._look_at_units(w)
        lifted, dropped, stored, arrived = self.task.settle()
        return {
            "delivered": self._deliver(arrived),
            "lifted": lifted,
            "dropped": dropped,
            "stored": stored,
            "refused": refused,
            "collided": collided,
        }

    def _look_at_units(self, w: int) -> None:
        """Where units stand after a collision, which may have pushed some."""
        rows = self.worlds[w].storage_units
        cells = self.grid.cell_of(rows["x"], rows["y"])
        self.task.place_units(w, np.where(rows["kiva_id"] > 0, np.int32(-1), cells))

    def _deliver(self, arrived: Iterable[tuple[int, int]]) -> np.ndarray:
        """Who of them has brought a requested unit, (n, robots) bool; another is requested."""
        delivered = np.zeros((self.n, self.robots), bool)
        for w, robot in arrived:
            unit = self.load[w, robot]
            if self.requested[w, unit]:
                others = np.flatnonzero(~self.requested[w])
                self.task.deliver(w, robot, self._random[w].choice(others))
                delivered[w, robot] = True
        self.delivered += delivered
        return delivered
