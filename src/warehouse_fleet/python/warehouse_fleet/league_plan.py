# SPDX-License-Identifier: Apache-2.0
"""Reads plans of the League of Robot Runners: the results of planners, on a map.

A location is row * width + column. Rows count downwards, headings quarter turns from east,
clockwise.
"""

from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from warehouse_fleet._core import Fleet, Rules, validate
from warehouse_fleet.problem import Problem, ProblemError, read, read_map
from warehouse_fleet.problem import _field as field_of  # noqa: PLC2701
from warehouse_fleet.problem import _json as json_of  # noqa: PLC2701
from warehouse_layout import Floor

LETTERS = "WFRC"  # by Action
COMPASS = "ESWN"  # by heading


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

    ticks: so many of the plan, from its begin; 0: all.
    """
    data = json_of(Path(path))
    problem, passable = _floor_of(Path(floor))
    actions = _actions(path, data)[:, : ticks or None]
    start, heading = _starts(path, data, passable.shape, len(actions), problem)
    plan = LeaguePlan(passable, start, heading, actions, str(path))
    _check(plan)
    return plan


def _floor_of(path: Path) -> tuple[Problem | None, NDArray[np.bool_]]:
    if path.suffix == ".map":
        return None, read_map(path)
    problem = read(path)
    return problem, problem.passable


def _actions(path: str | PathLike[str], data: dict[str, Any]) -> NDArray[np.uint8]:
    """Returns the actions (robots, ticks); robots whose part is shorter wait at its end."""
    paths = field_of(Path(path), data, "actualPaths", list)
    rows = [_row(path, robot, text) for robot, text in enumerate(paths)]
    if not rows:
        raise ProblemError(f"{path}: actualPaths is empty; a text for each robot was expected")
    actions = np.zeros((len(rows), max(map(len, rows))), np.uint8)
    for robot, row in enumerate(rows):
        actions[robot, : len(row)] = row
    return actions


def _row(path: str | PathLike[str], robot: int, text: Any) -> NDArray[np.uint8]:
    """Returns the actions of a text such as "F,R,W"."""
    where = f"{path}: actualPaths[{robot}]"
    if not isinstance(text, str):
        raise ProblemError(f"{where} is {text!r:.40}; a text as 'F,R,C,W' was expected")
    letters = text.split(",") if text else []
    wrong = next((i for i, one in enumerate(letters) if one not in LETTERS or not one), None)
    if wrong is not None:
        raise ProblemError(
            f"{where}: '{letters[wrong]:.20}' at tick {wrong}; one of F, R, C, W was expected"
        )
    return np.array([LETTERS.index(one) for one in letters], np.uint8)


def _starts(
    path: str | PathLike[str],
    data: dict[str, Any],
    shape: tuple[int, ...],
    robots: int,
    problem: Problem | None,
) -> tuple[NDArray[np.int32], NDArray[np.uint8]]:
    """Returns locations and headings at the start: the plan's, else those of its problem."""
    size = field_of(Path(path), data, "teamSize", int, robots)
    if size != robots:
        raise ProblemError(f"{path}: teamSize is {size}; actualPaths has {robots} robots")
    if "start" not in data and problem is not None:
        if len(problem.agents) != robots:
            raise ProblemError(
                f"{path}: actualPaths has {robots} robots; "
                f"{problem.source} has {len(problem.agents)}"
            )
        return problem.agents, np.zeros(robots, np.uint8)
    entries = field_of(Path(path), data, "start", list)
    if len(entries) != robots:
        raise ProblemError(f"{path}: start has {len(entries)} robots; actualPaths has {robots}")
    found = [_start(path, robot, entry, shape) for robot, entry in enumerate(entries)]
    locations, headings = zip(*found)
    if problem is not None and not np.array_equal(problem.agents[:robots], locations):
        robot = int(np.flatnonzero(np.not_equal(problem.agents[:robots], locations[: len(problem.agents)]))[0])
        raise ProblemError(f"{path}: start[{robot}] is {entries[robot]}; {problem.source} has another")
    return np.array(locations, np.int32), np.array(headings, np.uint8)


def _start(
    path: str | PathLike[str], robot: int, entry: Any, shape: tuple[int, ...]
) -> tuple[int, int]:
    """Returns the location and the heading of an entry [row, column, letter]."""
    is_right = (
        isinstance(entry, list)
        and len(entry) == 3
        and all(type(value) is int and 0 <= value < most for value, most in zip(entry, shape))
        and isinstance(entry[2], str)
        and entry[2] in COMPASS
        and len(entry[2]) == 1
    )
    if not is_right:
        raise ProblemError(
            f"{path}: start[{robot}] is {entry!r:.60}; [row, column, E, S, W or N] on a map of "
            f"{shape[0]} rows and {shape[1]} columns was expected"
        )
    return entry[0] * shape[1] + entry[1], COMPASS.index(entry[2])


def _check(plan: LeaguePlan) -> None:
    """Raises ProblemError where robots would be in walls, in one cell, or swap cells."""
    walls = np.flatnonzero(~plan.passable.flat[plan.start])
    if walls.size:
        robot = int(walls[0])
        row, column = divmod(int(plan.start[robot]), plan.passable.shape[1])
        raise ProblemError(f"{plan.source}: start[{robot}]: row {row}, column {column} is a wall")
    floor = Floor(plan.passable)
    fleet = Fleet(plan.start, plan.heading, plan.start)
    found = validate(floor, fleet, plan.actions, Rules(rings=True), -1)
    if found:
        raise ProblemError(f"{plan.source}: actualPaths: {found[0].describe(floor, [])}")
