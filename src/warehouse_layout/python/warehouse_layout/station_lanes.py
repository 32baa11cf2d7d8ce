# SPDX-License-Identifier: Apache-2.0
"""The lanes of a drawing's stations: as they are drawn, or where there is room for one.

See lane_finder for the shapes that a lane without a drawn queue can have.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from warehouse_layout import drawn_floor
from warehouse_layout._core import Floor, FloorError, check_layout
from warehouse_layout.drawn_floor import DrawnFloor
from warehouse_layout.lane_finder import lanes_past
from warehouse_layout.layout_file import KINDS, Cell, LayoutFile, StationEntry
from warehouse_layout.stations import (
    STEPS,
    Station,
    check_lane,
    lane_mask,
    neighbour,
    with_lanes,
)

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
    found: dict[str, Station] = {}
    faults: list[LaneFault] = []
    for entry in sorted(file.stations, key=lambda e: not (e.queue and e.exit)):
        try:
            cells, service = _lane(file, drawn, entry, found.values())
            check_lane(f"station {entry.name}", cells, drawn.passable)
            _check_apart(entry, cells, drawn, found.values())
            found[entry.key] = Station(entry.name, KINDS[entry.kind], cells, service)
        except FloorError as error:
            faults.append(LaneFault(entry.name, str(error), _cells_of(entry)))
    return [found[e.key] for e in file.stations if e.key in found], faults


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


def _lane(
    file: LayoutFile, drawn: DrawnFloor, entry: StationEntry, others: Iterable[Station]
) -> tuple[np.ndarray, int]:
    """Returns the cells of a lane (n,) int32 in driving order, and the index of the service cell.

    Raises FloorError where there is no room for one.
    """
    others = list(others)
    if entry.queue and entry.exit:
        return _numbers(_cells_of(entry), drawn), len(entry.queue)
    before = _faults(file, drawn, others)
    for cells in _candidates(file, drawn, entry, others):
        numbers, service = _numbers(cells, drawn), cells.index(entry.service)
        station = Station(entry.name, KINDS[entry.kind], numbers, service)
        if _faults(file, drawn, [*others, station]) <= before:
            return numbers, service
    column, row = entry.service
    what = "queue" if entry.exit else "exit" if entry.queue else "lane"
    raise FloorError(
        f"station {entry.name} at [{column}, {row}] has no room for a {what}: a lane enters from a"
        " street, passes the service cell and leaves to a street, and must not cut others off;"
        " draw queue and exit, or leave more floor around it"
    )


def _numbers(cells: Iterable[Cell], drawn: DrawnFloor) -> np.ndarray:
    width = drawn.passable.shape[1]
    return np.array([row * width + column for column, row in cells], np.int32)


def _faults(file: LayoutFile, drawn: DrawnFloor, stations: list[Station]) -> set[str]:
    ways = drawn_floor.exits(file.floor, drawn, stations)
    floor = Floor(
        drawn.passable,
        storage=drawn.storage,
        parking=drawn.parking,
        lane=lane_mask(stations, drawn.passable.shape),
        exits=with_lanes(ways, drawn.passable, stations),
    )
    return set(check_layout(floor))


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
