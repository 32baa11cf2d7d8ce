# SPDX-License-Identifier: Apache-2.0
"""A request for a simulation: its fields, checked before anything starts."""

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from warehouse_layout.file import files
from warehouse_layout.file.layout_file import SUFFIX
from warehouse_sim import launch_arguments, launching
from warehouse_sim.launch_arguments import ARGUMENTS, OF_THE_SHIFT, Place

NAME = re.compile(r"[a-z0-9][a-z0-9-]{0,39}")
FILES = {"shift": "operations.launch", "empty": "empty_world.launch"}
DEFAULT_FILE = "warehouse.launch"
# Arguments that the hub sets itself, or that need a screen.
OWN = ("viewer", "viewer_port", "viewer_host", "viewer_token_file", "rviz")
MOST_TEXT = 1_000_000  # characters of a layout or a world that is sent as text
MOST_VALUE = 4000  # characters of any other value


class WishError(ValueError):
    """Raised for an invalid request: the field, the reason, and the nearest valid value or ""."""

    def __init__(self, field_name: str, reason: str, nearest: str = "") -> None:
        super().__init__(f"{field_name}: {reason}")
        self.field, self.reason, self.nearest = field_name, reason, nearest


@dataclass(frozen=True)
class Wish:
    """The request for a simulation; `texts` are files to write into its folder, by argument."""

    name: str
    file: str = DEFAULT_FILE
    arguments: dict[str, str] = field(default_factory=dict)
    texts: dict[str, str] = field(default_factory=dict)

    def as_json(self) -> dict[str, Any]:
        """Returns what from_json() reads."""
        return {"name": self.name, "file": self.file, "arguments": self.arguments}

    @classmethod
    def from_json(cls, text: str) -> "Wish":
        """Returns the Wish that as_json() gave. Raises ValueError for any other text."""
        values = json.loads(text)
        try:
            return cls(values["name"], values["file"], dict(values["arguments"]))
        except (KeyError, TypeError) as error:
            raise ValueError(f"not a simulation: {error}") from error


def read(body: Mapping[str, Any], folder: Path) -> Wish:
    """Returns the Wish in the body of a request; relative paths start at `folder`.

    Raises WishError for the first field that is wrong.
    """
    name = _name(body.get("name", ""))
    file = _file(body)
    values = {key: value for key, value in body.items() if key not in ("name", *FILES)}
    _check_known(values, file)
    arguments = {key: _text(key, value) for key, value in values.items()}
    texts = {key: arguments.pop(key) for key in ("layout", "world") if _is_content(arguments, key)}
    wish = Wish(name, file, arguments, texts)
    _check(wish, folder)
    return wish


def _name(name: object) -> str:
    if not isinstance(name, str) or not NAME.fullmatch(name):
        reason = "1 to 40 small letters, digits and '-' were expected, a letter or digit first"
        raise WishError("name", reason, _near_name(str(name)))
    return name


def _near_name(name: str) -> str:
    out = re.sub(r"[^a-z0-9-]+", "-", name.lower()).strip("-")[:40]
    return out if NAME.fullmatch(out) else ""


def _file(body: Mapping[str, Any]) -> str:
    chosen = [key for key in FILES if body.get(key, False)]
    for key in FILES:
        if not isinstance(body.get(key, False), bool):
            raise WishError(key, "true or false was expected")
    if len(chosen) > 1:
        raise WishError("empty", "a shift needs a warehouse; leave one of both out")
    if chosen:
        return FILES[chosen[0]]
    asks_for_shift = "shift" not in body and not body.keys().isdisjoint(OF_THE_SHIFT)
    return FILES["shift"] if asks_for_shift else DEFAULT_FILE


def _check_known(values: Mapping[str, Any], file: str) -> None:
    known = known_arguments(file)
    for key in values:
        if key in OWN:
            raise WishError(key, "the hub sets it; leave it out")
        if key not in known:
            nearest = next(iter(get_close_matches(key, known, 1)), "")
            reason = f"{file} has no such argument; known are {', '.join(sorted(known))}"
            raise WishError(key[:100], reason, nearest)


def known_arguments(file: str) -> set[str]:
    """Returns the names of the arguments that a request may have for a launch file."""
    path = launching.SHARE / "launch" / file
    known = launching.known_arguments(path, launching.SHARE) or set()
    return (known & ARGUMENTS.keys()) - {*OWN}


def _text(key: str, value: object) -> str:
    """Returns a value as roslaunch takes it."""
    if isinstance(value, bool):
        return str(value).lower()
    if not isinstance(value, str | int | float):
        raise WishError(key, "a text, a number, true or false was expected")
    text = str(value)
    most = MOST_TEXT if key in ("layout", "world") else MOST_VALUE
    if len(text) > most:
        raise WishError(key, f"{len(text)} characters; {most} at most were expected")
    if "\0" in text or ("\n" in text and key not in ("layout", "world")):
        raise WishError(key, "one line of text was expected")
    return text


def _is_content(arguments: Mapping[str, str], key: str) -> bool:
    return "\n" in arguments.get(key, "") or arguments.get(key, "").lstrip().startswith("<")


def _check(wish: Wish, folder: Path) -> None:
    place = Place(cwd=folder, worlds=files.worlds())
    for key, text in wish.arguments.items():
        reason = ARGUMENTS[key](text, place)
        if reason:
            raise WishError(key, reason, _nearest(reason))
    if texts := launch_arguments.conflicts(wish.arguments, place):
        first, _, rest = texts[0].partition(":=")
        raise WishError(first, rest.partition(": ")[2] or rest)


def _nearest(reason: str) -> str:
    """Returns the nearest valid value that a reason proposes, or ""."""
    proposed = re.search(r"\(did you mean '([^']*)'\?\)", reason)
    return proposed[1] if proposed else ""


def written(wish: Wish, folder: Path) -> Wish:
    """Returns the Wish with its texts as files of `folder`.

    Raises WishError for a layout in which no fleet can work, and for a world that is not SDF.
    """
    names = {"layout": f"{wish.name}{SUFFIX}", "world": f"{wish.name}.sdf"}
    arguments = dict(wish.arguments)
    for key, text in wish.texts.items():
        path = folder / names[key]
        path.write_text(text, encoding="utf-8")
        arguments[key] = str(path)
    out = Wish(wish.name, wish.file, arguments)
    _check(out, folder)
    return out
