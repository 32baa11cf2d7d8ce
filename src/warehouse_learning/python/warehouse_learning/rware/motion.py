# SPDX-License-Identifier: Apache-2.0
"""RWARE's task where actions take time: "ideal", robots that accelerate and turn and meet nothing,
and "bodies", robots of the warehouse's physics, which lift real storage units and could collide.

An action comes true when it ends; until then its robot stands where it stood for all others, and
holds the cell that it goes to. Observations, rewards and the random stream are RWARE's own.
"""

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from kiva_plugin_cpp import COMMAND, EventKind, Kind, Status, World, Worlds
from warehouse_layout.place import layout
from warehouse_learning import building
from warehouse_learning._core import Rware
from warehouse_learning.rware.task import Action, Direction, Task

PHYSICS = "grid", "ideal", "bodies"
STEP = 0.05  # of physics; ends in the same places as one of 1 ms [s]
SHOWN_EVERY = 2  # steps, to who watches
LONGEST = 20.0  # an action ends then, whatever became of it [s]
AHEAD = {
    Direction.UP: (0, 1),
    Direction.DOWN: (0, -1),
    Direction.LEFT: (-1, 0),
    Direction.RIGHT: (1, 0),
}  # in world: x to the right, y up
DX, DY = np.array([AHEAD[Direction(d)] for d in range(4)], float).T
YAW = np.arctan2(DY, DX)
# What the physics takes for each action from rest to rest, in steps of STEP, with the Kiva of
# worlds/models [s].
DURATIONS = {Action.FORWARD: 2.1, Action.LEFT: 0.7, Action.RIGHT: 0.7, Action.TOGGLE_LOAD: 2.15}
SECONDS = np.array([DURATIONS.get(Action(a), 0.0) for a in range(5)])


class Motion:
    """How actions of `n` warehouses of a Task pass in time; `time` [s] of each, since its episode
    began.

    decision: "action", a step lasts until every robot has ended its action; a number is its
    duration [s], and robots that have not ended an action continue it and begin no other.
    """

    def __init__(self, task: Task, warehouses: Rware, n: int, decision: float | str) -> None:
        self._warehouses = warehouses
        self._seconds = 0.0 if decision == "action" else float(decision)
        self._has_bodies = False
        self.current = np.zeros((n, task.n_agents), np.int8)
        self.time = np.zeros(n)

    @property
    def busy(self) -> np.ndarray:
        """Whether each agent is at an action, (n, agents) bool."""
        return self.current != Action.NOOP

    def reset(self, which: np.ndarray) -> None:
        """Episodes of `which`, (n,) bool, begin, in the warehouses already."""
        self.current[which] = Action.NOOP
        self.time[which] = 0

    def infos(self) -> dict[str, np.ndarray]:
        """Returns the infos: `time` (n,) [s] and `busy` (n, agents) bool."""
        return {"time": self.time.copy(), "busy": self.busy}

    def pass_time(self, which: np.ndarray, actions: np.ndarray) -> np.ndarray:
        """Begins actions, (n, agents) int8, and lets a decision pass in `which`, (n,) bool.

        Returns what ended, (n, agents) int8: to be passed to the warehouses, which apply it.
        """
        idle = self.current == Action.NOOP
        self._warehouses.begin(which, actions, self._has_bodies, self.current)
        self._begin(idle & self.busy)
        done = self._wait(which) & self.busy & which[:, None]
        ended = np.where(done, self.current, np.int8(Action.NOOP))
        self.current[done] = Action.NOOP
        return ended

    def _begin(self, which: np.ndarray) -> None:
        """Robots `which`, (n, agents) bool, begin their current action."""
        raise NotImplementedError

    def _wait(self, which: np.ndarray) -> np.ndarray:
        """A decision passes. Returns whose action has ended, (n, agents) bool."""
        raise NotImplementedError


class IdealMotion(Motion):
    """Each action takes the time that it takes a robot alone."""

    def __init__(self, task: Task, warehouses: Rware, n: int, decision: float | str) -> None:
        super().__init__(task, warehouses, n, decision)
        self._left = np.zeros(self.current.shape)

    def _begin(self, which: np.ndarray) -> None:
        self._left[which] = SECONDS[self.current[which]]

    def _wait(self, which: np.ndarray) -> np.ndarray:
        left = np.where(self.busy, self._left, 0.0)
        seconds = np.full(len(left), self._seconds) if self._seconds else left.max(1)
        self._left -= seconds[:, None]
        self.time[which] += seconds[which]
        return self._left <= 1e-9


class BodyMotion(Motion):
    """Robots and storage units of the physics do it; `collisions` (n, agents) in these episodes."""

    def __init__(
        self, task: Task, warehouses: Rware, n: int, decision: float | str, threads: int = 1
    ) -> None:
        super().__init__(task, warehouses, n, decision)
        self._has_bodies = True
        self._height, self._width = task.floor.grid_size
        self.worlds, self._checkpoint = _worlds(task, n, threads)
        self._kiva_id = self.worlds[0].fleet.kiva_id
        self._where = np.zeros((n, task.n_agents, 3), np.int32)
        self.collisions = np.zeros((n, task.n_agents), np.int64)
        # Called with what happened in the first world, as of Worlds.events(), as time passes.
        self.on_moved: Callable[[list[Any]], Any] | None = None

    def _at(self, cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(x, y) of cells' centres in world [m]."""
        row, column = np.divmod(cells, self._width)
        return column.astype(float), (self._height - 1 - row).astype(float)

    def reset(self, which: np.ndarray) -> None:
        """See Motion."""
        super().reset(which)
        chosen = np.flatnonzero(which).astype(np.int32)
        self.worlds.restore(chosen, self._checkpoint)
        self._warehouses.where(self._where)
        x, y = self._at(self._where[which, :, 0])
        yaw = YAW[self._where[which, :, 1]]
        agents = len(self._kiva_id)
        ids = np.tile(self._kiva_id, len(chosen))
        self.worlds.place(np.repeat(chosen, agents), ids, x.ravel(), y.ravel(), yaw.ravel())
        self.collisions[which] = 0

    def infos(self) -> dict[str, np.ndarray]:
        """See Motion; with `collisions` (n, agents) in the episode."""
        return super().infos() | {"collisions": self.collisions.copy()}

    def _begin(self, which: np.ndarray) -> None:
        self._warehouses.where(self._where)
        world, agent = np.nonzero(which)
        action = self.current[which]
        cell, direction, shelf = self._where[which].T
        rows = np.zeros(len(action), COMMAND)
        rows["kiva_id"] = self._kiva_id[agent]
        self._drive(rows, world, agent, cell, direction)
        turns = (action == Action.LEFT) | (action == Action.RIGHT)
        rows["kind"][turns] = Kind.ROTATE
        rows["direction"] = np.where(action == Action.LEFT, 1, -1)
        lifts = action == Action.TOGGLE_LOAD
        rows["kind"][lifts] = Kind.LIFT
        rows["lift"] = shelf < 0
        for i in np.flatnonzero(lifts & (shelf < 0)):
            rows["shelf_id"][i] = 1 + self._warehouses.shelf_at(int(world[i]))[cell[i]]
        self.worlds.post(world.astype(np.int32), rows)

    def _drive(
        self,
        rows: np.ndarray,
        world: np.ndarray,
        agent: np.ndarray,
        cell: np.ndarray,
        direction: np.ndarray,
    ) -> None:
        """Forward, to the middle of the next cell: what it was off is mended."""
        x, y = self._at(cell)
        along_x = DX[direction] != 0
        rows["kind"] = np.where(along_x, Kind.MOVE_X, Kind.MOVE_Y)
        rows["x"] = np.where(along_x, x + DX[direction] - self.worlds.x[world, agent], 0)
        rows["y"] = np.where(along_x, 0, y + DY[direction] - self.worlds.y[world, agent])

    def _wait(self, which: np.ndarray) -> np.ndarray:
        before = self._clocks()
        steps = round((self._seconds or LONGEST) / STEP)
        each = min(steps, SHOWN_EVERY) if self.on_moved else steps
        while steps > 0:
            self.worlds.step(min(steps, each), until_idle=not self._seconds)
            self.collisions += self.worlds.counts[..., EventKind.COLLISION]
            steps -= each
            if self.on_moved:
                self.on_moved([event[1:] for event in self.worlds.events() if event[0] == 0])
            if not self._seconds and not self.worlds.status.any():
                break
        self.time[which] += (self._clocks() - before)[which]
        return self.worlds.status == Status.IDLE

    def _clocks(self) -> np.ndarray:
        return np.array([self.worlds[i].time for i in range(len(self.time))])


def _worlds(task: Task, n: int, threads: int) -> tuple[Worlds, Any]:
    """(Worlds, checkpoint): worlds with a storage unit on each of the task's shelves' places, whose
    robots stand anywhere."""
    height, width = task.floor.grid_size
    row, column = np.nonzero(task.floor.highways == 0)
    units = np.column_stack([column, height - 1 - row]).astype(float)
    count = task.n_agents
    robots = np.column_stack([np.arange(count) % width, np.arange(count) // width, np.zeros(count)])
    laid = layout.Layout(
        layout.Floor(-0.5, width - 0.5, -0.5, height - 0.5),
        robots=robots.astype(float),
        units=units,
        places=units,
    )
    with tempfile.TemporaryDirectory() as folder:
        building.write_kiva(Path(folder), acceleration=1.0, lift_time=2.2, lasers=False)
        first = World.of_layout(laid, world="empty", model_paths=[folder])
    first.step_size = STEP
    checkpoint = first.checkpoint()
    others = [World() for _ in range(n - 1)]
    for world in others:
        world.restore(checkpoint)
    return Worlds.of([first, *others], threads), checkpoint


def _is_time(decision: float | str) -> bool:
    if isinstance(decision, bool | str) or not isinstance(decision, int | float):
        return False
    return bool(STEP <= decision <= LONGEST)


def motion_of(
    physics: str, task: Task, warehouses: Rware, n: int, decision: float | str, threads: int = 1
) -> Motion | None:
    """Returns how actions pass in time; None on the grid, where they take a step.

    Raises ValueError for another name than those of PHYSICS, or no time.
    """
    if physics not in PHYSICS:
        raise ValueError(f"physics is {physics!r}; one of {', '.join(PHYSICS)} was expected")
    if decision != "action" and not _is_time(decision):
        raise ValueError(
            f'decision is {decision!r}; "action" or seconds were expected, {STEP} to {LONGEST:g}'
        )
    if physics == "grid":
        return None
    if physics == "ideal":
        return IdealMotion(task, warehouses, n, decision)
    return BodyMotion(task, warehouses, n, decision, threads)
