# SPDX-License-Identifier: Apache-2.0
"""Carries units: each transport that a robot does goes on to its next step."""

from typing import TYPE_CHECKING

import numpy as np

from warehouse_fleet.message_enums import Status
from warehouse_fleet.robot_table import NOWHERE
from warehouse_fleet.transport_book import STAY, Kind, Step, Transport

if TYPE_CHECKING:
    from warehouse_fleet.transports import Transports

LIFT_PATIENCE = 3.0  # a lift that has not begun within this is asked for again [s]
LIFT_ATTEMPTS = 8  # of ten messages one may be lost, and thousands of units are lifted


def run(work: "Transports", reports: np.ndarray) -> None:
    """Goes on where a lift has ended, a robot has arrived or a station has released its unit."""
    for robot in np.flatnonzero(work.robots.busy).tolist():
        _watch_lift(work, robot, reports[robot])
    for robot in work.traffic.arrived.tolist():
        _arrive(work, robot)
    for transport in work.book.assigned():
        if transport.step == Step.WAITING and transport.let_go:
            _leave(work, transport)


def _watch_lift(work: "Transports", robot: int, report: np.void) -> None:
    transport = work.book.of_robot.get(robot)
    if transport is None or transport.step not in (Step.LIFTING, Step.DROPPING):
        return
    if report["status"] != Status.IDLE:
        return
    robots, is_up = work.robots, transport.step == Step.LIFTING
    if report["shelf_id"] == (transport.shelf if is_up else 0):
        robots.busy[robot] = False
        _bring(work, transport) if is_up else _stored(work, transport)
    elif robots.astray[robot]:  # lifts again when it is back in the middle
        robots.busy[robot] = False
        transport.step = Step.FETCHING if is_up else Step.STORING
        if is_up:
            work.book.inbound[transport.station] -= 1
            work.book.fetched[transport.station] += 1
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
    transport.step, transport.since = step, work.traffic.time
    transport.attempts += 1
    work.robots.busy[transport.robot] = True
    work.order_lift(transport, step == Step.LIFTING)


def send(work: "Transports", transport: Transport, cell: int, home: int = NOWHERE) -> None:
    """Sends a transport's robot to a cell; with a `home` it drives loaded, see RobotTable."""
    robot = transport.robot
    work.traffic.journey(robot)
    begin = int(work.robots.cell[robot])
    loaded = home != NOWHERE
    work.shortest[robot] = work.traffic.floor.shortest(begin, int(cell), loaded=loaded)
    work.robots.send(robot, cell, home)


def _arrive(work: "Transports", robot: int) -> None:
    transport = work.book.of_robot.get(robot)
    if transport is None:
        return
    if transport.step in (Step.FETCHING, Step.BRINGING, Step.STORING):
        _count_journey(work, robot)
    if transport.step == Step.FETCHING:
        transport.step, transport.since = Step.READY, work.traffic.time
        work.book.ready.append(transport)
    elif transport.step == Step.BRINGING:
        transport.step, transport.since = Step.WAITING, work.traffic.time
        work.robots.busy[robot] = True
        work.book.totals.delivered += 1
        work.publish_event(transport, Kind.ARRIVED)
        if not transport.station:
            transport.let_go = True
    elif transport.step == Step.STORING:
        transport.attempts = 0
        begin_lift(work, transport, Step.DROPPING)


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
    if transport.let_go:  # was cancelled meanwhile
        store(work, transport)
        return
    transport.step, transport.since = Step.BRINGING, work.traffic.time
    # The place stays reserved: there is always one to return to.
    transport.place = place
    # A loaded robot may enter one storage place: that of its destination, or the one it leaves.
    is_stored = work.plan.storage.flat[transport.cell]
    send(work, transport, transport.cell, transport.cell if is_stored else place)


def _leave(work: "Transports", transport: Transport) -> None:
    """The unit has been released."""
    work.robots.busy[transport.robot] = False
    work.publish_event(transport, Kind.RELEASED)
    work.book.inbound[transport.station] -= 1
    if transport.then == STAY:
        if work.plan.storage.flat[transport.cell]:
            transport.place = transport.cell
        transport.attempts = 0
        begin_lift(work, transport, Step.DROPPING)
    else:
        store(work, transport, is_inbound=False)


def store(work: "Transports", transport: Transport, is_inbound: bool = True) -> None:
    """Sends a loaded robot to a free storage place; is_inbound: its station counts on it still."""
    if is_inbound:
        work.book.inbound[transport.station] -= 1
    transport.place = NOWHERE
    out = work.taken_cells() | set(work.traffic.closed.tolist())
    free = np.array([cell for cell in work.places.tolist() if cell not in out])
    begin = int(work.robots.cell[transport.robot])
    transport.place = int(work.choose_place(transport.shelf, begin, free))
    transport.step, transport.since = Step.STORING, work.traffic.time
    send(work, transport, transport.place, transport.place)


def _stored(work: "Transports", transport: Transport) -> None:
    robots = work.robots
    robots.loaded[transport.robot] = False
    cell = int(robots.cell[transport.robot])
    work.units.put_down(transport.shelf, cell, work.traffic.time)
    work.close_streets()
    work.book.totals.stored += 1
    work.publish_event(transport, Kind.STORED)
    transport.step = Step.DROPPING
    work.end(transport)
