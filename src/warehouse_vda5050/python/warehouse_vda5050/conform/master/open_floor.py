# SPDX-License-Identifier: Apache-2.0
"""A floor with nodes anywhere: a cell is the number of a place that an order has named."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from warehouse_vda5050.grid import Cell, Grid, GridError
from warehouse_vda5050.model import Node

NEAR = 0.25  # largest distance of a vehicle from the place at which it stands [m]
NOWHERE: Cell = (-1, 0)


@dataclass
class Place:
    """A node, by the name that was used for it last [m]."""

    name: str
    x: float
    y: float


@dataclass(frozen=True, eq=False)
class OpenFloor(Grid):
    """Places in the order in which they became known; any edge between two is a straight line."""

    places: list[Place] = field(default_factory=list)

    def add(self, name: str, x: float, y: float) -> Cell:
        """Returns the cell of a place; one that is known takes the name over."""
        cell = self.cell_at(x, y)
        if cell == NOWHERE or self._distance(cell, x, y) > 1e-3:
            self.places.append(Place(name, x, y))
            return len(self.places) - 1, 0
        self.places[cell[0]].name = name
        return cell

    def _distance(self, cell: Cell, x: float, y: float) -> float:
        place = self.places[cell[0]]
        return math.hypot(place.x - x, place.y - y)

    def node_id(self, cell: Cell) -> str:
        """Returns the name of a place, '' for none."""
        return self.places[cell[0]].name if self.contains(cell) else ""

    def position(self, cell: Cell) -> tuple[float, float]:
        """Returns where a place is [m]."""
        place = self.places[cell[0]]
        return place.x, place.y

    def contains(self, cell: Cell) -> bool:
        """Returns whether a cell is a place."""
        return 0 <= cell[0] < len(self.places)

    def cell_at(self, x: float, y: float) -> Cell:
        """Returns the nearest place, NOWHERE if none is near."""
        nearest, least = NOWHERE, NEAR
        for k, place in enumerate(self.places):
            off = max(abs(place.x - x), abs(place.y - y))
            if off <= least and (off := math.hypot(place.x - x, place.y - y)) <= least:
                nearest, least = (k, 0), off
        return nearest

    def cell_of(self, node: Node) -> Cell:
        """Returns the place of an order's node, which is known from then on. Raises GridError."""
        if node.position is not None:
            return self.add(node.id, node.position.x, node.position.y)
        known = [k for k, place in enumerate(self.places) if place.name == node.id]
        if not known:
            raise GridError(f"node {node.id!r} has no nodePosition, and had none before")
        return known[-1], 0

    def between(self, a: Cell, b: Cell) -> list[Cell]:
        """Returns both places: nothing lies between them."""
        return [a] if a == b else [a, b]
