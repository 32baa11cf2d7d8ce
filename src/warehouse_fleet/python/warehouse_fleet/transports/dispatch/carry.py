# SPDX-License-Identifier: Apache-2.0
"""Carries units: each transport that a robot does goes on to its next step."""

from typing import TYPE_CHECKING

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE, Reports
from warehouse_fleet.transports.transport_book import (
    BRINGING,
    DROPPING,
    FETCHING,
    LIFTING,
    READY,
    STAY,
    STORING,
    WAITING,
    Kind,
    Step,
    Transport,
)
from warehouse_layout.message_enums import Status

if TYPE_CHECKING:
    from warehouse_fleet.transports.transports import Transports

IDLE = int(Status.IDLE)
DRIVES = np.isin(np.arange(len(Step) + 1), (FETCHING, BRINGING, STORING))  # by step; none: False
LIFT_PATIENCE = 3.0  # a lift that has not begun within this is asked for again [s]
LIFT_ATTEMPTS = 8  # of ten messages one may be lost, and thousands of units are lifted


def run(work: "Transports", reports: Reports) -> None:
    """Goes on where a lift has ended, a robot has arrived or a station has released its unit."""
    book, robots = work.book, work.robots
    lifting = (book.step_of == LIFTING) | (book.step_of == DROPPING)
    ended = lifting & robots.busy & (reports["status"] == IDLE)
    for robot in ended.nonzero()[0].tolist():
        _watch_lift(work, robot, int(reports["shelf_id"][robot]))
    for robot in work.traffic.arrived(DRIVES[book.step_of]).tolist():
        _arrive(work, robot)
    released, work.released = work.released, []
    for transport in sorted(released, key=lambda one: one.turn):
        if transport.step == WAITING and transport.number in book:
            _leave(work, transport)


def _watch_lift(work: "Transports", robot: int, shelf: int) -> None:
    """Goes on with a robot that is idle, and is to lift or drop its unit; shelf: what it carries,
    0: nothing."""
    transport = work.book.of_robot[robot]
    robots, is_up = work.robots, transport.step == LIFTING
    if shelf == (transport.shelf if is_up else 0):
        robots.busy[robot] = False
        _bring(work, transport) if is_up else _stored(work, transport)
    elif robots.astray[robot]:  # lifts again when it is back in the middle
        robots.busy[robot] = False
        work.book.go_on(transport, FETCHING if is_up else STORING, work.traffic.time)
    elif work.traffic.time - transport.since > LIFT_PATIENCE:
        if transport.attempts < LIFT_ATTEMPTS:
            begin_lift(work, transport, transport.step)
        else:
            robots.busy[robot] = False
            work.fail(
                transport, "its robot can't lift it" if is_up else "its robot can't put it down"
            )


def begin_lift(work: "Transports", transport: Transport, step: Step) -> None:
    """Orders a robot to lift or drop its unit: step is LIFTING or DROPPING."""
    work.book.go_on(transport, step, work.traffic.time)
    transport.attempts += 1
    work.robots.busy[transport.robot] = True
    work.order_lift(transport, step == LIFTING)


def send(work: "Transports", transport: Transport, cell: int, home: int = NOWHERE) -> None:
    """Sends a transport's robot to a cell; with a `home` it drives loaded, see RobotTable."""
    robot = transport.robot
    work.traffic.journey(robot)
    begin = int(work.robots.cell[robot])
    loaded = home != NOWHERE
    work.shortest[robot] = work.traffic.floor.shortest(begin, int(cell), loaded=loaded)
    work.robots.send(robot, cell, home)


def _arrive(work: "Transports", robot: int) -> None:
    transport, book = work.book.of_robot[robot], work.book
    _count_journey(work, robot)
    if transport.step == FETCHING:
        book.go_on(transport, READY, work.traffic.time)
    elif transport.step == BRINGING:
        work.robots.busy[robot] = True
        work.arrive(transport)
    else:
        transport.attempts = 0
        begin_lift(work, transport, DROPPING)


def _count_journey(work: "Transports", robot: int) -> None:
    driven, planned, cells = work.traffic.journey(robot)
    totals = work.book.totals
    totals.driven += driven
    totals.planned += planned
    totals.cells += cells
    totals.shortest += work.shortest.pop(robot, cells)


def _bring(work: "Transports", transport: Transport) -> None:
    """The unit has been lifted."""
    place = work.units.lift(transport.shelf)
    work.close_streets()
    work.robots.loaded[transport.robot] = True
    work.publish_event(transport, Kind.LIFTED)
    if transport.let_go:  # goes to no destination
        store(work, transport)
        return
    work.book.go_on(transport, BRINGING, work.traffic.time)
    # The place stays reserved: there is always one to return to.
    work.book.keep(transport, place)
    # A loaded robot may enter one storage place: that of its destination, or the one it leaves.
    is_stored = work.plan.storage.flat[transport.cell]
    send(work, transport, transport.cell, transport.cell if is_stored else place)


def _leave(work: "Transports", transport: Transport) -> None:
    """The unit has been released."""
    work.robots.busy[transport.robot] = False
    work.publish_event(transport, Kind.RELEASED)
    if transport.then == STAY:
        if work.plan.storage.flat[transport.cell]:
            work.book.keep(transport, transport.cell)
        transport.attempts = 0
        begin_lift(work, transport, DROPPING)
    else:
        store(work, transport)


def store(work: "Transports", transport: Transport) -> None:
    """Sends a loaded robot to a free storage place."""
    work.book.keep(transport, NOWHERE)
    taken = work.taken()
    taken[work.traffic.closed] = True
    free = work.places[~taken[work.places]]
    begin = int(work.robots.cell[transport.robot])
    work.book.keep(transport, int(work.choose_place(transport.shelf, begin, free)))
    work.book.go_on(transport, STORING, work.traffic.time)
    send(work, transport, transport.place, transport.place)


def _stored(work: "Transports", transport: Transport) -> None:
    robots = work.robots
    robots.loaded[transport.robot] = False
    cell = int(robots.cell[transport.robot])
    work.units.put_down(transport.shelf, cell, work.traffic.time)
    work.close_streets()
    work.book.totals.stored += 1
    work.publish_event(transport, Kind.STORED)
    work.end(transport)
