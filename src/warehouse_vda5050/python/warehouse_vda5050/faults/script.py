# SPDX-License-Identifier: Apache-2.0
"""A script of faults with times, as a YAML file.

    - {at: 10, vehicle: 1, fault: lost, seconds: 20}
    - {at: 60, vehicle: 2, fault: "error:WARNING"}
    - {at: 90, vehicle: 2, fault: ""}

at: seconds since the first robot became a vehicle; vehicle: the number of the robot; seconds: how
long it lasts, 0 or left out: until it is ended. All times are wall clock.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from warehouse_layout.file import user_file
from warehouse_vda5050.faults.kinds import FaultError, FaultRequest, read_request

FIELDS = ("at", "vehicle", "fault", "seconds")
MOST_NUMBER = 1_000_000  # of a robot, as in the world


class ScriptError(ValueError):
    """A file that can't be read; the message names file, line and field."""


@dataclass(frozen=True)
class ScriptedFault:
    """A line of a script. `where` names file and line for people."""

    at: float
    vehicle: int
    request: FaultRequest
    where: str


class FaultScript:
    """Faults in the order of their times."""

    def __init__(self, faults: list[ScriptedFault]) -> None:
        self._left = sorted(faults, key=lambda fault: fault.at, reverse=True)

    def due(self, seconds: float) -> Iterator[ScriptedFault]:
        """Yields the faults of up to `seconds` since the beginning, each once."""
        while self._left and self._left[-1].at <= seconds:
            yield self._left.pop()


def read(path: Path) -> FaultScript:
    """Returns the script in a file. Raises ScriptError."""
    try:
        return _script(path, user_file.read_text(path))
    except yaml.MarkedYAMLError as error:
        line = error.problem_mark.line + 1 if error.problem_mark else 1
        raise ScriptError(f"{path}:{line}: {error.problem}") from error
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise ScriptError(f"{path}: {error}") from error


def _script(path: Path, text: str) -> FaultScript:
    root = yaml.compose(text, yaml.SafeLoader)
    if not isinstance(root, yaml.SequenceNode):
        line = root.start_mark.line + 1 if root else 1
        raise ScriptError(f"{path}:{line}: a list of {{at, vehicle, fault, seconds}} was expected")
    return FaultScript([_entry(f"{path}:{node.start_mark.line + 1}", node) for node in root.value])


def _entry(where: str, node: yaml.Node) -> ScriptedFault:
    fields = _fields(where, node)
    for name in FIELDS[:3]:
        if name not in fields:
            raise ScriptError(f"{where}: {name} is missing")
    vehicle, fault = fields["vehicle"], fields["fault"]
    if isinstance(vehicle, bool) or not isinstance(vehicle, int):
        raise ScriptError(f"{where}: vehicle is {vehicle!r}; the number of a robot was expected")
    if not 1 <= vehicle <= MOST_NUMBER:
        raise ScriptError(f"{where}: vehicle is {vehicle}; 1 to {MOST_NUMBER} was expected")
    if not isinstance(fault, str):
        raise ScriptError(f"{where}: fault is {fault!r}; the name of a fault was expected")
    at, seconds = _number(where, "at", fields["at"]), fields.get("seconds", 0)
    try:
        request = read_request(fault, _number(where, "seconds", seconds))
    except FaultError as error:
        raise ScriptError(f"{where}: {error}") from error
    return ScriptedFault(at, vehicle, request, where)


def _fields(where: str, node: yaml.Node) -> dict[str, Any]:
    value = yaml.SafeLoader("").construct_document(node)
    if not isinstance(value, dict):
        raise ScriptError(f"{where}: {{at, vehicle, fault, seconds}} was expected, not {value!r}")
    for name in value:
        if name not in FIELDS:
            raise ScriptError(f"{where}: unknown field {name!r}; known are {', '.join(FIELDS)}")
    return value


def _number(where: str, name: str, value: Any) -> float:
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not is_number or not math.isfinite(value) or value < 0:
        raise ScriptError(f"{where}: {name} is {value!r}; seconds, 0 or more, were expected")
    return float(value)
