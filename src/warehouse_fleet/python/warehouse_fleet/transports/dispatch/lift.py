# SPDX-License-Identifier: Apache-2.0
"""Watches lifts: what has been lifted is brought on, what has been dropped is stored."""

from warehouse_fleet.robots.robot_table import Reports, RobotTable
from warehouse_fleet.transports.completion import Completion
from warehouse_fleet.transports.journeys import Journeys
from warehouse_fleet.transports.lifts import Lifts
from warehouse_fleet.transports.storing import Storing
from warehouse_fleet.transports.streets import Streets
from warehouse_fleet.transports.transport_book import (
    BRINGING,
    DROPPING,
    FETCHING,
    LIFTING,
    STORING,
    Kind,
    Transport,
    TransportBook,
)
from warehouse_layout.message_enums import Status

IDLE = int(Status.IDLE)
LIFT_PATIENCE = 3.0  # a lift that has not begun within this is commanded again [s]
LIFT_ATTEMPTS = 8  # of ten messages one may be lost, and thousands of units are lifted


class LiftWatch:
    """Brings transports whose robots have lifted or dropped their units to the next step."""

    def __init__(
        self,
        book: TransportBook,
        robots: RobotTable,
        lifts: Lifts,
        streets: Streets,
        journeys: Journeys,
        storing: Storing,
        completion: Completion,
    ) -> None:
        self._book, self._robots, self._lifts = book, robots, lifts
        self._streets, self._journeys = streets, journeys
        self._storing, self._completion = storing, completion

    def run(self, reports: Reports) -> None:
        """Looks at robots that were to lift or drop and are idle, by reports (n,) of REPORT."""
        steps = self._book.step_of
        lifting = (steps == LIFTING) | (steps == DROPPING)
        ended = lifting & self._robots.busy & (reports["status"] == IDLE)
        for robot in ended.nonzero()[0].tolist():
            self._look_at(robot, int(reports["shelf_id"][robot]))

    def _look_at(self, robot: int, shelf: int) -> None:
        """Checks the lift of an idle robot. shelf: the unit that it carries, 0: none."""
        transport = self._book.of_robot[robot]
        robots, is_up = self._robots, transport.step == LIFTING
        if shelf == (transport.shelf if is_up else 0):
            robots.busy[robot] = False
            self._bring(transport) if is_up else self._end(transport)
        elif robots.astray[robot]:  # lifts again when it is back in the middle
            robots.busy[robot] = False
            self._book.go_on(transport, FETCHING if is_up else STORING)
        elif self._book.time - transport.since > LIFT_PATIENCE:
            if transport.attempts < LIFT_ATTEMPTS:
                self._lifts.repeat(transport, transport.step)
                return
            robots.busy[robot] = False
            text = "its robot can't lift it" if is_up else "its robot can't put it down"
            self._completion.fail(transport, text)

    def _bring(self, transport: Transport) -> None:
        """Sends a unit that has been lifted to its destination."""
        place = self._streets.lift(transport.shelf)
        self._robots.loaded[transport.robot] = True
        self._book.publish_event(transport, Kind.LIFTED)
        if transport.leave:  # goes to no destination
            self._storing.store(transport)
            return
        self._book.go_on(transport, BRINGING)
        # The place stays reserved: there is always one to return to.
        self._book.keep(transport, place)
        # A loaded robot may enter one storage place: that of its destination, or the one it leaves.
        home = transport.cell if self._storing.is_place(transport.cell) else place
        self._journeys.begin(transport.robot, transport.cell, home)

    def _end(self, transport: Transport) -> None:
        """Ends the transport of a unit that has been put down."""
        self._robots.loaded[transport.robot] = False
        cell = int(self._robots.cell[transport.robot])
        self._streets.put_down(transport.shelf, cell, self._book.time)
        self._book.totals.stored += 1
        if transport.is_put_back:
            self._completion.put_back(transport)
            return
        self._book.publish_event(transport, Kind.STORED)
        self._completion.end(transport)
