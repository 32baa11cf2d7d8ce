# SPDX-License-Identifier: Apache-2.0
"""Transports: a storage unit is fetched, brought to a station or a cell, waits there until it is
released, and is stored again. Neither ROS nor physics: Traffic drives, the host sends the lifts."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE, Reports
from warehouse_fleet.traffic.station_ways import StationWays
from warehouse_fleet.traffic.traffic import STAYS, Traffic
from warehouse_fleet.transports.charging import Charging
from warehouse_fleet.transports.dispatch import admit, assign, carry, park, recover
from warehouse_fleet.transports.transport_book import (
    ENDS,
    STAY,
    STORE,
    Answer,
    Kind,
    Step,
    Totals,
    Transport,
    TransportBook,
    TransportEvent,
)
from warehouse_fleet.transports.transport_requests import TransportRequests
from warehouse_fleet.transports.unit_map import UnitMap, UnitPoses
from warehouse_layout.floor.floor_plan import FloorPlan

__all__ = [
    "ENDS",
    "NOWHERE",
    "STAY",
    "STORE",
    "Answer",
    "Kind",
    "LiftOrder",
    "Step",
    "Transport",
    "TransportEvent",
    "Transports",
]

LIFTED = 6  # units under way to a station at the most: more only crowd the streets before it


class LiftOrder(NamedTuple):
    """A robot is to lift (up) or drop a unit, where it stands."""

    kiva_id: int
    shelf_id: int
    up: bool


class Transports(TransportRequests):
    """All transports, and the dispatcher that gives them to robots; its phases are in dispatch/.

    Others may decide: `match_robots(asked, free)` yields pairs of a Transport of those `asked` for
    and a robot of the indices `free`; `choose_place(shelf_id, cell, free)` returns one of the cells
    `free` for a unit that is in `cell`; `park(robot)` returns the cell for a robot without more
    work, or None: it waits where it is; `charging.policy` decides which robots are charged when.
    Numbers of transports begin after `last`. No units are known before update_units().
    """

    def __init__(self, plan: FloorPlan, traffic: Traffic, last: int = 0) -> None:
        names = [station.name for station in plan.stations]
        super().__init__(plan, TransportBook(len(traffic.robots), last, names))
        self.traffic, self.robots = traffic, traffic.robots
        self.units = UnitMap(plan)
        self.match_robots: Callable[
            [list[Transport], np.ndarray], Iterable[tuple[Transport, int]]
        ] = lambda asked, free: assign.nearest_robots(self, asked, free)
        self.choose_place: Callable[[int, int, np.ndarray], int] = lambda _shelf_id, cell, free: (
            self.nearest(cell, free)
        )
        self.park: Callable[[int], int | None] = lambda _robot: None
        # How many units of a station may be lifted at a time: its lane has room for them.
        self.capacity = {one.name: min(LIFTED, one.service + 1) for one in plan.stations}
        self._queue_of = np.full(
            plan.passable.size, NOWHERE, np.int32
        )  # a station's index, by cell
        for i, one in enumerate(plan.stations):
            self._queue_of[one.queue] = i
        self._ways = StationWays(plan)
        self.charging = Charging(plan, traffic, self.distance)
        self.places = np.flatnonzero(plan.storage)  # cells
        self.aside = (plan.storage | plan.parking).ravel()  # cells where no robot passes
        # What the phases keep from tick to tick.
        self.abandoned_units: set[int] = set()  # to be stored, wherever they are
        self.released: list[Transport] = []  # that wait at their destination, and may leave
        self.freed: list[int] = []  # robots that have ended a transport since park ran
        self.shortest: dict[int, int] = {}  # cells of the journey that a robot is on
        self._lifts: list[LiftOrder] = []

    # --- the fleet of TransportRequests

    @property
    def time(self) -> float:
        """The simulated time of the last reports [s]."""
        return self.traffic.time

    @property
    def cell_of_unit(self) -> dict[int, int]:
        """The cell of each unit; NOWHERE: it is carried, or stands across cells."""
        return self.units.cell_of

    def kiva_id(self, robot: int) -> int:
        """Returns the id of a robot, given its index."""
        return int(self.robots.kiva_ids[robot])

    def check_reach(self, shelf_id: int, cell: int) -> None:
        """Raises ValueError if no robot can come to a unit; `cell` is on the fleet's floor."""
        if not self.units.is_in_reach(self.units.cell_of[shelf_id]):
            raise ValueError(f"no robot can reach storage unit {shelf_id} and return")

    def taken(self) -> np.ndarray:
        """Returns (cells,) bool: those with a unit, or kept for one that is under way."""
        taken = self.units.stands.copy()
        taken[self.book.kept_places()] = True
        taken[self.book.destinations()] = True
        return taken

    def end(self, transport: Transport) -> None:
        """Removes a transport that is over; its robot is free."""
        self.book.remove(transport)
        if transport.robot != NOWHERE:
            self.freed.append(transport.robot)
            self.robots.send(transport.robot, NOWHERE)

    def turn_back(self, transport: Transport) -> None:
        """Has a unit that is being brought stored instead."""
        carry.store(self, transport)

    def leave(self, transport: Transport) -> None:
        """Has a unit leave its destination at the next tick."""
        self.released.append(transport)

    def fail(self, transport: Transport, text: str) -> None:
        """Ends a transport that can't be done, for the reason `text`."""
        self.book.totals.failed += 1
        self.publish_event(transport, Kind.FAILED, text)
        self.end(transport)

    # --- state

    def __iter__(self) -> Iterator[Transport]:
        return iter(self.book)

    def __contains__(self, transport_id: object) -> bool:
        return transport_id in self.book

    @property
    def totals(self) -> Totals:
        """What all robots have done so far."""
        return self.book.totals

    def assigned(self) -> list[Transport]:
        """Returns the transports that a robot does."""
        return self.book.assigned()

    def take_lifts(self) -> list[LiftOrder]:
        """Returns the lifts that are to be sent since the last call."""
        lifts, self._lifts = self._lifts, []
        return lifts

    def open_for(self, station: str) -> int:
        """Returns how many transports to a station have no robot yet."""
        return self.book.open_for(station)

    def in_lane(self) -> np.ndarray:
        """Returns (n,) bool: robots in the queue of the station to which their transport goes."""
        station = self.book.station_of
        return (station != NOWHERE) & (self._queue_of[self.robots.cell] == station)

    def update_units(self, poses: UnitPoses) -> None:
        """Updates where all units stand; others than robots move units as well. Units that stand
        across cells are not fetched, and close the cells around them."""
        cells, obstructed = self.units.locate(poses)
        for cell in obstructed:
            self.traffic.shut(cell, poses.stamp + STAYS)
        self.update_cells(cells, poses.stamp)

    def update_cells(self, cells: dict[int, int], stamp: float) -> None:
        """Updates the cell of each unit, {unit: cell}, as seen at that time [s]."""
        lifted = [t.shelf for t in self.book.assigned() if t.step >= Step.LIFTING]
        self.units.update(cells, stamp, lifted)
        for transport in self:
            if transport.shelf not in self.units.cell_of:
                self.fail(transport, f"storage unit {transport.shelf} was removed from the world")
        recover.store_abandoned(self)
        self.close_streets()

    # --- the dispatcher

    def advance(self, reports: Reports) -> None:
        """Runs all phases once, by what robots report: aligned reports (n,) of REPORT."""
        recover.run(self, reports)
        carry.run(self, reports)
        admit.run(self)
        self._charge(is_wanted=True)
        assign.run(self)
        self._charge(is_wanted=bool(self.book.open))
        park.run(self)

    def _charge(self, is_wanted: bool) -> None:
        if self.charging.is_simulated:
            self.charging.advance(self.without_work(), is_wanted)

    def without_work(self) -> np.ndarray:
        """Returns (n,) bool: robots that could be given work."""
        robots = self.robots
        idle = robots.automatic & ~robots.busy & ~robots.loaded & (robots.cell != NOWHERE)
        return idle & (self.book.step_of == NOWHERE)

    def is_cut_off(self, transport: Transport) -> bool:
        """Returns whether no robot can come to the station of a transport, or leave it, with its
        unit now."""
        barred = {*self.traffic.closed.tolist(), *self.units.in_streets()}
        barred.discard(self.cell_of_unit[transport.shelf])
        return self._ways.are_barred(transport.station, barred)

    def close_streets(self) -> None:
        """Closes the cells in which units stand off the storage places for loaded robots."""
        self.traffic.set_units(self.units.in_streets())

    def order_lift(self, transport: Transport, up: bool) -> None:
        """Adds the order that a transport's robot lifts or drops its unit."""
        kiva_id = int(self.robots.kiva_ids[transport.robot])
        self._lifts.append(LiftOrder(kiva_id, transport.shelf, up))

    def nearest(self, cell: int, cells: Sequence[int]) -> int:
        """Returns the nearest of some cells; NOWHERE if there are none."""
        if not len(cells):
            return NOWHERE
        return int(cells[self.distance(cell, np.asarray(cells)).argmin()])

    def distance(self, cell: int, cells: np.ndarray) -> np.ndarray:
        """Returns how far some cells are, along the axes [cells]."""
        (y, x), (ys, xs) = divmod(cell, self.plan.width), np.divmod(cells, self.plan.width)
        return np.abs(xs - x) + np.abs(ys - y)
