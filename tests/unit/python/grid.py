# SPDX-License-Identifier: Apache-2.0
"""Grid points of a floor on which a robot may stand."""

import math

from warehouse_client.routes import point
from warehouse_layout.floor.stations import STEPS


class Grid:
    """The points of a rectangle min_x … max_y [m] without those that are blocked."""

    def __init__(self, floor, blocked=()):
        xs = range(math.ceil(floor.min_x), math.floor(floor.max_x) + 1)
        ys = range(math.ceil(floor.min_y), math.floor(floor.max_y) + 1)
        self.points = {(x, y) for x in xs for y in ys} - {point(p) for p in blocked}

    def free(self, p):
        """Whether a robot may stand on a point."""
        return p in self.points

    def neighbours(self, p):
        """The free points one step away."""
        return [q for dx, dy in STEPS if self.free(q := (p[0] + dx, p[1] + dy))]
