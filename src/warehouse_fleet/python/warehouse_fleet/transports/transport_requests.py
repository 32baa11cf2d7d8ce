# SPDX-License-Identifier: Apache-2.0
"""The requests to a fleet for transports. What is asked for is answered, and events follow, in the
same way whichever fleet it is: robots that drive, or ideal ones."""

from abc import ABC, abstractmethod
from collections.abc import Mapping

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE
from warehouse_fleet.transports.transport_book import (
    BRINGING,
    READY,
    STAY,
    STORE,
    WAITING,
    Kind,
    Leave,
    Transport,
    TransportAnswer,
    TransportBook,
    TransportEvent,
)
from warehouse_layout.floor.floor_plan import FloorPlan


class TransportRequests(ABC):
    """The requests to the fleet whose transports are in `book`, on a FloorPlan. A fleet says what
    stands where, and carries out what has been granted."""

    def __init__(self, plan: FloorPlan, book: TransportBook) -> None:
        self.plan, self.book = plan, book
        self.stations = {station.name: station for station in plan.stations}
        self.is_open = dict.fromkeys(self.stations, True)
        self.left_out: frozenset[str] = frozenset()  # stations that no robot can reach

    # --- the fleet

    @property
    @abstractmethod
    def cell_of_unit(self) -> Mapping[int, int]:
        """The cell of each unit; NOWHERE: it is carried, or stands across cells."""

    @abstractmethod
    def check_reach(self, shelf_id: int, cell: int) -> None:
        """Raises ValueError if no robot can bring a unit to a cell and return."""

    @abstractmethod
    def taken(self) -> np.ndarray:
        """Returns (cells,) bool: those with a unit, or kept for one that is under way."""

    @abstractmethod
    def end(self, transport: Transport) -> None:
        """Removes a transport that is over; its robot is free."""

    @abstractmethod
    def turn_back(self, transport: Transport) -> None:
        """Has a unit that is being brought stored instead."""

    @abstractmethod
    def leave(self, transport: Transport) -> None:
        """Has a unit leave its destination that has been let go there, now or soon."""

    # --- requests

    def submit(
        self,
        shelf_id: int,
        station: str = "",
        x: float | None = None,
        y: float | None = None,
        then: int = STORE,
        priority: int = 0,
    ) -> TransportAnswer:
        """Asks for a unit to be brought to a station, or to the cell at (x, y) [m]."""
        try:
            self._check(shelf_id, then)
            cell = self._destination(shelf_id, station, x, y)
            self.check_reach(shelf_id, cell)
        except ValueError as error:
            return TransportAnswer(0, False, str(error))
        transport = self.book.add(shelf_id, station, cell, then, priority)
        self.book.enqueue(transport)
        self.book.publish_event(transport, Kind.RECEIVED)
        return TransportAnswer(transport.number, True, "")

    def _check(self, shelf_id: int, then: int) -> None:
        if shelf_id in self.book.of_unit:
            number = self.book.of_unit[shelf_id].number
            raise ValueError(f"storage unit {shelf_id} has transport {number} already")
        if shelf_id not in self.cell_of_unit:
            raise ValueError(f"there is no storage unit {shelf_id}")
        if then not in (STORE, STAY):
            raise ValueError(f"then is {then}; 0 (STORE) or 1 (STAY) was expected")

    def _destination(self, shelf_id: int, station: str, x: float | None, y: float | None) -> int:
        if station:
            if station in self.left_out:
                raise ValueError(f"no robot can reach station {station} and return")
            if station not in self.stations:
                raise ValueError(f"there is no station {station!r}")
            if not self.is_open[station]:
                raise ValueError(f"station {station} is closed")
            return self.stations[station].service_cell
        if x is None or y is None or not np.isfinite([x, y]).all():
            raise ValueError(f"neither a station nor a point: ({x}, {y})")
        cell = int(self.plan.cell_of(x, y))
        if cell == NOWHERE or not self.plan.passable.flat[cell]:
            raise ValueError(f"no robot can stand at ({x:g}, {y:g})")
        if self.plan.lane.flat[cell]:
            raise ValueError(f"({x:g}, {y:g}) is in the lane of a station; name the station")
        if self.taken()[cell] and self.cell_of_unit[shelf_id] != cell:
            raise ValueError(f"({x:g}, {y:g}) is taken")
        return cell

    def release(self, transport_id: int) -> tuple[bool, str]:
        """Releases a unit that has arrived at its destination. Returns (success, message)."""
        transport = self.book.get(transport_id)
        if transport is None:
            return False, f"there is no transport {transport_id} under way"
        if transport.leave == Leave.CANCELLED:
            return False, f"transport {transport_id} was cancelled"
        if transport.leave or (transport.step > WAITING and not transport.is_put_back):
            return False, f"transport {transport_id} has been released already"
        if transport.step != WAITING:
            return False, f"transport {transport_id} has not arrived yet"
        self._let_go(transport, Leave.RELEASED)
        return True, ""

    def cancel(self, transport_id: int) -> tuple[bool, str]:
        """Ends a transport; a unit that is lifted is stored again, from its station as well. Does
        nothing where the unit has been released or the transport cancelled. Returns (success,
        message)."""
        transport = self.book.get(transport_id)
        if transport is None:
            return False, f"there is no transport {transport_id} under way"
        if transport.leave == Leave.CANCELLED:
            return True, ""
        if transport.step <= READY:
            self.book.publish_event(transport, Kind.CANCELLED)
            self.end(transport)
            return True, ""
        if transport.leave or (transport.step > WAITING and not transport.is_put_back):
            return True, ""
        self.book.publish_event(transport, Kind.CANCELLED)
        transport.then, transport.is_put_back = STORE, False
        self._let_go(transport, Leave.CANCELLED)
        if transport.step == BRINGING:
            self.turn_back(transport)
        return True, ""

    def _let_go(self, transport: Transport, leave: Leave) -> None:
        transport.leave = leave
        if transport.step == WAITING:
            self.leave(transport)

    def set_open(self, station: str, is_open: bool) -> None:
        """Opens or closes a station. A closed one gets no more units; those on the way there are
        stored again."""
        self.is_open[station] = is_open
        if is_open:
            return
        for transport in self.book:
            if transport.station == station and transport.step < WAITING:
                self.cancel(transport.number)

    # --- state

    def arrive(self, transport: Transport) -> None:
        """Notes that a unit has arrived at its destination, where it waits to be released. A unit
        that stays in a cell is put down at once."""
        self.book.go_on(transport, WAITING)
        self.book.totals.delivered += 1
        self.book.publish_event(transport, Kind.ARRIVED)
        if not transport.station and transport.then == STAY:
            self._let_go(transport, Leave.RELEASED)

    def take_events(self) -> list[TransportEvent]:
        """Returns all events since the last call, in order."""
        return self.book.take_events()

    def waiting(self, station: str) -> int:
        """Returns how many units are at a station or on the way to it."""
        return self.book.waiting(station)
