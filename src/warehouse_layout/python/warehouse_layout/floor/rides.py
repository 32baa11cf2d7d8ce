# SPDX-License-Identifier: Apache-2.0
"""Ways that lead from tier to tier: drives, with rides of elevators between them.

Each drive is from standstill to standstill, so times of a way add up: drives and rides. That robots
wait for an elevator comes on top.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple, Protocol

import numpy as np

from warehouse_layout.floor.elevators import Elevator


class Ride(NamedTuple):
    """A ride between two cells of an elevator, by its index in the plan, and its time [s]."""

    elevator: int
    start: int
    end: int
    seconds: float


class Leg(NamedTuple):
    """A drive: its time [s], its length [m], where it ends, and the ride after it."""

    seconds: float
    metres: float
    end: int
    ride: Ride | None = None


def rides_of(elevators: Sequence[Elevator]) -> list[Ride]:
    """Returns all rides of a plan's elevators."""
    return [Ride(i, *ride) for i, elevator in enumerate(elevators) for ride in elevator.rides()]


class Option(NamedTuple):
    """A way with one ride: the time to the elevator and that of the whole way, without waiting
    [s]."""

    ride: Ride
    there: float
    seconds: float


class RoutesOfDrives(Protocol):
    """Routes from one cell to all others, or back, without rides; see travel.Table."""

    seconds: np.ndarray
    metres: np.ndarray

    def cells(self, cell: int) -> list[int]:
        """Returns the cells of the route between the table's own cell and another."""


class _Next(NamedTuple):
    """How a way goes on from the far end of a ride to the table's own cell."""

    seconds: float
    metres: float
    ride: Ride
    after: int | None  # the far end of the next ride; None: the rest is driven


class JoinedTable:
    """A Table of routes with rides.

    seconds, metres: by cell; or inf. distance: metres, and those that count for a change of
    tiers. near: the end of a ride towards the table's own cell, far: the other one.
    """

    def __init__(
        self,
        direct: RoutesOfDrives,
        rides: Sequence[Ride],
        table_of: Callable[[int], RoutesOfDrives],
        is_forward: bool,
        change: float,
    ) -> None:
        self._direct, self._table_of, self._is_forward = direct, table_of, is_forward
        self._rides = rides
        self._next = self._ways_on(rides)
        self.seconds, self.metres = direct.seconds.copy(), direct.metres.copy()
        self._far = np.full(len(direct.seconds), -1, np.int64)  # of the first ride, by cell
        for far, on in self._next.items():
            table = table_of(far)
            seconds = table.seconds + on.seconds
            better = seconds < self.seconds
            self.seconds[better] = seconds[better]
            self.metres[better] = table.metres[better] + on.metres
            self._far[better] = far
        self.distance = self.metres + np.where(self._far >= 0, change, 0.0)

    def _ends(self, ride: Ride) -> tuple[int, int]:
        """Returns the near and the far end of a ride."""
        return (ride.start, ride.end) if self._is_forward else (ride.end, ride.start)

    def _ways_on(self, rides: Sequence[Ride]) -> dict[int, _Next]:
        """Returns the best way on from each far end: shortest paths by Bellman and Ford."""
        out: dict[int, _Next] = {}
        changed = True
        while changed:
            changed = False
            for ride in rides:
                near, far = self._ends(ride)
                for after in (None, *out):
                    on = self._through(ride, near, after, out)
                    if on.seconds < (out[far].seconds if far in out else math.inf):
                        out[far] = on
                        changed = True
        return out

    def _through(self, ride: Ride, near: int, after: int | None, known: dict[int, _Next]) -> _Next:
        """Returns the way on by a ride, and from its near end straight or by the next far end."""
        table = self._direct if after is None else self._table_of(after)
        rest = _Next(0.0, 0.0, ride, None) if after is None else known[after]
        return _Next(
            ride.seconds + float(table.seconds[near]) + rest.seconds,
            float(table.metres[near]) + rest.metres,
            ride,
            after,
        )

    def options(self, cell: int) -> Iterator[Option]:
        """Yields the ways to or from a cell with one ride, if the shortest way has rides."""
        if self._far[cell] < 0:
            return
        for ride in self._rides:
            near, far = self._ends(ride)
            drives = self._table_of(far).seconds[cell], self._direct.seconds[near]
            if np.isfinite(drives).all():
                first, last = drives[::-1] if self._is_forward else drives
                yield Option(ride, float(first), float(first + ride.seconds + last))

    def _parts(self, cell: int, via: Ride | None) -> list[tuple[RoutesOfDrives, int, Ride | None]]:
        """Returns (table, cell, ride) of each drive between a cell and the table's own one: the
        table's routes from there, and the ride at its own cell."""
        if via:
            near, far = self._ends(via)
            return [(self._table_of(far), cell, via), (self._direct, near, None)]
        out: list[tuple[RoutesOfDrives, int, Ride | None]] = []
        next_far: int | None = int(self._far[cell]) if self._far[cell] >= 0 else None
        while next_far is not None:
            on = self._next[next_far]
            out.append((self._table_of(next_far), cell, on.ride))
            cell, next_far = self._ends(on.ride)[0], on.after
        return [*out, (self._direct, cell, None)]

    def runs(self, cell: int, via: Ride | None = None) -> list[list[int]]:
        """Returns the cells of each drive between a cell and the table's own one; via: the only
        ride; None: by the shortest way."""
        return [table.cells(start) for table, start, _ in self._parts(cell, via)]

    def legs(self, cell: int, own: int, via: Ride | None = None) -> list[Leg]:
        """Returns the drives and rides of the route between a cell and the table's own one, in the
        order of driving; via: as that of runs()."""
        parts = self._parts(cell, via)
        drives = [(float(t.seconds[at]), float(t.metres[at])) for t, at, _ in parts]
        rides = [ride for _, _, ride in parts if ride]
        if self._is_forward:
            drives, rides = drives[::-1], rides[::-1]
        return _legs(drives, rides, cell if self._is_forward else own)


def _legs(drives: Sequence[tuple[float, float]], rides: Sequence[Ride], end: int) -> list[Leg]:
    legs = [Leg(*drive, ride.start, ride) for drive, ride in zip(drives, rides)]
    return [*legs, Leg(*drives[-1], end)]


Drive = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


class Chains:
    """Shortest chains of rides between cells of elevators, for robots whose drives between them
    have a closed form: drive(cells (n, 1), to (1, m)) returns times [s] and lengths [m], (n, m)."""

    def __init__(self, rides: Sequence[Ride], tier: np.ndarray, drive: Drive) -> None:
        self._all, self._tier, self._drive = rides, tier, drive
        self.starts = np.array(sorted({ride.start for ride in rides}), int)
        self.ends = np.array(sorted({ride.end for ride in rides}), int)
        index = {int(cell): i for i, cell in enumerate(self.starts)}
        to = {int(cell): i for i, cell in enumerate(self.ends)}
        shape = len(self.starts), len(self.ends)
        self._seconds = np.full(shape, np.inf)
        self._metres = np.zeros(shape)
        self._rides: dict[tuple[int, int], tuple[Ride, ...]] = {}
        for ride in rides:
            self._offer(index[ride.start], to[ride.end], ride.seconds, 0.0, (ride,))
        self._join()

    def _join(self) -> None:
        """Joins chains until none becomes shorter."""
        between, metres = self._apart(self.ends, self.starts)
        changed = True
        while changed:
            known = list(self._rides.items())
            changed = False
            for (i, j), first in known:
                for (k, m), then in known:
                    seconds = self._seconds[i, j] + between[j, k] + self._seconds[k, m]
                    length = self._metres[i, j] + metres[j, k] + self._metres[k, m]
                    changed |= self._offer(i, m, seconds, length, (*first, *then))

    def _offer(
        self, i: int, j: int, seconds: float, metres: float, rides: tuple[Ride, ...]
    ) -> bool:
        """Notes a chain if it is the shortest so far; returns whether it is."""
        if not seconds < self._seconds[i, j]:
            return False
        self._seconds[i, j], self._metres[i, j], self._rides[i, j] = seconds, metres, rides
        return True

    def _apart(self, cells: np.ndarray, to: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Returns times and lengths of drives, (n, m); inf from one tier to another."""
        seconds, metres = self._drive(cells[:, None], to[None, :])
        apart = self._tier[cells][:, None] != self._tier[to][None, :]
        return np.where(apart, np.inf, seconds), metres

    def joined(self, cells: np.ndarray, to: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Returns times [s] and driven lengths [m] of ways, (n, m)."""
        seconds, metres = self._apart(cells, to)
        if np.isfinite(seconds).all():
            return seconds, metres
        there, there_m = self._apart(cells, self.starts)
        back, back_m = self._apart(self.ends, to)
        first = there[:, :, None] + self._seconds  # (n, starts, ends)
        start = first.argmin(axis=1)  # (n, ends)
        first = np.take_along_axis(first, start[:, None], axis=1)[:, 0]
        driven = np.take_along_axis(there_m, start, axis=1)
        driven = driven + self._metres[start, np.arange(len(self.ends))]
        whole = first[:, :, None] + back  # (n, ends, m)
        end = whole.argmin(axis=1)  # (n, m)
        by_rides = np.take_along_axis(whole, end[:, None], axis=1)[:, 0]
        length = np.take_along_axis(driven, end, axis=1) + back_m[end, np.arange(len(to))]
        better = ~np.isfinite(seconds)  # on one tier robots drive
        return np.where(better, by_rides, seconds), np.where(better, length, metres)

    def options(self, start: int, end: int) -> Iterator[Option]:
        """Yields the ways between two cells with one ride, if they are on two tiers."""
        tier = self._tier
        if tier[start] == tier[end]:
            return
        for ride in self._all:
            if (tier[ride.start], tier[ride.end]) == (tier[start], tier[end]):
                first, last = self._one(start, ride.start)[0], self._one(ride.end, end)[0]
                yield Option(ride, first, first + ride.seconds + last)

    def legs(self, start: int, end: int, via: Ride | None = None) -> list[Leg]:
        """Returns the drives and rides of the way between two cells; via: the only ride; None: by
        the shortest way."""
        rides = (via,) if via else self._shortest(start, end)
        stops = [start, *(cell for ride in rides for cell in (ride.start, ride.end)), end]
        drives = [self._one(a, b) for a, b in zip(stops[::2], stops[1::2])]
        return _legs(drives, rides, end)

    def _shortest(self, start: int, end: int) -> tuple[Ride, ...]:
        """Returns the rides of the shortest way between two cells; () on one tier."""
        if self._tier[start] == self._tier[end]:
            return ()
        there, _ = self._apart(np.array([start]), self.starts)
        back, _ = self._apart(self.ends, np.array([end]))
        whole = there[0][:, None] + self._seconds + back[:, 0]
        first, last = np.unravel_index(int(whole.argmin()), whole.shape)
        return self._rides[int(first), int(last)]

    def _one(self, start: int, end: int) -> tuple[float, float]:
        """Returns time and length of one drive."""
        seconds, metres = self._drive(np.array(start), np.array(end))
        return float(seconds), float(metres)
