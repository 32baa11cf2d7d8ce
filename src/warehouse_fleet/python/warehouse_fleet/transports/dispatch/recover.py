# SPDX-License-Identifier: Apache-2.0
"""Recovers transports whose robots fail, and units that no transport put where they are."""

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE, Reports, RobotTable
from warehouse_fleet.transports.completion import Completion
from warehouse_fleet.transports.contracts import Roads
from warehouse_fleet.transports.storing import Storing
from warehouse_fleet.transports.transport_book import READY, STORING, Kind, Leave, TransportBook
from warehouse_fleet.transports.unit_map import UnitMap
from warehouse_layout.message_enums import RobotMode, Status

IDLE = int(Status.IDLE)
DEAD = 30.0  # a robot that does not move loses its transport after this duration [s]
URGENT = 255  # the highest priority


class Recovery:
    """Takes transports from robots that are lost, gives a transport to each robot that carries a
    unit without one, and sends units elsewhere whose place is closed."""

    def __init__(
        self,
        book: TransportBook,
        robots: RobotTable,
        units: UnitMap,
        roads: Roads,
        storing: Storing,
        completion: Completion,
    ) -> None:
        self._book, self._robots, self._units = book, robots, units
        self._roads, self._storing, self._completion = roads, storing, completion
        self._abandoned: set[int] = set()  # units that are to be stored, wherever they are

    def run(self, reports: Reports) -> None:
        """Recovers transports and units, by reports (n,) of REPORT."""
        self._drop_lost()
        self._adopt_loaded(reports)
        if len(closed := self._roads.closed):
            self._avoid(set(closed.tolist()))

    def _lost(self) -> np.ndarray:
        """(n,) bool: robots that others command, or that have not moved for DEAD seconds."""
        robots = self._robots
        return ~robots.automatic | (self._book.time - robots.stalled_since > DEAD)

    def _drop_lost(self) -> None:
        robots, lost = self._robots, self._lost()
        works = self._book.step_of != NOWHERE
        for robot in (works & (lost | robots.broken | robots.lifts_not)).nonzero()[0].tolist():
            transport = self._book.of_robot[robot]
            if transport.step <= READY:
                self._book.unassign(transport)
            elif lost[robot]:  # a broken robot may soon go on
                self._abandoned.add(transport.shelf)
                self._completion.fail(transport, self._why_lost(robot))

    def _why_lost(self, robot: int) -> str:
        robots = self._robots
        if robots.gone[robot]:
            return "its robot was removed from the world"
        if robots.broken[robot]:
            return "its robot is broken"
        if robots.mode[robot] == RobotMode.AUTOMATIC:
            return "its robot does not move"
        return f"its robot is {RobotMode(robots.mode[robot]).name} now"

    def _adopt_loaded(self, reports: Reports) -> None:
        robots, shelf = self._robots, reports["shelf_id"]
        loaded = shelf != 0
        without = self._book.step_of == NOWHERE
        robots.loaded[without] = loaded[without]
        # A robot that broke while it lifted, or was served, and lost its transport, is free again.
        robots.busy[without & ~robots.broken & (reports["status"] == IDLE)] = False
        ready = without & loaded & robots.stands & ~robots.broken & ~self._lost()
        for robot in ready.nonzero()[0].tolist():
            self._adopt(robot, int(shelf[robot]))

    def _adopt(self, robot: int, shelf: int) -> None:
        """Creates a transport for a robot that carries a unit without one: the unit is stored. A
        transport that asks for the unit is done after that."""
        asked = self._book.of_unit.get(shelf)
        if asked is not None and asked.robot != NOWHERE:
            return
        transport = self._book.add(shelf, "", int(self._robots.cell[robot]))
        self._book.hand_over(transport, robot)
        self._units.cell_of[shelf] = NOWHERE
        self._robots.loaded[robot] = True
        self._book.publish_event(transport, Kind.RECEIVED, "its robot was found with it")
        self._storing.store(transport)

    def _avoid(self, closed: set[int]) -> None:
        """Chooses another place for units that can't get to theirs, which is closed."""
        for transport in self._book.assigned():
            is_away = self._robots.cell[transport.robot] != transport.place
            is_barred = transport.step == STORING and transport.place in closed and is_away
            if is_barred and self._storing.has_place():
                self._storing.store(transport)

    def store_abandoned(self) -> None:
        """Creates urgent transports for units that lost robots left in the streets."""
        for shelf in sorted(self._abandoned & self._units.cell_of.keys()):
            cell = self._units.cell_of[shelf]
            if cell == NOWHERE or not self._units.is_in_reach(cell):
                continue
            self._abandoned.discard(shelf)
            if not self._storing.is_place(cell):
                self._fetch(shelf, cell)

    def _fetch(self, shelf: int, cell: int) -> None:
        if shelf in self._book.of_unit:
            self._book.of_unit[shelf].priority = URGENT
            self._book.sort_open()
            return
        transport = self._book.add(shelf, "", cell, priority=URGENT)
        transport.leave = Leave.RELEASED  # to storage, at once
        self._book.enqueue(transport)
        self._book.publish_event(transport, Kind.RECEIVED, "its robot was lost")
