# SPDX-License-Identifier: Apache-2.0
"""Reads the file that says which robots are vehicles behind a broker.

    21: {manufacturer: acme, serial: "0007", origin: [4.0, 2.0, 1.5708]}
    22: {manufacturer: acme, serial: "0008", action_parameters: {stationType: floor}}

The number is the robot's in the warehouse (kiva21); origin is where the vehicle's own map has its
zero point in the frame world, x y [m] theta [rad]; action_parameters go with each pick and drop.
map_id is the mapId of its orders, if not the one that it reports, and node_ids the pattern of its
node ids, if not c{column}_{row}.
"""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from warehouse_layout.file import user_file
from warehouse_vda5050.master.frame import Frame
from warehouse_vda5050.topics import Identity, TopicError

MOST_NUMBER = 1_000_000  # of a robot, as in the world
FIELDS = ("manufacturer", "serial", "origin", "action_parameters", "map_id", "node_ids")
NODE_IDS = "c{column}_{row}"
PATTERN = re.compile(r"[^{}]*\{column\}[^{}]+\{row\}[^{}]*|[^{}]*\{row\}[^{}]+\{column\}[^{}]*")


class RobotsFileError(ValueError):
    """A file that can't be read; the message names file, robot and field."""


@dataclass(frozen=True)
class RemoteRobot:
    """A robot of the warehouse that is a vehicle behind the broker."""

    number: int
    identity: Identity
    frame: Frame = Frame()
    action_parameters: Mapping[str, Any] = field(default_factory=dict)
    map_id: str = ""  # of its orders; '': the one that it reports
    node_ids: str = NODE_IDS  # pattern of the ids of nodes

    def node_id(self, cell: tuple[int, int]) -> str:
        """Returns the id of the node in a cell."""
        return self.node_ids.format(column=cell[0], row=cell[1])

    def entry(self) -> dict[str, Any]:
        """Returns the fields of its entry in a file."""
        fields: dict[str, Any] = {
            "manufacturer": self.identity.manufacturer,
            "serial": self.identity.serial,
            "origin": [round(value, 6) for value in (self.frame.x, self.frame.y, self.frame.theta)],
        }
        if self.action_parameters:
            fields["action_parameters"] = dict(self.action_parameters)
        if self.map_id:
            fields["map_id"] = self.map_id
        return fields if self.node_ids == NODE_IDS else fields | {"node_ids": self.node_ids}


def read(path: Path) -> list[RemoteRobot]:
    """Returns the robots of a file, by number. Raises RobotsFileError."""
    try:
        entries = yaml.safe_load(user_file.read_text(path))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise RobotsFileError(f"{path}: {error}") from error
    if not isinstance(entries, dict) or not entries:
        raise RobotsFileError(
            f"{path}: robots were expected, number: {{manufacturer: …, serial: …}}"
        )
    return robots_of(path, entries)


def robots_of(path: Path, entries: Mapping[Any, Any]) -> list[RemoteRobot]:
    """Returns the robots of entries by number, as a file has them. Raises RobotsFileError."""
    robots = [read_robot(f"{path}: robot {n}", n, entry) for n, entry in entries.items()]
    _check_distinct(path, robots)
    return sorted(robots, key=lambda robot: robot.number)


def read_robot(where: str, number: Any, entry: Any) -> RemoteRobot:
    """Returns the robot of one entry; `where` stands before faults. Raises RobotsFileError."""
    if isinstance(number, bool) or not isinstance(number, int) or not 1 <= number <= MOST_NUMBER:
        raise RobotsFileError(f"{where}: its number must be whole, from 1 to {MOST_NUMBER}")
    if not isinstance(entry, dict):
        raise RobotsFileError(f"{where}: manufacturer and serial were expected, not {entry!r}")
    for name in entry:
        if name not in FIELDS:
            raise RobotsFileError(f"{where}: unknown field {name!r}; known are {', '.join(FIELDS)}")
    try:
        identity = Identity(_text(where, entry, "manufacturer"), _text(where, entry, "serial"))
    except TopicError as error:
        raise RobotsFileError(f"{where}: {error}") from error
    parameters = entry.get("action_parameters", {})
    if not isinstance(parameters, dict):
        raise RobotsFileError(f"{where}: action_parameters must be names with values")
    map_id = _text(where, entry, "map_id") if "map_id" in entry else ""
    node_ids = _text(where, entry, "node_ids") if "node_ids" in entry else NODE_IDS
    if not PATTERN.fullmatch(node_ids):
        raise RobotsFileError(
            f"{where}: node_ids is {node_ids!r}; a pattern such as {NODE_IDS} was expected"
        )
    frame = _frame(where, entry.get("origin", [0, 0, 0]))
    return RemoteRobot(number, identity, frame, parameters, map_id, node_ids)


def _text(where: str, entry: Mapping[str, Any], name: str) -> str:
    value = entry.get(name)
    if not isinstance(value, str):
        hint = "; put it in quotes" if isinstance(value, int) else ""
        raise RobotsFileError(f"{where}: {name} must be a text, not {value!r}{hint}")
    return value


def _frame(where: str, origin: Any) -> Frame:
    numbers = origin if isinstance(origin, list) else []
    is_number = [isinstance(n, (int, float)) and not isinstance(n, bool) for n in numbers]
    if len(numbers) != 3 or not all(is_number) or not all(map(math.isfinite, numbers)):
        raise RobotsFileError(f"{where}: origin must be [x, y, theta] in metres and radians")
    return Frame(*map(float, numbers))


def _check_distinct(path: Path, robots: list[RemoteRobot]) -> None:
    numbers: dict[Identity, int] = {}
    for robot in robots:
        other = numbers.setdefault(robot.identity, robot.number)
        if other != robot.number:
            name = f"{robot.identity.manufacturer}/{robot.identity.serial}"
            raise RobotsFileError(f"{path}: robots {other} and {robot.number} are both {name}")
