# SPDX-License-Identifier: Apache-2.0
"""Reads and writes problems of the League of Robot Runners.

A location is row * width + column. Rows count downwards, so the turn from +x towards +y is
clockwise.
"""

import json
import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from warehouse_fleet.league.delays import DURATIONS, EVENTS, DelayModel
from warehouse_layout.file import user_file

PASSABLE, WALLS = ".ESG", "@TOW"  # the letters of a map


class ProblemError(Exception):
    """A file can't be used; the text names the file, the line and what was expected."""


@dataclass
class Problem:
    """A floor, robots on it, and tasks for them."""

    passable: NDArray[np.bool_]  # (rows, columns)
    agents: NDArray[np.int32]  # the location of each robot, (robots,); all face east
    tasks: list[list[int]]  # the locations of each task, to be visited in order
    round_robin: bool = False  # task k belongs to robot k mod robots
    reveal: float = 1.0  # tasks revealed at a time, as a multiple of the number of robots
    repeats: bool = False  # after the last task comes the first one again
    delays: DelayModel | None = None
    source: str = field(default="", repr=False)  # the path of its file

    @property
    def revealed(self) -> float:
        """How many unfinished tasks are known at a time, the robots' own among them."""
        if self.round_robin:
            return math.inf
        return max(1, int(self.reveal * len(self.agents)))

    def errands(self, task: int) -> list[int]:
        """Returns the locations of a task, to be visited in order."""
        return self.tasks[task % len(self.tasks) if self.repeats else task]


def read(path: str | PathLike[str]) -> Problem:
    """Reads a problem from a JSON file and the files that it names; raises ProblemError."""
    path = Path(path)
    data = read_json(path)
    passable = read_map(path.parent / _field(path, data, "mapFile", str))
    agent_file = "robotFile" if "robotFile" in data and "agentFile" not in data else "agentFile"
    agents = _numbers(path.parent / _field(path, data, agent_file, str), one_a_line=True)
    tasks = _numbers(path.parent / _field(path, data, "taskFile", str), one_a_line=False)
    robots = _field(path, data, "teamSize", int, len(agents.lines))
    if not 1 <= robots <= len(agents.lines):
        raise ProblemError(
            f"{path}: teamSize is {robots}; 1 to {len(agents.lines)}, the robots of "
            f"{agents.path}, was expected"
        )
    strategy = _field(path, data, "taskAssignmentStrategy", str, "greedy")
    if strategy not in ("greedy", "roundrobin", "roundrobin-fixed"):
        raise ProblemError(
            f"{path}: taskAssignmentStrategy is '{strategy}'; roundrobin, roundrobin-fixed or "
            "greedy was expected"
        )
    reveal = _field(path, data, "numTasksReveal", (int, float), 1)
    if not reveal > 0:
        raise ProblemError(f"{path}: numTasksReveal is {reveal}; more than 0 was expected")
    agents.lines = agents.lines[:robots]
    agents.check(passable)
    agents.check_distinct()
    tasks.check(passable)
    if not tasks.lines:
        raise ProblemError(f"{tasks.path}: 0 tasks; 1 or more was expected")
    return Problem(
        passable,
        np.array([line[0] for _, line in agents.lines], np.int32),
        [line for _, line in tasks.lines],
        strategy != "greedy",
        float(reveal),
        strategy != "roundrobin-fixed",
        _delays(path, data),
        str(path),
    )


def _delays(path: Path, data: dict[str, Any]) -> DelayModel | None:
    """Returns what the problems of 2026 call delayConfig; None if there is none."""
    if "delayConfig" not in data:
        return None
    config = _field(path, data, "delayConfig", dict)
    ticks = _field(path, data, "agentCounter", int, 1)
    least, most = (_field(path, config, name, int) for name in ("minDelay", "maxDelay"))
    chance = _field(path, config, "pDelay", (int, float))
    events = _field(path, config, "eventModel", str, EVENTS[0])
    durations = _field(path, config, "durationModel", str, DURATIONS[0])
    mean = _field(path, config, "gaussMeanRatio", (int, float), 0.5)
    deviation = _field(path, config, "gaussStdRatio", (int, float), 0.2)
    for name, value, is_right, expected in (
        ("agentCounter", ticks, ticks >= 1, "1 or more"),
        ("minDelay", least, least >= 1, "1 or more"),
        ("maxDelay", most, most >= least, f"at least minDelay, {least},"),
        ("pDelay", chance, 0 <= chance <= 1, "0 to 1"),
        ("eventModel", events, events in EVENTS, " or ".join(EVENTS)),
        ("durationModel", durations, durations in DURATIONS, " or ".join(DURATIONS)),
        ("gaussMeanRatio", mean, 0 <= mean <= 1, "0 to 1"),
        ("gaussStdRatio", deviation, deviation >= 0, "0 or more"),
    ):
        if not is_right:
            raise ProblemError(f"{path}: {name} is {value!r}; {expected} was expected")
    seed = _field(path, config, "seed", int, 0)
    return DelayModel(seed, least, most, events, chance, durations, mean, deviation, ticks)


def read_map(path: str | PathLike[str]) -> NDArray[np.bool_]:
    """Returns where robots can drive, (rows, columns); raises ProblemError."""
    lines = _text(path).splitlines()
    size = {}
    for number, expected in enumerate(("type", "height", "width", "map"), 1):
        words = lines[number - 1].split() if len(lines) >= number else []
        if not words or words[0] != expected:
            raise ProblemError(f"{path}:{number}: a line '{expected} …' was expected")
        if expected in ("height", "width"):
            size[expected] = _integer(words[1] if len(words) == 2 else "", path, number, 1)
    rows = lines[4 : 4 + size["height"]]
    if len(rows) < size["height"]:
        raise ProblemError(
            f"{path}:{len(lines)}: {size['height']} rows were expected, {len(rows)} are there"
        )
    for number, row in enumerate(rows, 5):
        if len(row) != size["width"]:
            raise ProblemError(
                f"{path}:{number}: {len(row)} cells; width {size['width']} was expected"
            )
        for column, cell in enumerate(row):
            if cell not in PASSABLE + WALLS:
                raise ProblemError(
                    f"{path}:{number}: '{cell}' in column {column}; "
                    f"one of {PASSABLE}{WALLS} was expected"
                )
    return np.array([[cell in PASSABLE for cell in row] for row in rows])


class _Lines:
    """The locations in a file of robots or tasks: (number of the line, locations in it)."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.lines: list[tuple[int, list[int]]] = []

    def check(self, passable: NDArray[np.bool_]) -> None:
        """Raises ProblemError for a location outside the map or in a wall."""
        for number, locations in self.lines:
            for location in locations:
                if not 0 <= location < passable.size:
                    raise ProblemError(
                        f"{self.path}:{number}: location {location}; "
                        f"0 to {passable.size - 1} was expected"
                    )
                if not passable.flat[location]:
                    raise ProblemError(f"{self.path}:{number}: location {location} is in a wall")

    def check_distinct(self) -> None:
        """Raises ProblemError for a location that occurs twice."""
        first: dict[int, int] = {}  # the line of each location
        for number, (location,) in self.lines:
            if location in first:
                raise ProblemError(
                    f"{self.path}:{number}: location {location} has a robot already, "
                    f"of line {first[location]}"
                )
            first[location] = number


def _numbers(path: Path, one_a_line: bool) -> _Lines:
    result = _Lines(path)
    count = None
    for number, line in enumerate(_text(path).splitlines(), 1):
        text = line.split("#", 1)[0].strip()
        if not text:
            continue
        values = [_integer(word, path, number, 0) for word in text.replace(",", " ").split()]
        if (one_a_line or count is None) and len(values) != 1:
            raise ProblemError(f"{path}:{number}: one number was expected")
        if count is None:
            count = values[0]
        elif len(result.lines) < count:
            result.lines.append((number, values))
    if count is None:
        raise ProblemError(f"{path}:1: the number of lines that follow was expected")
    if len(result.lines) < count:
        raise ProblemError(f"{path}: {count} lines were announced, {len(result.lines)} are there")
    return result


def _integer(word: str, path: str | PathLike[str], number: int, least: int) -> int:
    try:
        value = int(word)
    except ValueError:
        value = least - 1
    if value < least:
        raise ProblemError(f"{path}:{number}: '{word}'; a whole number from {least} was expected")
    return value


def _text(path: str | PathLike[str]) -> str:
    try:
        return user_file.read_text(path)
    except (OSError, UnicodeDecodeError) as error:
        raise ProblemError(f"{path}: {getattr(error, 'strerror', None) or error}") from error


def read_json(path: Path) -> dict[str, Any]:
    """Returns the JSON object in a file; raises ProblemError."""
    try:
        data = json.loads(_text(path))
    except json.JSONDecodeError as error:
        raise ProblemError(f"{path}:{error.lineno}: {error.msg}; JSON was expected") from error
    if not isinstance(data, dict):
        raise ProblemError(f"{path}:1: a JSON object was expected")
    return data


_MISSING = object()


def _field(
    path: Path,
    data: dict[str, Any],
    name: str,
    kind: type | tuple[type, ...],
    default: Any = _MISSING,
) -> Any:
    """Returns a field of the JSON object if it is of that kind; raises ProblemError."""
    value = data.get(name, default)
    if value is _MISSING:
        raise ProblemError(f"{path}: there is no '{name}'")
    if isinstance(value, bool) or not isinstance(value, kind):
        names: dict[Any, str] = {str: "a text", int: "a whole number", dict: "an object"}
        expected = names.get(kind, "a number")
        raise ProblemError(f"{path}: {name} is {json.dumps(value)}; {expected} was expected")
    return value


def write_problem(
    folder: str | PathLike[str],
    name: str,
    passable: NDArray[np.bool_],
    agents: Sequence[int] | NDArray[np.integer[Any]],
    tasks: Sequence[Iterable[int]],
    round_robin: bool = True,
    reveal: float = 1,
) -> Path:
    """Writes the four files of a problem into `folder`, which is created if it does not exist.
    Returns the path of the file for read(). The arguments are as the fields of Problem."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    rows = ["".join("." if cell else "@" for cell in row) for row in passable]
    head = f"type octile\nheight {passable.shape[0]}\nwidth {passable.shape[1]}\nmap\n"
    (folder / f"{name}.map").write_text(head + "\n".join(rows) + "\n")
    (folder / f"{name}.agents").write_text("\n".join(map(str, [len(agents), *agents])) + "\n")
    lines = [",".join(map(str, task)) for task in tasks]
    (folder / f"{name}.tasks").write_text("\n".join([str(len(tasks)), *lines]) + "\n")
    data = {
        "mapFile": f"{name}.map",
        "agentFile": f"{name}.agents",
        "taskFile": f"{name}.tasks",
        "teamSize": len(agents),
        "numTasksReveal": reveal,
    }
    if round_robin:
        data["taskAssignmentStrategy"] = "roundrobin"
    path = folder / f"{name}.json"
    path.write_text(json.dumps(data, indent=1) + "\n")
    return path
