# SPDX-License-Identifier: Apache-2.0
"""Elevators between the tiers of a floor, which lie side by side in one plan."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import permutations

import numpy as np

NO_TIER = -1


@dataclass(frozen=True)
class Elevator:
    """A lift for one robot, with or without a unit.

    cells: where robots get in and out, y * width + x, one a tier. seconds: of a ride from one of
    them (row) to another (column) [s]; nothing else takes it time: an empty car is wherever a robot
    gets in, as in RAWSim-O.
    """

    name: str
    cells: tuple[int, ...]
    seconds: tuple[tuple[float, ...], ...]

    @classmethod
    def evenly(cls, name: str, cells: Sequence[int], seconds: float) -> "Elevator":
        """Returns an elevator that takes a time from each tier to the next one in `cells` [s]."""
        tiers = range(len(cells))
        times = tuple(tuple(abs(a - b) * float(seconds) for b in tiers) for a in tiers)
        return cls(name, tuple(cells), times)

    @property
    def a_tier(self) -> float | None:
        """The time from each tier to the next one [s]; None where times are not so even."""
        even = Elevator.evenly(self.name, self.cells, self.seconds[0][1])
        return self.seconds[0][1] if even.seconds == self.seconds else None

    def rides(self) -> Iterable[tuple[int, int, float]]:
        """Yields from, to, both cells, and the time of each ride [s]."""
        for a, b in permutations(range(len(self.cells)), 2):
            yield self.cells[a], self.cells[b], self.seconds[a][b]


def tiers(passable: np.ndarray, elevators: Sequence[Elevator]) -> np.ndarray:
    """Returns the number of the tier of each cell, (h, w) int: from 0; NO_TIER off the floor.

    A tier is what is connected with an elevator's cell; what is connected with none belongs to the
    first.
    """
    out = np.where(passable, 0, NO_TIER)
    if not elevators:
        return out
    from scipy import ndimage

    parts, _ = ndimage.label(passable)
    cells = sorted({cell for elevator in elevators for cell in elevator.cells})
    labels = dict.fromkeys(parts.flat[cell] for cell in cells if passable.flat[cell])
    for number, label in enumerate(labels):
        out[parts == label] = number
    return out
