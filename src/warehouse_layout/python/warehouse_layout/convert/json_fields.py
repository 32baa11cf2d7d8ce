# SPDX-License-Identifier: Apache-2.0
"""Looks up fields of a JSON file; errors name the file and the field."""

import json
import math
from collections.abc import Iterator
from typing import Any, NoReturn

from warehouse_layout.convert.common import FormatError, PathName, text_of

FAR = 1e6  # [m] from the origin, at most


class Fields:
    """An object of a JSON file, and where in the file it is: `layouts[0].nodes[3]`."""

    def __init__(self, path: PathName, place: str, values: Any) -> None:
        self._path, self.place = path, place
        if not isinstance(values, dict):
            self.fail("", f"is {_short(values)}; an object was expected")
        self._values: dict[str, Any] = values

    def __contains__(self, name: str) -> bool:
        return self._values.get(name) is not None

    def text(self, name: str, default: str | None = None) -> str:
        """Returns a text; default: of a missing one, None: it must be there. Raises FormatError."""
        value = self._values.get(name, default)
        if not isinstance(value, str):
            self.fail(name, f"is {_short(value)}; a text was expected")
        return value

    def number(self, name: str) -> float:
        """Returns a number of metres. Raises FormatError."""
        value: Any = self._values.get(name)
        is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
        if not is_number or not math.isfinite(value) or abs(value) > FAR:
            self.fail(name, f"is {_short(value)}; a number of metres up to {FAR:g} was expected")
        return float(value)

    def flag(self, name: str, default: bool) -> bool:
        """Returns true or false. Raises FormatError."""
        value = self._values.get(name, default)
        if not isinstance(value, bool):
            self.fail(name, f"is {_short(value)}; true or false was expected")
        return value

    def inner(self, name: str) -> "Fields":
        """Returns an object within this one. Raises FormatError."""
        return Fields(self._path, self._at(name), self._values.get(name))

    def texts(self, name: str) -> list[str]:
        """Returns a list of texts, [] if it is missing. Raises FormatError."""
        values = self._list(name)
        for i, value in enumerate(values):
            if not isinstance(value, str):
                self.fail(f"{name}[{i}]", f"is {_short(value)}; a text was expected")
        return values

    def each(self, *names: str) -> Iterator["Fields"]:
        """Yields the objects of the first of these lists that there is. Raises FormatError."""
        name = next((n for n in names if n in self), names[0])
        for i, value in enumerate(self._list(name)):
            yield Fields(self._path, self._at(f"{name}[{i}]"), value)

    def fail(self, name: str, text: str) -> NoReturn:
        """Raises FormatError about a field."""
        place = self._at(name)
        raise FormatError(f"{self._path}: {place} {text}" if place else f"{self._path}: {text}")

    def _list(self, name: str) -> list[Any]:
        value = self._values.get(name)
        if value is None:
            return []
        if not isinstance(value, list):
            self.fail(name, f"is {_short(value)}; a list was expected")
        return value

    def _at(self, name: str) -> str:
        return ".".join(part for part in (self.place, name) if part)


def read(path: PathName) -> Fields:
    """Returns the object that a JSON file holds. Raises FormatError."""
    try:
        return Fields(path, "", json.loads(text_of(path)))
    except json.JSONDecodeError as error:
        place = f"{path}:{error.lineno}:{error.colno}"
        raise FormatError(f"{place}: is not JSON: {error.msg}") from error


def _short(value: Any) -> str:
    text = json.dumps(value) if value is not None else "missing"
    return text if len(text) <= 40 else f"{text[:37]}..."
