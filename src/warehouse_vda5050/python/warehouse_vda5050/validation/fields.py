# SPDX-License-Identifier: Apache-2.0
"""Reads fields of a JSON object by name and type, and knows which were not read."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from warehouse_vda5050.validation import MessageError

REQUIRED: Any = object()


class Fields:
    """An object of a message. `path` is where it stands, for errors: nodes[2].nodePosition.

    A default of REQUIRED makes a missing field an error; null counts as missing. `strict`: whether
    deviations that peers in the field are known for are errors. Raises MessageError.
    """

    def __init__(
        self,
        value: Any,
        path: str = "",
        unread: list[str] | None = None,
        strict: bool = False,
    ) -> None:
        if not isinstance(value, dict):
            raise MessageError(
                f"{path or 'the message'} is {_named(value)}; an object was expected"
            )
        self._value, self._path, self.strict = value, path, strict
        self._read: set[str] = set()
        self._unread = [] if unread is None else unread  # shared with the objects within

    def path_of(self, key: str) -> str:
        """Returns where a field of this object stands."""
        return f"{self._path}.{key}" if self._path else key

    def has(self, key: str) -> bool:
        """Returns whether a field is there."""
        return self._value.get(key) is not None

    def text(self, key: str, default: Any = REQUIRED) -> Any:
        """Returns a string."""
        return self._get(key, default, str, "a string")

    def flag(self, key: str, default: Any = REQUIRED) -> Any:
        """Returns a boolean."""
        return self._get(key, default, bool, "true or false")

    def number(self, key: str, default: Any = REQUIRED) -> Any:
        """Returns a finite number as a float."""
        value = self._get(key, default, (int, float), "a number")
        if value is default and default is not REQUIRED:
            return default
        if isinstance(value, bool) or abs(value) > 1e300 or not math.isfinite(value):
            self._fail(key, value, "a number")
        return float(value)

    def natural(self, key: str, default: Any = REQUIRED) -> Any:
        """Returns a whole number from 0 to 2³² - 1."""
        value = self.number(key, default)
        if value is default and default is not REQUIRED:
            return default
        if value != int(value) or not 0 <= value < 1 << 32:
            self._fail(key, self._value[key], "a whole number from 0 to 4294967295")
        return int(value)

    def any(self, key: str, default: Any = REQUIRED) -> Any:
        """Returns whatever stands there."""
        return self._get(key, default, object, "a value")

    def object(self, key: str) -> Fields | None:
        """Returns an object within this one, None if it is missing."""
        value = self._get(key, None, dict, "an object")
        return (
            None if value is None else Fields(value, self.path_of(key), self._unread, self.strict)
        )

    def lenient_object(self, key: str) -> Fields | None:
        """Returns an object that stands under a name which strict peers don't use."""
        return None if self.strict else self.object(key)

    def objects(self, key: str, default: Any = REQUIRED) -> list[Fields]:
        """Returns the objects of a list."""
        items = self._get(key, default, list, "a list")
        path = self.path_of(key)
        return [
            Fields(item, f"{path}[{i}]", self._unread, self.strict) for i, item in enumerate(items)
        ]

    def skip(self, *keys: str) -> None:
        """Marks fields as known although nothing here makes use of them."""
        self._read.update(keys)

    def close(self) -> None:
        """Notes the fields that were neither read nor skipped as unknown."""
        for key in self._value:
            if key not in self._read:
                self._unread.append(self.path_of(key)[:100])

    @property
    def unread(self) -> list[str]:
        """Paths of the unknown fields of all objects of the message that were closed."""
        return self._unread

    def __iter__(self) -> Iterator[str]:
        return iter(self._value)

    def _get(self, key: str, default: Any, kind: Any, expected: str) -> Any:
        self._read.add(key)
        value = self._value.get(key)
        if value is None:
            if default is REQUIRED:
                raise MessageError(f"{self.path_of(key)} is missing; {expected} was expected")
            return default
        if not isinstance(value, kind):
            self._fail(key, value, expected)
        return value

    def _fail(self, key: str, value: Any, expected: str) -> None:
        raise MessageError(f"{self.path_of(key)} is {_named(value)}; {expected} was expected")


def _named(value: Any) -> str:
    if isinstance(value, (dict, list)):
        return "an object" if isinstance(value, dict) else "a list"
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
