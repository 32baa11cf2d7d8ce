# SPDX-License-Identifier: Apache-2.0
"""Where a vehicle may drive: a line of places, and nowhere else."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

NEAR = 0.3  # share of an edge within which the vehicle stands at a place


class GroundError(ValueError):
    """Places that no vehicle can be driven along; the message says why."""


@dataclass(frozen=True)
class Place:
    """A node [m]."""

    id: str
    x: float
    y: float
    map_id: str = ""

    def distance(self, x: float, y: float) -> float:
        """Returns how far a position is from it [m]."""
        return math.hypot(self.x - x, self.y - y)


class Ground:
    """Places in a line: the vehicle drives from each to its neighbours."""

    def __init__(self, places: Iterable[Place]) -> None:
        self.places = list(places)
        if len(self.places) < 2:
            raise GroundError(f"{len(self.places)} places; two at least were expected")

    @property
    def edges(self) -> int:
        """The count of edges."""
        return len(self.places) - 1

    def at(self, x: float, y: float) -> int | None:
        """Returns the number of the place at which a position is, None if it is at none."""
        k = min(range(len(self.places)), key=lambda i: self.places[i].distance(x, y))
        beside = self.places[k - 1 if k else 1]
        edge = beside.distance(self.places[k].x, self.places[k].y)
        return k if self.places[k].distance(x, y) <= NEAR * edge else None

    def nearest(self, x: float, y: float) -> int:
        """Returns the number of the place that is nearest."""
        return min(range(len(self.places)), key=lambda i: self.places[i].distance(x, y))

    def way(self, here: int, edges: int) -> list[Place]:
        """Returns the places of a way with a number of edges, towards the farther end."""
        ahead = self.edges - here >= here
        numbers = range(here, here + edges + 1) if ahead else range(here, here - edges - 1, -1)
        return [self.places[i] for i in numbers]

    def room(self, here: int) -> int:
        """Returns the count of edges of the longest way from a place."""
        return max(here, self.edges - here)


def straight(
    x: float, y: float, map_id: str, id: str, heading: float, spacing: float, edges: int
) -> Ground:
    """Returns the ground of a vehicle without a list of nodes: `edges` ahead of where it stands."""
    c, s = math.cos(heading) * spacing, math.sin(heading) * spacing
    names = [id, *(f"conform_{k}" for k in range(1, edges + 1))]
    rows = (Place(name, x + k * c, y + k * s, map_id) for k, name in enumerate(names))
    return Ground(rows)


def read(file: Path, here: str, x: float, y: float, edges: int) -> Ground:
    """Returns the ground that a file has: a LIF layout, or a list of {nodeId, x, y, mapId} in the
    order in which they are driven. Raises GroundError."""
    try:
        value = json.loads(file.read_text(encoding="utf-8"))
        if isinstance(value, dict):
            return _of_lif(value, here, x, y, edges)
        return Ground([_place(row) for row in value])
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        if isinstance(error, GroundError):
            raise
        raise GroundError(f"{file}: {error!r}; a LIF layout or a list of nodes expected") from None


def _place(row: dict[str, Any]) -> Place:
    at = row.get("nodePosition", row)
    map_id = str(row.get("mapId") or at.get("mapId") or "")
    return Place(str(row["nodeId"]), float(at["x"]), float(at["y"]), map_id)


def _of_lif(value: dict[str, Any], here: str, x: float, y: float, edges: int) -> Ground:
    """A way of edges that are driven in both directions, from where the vehicle stands."""
    layouts = value["layouts"]
    places = {p.id: p for layout in layouts for p in map(_place, layout["nodes"])}
    ways = {(e["startNodeId"], e["endNodeId"]) for layout in layouts for e in layout["edges"]}
    start = here if here in places else min(places, key=lambda i: places[i].distance(x, y))
    best = _longest([start], {(a, b) for a, b in ways if (b, a) in ways}, edges)
    return Ground([places[i] for i in best])


def _longest(way: list[str], ways: set[tuple[str, str]], edges: int) -> list[str]:
    if len(way) > edges:
        return way
    best = way
    for after in sorted(b for a, b in ways if a == way[-1] and b not in way):
        way_on = _longest([*way, after], ways, edges)
        if len(way_on) > edges:
            return way_on
        best = max(best, way_on, key=len)
    return best
