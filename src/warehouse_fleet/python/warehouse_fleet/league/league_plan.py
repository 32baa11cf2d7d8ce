# SPDX-License-Identifier: Apache-2.0
"""Reads plans of the League of Robot Runners: the results of planners, on a map.

A location is row * width + column. Rows count downwards, headings quarter turns from east,
clockwise.
"""

import json
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from warehouse_fleet._core import Fleet, Rules, validate
from warehouse_fleet.league.problem import Problem, ProblemError, read, read_map
from warehouse_layout import Floor
from warehouse_layout.file import user_file

MOST_BYTES = 2_000_000_000  # of a result: 10,000 robots for 100,000 ticks
ACTIONS = {"W": 0, "F": 1, "R": 2, "C": 3}  # rows count downwards, so R is Action's positive turn
HEADINGS = {"E": 0, "S": 1, "W": 2, "N": 3}


@dataclass
class LeaguePlan:
    """What robots do on a floor, tick by tick; free of conflicts, but rings are allowed."""

    passable: NDArray[np.bool_]  # (rows, columns)
    start: NDArray[np.int32]  # (robots,) locations
    heading: NDArray[np.uint8]  # (robots,) at the start
    actions: NDArray[np.uint8]  # (robots, ticks) of Action
    source: str = ""  # the path of its file

    @property
    def ticks(self) -> int:
        """How many ticks it lasts."""
        return self.actions.shape[1]

    def locations(self) -> NDArray[np.int32]:
        """Returns where robots are before each tick and after the last, (robots, ticks + 1)."""
        turns = np.array([0, 0, 1, 3], np.uint8)[self.actions]
        heading = np.cumsum(turns, axis=1, dtype=np.uint8) + self.heading[:, None]
        width = self.passable.shape[1]
        ahead = np.array([1, width, -1, -width], np.int32)[heading & 3]
        ahead[self.actions != 1] = 0  # a robot that drives does not turn at that tick
        moves = np.cumsum(ahead, axis=1, dtype=np.int32)
        return np.concatenate([self.start[:, None], self.start[:, None] + moves], axis=1)


def read_plan(path: str | PathLike[str], floor: str | PathLike[str], ticks: int = 0) -> LeaguePlan:
    """Reads a plan, JSON, on the floor of a problem (JSON) or of a map; raises ProblemError.

    ticks: number of ticks to read, from the plan's begin; 0: all.
    """
    floor = Path(floor)
    problem = None if floor.suffix == ".map" else read(floor)
    passable = read_map(floor) if problem is None else problem.passable
    result = _Result(Path(path))
    actions = result.actions()
    start, heading = result.starts(len(actions), passable, problem)
    plan = LeaguePlan(passable, start, heading, actions[:, : ticks or None], str(path))
    _check_conflicts(plan)
    return plan


class _Result:
    """The fields of a result's file; each method raises ProblemError."""

    def __init__(self, path: Path) -> None:
        self._path = path
        try:
            self._data = json.loads(user_file.read_text(path, most=MOST_BYTES))
        except (OSError, UnicodeDecodeError) as error:
            self._fail(getattr(error, "strerror", None) or str(error))
        except json.JSONDecodeError as error:
            raise ProblemError(f"{path}:{error.lineno}: {error.msg}; JSON was expected") from error
        if not isinstance(self._data, dict):
            self._fail("a JSON object was expected")

    def _fail(self, text: str) -> NoReturn:
        raise ProblemError(f"{self._path}: {text}")

    def _list(self, name: str) -> list[Any]:
        if name not in self._data:
            self._fail(f"there is no '{name}'; a result of a planner was expected")
        value = self._data[name]
        if not isinstance(value, list) or not value:
            self._fail(f"{name} is {_short(value)}; a list with an entry a robot was expected")
        return value

    def actions(self) -> NDArray[np.uint8]:
        """Returns the actions (robots, ticks); robots whose part is shorter wait at its end."""
        texts = self._list("actualPaths")
        robots = self._data.get("teamSize", len(texts))
        if robots != len(texts):
            self._fail(f"teamSize is {_short(robots)}; actualPaths has {len(texts)} robots")
        rows = [self._row(robot, text) for robot, text in enumerate(texts)]
        actions = np.zeros((len(rows), max(map(len, rows))), np.uint8)
        for robot, row in enumerate(rows):
            actions[robot, : len(row)] = row
        if not actions.size:
            self._fail("actualPaths has no ticks; texts such as 'F,R,C,W' were expected")
        return actions

    def _row(self, robot: int, text: Any) -> list[int]:
        """Returns the actions of a text such as "F,R,W"."""
        where = f"actualPaths[{robot}]"
        if not isinstance(text, str):
            self._fail(f"{where} is {_short(text)}; a text such as 'F,R,C,W' was expected")
        letters = text.split(",") if text else []
        for tick, letter in enumerate(letters):
            if letter not in ACTIONS:
                self._fail(f"{where}: {_short(letter)} at tick {tick}; F, R, C or W was expected")
        return [ACTIONS[letter] for letter in letters]

    def starts(
        self, robots: int, passable: NDArray[np.bool_], problem: Problem | None
    ) -> tuple[NDArray[np.int32], NDArray[np.uint8]]:
        """Returns locations and headings at the start; they must be those of the problem."""
        entries = self._list("start")
        if len(entries) != robots:
            self._fail(f"start has {len(entries)} robots; actualPaths has {robots}")
        start, heading = zip(*(self._start(i, row, passable) for i, row in enumerate(entries)))
        first: dict[int, int] = {}
        for robot, location in enumerate(start):
            if first.setdefault(location, robot) != robot:
                self._fail(f"start[{robot}] is where start[{first[location]}] is")
        if problem is not None:
            self._check_agents(start, problem)
        return np.array(start, np.int32), np.array(heading, np.uint8)

    def _check_agents(self, start: tuple[int, ...], problem: Problem) -> None:
        agents = problem.agents.tolist()
        if len(agents) != len(start):
            self._fail(f"start has {len(start)} robots; {problem.source} has {len(agents)}")
        for robot, (here, there) in enumerate(zip(start, agents)):
            if here != there:
                columns = problem.passable.shape[1]
                self._fail(
                    f"start[{robot}] is row {here // columns}, column {here % columns}; in "
                    f"{problem.source} it is row {there // columns}, column {there % columns}"
                )

    def _start(self, robot: int, entry: Any, passable: NDArray[np.bool_]) -> tuple[int, int]:
        """Returns the location and the heading of an entry [row, column, letter]."""
        rows, columns = passable.shape
        match entry:
            case [int(row), int(column), "E" | "S" | "W" | "N" as letter] if (
                0 <= row < rows and 0 <= column < columns
            ):
                is_free = passable[row, column]
            case _:
                self._fail(
                    f"start[{robot}] is {_short(entry)}; [row, column, E, S, W or N] on a map of "
                    f"{rows} rows and {columns} columns was expected"
                )
        if not is_free:
            self._fail(f"start[{robot}] is {_short(entry)}, which is a wall of the map")
        return row * columns + column, HEADINGS[letter]


def _short(value: Any) -> str:
    """Returns a value as JSON, cut where it is long."""
    text = json.dumps(value)
    return text if len(text) <= 40 else f"{text[:37]}..."


def _check_conflicts(plan: LeaguePlan) -> None:
    """Raises ProblemError where robots would be in walls, in one cell, or exchange their cells."""
    fleet = Fleet(plan.start, plan.heading, plan.start)
    floor = Floor(plan.passable)
    violations = validate(floor, fleet, plan.actions, Rules(rings=True))
    if violations:
        raise ProblemError(f"{plan.source}: actualPaths: {violations[0].describe(floor)}")
