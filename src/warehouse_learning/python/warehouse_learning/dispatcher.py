# SPDX-License-Identifier: Apache-2.0
"""A dispatcher as a Gymnasium environment: it says which task goes to which robot, and the fleet's
own planner (warehouse_fleet) drives them there."""

from collections.abc import Collection, Iterable, Iterator
from types import SimpleNamespace
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from numpy.typing import ArrayLike

from warehouse_fleet.hosts.fleet_driver import FleetDriver
from warehouse_fleet.transports.transports import NOWHERE, Kind, Transport
from warehouse_layout.floor import plan_reader
from warehouse_layout.floor.stations import PICK
from warehouse_learning import building, fields
from warehouse_learning.fields import Field
from warehouse_learning.grid import Grid
from warehouse_learning.options import Options
from warehouse_learning.page import Page
from warehouse_learning.picture import Picture
from warehouse_learning.screen import RENDER_MODES, Screen
from warehouse_learning.warehouses import ActionError

DECISION = 5.0  # unless options say otherwise [s]
SERVICE = 10.0  # of a unit at its station [s]
OLD = 300.0  # a task's age that counts as 1 [s]


class KivaDispatcherEnv(gymnasium.Env):
    """Action 0 waits; 1 + task * robots + robot gives that task to that robot, if it has none.

    A task is a storage unit that is to be brought to a picking station, served there for 10 s and
    stored again; `requests` tasks are open at any time. A decision lasts 5 simulated seconds, or
    `decision`. Reward: "delivered" for each unit that arrives, "refused" for a robot that is at
    work already, "step", "collided". Options as of warehouse_learning.Options; those about single
    robots' actions say nothing here. info["action_mask"] is (actions,) int8.
    """

    metadata = {"render_modes": RENDER_MODES, "render_fps": 4}

    def __init__(self, render_mode: str | None = None, **options: object) -> None:
        if options.get("continuous"):
            raise ValueError("continuous is for robots; a dispatcher gives tasks")
        options.setdefault("decision", DECISION)
        self.options = Options.of(options)
        worlds, self._checkpoint = building.build(1, self.options, threads=1)
        self._world = worlds[0]
        self._driver: Any = None
        robots, tasks = self.options.robots, self.options.requests
        self.fields = [
            Field("robot_position", (robots, 2), 0, 1, "floor", "1 is the last column or row"),
            Field("robot_free", (robots,), 0, 1, "", "1: it has no task"),
            Field("robot_loaded", (robots,), 0, 1, "", "1: it carries a unit"),
            Field("task_unit", (tasks, 2), 0, 1, "floor", "where the unit stands"),
            Field("task_station", (tasks, 2), 0, 1, "floor", "where it is to be brought"),
            Field("task_age", (tasks,), 0, 1, f"{OLD:g} s", "since it was asked for"),
        ]
        self.observation_space = spaces.Box(*fields.bounds(self.fields))
        self.action_space = spaces.Discrete(1 + robots * tasks)
        self.render_mode = render_mode
        self._grid = Grid(plan_reader.of_world(self._world), 0)
        self._scene = SimpleNamespace(worlds=[self._world], robots=robots, grid=self._grid)
        page = lambda: Page(self._world, self.options.title)  # noqa: E731
        asked = lambda: [task["shelf"] for task in self._tasks]  # noqa: E731
        self._screen = Screen(render_mode, lambda: Picture(self._scene), page, asked)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begins an episode; the same seed begins the same one. Returns (observation, info)."""
        super().reset(seed=seed)
        if self._driver:
            self._driver.close()
        self._world.restore(self._checkpoint)
        self._driver = FleetDriver(self._world)
        self._driver.transports.match_robots = self._match
        self._stations = [s for s in self._driver.plan.stations if s.kind == PICK]
        self._tasks: list[Any] = []
        self._released: dict[Any, Any] = {}
        self._wishes: dict[Any, Any] = {}
        self._cycle = self.delivered = 0
        while len(self._tasks) < self.options.requests:
            self._ask()
        self._screen.stepped()
        return self._observation(), self._info()

    def step(self, action: ArrayLike) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Assigns a task; returns (observation, reward, terminated, truncated, info).

        Raises ActionError for an invalid action.
        """
        if not self._driver:
            raise gymnasium.error.ResetNeeded("reset() begins the first episode")
        actions = np.asarray(action)
        if (
            actions.shape != ()
            or actions.dtype.kind not in "iu"
            or not 0 <= actions < self.action_space.n
        ):
            raise ActionError(
                f"dispatcher: action {action!r}; a whole number from 0 to"
                f" {self.action_space.n - 1} was expected"
            )
        refused = not self._assign(int(actions))
        collisions, before = self._driver.collisions, self.delivered
        end = self._driver.time + self.options.decision
        while self._driver.time < end - 1e-9:
            self._driver.step()
            self._hear()
            self._screen.moved()
        self._cycle += 1
        reward = self.options.rewards
        earned = (
            reward["step"]
            + reward["delivered"] * (self.delivered - before)
            + reward["refused"] * refused
            + reward["collided"] * (self._driver.collisions - collisions)
        )
        self._screen.stepped()
        ends = self._cycle >= self.options.max_cycles
        return self._observation(), float(earned), False, ends, self._info()

    def action_masks(self) -> np.ndarray:
        """Returns (actions,) bool, as sb3_contrib's MaskablePPO asks for."""
        free = np.tile(self._free(), self.options.requests)
        return np.concatenate([[True], free])

    def render(self) -> np.ndarray | None:
        """Returns the picture, (height, width, 3) uint8, or shows it on the page."""
        units = self._world.storage_units["shelf_id"]
        asked = [task["shelf"] for task in self._tasks]
        self._scene.requested = np.isin(units, asked)[None]
        self._scene.busy = ~self._free()[None]
        return self._screen.render()

    def close(self) -> None:
        """Closes the page, if there is one."""
        self._screen.close()
        if self._driver:
            self._driver.close()
            self._driver = None

    def _match(
        self, asked: Iterable[Transport], free: Collection[int]
    ) -> Iterator[tuple[Transport, int]]:
        """Transports and the robots assigned to them; a stuck robot starts once it is free."""
        for transport in asked:
            robot = self._wishes.get(transport.shelf, NOWHERE)
            if robot in free:
                del self._wishes[transport.shelf]
                yield transport, robot

    def _free(self) -> np.ndarray:
        """(robots,) bool: without a task."""
        free = np.ones(self.options.robots, bool)
        for transport in self._driver.transports:
            if transport.robot != NOWHERE:
                free[transport.robot] = False
        free[list(self._wishes.values())] = False
        return free

    def _assign(self, action: int) -> bool:
        """Whether that was possible."""
        if action == 0:
            return True
        number, robot = divmod(action - 1, self.options.robots)
        if not self._free()[robot]:
            return False
        task = self._tasks[number]
        answer = self._driver.transports.submit(task["shelf"], task["station"].name)
        if not answer.accepted:
            return False
        self._wishes[task["shelf"]] = robot
        del self._tasks[number]
        self._ask()
        return True

    def _ask(self) -> None:
        """One more task: a unit that stands in storage, to any station."""
        transports = self._driver.transports
        taken = {task["shelf"] for task in self._tasks} | {t.shelf for t in transports}
        units = [u for u, c in sorted(transports.cell_of_unit.items()) if c != NOWHERE]
        free = [u for u in units if u not in taken]
        if not free:  # all others are on the way: one that is comes again
            free = [u for u in sorted(transports.cell_of_unit) if u not in taken] or units
        self._tasks.append(
            {
                "shelf": free[self.np_random.integers(len(free))],
                "station": self._stations[self.np_random.integers(len(self._stations))],
                "since": self._driver.time,
            }
        )

    def _hear(self) -> None:
        time, transports = self._driver.time, self._driver.transports
        for event in transports.take_events():
            if event.kind == Kind.ARRIVED:
                self.delivered += 1
                self._released[event.transport_id] = time + SERVICE
        for number in [n for n, until in self._released.items() if time >= until]:
            del self._released[number]
            transports.release(number)

    def _observation(self) -> np.ndarray:
        grid, fleet = self._grid, self._world.fleet
        units = self._driver.transports.cell_of_unit
        at = [max(units[task["shelf"]], 0) for task in self._tasks]
        stations = [task["station"].service_cell for task in self._tasks]
        age = [(self._driver.time - task["since"]) / OLD for task in self._tasks]
        parts = (
            np.clip(grid.share_of(grid.cell_of(fleet.x, fleet.y)), 0, 1),
            self._free(),
            fleet.shelf_id > 0,
            grid.share_of(np.array(at)),
            grid.share_of(np.array(stations)),
            np.minimum(age, 1),
        )
        return np.concatenate([np.ravel(part) for part in parts]).astype(np.float32)

    def _info(self) -> dict[str, Any]:
        return {
            "action_mask": self.action_masks().astype(np.int8),
            "delivered": self.delivered,
            "time": self._driver.time,
        }
