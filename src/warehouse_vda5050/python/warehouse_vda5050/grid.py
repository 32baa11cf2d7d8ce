# SPDX-License-Identifier: Apache-2.0
"""Cells of a floor as nodes: c<column>_<row> is the node in the middle of that cell.

A layout exported as LIF names it <column>_<row>, which is understood as well.
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass

from warehouse_vda5050.model import Node, Position

ID = re.compile(r"c?(\d{1,9})_(\d{1,9})")
TOLERANCE = 0.1  # largest distance of a position from a cell's centre [m]

Cell = tuple[int, int]  # column, row


class GridError(ValueError):
    """No place where a robot can stand; the message names node and reason."""


@dataclass(frozen=True)
class Grid:
    """The cells of a floor: the middle of column 0, row 0 is at x, y; `spacing` is their edge [m].

    `blocked` are those where nothing can stand (walls, belts).
    """

    x: float
    y: float
    spacing: float
    columns: int
    rows: int
    blocked: frozenset[Cell] = frozenset()

    def node_id(self, cell: Cell) -> str:
        """Returns the node id of a cell."""
        return f"c{cell[0]}_{cell[1]}"

    def position(self, cell: Cell) -> tuple[float, float]:
        """Returns the middle of a cell [m]."""
        return self.x + cell[0] * self.spacing, self.y + cell[1] * self.spacing

    def contains(self, cell: Cell) -> bool:
        """Returns whether a cell is on the floor."""
        return 0 <= cell[0] < self.columns and 0 <= cell[1] < self.rows

    def cell_at(self, x: float, y: float) -> Cell:
        """Returns the cell that a position [m] is in, on the floor or not."""
        return round((x - self.x) / self.spacing), round((y - self.y) / self.spacing)

    def cell_of_id(self, node_id: str) -> Cell | None:
        """Returns the cell that a node id names, None if it names none."""
        match = ID.fullmatch(node_id)
        return (int(match[1]), int(match[2])) if match else None

    def cell_of(self, node: Node) -> Cell:
        """Returns the cell of an order's node: by its position, else by its id. Raises GridError.

        An id of the form c<column>_<row> and a position that disagree are refused; other ids are
        not checked if there is a position.
        """
        named = self.cell_of_id(node.id)
        if node.position is None:
            cell = named
            if cell is None:
                raise GridError(
                    f"node {node.id!r} is unknown: neither a nodePosition nor an id such as c3_4"
                )
        else:
            cell = self._cell_of_position(node.id, node.position)
            if named is not None and named != cell:
                raise GridError(
                    f"node {node.id!r} is at {node.position.x}, {node.position.y},"
                    f" which is {self.node_id(cell)}"
                )
        if not self.contains(cell):
            raise GridError(
                f"node {node.id!r} is off the floor of {self.columns} x {self.rows} cells"
            )
        return cell

    def _cell_of_position(self, node_id: str, position: Position) -> Cell:
        if max(abs(position.x - self.x), abs(position.y - self.y)) > 1e6:
            raise GridError(f"node {node_id!r} is off the floor: {position.x}, {position.y}")
        cell = self.cell_at(position.x, position.y)
        x, y = self.position(cell)
        if max(abs(position.x - x), abs(position.y - y)) > TOLERANCE:
            raise GridError(
                f"node {node_id!r} at {position.x}, {position.y} is in the middle of no cell;"
                f" the nearest is {x:g}, {y:g}"
            )
        return cell

    def between(self, a: Cell, b: Cell) -> list[Cell]:
        """Returns the cells from a to b, both included. Raises GridError if they are not in a
        line along the grid."""
        if a[0] != b[0] and a[1] != b[1]:
            raise GridError(f"{self.node_id(a)} and {self.node_id(b)} are not in a line")
        steps = max(abs(b[0] - a[0]), abs(b[1] - a[1]))
        dx, dy = _sign(b[0] - a[0]), _sign(b[1] - a[1])
        return [(a[0] + k * dx, a[1] + k * dy) for k in range(steps + 1)]

    def blocked_among(self, cells: Iterable[Cell]) -> Cell | None:
        """Returns the first cell of some where nothing can stand, None if there is none."""
        return next((cell for cell in cells if cell in self.blocked), None)


def _sign(number: int) -> int:
    return (number > 0) - (number < 0)
