# SPDX-License-Identifier: Apache-2.0
"""Commands to try first, which work in the warehouse that stands."""

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from warehouse_client.routes import elbow, point
from warehouse_client.survey import Survey

SYSTEM = Path("/usr/lib")  # Python and ROS search it by default
NEAREST = 20  # units tried for each robot

Point = tuple[int, int]  # on the grid [m]
Pairs = list[tuple[str, str]]  # shell command, its effect

_CREATE = "rosservice call /warehouse/create_warehouse_models '{warehouse_name: small}'"
_WITHOUT_ROBOTS = [
    (_CREATE, "build a warehouse here"),
    ("rostopic echo -n 1 /warehouse/state", "what stands in it"),
    ("rosrun warehouse_sim insert_world paper", "or add the models of a world file"),
]
_OF_THE_ENGINE = [
    ("rosservice call /gazebo/get_world_properties", "the same as the engine sees it"),
]
_WITH_A_FLEET = [  # robots of a coordinator are busy, and refuse commands
    ("rostopic echo -n 1 /warehouse/coordinator", "what each robot does"),
    ("rostopic echo -n 1 /warehouse/state", "what stands in the warehouse"),
    ("rosrun warehouse_sim events", "what happens, until Ctrl-C"),
]


def commands(survey: Survey, has_coordinator: bool = False) -> list[tuple[str, str]]:
    """Returns three pairs (shell command, its effect) for a Survey."""
    if not survey.kiva:
        return _WITHOUT_ROBOTS
    if has_coordinator:
        return _WITH_A_FLEET
    if abs(survey.spacing - 1) > 1e-6:
        return [*_WITHOUT_ROBOTS[1:2], *_OF_THE_ENGINE]  # ways are searched on whole metres
    return _fetch(survey) or _stroll(survey)


def _fetch(survey: Survey) -> Pairs | None:
    """Returns the commands to fetch a unit that a robot reaches with one command, or None."""
    units = {number: point(pose) for number, pose in survey.storage_unit.items()}
    fixed = survey.obstacles() | {point(pose) for pose in survey.kiva.values()}
    for kiva, unit in _nearest(survey.kiva, units):
        way = elbow(survey.kiva[kiva], units[unit])
        # The load must leave by the robot's way in, which passes no other unit.
        if len(way) > 1 and fixed.isdisjoint(way[1:]) and way[-2] not in units.values():
            return _carry(kiva, unit, way[-1], way[-2])
    return None


def _nearest(robots: Mapping[int, Any], units: Mapping[int, Any]) -> Iterator[tuple[int, int]]:
    """Pairs of a robot's and a unit's number, the nearest units of each robot."""
    for kiva in sorted(robots):
        x, y = point(robots[kiva])
        far = {number: abs(x - ux) + abs(y - uy) for number, (ux, uy) in units.items()}
        yield from ((kiva, unit) for unit in sorted(far, key=far.__getitem__)[:NEAREST])


def _carry(kiva: int, unit: int, at: Point, back: Point) -> Pairs:
    axis, distance = ("x", back[0] - at[0]) if back[0] != at[0] else ("y", back[1] - at[1])
    return [
        (_pub("mov", "MoveTo", x=at[0], y=at[1], kiva_id=kiva), f"beneath storage_unit{unit}"),
        (_pub("lift", "Lift", status=1, kiva_id=kiva, shelf_id=unit), "take it up"),
        (_pub(f"mov{axis}", "MoveAlong", distance=distance, kiva_id=kiva), "carry it out"),
    ]


def _stroll(survey: Survey) -> Pairs:
    """Returns commands for a parked robot at a street: a step ahead, a turn, and back."""
    kiva, (x, y, yaw) = min(survey.kiva.items())
    dx, dy = round(math.cos(yaw)), round(math.sin(yaw))
    axis, distance = ("x", dx) if dx else ("y", dy)
    home = point((x, y))
    return [
        (_pub(f"mov{axis}", "MoveAlong", distance=distance, kiva_id=kiva), "a step ahead"),
        (_pub("rot", "Rotate", direction=1, kiva_id=kiva), "a quarter turn to the left"),
        (_pub("mov", "MoveTo", x=home[0], y=home[1], kiva_id=kiva), "home again"),
    ]


def _pub(topic: str, kind: str, **fields: float) -> str:
    text = ", ".join(f"{name}: {value}" for name, value in fields.items())
    return f"rostopic pub -1 /{topic} warehouse_msgs/{kind} '{{{text}}}'"


def within(namespace: str, pairs: list[tuple[str, str]]) -> list[tuple[str, str]]:
    """Returns pairs (shell command, its effect) for a warehouse in a namespace, `/` or `/sim1/`."""
    return [(_within(namespace, command), meaning) for command, meaning in pairs]


def _within(namespace: str, command: str) -> str:
    if namespace == "/":
        return command
    if " /" in command:
        return command.replace(" /", f" {namespace}")
    return f"ROS_NAMESPACE={namespace.rstrip('/')} {command}"


def greeting(title: str, pairs: Pairs) -> str:
    """Returns the text for the terminal once a warehouse is built."""
    wide = max(len(command) for command, _ in pairs)
    lines = [f"    {command:{wide}}   # {meaning}" for command, meaning in pairs]
    how = "Try in another terminal, each line once the one before is done:"
    return "\n".join(["", title, "", how, "", *_to_source(), *lines, ""])


def _to_source() -> list[str]:
    """Returns the line that another terminal needs first; [] where Debian's packages are
    installed."""
    return [] if SYSTEM in Path(__file__).parents else ["    source devel/setup.bash"]
