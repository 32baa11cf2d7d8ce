# SPDX-License-Identifier: Apache-2.0
"""The choice of storage places for units that robots carry."""

from collections.abc import Callable

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE, RobotTable
from warehouse_fleet.transports.contracts import Roads
from warehouse_fleet.transports.journeys import Journeys
from warehouse_fleet.transports.transport_book import STORING, Transport, TransportBook
from warehouse_fleet.transports.unit_map import UnitMap

# (unit, cell of its robot, free cells (n,)) -> one of the free cells
PlaceChoice = Callable[[int, int, np.ndarray], int]


class Storing:
    """Sends loaded robots to storage places. `storage`, (cells,) bool: which cells are some."""

    def __init__(
        self,
        storage: np.ndarray,
        book: TransportBook,
        robots: RobotTable,
        units: UnitMap,
        roads: Roads,
        journeys: Journeys,
        choose_place: PlaceChoice,
    ) -> None:
        self._storage, self._places = storage, np.flatnonzero(storage)
        self._book, self._robots, self._units = book, robots, units
        self._roads, self._journeys, self._choose_place = roads, journeys, choose_place

    def store(self, transport: Transport) -> None:
        """Sends the loaded robot of a transport to a free storage place."""
        self._book.keep(transport, NOWHERE)
        free = self._free_places()
        start = int(self._robots.cell[transport.robot])
        self._book.keep(transport, int(self._choose_place(transport.shelf, start, free)))
        self._book.go_on(transport, STORING)
        self._journeys.begin(transport.robot, transport.place, transport.place)

    def has_place(self) -> bool:
        """Returns whether a storage place is free that robots can reach now."""
        taken = self.taken()
        taken[self._roads.closed] = True
        taken |= self._roads.is_cut
        return not taken[self._places].all()

    def _free_places(self) -> np.ndarray:
        """Returns the free storage places that robots can reach now; where there are none, those
        that they can reach later."""
        taken = self.taken()
        barred = taken | self._roads.is_cut
        barred[self._roads.closed] = True
        free = self._places[~barred[self._places]]
        return free if len(free) else self._places[~taken[self._places]]

    def is_place(self, cell: int) -> bool:
        """Returns whether a cell is a storage place."""
        return bool(self._storage[cell])

    def taken(self) -> np.ndarray:
        """Returns (cells,) bool: those with a unit, or kept for a unit that is under way."""
        taken = self._units.stands.copy()
        taken[self._book.kept_places()] = True
        taken[self._book.destinations()] = True
        return taken
