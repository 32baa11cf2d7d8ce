# SPDX-License-Identifier: Apache-2.0
"""Shapes of a drawing, and outlines that are drawn as loose lines."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

PLACES = ("belts", "storage", "parking", "charging", "stations", "replenish", "robots", "keep_out")
OUTLINED = (*PLACES, "floor")  # what lines can enclose; walls and streets are lines themselves
JOIN = 0.01  # largest gap between ends that count as joined [m]


@dataclass(frozen=True, eq=False)
class Shape:
    """What is drawn on a layer: a line, an outline, or a place."""

    kind: str  # of dxf_layers.NAMES
    points: np.ndarray  # (n, 2) x y [m]
    closed: bool = False
    filled: bool = False  # walls: the inside belongs to it
    name: str = ""

    @property
    def size(self) -> np.ndarray:
        """Edges along x and y of the rectangle about it [m]."""
        return np.ptp(self.points, axis=0)

    @property
    def centre(self) -> np.ndarray:
        """The middle of that rectangle [m]."""
        return (self.points.min(axis=0) + self.points.max(axis=0)) / 2

    def along(self, step: float) -> np.ndarray:
        """Returns points (n, 2) [m] along its lines, at most a step [m] apart."""
        points = self.points
        if self.closed and len(points) > 1:
            points = np.concatenate([points, points[:1]])
        parts = [points[:1]]
        for a, b in zip(points, points[1:]):
            count = max(1, math.ceil(math.dist(a, b) / step))
            parts.append(a + (b - a) * (np.arange(1, count + 1) / count)[:, None])
        return np.concatenate(parts)


def joined(shapes: list[Shape]) -> list[Shape]:
    """Returns the shapes, those that are lines around a place as one outline each."""
    out = [shape for shape in shapes if not _is_loose(shape)]
    for kind in dict.fromkeys(shape.kind for shape in shapes if _is_loose(shape)):
        out += _outlines([shape for shape in shapes if _is_loose(shape) and shape.kind == kind])
    return out


def _is_loose(shape: Shape) -> bool:
    return shape.kind in OUTLINED and not shape.closed and len(shape.points) > 1


def _outlines(lines: list[Shape]) -> list[Shape]:
    """Returns lines of one kind; those that form a ring, each end at that of one other, as one."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    ends = np.concatenate([segment.points[[0, -1]] for segment in lines])
    pairs = cKDTree(ends).query_pairs(JOIN, output_type="ndarray")
    graph = coo_array((np.ones(len(pairs)), pairs.T), shape=(len(ends), len(ends)))
    _, corner = connected_components(graph, directed=False)
    at = corner.reshape(-1, 2)  # of each line, where it begins and ends
    around: dict[int, list[int]] = {}
    for line, (begin, end) in enumerate(at.tolist()):
        around.setdefault(begin, []).append(line)
        around.setdefault(end, []).append(line)
    out, visited = [], set[int]()
    for first in range(len(lines)):
        if first in visited:
            continue
        ring = _ring(first, at, around)
        visited |= set(ring)
        out += [_closed(lines, ring, at)] if len(ring) > 2 else [lines[i] for i in ring]
    return out


def _ring(first: int, at: np.ndarray, around: dict[int, list[int]]) -> list[int]:
    """Returns the lines of the ring that a line is part of, in order; the line alone without."""
    ring, corner = [first], int(at[first, 1])
    while corner != at[first, 0]:
        following = [line for line in around[corner] if line != ring[-1]]
        if len(around[corner]) != 2 or len(following) != 1 or following[0] in ring:
            return [first]
        ring.append(following[0])
        begin, end = at[ring[-1]].tolist()
        corner = end if begin == corner else begin
    return ring if len(around[corner]) == 2 else [first]


def _closed(lines: list[Shape], ring: Iterable[int], at: np.ndarray) -> Shape:
    parts, corner = [], None
    for line in ring:
        begin, end = at[line].tolist()
        is_forward = corner in (None, begin)
        points = lines[line].points if is_forward else lines[line].points[::-1]
        parts.append(points[:-1])
        corner = end if is_forward else begin
    first = lines[next(iter(ring))]
    return replace(first, points=np.concatenate(parts), closed=True)
