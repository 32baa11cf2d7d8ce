# SPDX-License-Identifier: Apache-2.0
"""Chooses where a warehouse stands on the floor of another world: in a room, or in the open.

A building on a plain has doors, which connect its rooms with the outside. Gaps narrower than DOORS
cells are closed, one width after the other: what a free square of that width can't come to, moved
from the edge of the floor, is inside. A part that is inside is a room if walls make up most of its
border: between the pillars of a forest there are no rooms.
"""

from dataclasses import dataclass

import numpy as np

from warehouse_layout.file.request import RequestError
from warehouse_layout.floor import masks
from warehouse_layout.floor.stations import STEPS
from warehouse_layout.generate.cells import Cells

DOORS = 4  # cells: gaps narrower than this are doors
OPEN = 0.25  # largest share of a room's border that may be doors
LEAST = 16  # cells of a room
NEAR = 5.0  # largest distance from a requested point to the nearest free cell [m]

Point = tuple[float, ...]  # x, y


@dataclass(frozen=True, eq=False)
class Region:
    """Free cells, (nx, ny) bool, and the point (i, j) in them that a warehouse shall surround."""

    mask: np.ndarray
    middle: Point
    name: str

    @property
    def box(self) -> tuple[slice, ...]:
        """Slices of the rectangle around its cells."""
        where = (np.flatnonzero(self.mask.any(axis)) for axis in (1, 0))
        return tuple(slice(w[0], w[-1] + 1) if len(w) else slice(0, 0) for w in where)


def choose(cells: Cells, at: Point | None = None) -> Region:
    """Returns the Region of Cells where a warehouse shall stand.

    This is the largest room, or without rooms the open floor. With `at` it is the room or the part
    of the open floor that holds this point, or is nearest to it. Raises RequestError where no cell
    within NEAR of it is free.
    """
    free = ~cells.taken
    rooms = find(free)
    if at is not None:
        return _around(cells, rooms, at)
    if rooms:
        return _room(cells, rooms[0])
    return Region(free, tuple(np.array(free.shape) / 2 - 0.5), f"on the {_open(free.sum())}")


def find(free: np.ndarray) -> list[np.ndarray]:
    """Returns the rooms of a floor as masks (nx, ny), the largest first; no two share a cell."""
    candidates: list[np.ndarray] = []
    for gap in range(1, DOORS + 1):
        inside = _inside(free, gap)
        candidates += [part for part in masks.parts(inside) if _is_room(part, free, inside)]
    candidates.sort(key=lambda room: -int(room.sum()))
    rooms: list[np.ndarray] = []
    used = np.zeros_like(free)
    for room in candidates:
        if not used[room].any():
            rooms.append(room)
            used |= room
    return rooms


def _inside(free: np.ndarray, gap: int) -> np.ndarray:
    """Returns the free cells without a way to the edge of the floor, if narrow gaps were closed.

    A gap is narrow if it is less than `gap` cells wide.
    """
    if min(free.shape) < gap:
        return free
    # Squares are joined by steps of a cell. Two that only touch, in a gate of a wall that runs
    # aslant, may be inside and outside.
    fits = masks.squares(free, gap)
    labels = masks.labelled(fits)
    at_edge = np.concatenate([labels[0], labels[-1], labels[:, 0], labels[:, -1]])
    is_outside = fits & np.isin(labels, at_edge)
    # What is narrow goes with what is nearest, doors with the outside.
    outside = masks.covered(is_outside, gap)
    inside = masks.covered(fits & ~is_outside, gap) & ~outside
    left = free & ~outside & ~inside
    while True:
        new = masks.grown(outside) & left
        outside |= new
        left &= ~new
        more = masks.grown(inside) & left
        inside |= more
        left &= ~more
        if not (new.any() or more.any()):
            return inside | left


def _is_room(part: np.ndarray, free: np.ndarray, inside: np.ndarray) -> bool:
    """Returns whether a part is large enough, with walls along most of its border. Pillars within
    it do not count."""
    if part.sum() < LEAST:
        return False
    around = masks.labelled(~np.pad(part, 1))
    padded, open_ = around != around[0, 0], np.pad(free & ~inside, 1)
    border = doors = 0
    for step in STEPS:
        beside = np.roll(padded, step, (0, 1)) & ~padded
        border += beside.sum()
        doors += (beside & open_).sum()
        edge = np.ones_like(padded)
        edge[1:-1, 1:-1] = False
        doors += (beside & edge).sum()  # where the floor ends there is no wall
    return bool(doors <= OPEN * border)


def _around(cells: Cells, rooms: list[np.ndarray], at: Point) -> Region:
    """Returns the Region that holds a point, or is nearest to it."""
    free = np.argwhere(~cells.taken)
    far = np.hypot(*(free + (cells.x, cells.y) - np.array(at)).T) if len(free) else np.array([])
    if not len(far) or far.min() > NEAR:
        floor = cells.floor
        raise RequestError(
            f"at:={at[0]:g},{at[1]:g}: no cell is free within {NEAR:g} m of it; the floor reaches"
            f" from ({floor.min_x:g}, {floor.min_y:g}) to ({floor.max_x:g}, {floor.max_y:g})"
        )
    middle = tuple(free[far.argmin()].tolist())
    for room in rooms:
        if room[middle]:
            return _room(cells, room, middle)
    taken = cells.taken | np.logical_or.reduce(rooms) if rooms else cells.taken
    labels = masks.labelled(~taken)
    part = labels == labels[middle]
    x, y = middle[0] + cells.x, middle[1] + cells.y
    return Region(part, middle, f"on the {_open(part.sum())}, around ({x}, {y})")


def _open(count: int) -> str:
    return f"open floor of {count} free cells"


def _room(cells: Cells, mask: np.ndarray, middle: Point | None = None) -> Region:
    where = np.argwhere(mask)
    low, high = where.min(0) + (cells.x, cells.y), where.max(0) + (cells.x, cells.y)
    name = f"in the room of {len(where)} free cells from ({low[0]}, {low[1]}) to"
    around = tuple(where.mean(0)) if middle is None else middle
    return Region(mask, around, f"{name} ({high[0]}, {high[1]})")
