# SPDX-License-Identifier: Apache-2.0
"""The lanes of a drawing's stations: as they are drawn, or where there is room for one.

See lane_finder for the shapes that a lane without a drawn queue can have.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from warehouse_layout._core import Floor, FloorError, check_layout, layout_faults
from warehouse_layout.file import drawn_floor
from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.drawn_floor import DrawnFloor
from warehouse_layout.file.layout_file import KINDS, Cell, LayoutFile, StationEntry
from warehouse_layout.floor.elevators import tiers
from warehouse_layout.floor.floor_plan import ALL_EXITS
from warehouse_layout.floor.lane_finder import lanes_past
from warehouse_layout.floor.stations import (
    STEPS,
    Station,
    check_lane,
    lane_mask,
    neighbour,
    with_lanes,
)

AROUND = 4  # cells around a lane on which it is checked first
QUEUES = (6, 5, 4, 3, 2, 1)  # cells of a queue that is not drawn, the longest first


@dataclass(frozen=True)
class LaneFault:
    """Why a station has no lane, with the cells that are in the way."""

    station: str
    text: str
    cells: tuple[Cell, ...]


def of_file(file: LayoutFile, drawn: DrawnFloor) -> tuple[list[Station], list[LaneFault]]:
    """Returns the stations of a file that have lanes, and why the others have none.

    Drawn lanes come first, so that lanes which are looked for keep out of them; the stations are in
    the order of the file.
    """
    by_name: dict[str, Station] = {}
    faults: list[LaneFault] = []
    search = _LaneSearch(file, drawn)
    for entry in sorted(file.stations, key=lambda e: not (e.queue and e.exit)):
        try:
            cells, service = search.lane(entry, list(by_name.values()))
            check_lane(f"station {entry.name}", cells, drawn.passable)
            _check_apart(entry, cells, drawn, by_name.values())
            cuts = tuple(
                (int(a), int(b)) for a, b in (_numbers(c, drawn) for c in entry.short_cuts)
            )
            by_name[entry.key] = Station(
                entry.name, KINDS[entry.kind], cells, service, short_cuts=cuts
            )
        except FloorError as error:
            faults.append(LaneFault(entry.name, str(error), _cells_of(entry)))
    return [by_name[e.key] for e in file.stations if e.key in by_name], faults


def _cells_of(entry: StationEntry) -> tuple[Cell, ...]:
    return (*entry.queue, entry.service, *entry.exit)


def _check_apart(
    entry: StationEntry, cells: np.ndarray, drawn: DrawnFloor, others: Iterable[Station]
) -> None:
    for other in others:
        shared = set(cells.tolist()) & set(other.cells.tolist())
        if shared:
            row, column = divmod(min(shared), drawn.passable.shape[1])
            raise FloorError(
                f"the lanes of the stations {entry.name} and {other.name} share the cell"
                f" [{column}, {row}]"
            )
    taken = [c for c in cells.tolist() if not drawn.streets.flat[c]]
    if taken:
        row, column = divmod(taken[0], drawn.passable.shape[1])
        raise FloorError(
            f"the lane of station {entry.name} needs the cell [{column}, {row}] as a street, but it"
            " is drawn as something else"
        )


class _LaneSearch:
    """Looks for lanes that add no fault to a floor.

    Checking a whole floor takes long on a large one: a lane is checked on the floor around it
    first, where most of those that cut others off show it.
    """

    def __init__(self, file: LayoutFile, drawn: DrawnFloor) -> None:
        self._file, self._drawn = file, drawn
        self._known: dict[tuple[bytes, ...], set[str]] = {}  # the last ones, by lanes
        self._tiers = _tiers(file, drawn)

    def lane(self, entry: StationEntry, others: list[Station]) -> tuple[np.ndarray, int]:
        """Returns the cells of a lane (n,) int32 in driving order, and the index of the service
        cell. Raises FloorError where there is no room for one."""
        file, drawn = self._file, self._drawn
        if entry.queue and entry.exit:
            return _numbers(_cells_of(entry), drawn), len(entry.queue)
        before, around = self._faults(others), _Around(file, entry.service, others)
        for cells in _candidates(file, drawn, entry, others):
            numbers, service = _numbers(cells, drawn), cells.index(entry.service)
            station = Station(entry.name, KINDS[entry.kind], numbers, service)
            if around.has_room(station) and self._faults([*others, station]) <= before:
                return numbers, service
        column, row = entry.service
        what = "a queue" if entry.exit else "an exit" if entry.queue else "a lane"
        raise FloorError(
            f"station {entry.name} at [{column}, {row}] has no room for {what}: a lane enters from"
            " a street, passes the service cell and leaves to a street, and must not cut others"
            " off; draw queue and exit, or leave more floor around it"
        )

    def _faults(self, stations: list[Station]) -> set[str]:
        """Returns the faults of the floor with these stations; the next one asks again."""
        lanes = tuple(station.cells.tobytes() for station in stations)
        if lanes not in self._known:
            ways = drawn_floor.exits(self._file.floor, self._drawn, stations)
            floors = [_floor(tier, ways, stations) for tier in self._tiers]
            self._known = {lanes: {fault for floor in floors for fault in check_layout(floor)}}
        return self._known[lanes]


class _Around:
    """The floor around a service cell, as far as its lane can reach and a little farther.

    All ways outside are taken to be open: what is cut off here is cut off on the whole floor.
    """

    def __init__(self, file: LayoutFile, service: Cell, others: Sequence[Station]) -> None:
        self._width = file.shape[1]
        reach = max(QUEUES) + AROUND
        self._low = [max(at - reach, 0) for at in service[::-1]]
        self._part = tuple(slice(low, at + reach + 1) for low, at in zip(self._low, service[::-1]))
        self._floor = np.pad(file.floor[self._part], 1, constant_values=lf.FLOOR)
        lanes = np.pad(lane_mask(others, file.shape)[self._part], 1)
        self._floor[lanes] = lf.WALL  # no robot drives through them
        self._before = _cells_at_fault(self._floor, [])

    def has_room(self, station: Station) -> bool:
        """Returns whether a lane adds no fault here."""
        rows, columns = np.divmod(station.cells, self._width)
        inside = rows - self._low[0] + 1, columns - self._low[1] + 1
        if not all(((at > 0) & (at < n - 1)).all() for at, n in zip(inside, self._floor.shape)):
            return True  # a drawn part of it lies farther away
        numbers = np.ravel_multi_index(inside, self._floor.shape).astype(np.int32)
        with_it = _cells_at_fault(self._floor, [replace(station, cells=numbers)])
        return not with_it - self._before - set(numbers.tolist())


def _cells_at_fault(floor: np.ndarray, stations: list[Station]) -> set[int]:
    drawn = drawn_floor.areas(floor)
    ways = drawn_floor.exits(floor, drawn, stations)
    edge = np.ones(floor.shape, bool)
    edge[2:-2, 2:-2] = False
    ways[edge] = ALL_EXITS
    faults = layout_faults(_floor(drawn, ways, stations))
    return {cell for _, cells in faults for cell in cells}


def _numbers(cells: Iterable[Cell], drawn: DrawnFloor) -> np.ndarray:
    width = drawn.passable.shape[1]
    return np.array([row * width + column for column, row in cells], np.int32)


def _tiers(file: LayoutFile, drawn: DrawnFloor) -> list[DrawnFloor]:
    """Returns the drawing's areas tier by tier: what is passable on each."""
    if not file.elevators:
        return [drawn]
    elevators = [elevator.of_plan(file.shape[1]) for elevator in file.elevators]
    tier = tiers(drawn.passable, elevators)
    return [replace(drawn, passable=tier == number) for number in range(tier.max() + 1)]


def _floor(drawn: DrawnFloor, ways: np.ndarray, stations: list[Station]) -> Floor:
    return Floor(
        drawn.passable,
        storage=drawn.storage,
        parking=drawn.parking,
        lane=lane_mask(stations, drawn.passable.shape),
        exits=with_lanes(ways, drawn.passable, stations),
    )


def _candidates(
    file: LayoutFile, drawn: DrawnFloor, entry: StationEntry, others: Iterable[Station]
) -> Iterator[list[Cell]]:
    """Yields lanes on streets that no other station has, those with long queues first.

    The first ones leave room beside the service cells of stations whose lanes come later.
    """
    free = drawn.streets & ~lane_mask(others, drawn.passable.shape)
    services = np.zeros_like(free)
    for other in file.stations:
        services[other.service[::-1]] = other.key != entry.key
    beside = np.any([neighbour(services, heading) for heading in range(4)], axis=0)
    roomy = list(_fitting(free & ~services & ~beside, drawn, entry))
    yield from roomy
    yield from (cells for cells in _fitting(free & ~services, drawn, entry) if cells not in roomy)


def _fitting(free: np.ndarray, drawn: DrawnFloor, entry: StationEntry) -> Iterator[list[Cell]]:
    """Yields lanes on these cells, (h, w) bool."""
    for cells in _shapes(drawn, entry):
        rows, columns = [row for _, row in cells], [column for column, _ in cells]
        height, width = free.shape
        inside = all(0 <= r < height and 0 <= c < width for c, r in cells)
        if inside and free[rows, columns].all() and len(set(cells)) == len(cells):
            yield cells


def _shapes(drawn: DrawnFloor, entry: StationEntry) -> Iterator[list[Cell]]:
    if entry.queue:
        for dx, dy in STEPS:
            yield [*entry.queue, entry.service, (entry.service[0] + dx, entry.service[1] + dy)]
        return
    towards = drawn_floor.beside(drawn.belts, entry.service) or range(4)
    for queue in QUEUES:
        for lane in lanes_past(entry.service, towards, queue):
            if not entry.exit:
                yield lane
            else:
                yield [*lane[: queue + 1], *entry.exit]
