# SPDX-License-Identifier: Apache-2.0
"""The last events of each robot and thing, which outlast the newest of all."""

from array import array
from collections.abc import Iterable
from typing import Any

from warehouse_viewer.rows import Columns, Rows

KEPT = 10  # of a model
BLOCK = 100  # rows that are added where more models have events than were expected


class OwnEvents:
    """The newest KEPT entries of each of those `models` that had one last. One thread at a time."""

    def __init__(self, columns: Columns, models: int) -> None:
        self._rows, self._models = Rows(0, columns), models
        self._free = array("i")
        self._sharers = array("B")  # how many models have the entry of a place
        self._places: dict[str, array[int]] = {}  # the model that had one last is the last

    def __len__(self) -> int:
        """The number of models that have events."""
        return len(self._places)

    def expect(self, models: int) -> None:
        """Allocates rows for the entries of `models` models."""
        missing = KEPT * min(models, self._models) - len(self._rows)
        if missing > 0:
            self._grow(missing)

    def add(self, names: Iterable[str], entry: dict[str, Any]) -> None:
        """Adds an entry of these models, none of them twice."""
        if not self._free:
            self._grow(BLOCK)
        place = self._free.pop()
        self._rows[place] = entry
        for name in names:
            self._keep(name, place)

    def of(self, model: str) -> list[dict[str, Any]]:
        """Returns a model's entries, oldest first."""
        return [self._rows[place] for place in self._places.get(model, ())]

    def _grow(self, count: int) -> None:
        self._free.extend(range(len(self._rows), len(self._rows) + count))
        self._sharers.extend([0] * count)
        self._rows.grow(count)

    def _keep(self, name: str, place: int) -> None:
        places = self._places.pop(name, array("i"))
        places.append(place)
        self._sharers[place] += 1
        if len(places) > KEPT:
            self._drop(places.pop(0))
        self._places[name] = places
        if len(self._places) > self._models:
            for old in self._places.pop(next(iter(self._places))):
                self._drop(old)

    def _drop(self, place: int) -> None:
        self._sharers[place] -= 1
        if not self._sharers[place]:
            self._free.append(place)
