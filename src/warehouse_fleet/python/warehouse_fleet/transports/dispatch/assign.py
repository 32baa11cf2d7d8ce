# SPDX-License-Identifier: Apache-2.0
"""Gives open transports to robots without work."""

from collections.abc import Callable, Iterable, Iterator, Mapping

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE, RobotTable
from warehouse_fleet.transports.dispatch.idle import idle_robots
from warehouse_fleet.transports.distances import Distances
from warehouse_fleet.transports.journeys import Journeys
from warehouse_fleet.transports.transport_book import Kind, Transport, TransportBook
from warehouse_fleet.transports.unfit_units import UnfitUnits
from warehouse_fleet.transports.unit_map import UnitMap

FETCHED = 4  # units of a station that are fetched before they may be lifted

# (open transports, indices (m,) of free robots) -> pairs of both
Matching = Callable[[list[Transport], np.ndarray], Iterable[tuple[Transport, int]]]


class Assignment:
    """Assigns robots to transports, as `match_robots` chooses. `kept` returns (n,) bool: robots
    that get no work now; `waits` why a transport can't be done now, empty if it can; `unfit`: the
    units that some robots can't carry."""

    def __init__(
        self,
        book: TransportBook,
        robots: RobotTable,
        units: UnitMap,
        journeys: Journeys,
        kept: Callable[[], np.ndarray],
        match_robots: Matching,
        waits: Callable[[Transport], str],
        unfit: UnfitUnits,
    ) -> None:
        self._book, self._robots, self._units = book, robots, units
        self._journeys, self._kept, self._match_robots = journeys, kept, match_robots
        self._waits, self._unfit = waits, unfit

    def run(self) -> None:
        """Gives open transports to robots without work, a few more than stations have room for."""
        if not self._book.open:
            return
        robots = self._robots
        able = ~robots.stalled & ~robots.lifts_not & ~self._kept()
        free = np.flatnonzero(idle_robots(robots, self._book) & able)
        asked = self._fetchable() if free.size else []
        for transport, robot in self._matched(asked, free) if asked else ():
            self._book.assign(transport, int(robot))
            self._book.publish_event(transport, Kind.ASSIGNED)
            self._journeys.begin(transport.robot, self._units.cell_of[transport.shelf])

    def _matched(self, asked: list[Transport], free: np.ndarray) -> Iterator[tuple[Transport, int]]:
        """Yields pairs as chosen; units that some robots can't carry choose first among the
        others."""
        picky = [transport for transport in asked if self._unfit.robots_of(transport.shelf)]
        for transport in picky:
            able = free[~np.isin(free, [*self._unfit.robots_of(transport.shelf)])]
            for pair in self._match_robots([transport], able) if able.size else ():
                free = free[free != pair[1]]
                yield pair
        rest = [transport for transport in asked if transport not in picky] if picky else asked
        if rest and free.size:
            yield from self._match_robots(rest, free)

    def _fetchable(self) -> list[Transport]:
        """Returns the transports that may have a robot now, the most urgent first."""
        fetchable, fetched = [], self._book.fetched.copy()
        for transport in self._book.open:
            station = transport.station
            is_full = station and fetched[station] >= FETCHED
            if is_full or self._waits(transport):
                continue
            if self._units.cell_of[transport.shelf] != NOWHERE:
                fetched[station] += 1
                fetchable.append(transport)
        return fetchable


def nearest_robots(
    distances: Distances,
    cell_of_unit: Mapping[int, int],
    cell_of_robot: np.ndarray,
    asked: list[Transport],
    free: np.ndarray,
) -> Iterator[tuple[Transport, int]]:
    """Yields each transport with the nearest robot that is free, the most urgent first."""
    for transport in asked[: len(free)]:
        cell = cell_of_unit[transport.shelf]
        robot = free[distances(cell, cell_of_robot[free]).argmin()]
        free = free[free != robot]
        yield transport, int(robot)
