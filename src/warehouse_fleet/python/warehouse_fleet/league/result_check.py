# SPDX-License-Identifier: Apache-2.0
"""Checks a result in the format of the League of Robot Runners against its problem."""

import concurrent.futures
import os
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from warehouse_fleet import Fleet, Rules, validate
from warehouse_fleet.league.problem import Problem, ProblemError, read_json
from warehouse_layout import Floor

LETTERS = {"W": 0, "F": 1, "R": 2, "C": 3, "T": 0}  # T: waited, for no plan came in time
MOST_FAULTS = 20


@dataclass
class Checked:
    """What a result is: `faults` are sentences, at most MOST_FAULTS of them."""

    robots: int
    ticks: int
    finished: int  # tasks, counted where the result lists its events
    faults: list[str] = field(default_factory=list)


def check(problem: Problem, path: str | PathLike[str], rules: Rules, threads: int = 0) -> Checked:
    """Returns what is wrong with the result in a file: starts, actions by the rules, tick after
    tick, and its tasks. threads: 0 for one a core. Raises ProblemError where the file can't be
    read."""
    path = Path(path)
    data = read_json(path)
    actions = _actions(path, data, len(problem.agents))
    robots, ticks = actions.shape
    checked = Checked(robots, ticks, int(data.get("numTaskFinished", 0)))
    _check_starts(problem, data, checked)
    cell, heading = _drive(problem, actions)
    floor = Floor(problem.passable)

    def faults_at(tick: int) -> list[str]:
        fleet = Fleet(cell[tick], heading[tick], np.full(checked.robots, -1, np.int32))
        violations = validate(floor, fleet, actions[:, tick : tick + 1], rules)
        return [f"tick {tick}: {v.describe(floor)}" for v in violations[:MOST_FAULTS]]

    with concurrent.futures.ThreadPoolExecutor(threads or os.cpu_count()) as pool:
        for faults in pool.map(faults_at, range(checked.ticks)):
            checked.faults += faults
            if len(checked.faults) >= MOST_FAULTS:
                pool.shutdown(cancel_futures=True)
                break
    if not checked.faults:
        _check_tasks(problem, data, cell, checked)
    del checked.faults[MOST_FAULTS:]
    return checked


def _actions(path: Path, data: dict[str, Any], robots: int) -> NDArray[np.uint8]:
    """Returns the actions, (robots, ticks)."""
    paths = data.get("actualPaths")
    if not isinstance(paths, list) or len(paths) != robots:
        raise ProblemError(
            f"{path}: actualPaths; a list with a path for each of {robots} robots was expected"
        )
    rows = []
    for robot, text in enumerate(paths):
        letters = text.split(",") if text else []
        wrong = set(letters) - set(LETTERS)
        if wrong:
            raise ProblemError(
                f"{path}: actualPaths[{robot}] has '{sorted(wrong)[0]}'; F, R, C, W or T was "
                "expected"
            )
        rows.append([LETTERS[letter] for letter in letters])
        if len(rows[-1]) != len(rows[0]):
            raise ProblemError(
                f"{path}: actualPaths[{robot}] has {len(rows[-1])} actions; {len(rows[0])}, as of "
                "robot 0, were expected"
            )
    return np.array(rows, np.uint8)


def _check_starts(problem: Problem, data: dict[str, Any], checked: Checked) -> None:
    width = problem.passable.shape[1]
    for robot, (start, cell) in enumerate(zip(data.get("start", []), problem.agents, strict=False)):
        expected = [*divmod(int(cell), width), "E"]
        if start != expected:
            checked.faults.append(f"robot {robot} starts at {start}; {expected} was expected")


def _drive(
    problem: Problem, actions: NDArray[np.uint8]
) -> tuple[NDArray[np.int32], NDArray[np.uint8]]:
    """Returns where robots stand before each tick and after the last, (ticks + 1, robots) cells,
    clipped to the map where an action would leave it; and their headings."""
    turns = np.array([0, 0, 1, 3], np.uint8)[actions.T]
    first = np.zeros((1, actions.shape[0]), np.uint8)
    heading = np.concatenate([first, np.cumsum(turns, axis=0, dtype=np.uint8)]) & 3
    width = problem.passable.shape[1]
    step = np.array([1, width, -1, -width], np.int32)[heading[:-1]] * (actions.T == 1)
    cell = np.cumsum(np.concatenate([problem.agents[None], step]), axis=0, dtype=np.int32)
    return np.clip(cell, 0, problem.passable.size - 1), heading


def _check_tasks(
    problem: Problem, data: dict[str, Any], cell: NDArray[np.int32], checked: Checked
) -> None:
    """Counts the tasks whose errands were done in order, each by the robot in its cell, once the
    task was revealed."""
    events = [event for event in data.get("events", []) if len(event) == 4]
    if not events or not all(isinstance(part, int) for part in events[0]):
        return  # the format of 2023 does not list errands
    done: dict[int, int] = {}
    finished = 0
    for tick, robot, task, errand in events:
        if task >= problem.revealed + finished:
            checked.faults.append(
                f"tick {tick}: task {task} was not revealed yet: {problem.revealed} are known at a "
                f"time, and {finished} were done"
            )
            continue
        errands = problem.errands(task)
        is_there = (
            0 <= tick < len(cell)
            and done.get(task, 0) == errand - 1 < len(errands)
            and cell[tick, robot] == errands[errand - 1]
        )
        if not is_there:
            checked.faults.append(
                f"tick {tick}: errand {errand} of task {task} was not done by robot {robot}"
            )
            continue
        done[task] = errand
        finished += errand == len(errands)
    if finished != checked.finished:
        checked.faults.append(f"numTaskFinished is {checked.finished}; {finished} were done")
