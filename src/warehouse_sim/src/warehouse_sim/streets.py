# SPDX-License-Identifier: Apache-2.0
"""One-way streets between the blocks of storage units."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Street:
    """One cell wide; robots go from `start` to `end`, two grid points (x, y) in world [m]."""

    start: tuple
    end: tuple

    @property
    def direction(self):
        """Unit vector along one axis, as integers."""
        return tuple(int(d) for d in np.sign(np.subtract(self.end, self.start)))

    @property
    def points(self):
        """All its grid points, in the order in which a robot passes them."""
        steps = int(np.abs(np.subtract(self.end, self.start)).sum())
        return [tuple(np.add(self.start, np.multiply(self.direction, i))) for i in range(steps + 1)]


def directions(count, first):
    """The ways (+1, -1) of parallel streets: neighbours opposed, the outer two opposed too.

    With an odd count both can't be; then the first two go the same way. For the outermost streets
    must go round: all others begin and end on them, so every point is reached from every other.
    """
    ways = [-first * (-1) ** (count - 1 - i) for i in range(count)]
    ways[0] = first
    return ways
