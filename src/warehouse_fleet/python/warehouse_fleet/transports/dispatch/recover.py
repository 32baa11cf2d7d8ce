# SPDX-License-Identifier: Apache-2.0
"""Recovers transports whose robots fail, and units that are found where no transport put them."""

from typing import TYPE_CHECKING

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE, Reports
from warehouse_fleet.transports.dispatch import carry
from warehouse_fleet.transports.transport_book import READY, STORING, Kind
from warehouse_layout.message_enums import RobotMode as Mode
from warehouse_layout.message_enums import Status

if TYPE_CHECKING:
    from warehouse_fleet.transports.transports import Transports

IDLE = int(Status.IDLE)
DEAD = 30.0  # a robot that does not move for so long has its transport taken from it [s]
URGENT = 255  # the highest priority


def run(work: "Transports", reports: Reports) -> None:
    """Takes transports from robots that are lost, gives one to each robot found carrying a unit,
    and sends units elsewhere whose place is closed. reports: (n,) of REPORT."""
    _drop_lost(work)
    _adopt_loaded(work, reports)
    if len(closed := work.traffic.closed):
        _avoid(work, set(closed.tolist()))


def _lost(work: "Transports") -> np.ndarray:
    """(n,) bool: robots that others command, or that have not moved for DEAD seconds."""
    robots = work.robots
    return ~robots.automatic | (work.traffic.time - robots.stalled_since > DEAD)


def _drop_lost(work: "Transports") -> None:
    robots, lost = work.robots, _lost(work)
    has_one = work.book.step_of != NOWHERE
    for robot in (has_one & (lost | robots.broken | robots.lifts_not)).nonzero()[0].tolist():
        transport = work.book.of_robot[robot]
        if transport.step <= READY:
            work.book.unassign(transport)
        elif lost[robot]:  # one that is broken may soon go on
            work.abandoned_units.add(transport.shelf)
            work.fail(transport, _why_lost(work, robot))


def _why_lost(work: "Transports", robot: int) -> str:
    robots = work.robots
    if robots.gone[robot]:
        return "its robot was removed from the world"
    if robots.broken[robot]:
        return "its robot is broken"
    if robots.mode[robot] == Mode.AUTOMATIC:
        return "its robot does not move"
    return f"its robot is {Mode(robots.mode[robot]).name} now"


def _adopt_loaded(work: "Transports", reports: Reports) -> None:
    robots, shelf = work.robots, reports["shelf_id"]
    loaded = shelf != 0
    without = work.book.step_of == NOWHERE
    robots.loaded[without] = loaded[without]
    # A robot that broke while it lifted, or was served, and lost its transport, is free again.
    robots.busy[without & ~robots.broken & (reports["status"] == IDLE)] = False
    ready = without & loaded & robots.stands & ~robots.broken & ~_lost(work)
    for robot in ready.nonzero()[0].tolist():
        _adopt(work, robot, int(shelf[robot]))


def _adopt(work: "Transports", robot: int, shelf: int) -> None:
    """Creates a transport for a robot found carrying a unit without one: the unit is stored. A
    transport that asks for the unit is done after that."""
    asked = work.book.of_unit.get(shelf)
    if asked is not None and asked.robot != NOWHERE:
        return
    transport = work.book.add(shelf, "", int(work.robots.cell[robot]))
    work.book.hand_over(transport, robot)
    work.units.cell_of[shelf] = NOWHERE
    work.robots.loaded[robot] = True
    work.publish_event(transport, Kind.RECEIVED, "its robot was found with it")
    carry.store(work, transport)


def _avoid(work: "Transports", closed: set[int]) -> None:
    """Chooses another place for units that can't get to theirs, which is closed."""
    for transport in work.book.assigned():
        is_away = work.robots.cell[transport.robot] != transport.place
        if transport.step == STORING and transport.place in closed and is_away:
            carry.store(work, transport)


def store_abandoned(work: "Transports") -> None:
    """Creates urgent transports for units that lost robots left in the streets."""
    for shelf in sorted(work.abandoned_units & work.units.cell_of.keys()):
        cell = work.units.cell_of[shelf]
        if cell == NOWHERE or not work.units.is_in_reach(cell):
            continue
        work.abandoned_units.discard(shelf)
        if work.plan.storage.flat[cell]:
            continue
        if shelf in work.book.of_unit:
            work.book.of_unit[shelf].priority = URGENT
            work.book.sort_open()
            continue
        transport = work.book.add(shelf, "", cell, priority=URGENT)
        transport.let_go = True  # to storage, at once
        work.book.enqueue(transport)
        work.publish_event(transport, Kind.RECEIVED, "its robot was lost")
