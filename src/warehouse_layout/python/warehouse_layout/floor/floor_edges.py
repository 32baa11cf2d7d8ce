# SPDX-License-Identifier: Apache-2.0
"""The edges between the cells of a floor as arrays, and what can be reached along them."""

import numpy as np

from warehouse_layout._core import Floor

NOWHERE = -1
HEADINGS = 4


class FloorEdges:
    """The edges of a Floor, whose streets may be one-way. They are read when first asked for."""

    def __init__(self, floor: Floor) -> None:
        self._floor = floor
        self._edges: dict[bool, np.ndarray] = {}  # by whether a robot is loaded

    def ahead(self, loaded: bool) -> np.ndarray:
        """Returns (cells, 4) int: the next cell towards each heading, or NOWHERE."""
        if loaded not in self._edges:
            edges = np.asarray(self._floor.edges(loaded)).reshape(-1, HEADINGS)
            self._edges[loaded] = edges
        return self._edges[loaded]

    def before(self, cell: int, loaded: bool) -> np.ndarray:
        """Returns the cells from which a robot drives to a cell, ascending."""
        return np.flatnonzero((self.ahead(loaded) == cell).any(1))

    def reached_from(self, cell: int, loaded: bool, closed: np.ndarray) -> np.ndarray:
        """Returns (cells,) bool: where a robot comes to from a cell while others, (cells,) bool,
        are closed."""
        edges = self.ahead(loaded)
        reached = np.zeros(len(edges), bool)
        reached[cell] = True
        front = np.array([cell])
        while len(front):
            ahead = np.unique(edges[front])
            ahead = ahead[ahead != NOWHERE]
            front = ahead[~reached[ahead] & ~closed[ahead]]
            reached[front] = True
        return reached

    def largest_part(self, streets: np.ndarray) -> np.ndarray:
        """Returns (cells,) bool: the most of `streets`, (cells,) bool, that hang together for
        loaded robots, whichever way they lead."""
        ahead = self.ahead(True)
        part = np.where(streets, np.arange(len(streets)), NOWHERE)
        begin, heading = np.nonzero((ahead != NOWHERE) & streets[:, None])
        end = ahead[begin, heading]
        begin, end = begin[streets[end]], end[streets[end]]
        while (part[begin] != part[end]).any():
            least = np.minimum(part[begin], part[end])
            np.minimum.at(part, begin, least)
            np.minimum.at(part, end, least)
            part[streets] = part[part[streets]]  # jumps to the head of the chain, which halves it
        sizes = np.bincount(part[streets], minlength=1)
        return streets & (part == sizes.argmax())
