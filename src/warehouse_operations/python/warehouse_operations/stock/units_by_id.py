# SPDX-License-Identifier: Apache-2.0
"""Sets and cells of storage units by their ids, in arrays: a policy asks for thousands at once."""

from collections.abc import Iterable, Iterator, Mapping, MutableMapping, MutableSet
from typing import Any

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE


def _room_for(values: np.ndarray, unit: int, fill: int) -> np.ndarray:
    """Returns the array itself, or a longer one that has an element for the unit as well."""
    if unit < len(values):
        return values
    return np.pad(values, (0, 2 * unit + 1 - len(values)), constant_values=fill)


class UnitSet(MutableSet[int]):
    """A set of ids of units."""

    def __init__(self, units: Iterable[int] = ()) -> None:
        ids = np.fromiter(units, np.int64)
        self._has = np.zeros(ids.max(initial=0) + 1, bool)
        self._has[ids] = True
        self._count = int(np.count_nonzero(self._has))

    def among(self, units: np.ndarray) -> np.ndarray:
        """Returns which of `units`, (n,), are in the set, (n,) bool."""
        if not len(units):
            return np.zeros(0, bool)
        self._has = _room_for(self._has, int(units.max()), False)
        return self._has[units]

    def __contains__(self, unit: Any) -> bool:
        """Returns whether a unit is in the set."""
        return 0 <= unit < len(self._has) and bool(self._has[unit])

    def __iter__(self) -> Iterator[int]:
        """Returns an iterator over the units, ascending."""
        return iter(np.flatnonzero(self._has).tolist())

    def __len__(self) -> int:
        """Returns the number of units."""
        return self._count

    def add(self, unit: int) -> None:
        """Adds a unit."""
        if unit not in self:
            self._has = _room_for(self._has, unit, False)
            self._has[unit] = True
            self._count += 1

    def discard(self, unit: int) -> None:
        """Removes a unit, if it is there."""
        if unit in self:
            self._has[unit] = False
            self._count -= 1


class UnitCells(MutableMapping[int, int]):
    """The cell in which each unit stands, by the unit's id."""

    def __init__(self, cells: Mapping[int, int]) -> None:
        ids = np.fromiter(cells.keys(), np.int64, len(cells))
        self._cells = np.full(ids.max(initial=0) + 1, NOWHERE, np.int32)
        self._cells[ids] = np.fromiter(cells.values(), np.int32, len(cells))

    def of(self, units: np.ndarray) -> np.ndarray:
        """Returns the cells of units, (n,); NOWHERE for units that stand in no cell."""
        if not len(units):
            return np.zeros(0, np.int32)
        self._cells = _room_for(self._cells, int(units.max()), NOWHERE)
        return self._cells[units]

    def __getitem__(self, unit: int) -> int:
        """Returns the cell of a unit. Raises KeyError."""
        cell = int(self._cells[unit]) if 0 <= unit < len(self._cells) else NOWHERE
        if cell == NOWHERE:
            raise KeyError(unit)
        return cell

    def __setitem__(self, unit: int, cell: int) -> None:
        """Notes that a unit stands in a cell."""
        self._cells = _room_for(self._cells, unit, NOWHERE)
        self._cells[unit] = cell

    def __delitem__(self, unit: int) -> None:
        """Notes that a unit stands nowhere. Raises KeyError."""
        if self.get(unit) is None:
            raise KeyError(unit)
        self._cells[unit] = NOWHERE

    def __iter__(self) -> Iterator[int]:
        """Returns an iterator over the units that stand in a cell, ascending."""
        return iter(np.flatnonzero(self._cells != NOWHERE).tolist())

    def __len__(self) -> int:
        """Returns the number of units that stand in a cell."""
        return int(np.count_nonzero(self._cells != NOWHERE))
