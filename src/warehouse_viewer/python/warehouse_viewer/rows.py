# SPDX-License-Identifier: Apache-2.0
"""Rows of numbers and texts in memory that is taken at once, and stays the same however long a
program runs."""

from collections.abc import Mapping
from operator import itemgetter
from typing import Any

import numpy as np

Columns = Mapping[str, type | int]


class Rows:
    """Places for rows, all in one array. One thread at a time.

    columns: the type of a number, or how many bytes of UTF-8 a text has as a rule; what is longer
    lies beside the array.
    """

    def __init__(self, count: int, columns: Columns) -> None:
        kinds = [(name, f"S{of}" if isinstance(of, int) else of) for name, of in columns.items()]
        self._widths = {name: of for name, of in columns.items() if isinstance(of, int)}
        self._rows, self._in_order = _taken(count, np.dtype(kinds)), itemgetter(*columns)
        self._long: dict[tuple[int, str], bytes] = {}

    def __len__(self) -> int:
        return len(self._rows)

    def grow(self, count: int) -> None:
        """Adds `count` empty places at the end."""
        self._rows = np.concatenate((self._rows, _taken(count, self._rows.dtype)))

    def __setitem__(self, place: int, row: dict[str, Any]) -> None:
        if self._long:
            for name in self._widths:
                self._long.pop((place, name), None)
        packed = {name: self._packed(place, name, row[name]) for name in self._widths}
        self._rows[place] = self._in_order(row | packed)

    def __getitem__(self, place: int) -> dict[str, Any]:
        row = dict(zip(self._rows.dtype.names, self._rows[place].item()))
        for name in self._widths:
            data = self._long.get((place, name), row[name])
            row[name] = data.decode(errors="surrogatepass")
        return row

    def _packed(self, place: int, name: str, text: str) -> bytes:
        data = text.encode(errors="surrogatepass")
        # numpy drops zeros at the end of a text.
        if len(data) <= self._widths[name] and not data.endswith(b"\0"):
            return data
        self._long[place, name] = data
        return b""


def _taken(count: int, kind: np.dtype) -> np.ndarray:
    """Returns rows that are written to: memory that was only asked for is taken later."""
    return np.full(count, np.zeros((), kind), kind)
