# SPDX-License-Identifier: Apache-2.0
"""Where on a floor that is not its own a warehouse stands: in which room, or in the open.

A building on a plain has doors, through which its rooms hang together with the outside. Gaps
narrower than DOORS cells are closed, one width after the other, by an opening of the free cells
(those covered by a free square of so many cells); what can then not be reached from the edge of the
floor is inside. A part that is inside is a room if walls make up most of its border: between the
pillars of a forest there are no rooms.
"""

from dataclasses import dataclass

import numpy as np

from warehouse_layout.request import RequestError
from warehouse_layout.stations import STEPS

DOORS = 4  # cells: gaps narrower than this are doors
OPEN = 0.25  # of a room's border may be doors
LEAST = 16  # cells of a room
NEAR = 5.0  # from a point that is asked for to the nearest free cell [m]


@dataclass(frozen=True, eq=False)
class Region:
    """Free cells, (nx, ny) bool, and the one (i, j) around which a warehouse shall stand."""

    mask: np.ndarray
    middle: tuple
    name: str

    @property
    def box(self):
        """Slices of the rectangle around its cells."""
        where = (np.flatnonzero(self.mask.any(axis)) for axis in (1, 0))
        return tuple(slice(w[0], w[-1] + 1) if len(w) else slice(0, 0) for w in where)


def choose(cells, at=None):
    """The Region of Cells where a warehouse shall stand: the largest room, or what a point (x, y)
    [m] is in or near; without rooms the open floor. Raises RequestError."""
    free = ~cells.taken
    rooms = find(free)
    if at is not None:
        return _around(cells, rooms, at)
    if rooms:
        return _room(cells, rooms[0])
    return Region(free, tuple(np.array(free.shape) / 2 - 0.5), f"on the {_open(free.sum())}")


def find(free):
    """The rooms of a floor, masks (nx, ny), the largest first; no two share a cell."""
    found = []
    for gap in range(1, DOORS + 1):
        inside = _inside(free, gap)
        found += [part for part in parts(inside) if _is_room(part, free, inside)]
    found.sort(key=lambda room: -int(room.sum()))
    rooms, used = [], np.zeros_like(free)
    for room in found:
        if not used[room].any():
            rooms.append(room)
            used |= room
    return rooms


def _inside(free, gap):
    """Free cells that can't be reached from the edge of the floor where gaps of less than so many
    cells are closed."""
    wide = _opened(free, gap)
    edge = np.ones_like(free)
    edge[1:-1, 1:-1] = False
    outside = np.zeros_like(free)
    for part in parts(wide):
        if part[edge].any():
            outside |= part
    # What is narrow goes with what is nearest, doors with the outside.
    inside = wide & ~outside
    left = free & ~wide
    while True:
        new = _grown(outside) & left
        outside |= new
        left &= ~new
        more = _grown(inside) & left
        inside |= more
        left &= ~more
        if not (new.any() or more.any()):
            return inside | left


def _opened(free, gap):
    """Cells covered by a free square of gap x gap cells."""
    nx, ny = free.shape
    if min(nx, ny) < gap:
        return np.zeros_like(free)
    fits = np.ones((nx - gap + 1, ny - gap + 1), bool)
    for i, j in np.ndindex(gap, gap):
        fits &= free[i : nx - gap + 1 + i, j : ny - gap + 1 + j]
    out = np.zeros_like(free)
    for i, j in np.ndindex(gap, gap):
        out[i : nx - gap + 1 + i, j : ny - gap + 1 + j] |= fits
    return out


def _is_room(part, free, inside):
    """Whether it is large enough, and walls are most of its border."""
    if part.sum() < LEAST:
        return False
    padded, open_ = np.pad(part, 1), np.pad(free & ~inside, 1)
    border = doors = 0
    for step in STEPS:
        beside = np.roll(padded, step, (0, 1)) & ~padded
        border += beside.sum()
        doors += (beside & open_).sum()
        edge = np.ones_like(padded)
        edge[1:-1, 1:-1] = False
        doors += (beside & edge).sum()  # where the floor ends there is no wall
    return doors <= OPEN * border


def _grown(mask):
    """Its cells and the four around each."""
    out = mask.copy()
    out[1:] |= mask[:-1]
    out[:-1] |= mask[1:]
    out[:, 1:] |= mask[:, :-1]
    out[:, :-1] |= mask[:, 1:]
    return out


def parts(mask):
    """Masks of the parts of a mask (nx, ny) that hang together side by side."""
    labels = _labelled(mask)
    return [labels == number for number in np.unique(labels[labels >= 0])]


def _labelled(mask):
    """(nx, ny) int: the number of the part that a cell is in, -1 where there is none. Runs along y
    are joined with those beside them that they touch."""
    labels, parent, before = np.full(mask.shape, -1), [], []

    def root(run):
        while parent[run] != run:
            parent[run] = parent[parent[run]]
            run = parent[run]
        return run

    for i, column in enumerate(mask):
        edges = np.flatnonzero(np.diff(np.r_[False, column, False].astype(np.int8))).tolist()
        runs = []
        for start, stop in zip(edges[::2], edges[1::2]):
            number = len(parent)
            parent.append(number)
            labels[i, start:stop] = number
            for other_start, other_stop, other in before:
                if other_start < stop and start < other_stop:
                    parent[root(number)] = root(other)
            runs.append((start, stop, number))
        before = runs
    roots = np.array([root(run) for run in range(len(parent))] + [-1])
    return roots[labels]


def _around(cells, rooms, at):
    """The Region that a point [m] is in, or that is nearest to it."""
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
    labels = _labelled(~taken)
    part = labels == labels[middle]
    x, y = middle[0] + cells.x, middle[1] + cells.y
    return Region(part, middle, f"on the {_open(part.sum())}, around ({x}, {y})")


def _open(count):
    return f"open floor of {count} free cells"


def _room(cells, mask, middle=None):
    where = np.argwhere(mask)
    low, high = where.min(0) + (cells.x, cells.y), where.max(0) + (cells.x, cells.y)
    name = f"in the room of {len(where)} free cells from ({low[0]}, {low[1]}) to"
    middle = tuple(where.mean(0)) if middle is None else middle
    return Region(mask, middle, f"{name} ({high[0]}, {high[1]})")
