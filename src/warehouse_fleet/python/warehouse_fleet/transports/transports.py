# SPDX-License-Identifier: Apache-2.0
"""Transports: a storage unit is fetched, brought to a station or a cell, waits there until it is
released, and is stored again. Neither ROS nor physics: Traffic drives, the host sends the lifts."""

from collections.abc import Iterable, Iterator

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE, Reports
from warehouse_fleet.traffic.station_ways import StationWays
from warehouse_fleet.traffic.traffic import STAYS, Traffic
from warehouse_fleet.transports.charging import Charging
from warehouse_fleet.transports.completion import Completion
from warehouse_fleet.transports.dispatch.admit import Admission
from warehouse_fleet.transports.dispatch.arrive import Arrival
from warehouse_fleet.transports.dispatch.assign import Assignment, Matching, nearest_robots
from warehouse_fleet.transports.dispatch.clear import Clearing
from warehouse_fleet.transports.dispatch.depart import Departure
from warehouse_fleet.transports.dispatch.evacuate import Evacuation
from warehouse_fleet.transports.dispatch.idle import idle_robots
from warehouse_fleet.transports.dispatch.lift import LiftWatch
from warehouse_fleet.transports.dispatch.park import CellChoice, Parking
from warehouse_fleet.transports.dispatch.recover import Recovery
from warehouse_fleet.transports.dispatch.reject import Rejection
from warehouse_fleet.transports.distances import Distances
from warehouse_fleet.transports.journeys import Journeys
from warehouse_fleet.transports.lifts import LiftOrder, Lifts
from warehouse_fleet.transports.storing import PlaceChoice, Storing
from warehouse_fleet.transports.streets import Streets
from warehouse_fleet.transports.transport_book import (
    ENDS,
    STAY,
    STORE,
    Kind,
    Step,
    Totals,
    Transport,
    TransportAnswer,
    TransportBook,
    TransportEvent,
)
from warehouse_fleet.transports.transport_requests import TransportRequests
from warehouse_fleet.transports.unfit_units import UnfitUnits
from warehouse_fleet.transports.unit_map import UnitMap, UnitPoses
from warehouse_layout.floor.floor_plan import FloorPlan

__all__ = [
    "ENDS",
    "NOWHERE",
    "STAY",
    "STORE",
    "TransportAnswer",
    "Kind",
    "LiftOrder",
    "Step",
    "Transport",
    "TransportEvent",
    "Transports",
]

LIFTED = 6  # units under way to a station at the most: more only crowd the streets before it


class Transports(TransportRequests):
    """All transports, and the dispatcher that gives them to robots; its phases are in dispatch/.

    Others may decide: `match_robots(asked, free)` yields pairs of a Transport of those `asked` for
    and a robot of the indices `free`; `choose_place(shelf_id, cell, free)` returns one of the cells
    `free` for a unit that is in `cell`; `park(robot)` returns the cell for a robot without more
    work, or None: it waits where it is; `charging.policy` decides which robots are charged when.
    Numbers of transports begin after `last`. No units are known before update_units().
    """

    def __init__(self, plan: FloorPlan, traffic: Traffic, last: int = 0) -> None:
        robots = traffic.robots
        names = [station.name for station in plan.stations]
        super().__init__(plan, TransportBook(robots.kiva_ids, traffic, last, names))
        self._traffic, self.robots = traffic, robots
        self.units = UnitMap(plan)
        tier = plan.tier.ravel() if plan.elevators else None
        self.distances = Distances(plan.width, tier)
        self.aside = (plan.storage | plan.parking).ravel()  # cells where no robot passes
        self.match_robots: Matching = lambda asked, free: nearest_robots(
            self.distances, self.units.cell_of, robots.cell, asked, free
        )
        self.choose_place: PlaceChoice = lambda _shelf_id, cell, free: self.distances.nearest(
            cell, free
        )
        self.park: CellChoice = lambda _robot: None
        self._queue_of = np.full(plan.passable.size, NOWHERE, np.int32)  # a station's, by cell
        for i, station in enumerate(plan.stations):
            self._queue_of[station.queue] = i
        self.charging = Charging(plan.charging, self.distances, robots, traffic, traffic)
        self._build_phases()

    def _build_phases(self) -> None:
        plan, traffic, book = self.plan, self._traffic, self.book
        robots, units, charging = self.robots, self.units, self.charging
        lifts = self._lifts = Lifts(book, robots)
        streets = self._streets = Streets(units, traffic, StationWays(plan))
        completion = self._completion = Completion(book, robots)
        journeys = Journeys(robots, traffic, book.totals)
        storage = plan.storage.ravel()
        storing = self._storing = Storing(
            storage, book, robots, units, traffic, journeys, self._choose_place
        )
        self._recovery = Recovery(book, robots, units, traffic, storing, completion)
        self._lift_watch = LiftWatch(book, robots, lifts, streets, journeys, storing, completion)
        self._arrival = Arrival(book, robots, journeys, lifts, self.arrive)
        self._departure = Departure(book, robots, lifts, storing)
        # The lane of a station has room for its queue and the unit that is served.
        capacity = {s.name: min(LIFTED, s.service + 1) for s in plan.stations}
        self._admission = Admission(book, robots, lifts, streets, capacity)
        ground = plan.passable & ~plan.storage & ~plan.parking & ~plan.lane
        self._evacuation = Evacuation(
            traffic.zones,
            traffic.standing,
            ground.ravel(),
            self.aside,
            self.distances,
            book,
            robots,
            units,
            storing,
        )
        unfit = UnfitUnits(book, robots)
        self._rejection = Rejection(book, robots, unfit, completion)
        self._assignment = Assignment(
            book,
            robots,
            units,
            journeys,
            charging.kept,
            self._match_robots,
            self._evacuation.why,
            unfit,
        )
        self._parking = Parking(
            self.aside, book, robots, completion, charging.cell_of, self._park, traffic
        )
        self._clearing = Clearing(
            self.aside, self.distances, book, robots, units, charging.cell_of, traffic
        )

    # The decisions of others, who may be replaced at any time.

    def _match_robots(
        self, asked: list[Transport], free: np.ndarray
    ) -> Iterable[tuple[Transport, int]]:
        return self.match_robots(asked, free)

    def _choose_place(self, shelf_id: int, cell: int, free: np.ndarray) -> int:
        return self.choose_place(shelf_id, cell, free)

    def _park(self, robot: int) -> int | None:
        return self.park(robot)

    # --- the fleet of TransportRequests

    @property
    def time(self) -> float:
        """The simulated time of the last reports [s]."""
        return self._traffic.time

    @property
    def cell_of_unit(self) -> dict[int, int]:
        """The cell of each unit; NOWHERE: it is carried, or stands across cells."""
        return self.units.cell_of

    def check_reach(self, shelf_id: int, cell: int) -> None:
        """Raises ValueError if no robot can come to a unit; `cell` is on the fleet's floor."""
        if not self.units.is_in_reach(self.units.cell_of[shelf_id]):
            raise ValueError(f"no robot can reach storage unit {shelf_id} and return")

    def taken(self) -> np.ndarray:
        """Returns (cells,) bool: those with a unit, or kept for one that is under way."""
        return self._storing.taken()

    def end(self, transport: Transport) -> None:
        """Removes a transport that is over; its robot is free."""
        self._completion.end(transport)

    def turn_back(self, transport: Transport) -> None:
        """Has a unit that is being brought stored instead."""
        self._storing.store(transport)

    def leave(self, transport: Transport) -> None:
        """Has a unit leave its destination at the next tick."""
        self._departure.add(transport)

    def reject(self, kiva_id: int, shelf_id: int, why: str) -> None:
        """Notes that a robot can't carry a unit: at the next tick others get its transport."""
        self._rejection.add(kiva_id, shelf_id, why)

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
        return self._lifts.take()

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
            self._traffic.shut(cell, poses.stamp + STAYS)
        self.update_cells(cells, poses.stamp)

    def update_cells(self, cells: dict[int, int], stamp: float) -> None:
        """Updates the cell of each unit, {unit: cell}, as seen at that time [s]."""
        lifted = [t.shelf for t in self.book.assigned() if t.step >= Step.LIFTING]
        self.units.update(cells, stamp, lifted)
        for transport in self:
            if transport.shelf not in self.units.cell_of:
                text = f"storage unit {transport.shelf} was removed from the world"
                self._completion.fail(transport, text)
        self._recovery.store_abandoned()
        self._streets.update()

    def held(self) -> list[tuple[Transport, str]]:
        """Returns the transports that wait for a closed zone, or for robots that stand for long,
        each with the reason."""
        rows = [(transport, self._evacuation.why(transport)) for transport in self.book.open]
        return [(transport, why) for transport, why in rows if why]

    # --- the dispatcher

    def advance(self, reports: Reports) -> None:
        """Runs all phases once, by what robots report: aligned reports (n,) of REPORT."""
        self._rejection.run()
        self._recovery.run(reports)
        self._lift_watch.run(reports)
        self._arrival.run()
        self._departure.run()
        self._evacuation.run()
        self._admission.run()
        self._charge(is_wanted=True)
        self._assignment.run()
        self._charge(is_wanted=bool(self.book.open))
        self._parking.run()
        self._clearing.run()

    def _charge(self, is_wanted: bool) -> None:
        if self.charging.is_simulated:
            self.charging.advance(idle_robots(self.robots, self.book), is_wanted)
