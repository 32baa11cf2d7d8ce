# SPDX-License-Identifier: Apache-2.0
"""The valid values of the launch files' arguments: a table from argument to check.

A Check takes a text and the Place where it was typed; it returns what was expected instead, or ""
for a valid text.
"""

import math
import os
import re
import socket
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

from warehouse_client import MOST_THREADS
from warehouse_layout.file.request import FIT, LIMITS, PRESETS
from warehouse_layout.models import world_file
from warehouse_sim import layout_argument
from warehouse_viewer.server import token
from warehouse_viewer.watch import webhooks

MOST_PORT, MOST_CHECKPOINTS = 65535, 100_000
MOST_WHOLE = 2**31 - 1  # of a parameter of ROS


@dataclass(frozen=True)
class Place:
    """The place of a person who types: relative paths start at `cwd`, `worlds` has worlds by
    name."""

    cwd: Path
    worlds: Path


Check = Callable[[str, Place], str]


def faults(values: Mapping[str, str], place: Place) -> list[str]:
    """Returns a sentence for each invalid argument of {name: text}."""
    checked = ((name, text, ARGUMENTS[name](text, place)) for name, text in values.items())
    return [f"{name}:={_without_password(text)}: {wrong}" for name, text, wrong in checked if wrong]


def conflicts(values: Mapping[str, str], place: Place) -> list[str]:
    """Returns sentences about valid arguments {name: text} that contradict each other."""
    return layout_argument.conflicts(values, place.worlds, place.cwd)


def value(name: str, text: str, place: Place) -> str:
    """Returns a checked argument as nodes take it: the files of a shift by their whole path."""
    return _of_the_shift(name, text, place) if name in OF_THE_SHIFT else text


def unknown(names: Iterable[str], known: Collection[str]) -> list[str]:
    """Returns a sentence for each of the names that a launch file does not know."""
    return [
        f"there is no argument '{name}'{near(name, known)}; known are {', '.join(sorted(known))}"
        for name in names
        if name not in known
    ]


def near(text: str, known: Iterable[str]) -> str:
    """Returns the question whether the nearest known word was meant; "" without a near one."""
    matches = get_close_matches(text, known, 1)
    return f" (did you mean '{matches[0]}'?)" if matches else ""


# --- checks


def _one_of(*words: str) -> Check:
    """Accepts these words; "" among them means that the argument may be empty."""
    named = ", ".join(word or "nothing" for word in words)

    def check(text: str, place: Place) -> str:
        return "" if text in words else f"one of {named} was expected{near(text, words)}"

    return check


def _flag(text: str, place: Place) -> str:
    return "" if text.lower() in ("true", "false", "1", "0") else "true or false was expected"


def _whole(most: int) -> Check:
    def check(text: str, place: Place) -> str:
        right = re.fullmatch(r"\+?\d{1,15}", text) and int(text) <= most
        return "" if right else f"a whole number from 0 to {most} was expected"

    return check


def _number(fits: Callable[[float], bool], expected: str) -> Check:
    def check(text: str, place: Place) -> str:
        try:
            right = math.isfinite(float(text)) and fits(float(text))
        except ValueError:
            right = False
        return "" if right else f"{expected} was expected"

    return check


def _world(text: str, place: Place) -> str:
    try:
        if text:
            world_file.find(text, place.worlds, place.cwd)
    except world_file.WorldFileError as error:
        return str(error)
    return ""


def _file(what: str) -> Check:
    """Accepts a readable file, and ""."""

    def check(text: str, place: Place) -> str:
        path = place.cwd / text
        if not text or (path.is_file() and os.access(path, os.R_OK)):
            return ""
        return f"{what} was expected; {path} is {'not a file' if path.exists() else 'not there'}"

    return check


def _layout(text: str, place: Place) -> str:
    return layout_argument.fault(text, place.cwd)


def _count(text: str, place: Place) -> str:
    """Accepts a number of robots, and ""."""
    return _whole(LIMITS["robots"])(text, place) if text else ""


def _robots(text: str, place: Place) -> str:
    """Accepts names or numbers of robots, and ""."""
    words = text.replace(",", " ").split()
    right = all(re.fullmatch(r"(kiva)?0*[1-9]\d{0,5}|(kiva)?1000000", word) for word in words)
    return "" if right else "names of robots were expected, such as 'kiva1 kiva2'"


def _file_name(text: str, place: Place) -> str:
    return "" if text and "/" not in text else "a part of a file's name was expected, without /"


def _new_file(text: str, place: Place) -> str:
    """Accepts a writable file, and ""."""
    path = place.cwd / text
    if not text or (os.access(path.parent, os.W_OK | os.X_OK) and not path.is_dir()):
        return ""
    return f"a file that can be written was expected; {path} can't be"


def _realism(text: str, place: Place) -> str:
    names = sorted(path.stem for path in (place.worlds / "realism").glob("*.yaml"))
    if "/" in text or "." in text:
        return _file(f"{', '.join(names)} or a YAML file")(text, place)
    return _one_of("", *names)(text, place)


def _host(text: str, place: Place) -> str:
    try:
        socket.getaddrinfo(text, 0)
    except (OSError, UnicodeError) as error:
        return f"an address of this machine was expected ({getattr(error, 'strerror', error)})"
    return ""


def _token_file(text: str, place: Place) -> str:
    try:
        if text:
            token.read(place.cwd / text)
    except token.TokenError as error:
        return str(error)
    return ""


def _webhooks(text: str, place: Place) -> str:
    try:
        webhooks.read(text)
    except ValueError as error:
        return str(error)
    return ""


def _point(text: str, place: Place) -> str:
    try:
        point(text)
    except ValueError as error:
        return str(error)
    return ""


def point(text: str) -> tuple[float, float] | None:
    """Returns (x, y) [m] of "x,y"; None for "". Raises ValueError."""
    if not text:
        return None
    try:
        x, y = map(float, text.split(","))
    except ValueError:
        x = y = math.nan
    if not (math.isfinite(x) and math.isfinite(y)):
        raise ValueError("two numbers x,y in metres were expected")
    return x, y


def _shift_takes(name: str) -> Check:
    """Accepts valid values of a shift's argument of that name."""

    def check(text: str, place: Place) -> str:
        try:
            _of_the_shift(name, text, place)
        except _errors_of_the_shift() as error:  # imported only once there is one
            return str(error)
        return ""

    return check


def _errors_of_the_shift() -> tuple[type[Exception], ...]:
    from warehouse_operations.runs.simulation import ERRORS

    return ERRORS


def _of_the_shift(name: str, text: str, place: Place) -> str:
    # Most launches have one of these: to import a shift for it takes longer than all else.
    if text in ("", "fill", "none"):
        return text
    from warehouse_operations.ros import arguments

    return getattr(arguments, name)(text, place.cwd)


def _without_password(text: str) -> str:
    """Returns a database's URL without its password, and any other text as it is."""
    return re.sub(r"(://[^:/@]*:)[^@]*@", r"\1***@", text)


# The values of arguments with few choices; the hub's form offers the same.
CHOICES = {
    "size": ("none", *PRESETS, FIT),
    "drive": ("", "traction", "jointed"),
    "transports": ("none", "random"),
}
OF_THE_SHIFT = ("orders", "policies", "database")
ARGUMENTS: dict[str, Check] = {
    "name": _file_name,
    "world": _world,
    "replay": _file("a recording"),
    "size": _one_of(*CHOICES["size"]),
    "at": _point,
    "layout": _layout,
    "robots": _count,
    "rviz": _flag,
    "rtf": _number(lambda rtf: rtf >= 0, "a factor above 0, or 0 (as fast as possible)"),
    "seed": _whole(MOST_WHOLE),
    "drive": _one_of(*CHOICES["drive"]),
    "realism": _realism,
    "threads": _whole(MOST_THREADS),
    "lockstep": _flag,
    "autosave": _whole(MOST_CHECKPOINTS),
    "record": _new_file,
    "viewer": _flag,
    "viewer_port": _whole(MOST_PORT),
    "viewer_host": _host,
    "viewer_token_file": _token_file,
    "webhooks": _webhooks,
    "cmd_vel": _robots,
    "map_to_odom": _flag,
    "map_resolution": _number(lambda edge: 0.01 <= edge <= 1, "a cell of 0.01 to 1 m"),
    "pose_topics": _whole(MOST_WHOLE),
    "actions": _flag,
    "coordinator": _flag,
    "transports": _one_of(*CHOICES["transports"]),
    "forecast_every": _number(lambda minutes: 0 <= minutes <= 1440, "0 to 1440 minutes"),
    "forecast_seconds": _number(lambda seconds: 0 <= seconds <= 3600, "0 to 3600 seconds"),
    "exchange": _number(lambda seconds: seconds > 0, "a number of seconds above 0"),
    "planner": _file("a YAML file that names a planner"),
    "respawn": _flag,
    "checked": _flag,
    **{name: _shift_takes(name) for name in OF_THE_SHIFT},
}
