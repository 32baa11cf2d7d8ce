# SPDX-License-Identifier: Apache-2.0
"""The units that could be brought to a picking station, in arrays: there may be thousands."""

from collections.abc import Collection, Iterator, Mapping
from functools import cached_property

import numpy as np

from warehouse_operations.stock.inventory import Inventory
from warehouse_operations.stock.orders import Line
from warehouse_operations.stock.units_by_id import UnitSet


class Candidates(Mapping[int, Mapping[Line, int]]):
    """The pieces of some lines that units could serve: {unit: {line: pieces}}, ascending.

    units: their ids, (n,). completes: number of lines that each completes, (n,). pieces: number of
    pieces that each has for all lines, (n,).
    """

    def __init__(self, lines: Collection[Line], inventory: Inventory, free_units: UnitSet) -> None:
        self._lines = list(lines)
        each_line = [self._of_line(number, inventory) for number in range(len(self._lines))]
        units, line, pieces, completes = (np.concatenate(parts) for parts in zip(*each_line))
        self.units, rows = np.unique(units, return_inverse=True)
        is_free = free_units.among(self.units)
        kept = is_free[rows]
        rows = (np.cumsum(is_free) - 1)[rows[kept]]
        self._rows, self._line, self._pieces = rows, line[kept], pieces[kept]
        self.units = self.units[is_free]
        count = len(self.units)
        self.completes = np.bincount(rows[completes[kept]], minlength=count)
        self.pieces = np.bincount(rows, self._pieces, minlength=count).astype(int)

    def _of_line(self, number: int, inventory: Inventory) -> tuple[np.ndarray, ...]:
        """Returns (units, line, pieces, whether they complete it) of one line, (m,) each."""
        missing = self._lines[number].missing
        units, available = inventory.by_unit(self._lines[number].sku)
        pieces = np.minimum(available, missing)
        return units, np.full(len(units), number), pieces, pieces >= missing

    @cached_property
    def _number(self) -> dict[int, int]:
        return {unit: i for i, unit in enumerate(self.units.tolist())}

    def __getitem__(self, unit: int) -> Mapping[Line, int]:
        """Returns {line: pieces} of a unit. Raises KeyError."""
        rows = np.flatnonzero(self._rows == self._number[unit])
        lines = zip(self._line[rows].tolist(), self._pieces[rows].tolist())
        return {self._lines[number]: pieces for number, pieces in lines}

    def __iter__(self) -> Iterator[int]:
        """Returns an iterator over the units."""
        return iter(self.units.tolist())

    def __len__(self) -> int:
        """Returns the number of units."""
        return len(self.units)
