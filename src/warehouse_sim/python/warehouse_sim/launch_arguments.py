# SPDX-License-Identifier: Apache-2.0
"""What the launch files' arguments may be: a table from argument to check.

A check takes the text that was given, and the Place from which; it returns what was expected
instead, or "" where the text is right.
"""

import math
import os
import re
import socket
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

from warehouse_layout import world_file
from warehouse_layout.request import FIT, PRESETS
from warehouse_viewer.server import token

MOST_PORT, MOST_THREADS, MOST_CHECKPOINTS = 65535, 256, 100_000
MOST_WHOLE = 2**31 - 1  # of a parameter of ROS


@dataclass(frozen=True)
class Place:
    """Where a person typed: relative paths start at `cwd`, worlds go by their name in `worlds`."""

    cwd: Path
    worlds: Path


def faults(values, place):
    """Sentences, one for each of the arguments {name: text} that is wrong."""
    checked = ((name, text, ARGUMENTS[name](text, place)) for name, text in values.items())
    return [f"{name}:={text}: {wrong}" for name, text, wrong in checked if wrong]


def unknown(names, known):
    """Sentences, one for each of the names that is none of those that a launch file knows."""
    return [
        f"there is no argument '{name}'{near(name, known)}; known are {', '.join(sorted(known))}"
        for name in names
        if name not in known
    ]


def near(text, known):
    """The question whether the nearest of the known words was meant; "" if none is near."""
    found = get_close_matches(text, known, 1)
    return f" (did you mean '{found[0]}'?)" if found else ""


# --- checks


def _anything(text, place):
    """What the node that takes it checks itself."""
    return ""


def _one_of(*words):
    """Of words; "" among them: none."""
    named = ", ".join(word or "nothing" for word in words)

    def check(text, place):
        return "" if text in words else f"one of {named} was expected{near(text, words)}"

    return check


def _flag(text, place):
    return "" if text.lower() in ("true", "false", "1", "0") else "true or false was expected"


def _whole(most):
    def check(text, place):
        right = re.fullmatch(r"\+?\d{1,15}", text) and int(text) <= most
        return "" if right else f"a whole number from 0 to {most} was expected"

    return check


def _number(fits, expected):
    def check(text, place):
        try:
            right = math.isfinite(float(text)) and fits(float(text))
        except ValueError:
            right = False
        return "" if right else f"{expected} was expected"

    return check


def _world(text, place):
    try:
        if text:
            world_file.find(text, place.worlds, place.cwd)
    except world_file.WorldFileError as error:
        return str(error)
    return ""


def _file(what):
    """To be read; "" for none."""

    def check(text, place):
        path = place.cwd / text
        if not text or (path.is_file() and os.access(path, os.R_OK)):
            return ""
        return f"{what} was expected; {path} is {'no file' if path.exists() else 'not there'}"

    return check


def _new_file(text, place):
    """To be written; "" for none."""
    path = place.cwd / text
    if not text or (os.access(path.parent, os.W_OK | os.X_OK) and not path.is_dir()):
        return ""
    return f"a file that can be written was expected; {path} is none"


def _realism(text, place):
    names = sorted(path.stem for path in (place.worlds / "realism").glob("*.yaml"))
    if "/" in text or "." in text:
        return _file(f"{', '.join(names)} or a YAML file")(text, place)
    return _one_of("", *names)(text, place)


def _host(text, place):
    try:
        socket.getaddrinfo(text, 0)
    except (OSError, UnicodeError) as error:
        return f"an address of this machine was expected ({getattr(error, 'strerror', error)})"
    return ""


def _token_file(text, place):
    try:
        if text:
            token.read(place.cwd / text)
    except token.TokenError as error:
        return str(error)
    return ""


def _point(text, place):
    try:
        point(text)
    except ValueError as error:
        return str(error)
    return ""


def point(text):
    """(x, y) of "x,y" [m]; None of "". Raises ValueError."""
    if not text:
        return None
    try:
        x, y = map(float, text.split(","))
    except ValueError:
        x = y = math.nan
    if not (math.isfinite(x) and math.isfinite(y)):
        raise ValueError("two numbers x,y in metres were expected")
    return x, y


ARGUMENTS = {
    "world": _world,
    "replay": _file("a recording"),
    "size": _one_of("none", *PRESETS, FIT),
    "at": _point,
    "rviz": _flag,
    "rtf": _number(lambda rtf: rtf >= 0, "a factor above 0, or 0 (as fast as possible)"),
    "seed": _whole(MOST_WHOLE),
    "drive": _one_of("", "traction", "jointed"),
    "realism": _realism,
    "threads": _whole(MOST_THREADS),
    "lockstep": _flag,
    "autosave": _whole(MOST_CHECKPOINTS),
    "record": _new_file,
    "viewer": _flag,
    "viewer_port": _whole(MOST_PORT),
    "viewer_host": _host,
    "viewer_token_file": _token_file,
    "actions": _flag,
    "coordinator": _flag,
    "transports": _one_of("none", "random"),
    "exchange": _number(lambda seconds: seconds > 0, "a number of seconds above 0"),
    "planner": _file("a YAML file that names a planner"),
    "respawn": _flag,
    # Of operations.launch.
    "orders": _anything,
    "policies": _anything,
    "database": _anything,
}
