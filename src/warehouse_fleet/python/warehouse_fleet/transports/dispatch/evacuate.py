# SPDX-License-Identifier: Apache-2.0
"""Keeps the fleet out of closed zones: robots inside leave, and transports into zones wait, as do
those to what robots cut off that stand broken or out of service for long."""

import numpy as np

from warehouse_fleet.robots.robot_table import NOWHERE, RobotTable
from warehouse_fleet.traffic.closed_zones import ClosedZones
from warehouse_fleet.traffic.standing_robots import StandingRobots
from warehouse_fleet.transports.dispatch.idle import idle_robots
from warehouse_fleet.transports.distances import Distances
from warehouse_fleet.transports.storing import Storing
from warehouse_fleet.transports.transport_book import (
    BRINGING,
    OPEN,
    READY,
    STORING,
    Leave,
    Transport,
    TransportBook,
)
from warehouse_fleet.transports.unit_map import UnitMap


class Evacuation:
    """Sends robots out of `zones`, and takes transports back whose targets lie within or are cut
    off. `streets` and `aside`, (cells,) bool: where robots may stand outside.

    What `standing` robots cut off is shut to new work alone: units that are on their way to a
    station stay so, since such robots are repaired or towed sooner or later.
    """

    def __init__(
        self,
        zones: ClosedZones,
        standing: StandingRobots,
        streets: np.ndarray,
        aside: np.ndarray,
        distances: Distances,
        book: TransportBook,
        robots: RobotTable,
        units: UnitMap,
        storing: Storing,
    ) -> None:
        self._zones, self._standing = zones, standing
        self._streets, self._aside = streets, aside
        self._distances, self._book, self._robots = distances, book, robots
        self._units, self._storing = units, storing

    def run(self) -> None:
        """Does so for all robots and transports; nothing where nothing is shut."""
        if self._is_idle:
            return
        for transport in self._book.assigned():
            self._take_back(transport)
        if len(self._zones):
            self._clear()

    @property
    def _is_idle(self) -> bool:
        return not len(self._zones) and not self._standing

    def why(self, transport: Transport) -> str:
        """Returns the zone or the robots for which a transport waits, as a sentence; empty: for
        none."""
        if self._is_idle or transport.step > BRINGING:
            return ""
        if why := self._why_by(self._zones, transport):
            return why
        return self._why_by(self._standing, transport) if transport.step <= READY else ""

    def _why_by(self, by: ClosedZones | StandingRobots, transport: Transport) -> str:
        where = self._units.cell_of.get(transport.shelf, NOWHERE)
        why = by.why_unit(transport.shelf, where) if transport.step <= READY else ""
        if why:
            return why
        if transport.station:
            return by.why_station(transport.station)
        return by.why_cell(transport.cell)

    def _take_back(self, transport: Transport) -> None:
        robot = transport.robot
        if OPEN < transport.step <= READY and self.why(transport):
            self._book.unassign(transport)
            self._robots.send(robot, NOWHERE)
        elif transport.step == BRINGING and self.why(transport):
            transport.is_put_back = transport.leave == Leave.NO
            self._storing.store(transport)
        elif transport.step == STORING and self._is_beyond(transport.place, robot):
            is_away = self._robots.cell[robot] != transport.place
            if is_away and self._storing.has_place():
                self._storing.store(transport)

    def _is_beyond(self, place: int, robot: int) -> bool:
        """Returns whether a place is in a zone or cut off from a robot; both may be on the far side
        of robots that stand."""
        is_cut = self._standing.is_cut
        is_beyond = is_cut[place] and not is_cut[self._robots.cell[robot]]
        return bool(self._zones.is_cut[place] or is_beyond)

    def _clear(self) -> None:
        """Sends robots without work that are in a zone, or on their way into it, elsewhere."""
        robots, is_cut = self._robots, self._zones.is_cut
        idle = idle_robots(robots, self._book)
        at, goal = is_cut[robots.cell], robots.goal
        to = np.where(goal != NOWHERE, is_cut[goal], at)
        for robot in np.flatnonzero(idle & to).tolist():
            if at[robot] or goal[robot] != NOWHERE:
                robots.send(robot, self._refuge(robot) if at[robot] else NOWHERE)

    def _refuge(self, robot: int) -> int:
        """Returns the nearest cell beneath a stored unit where a robot is in no other's way, else
        of a street; NOWHERE if none is free."""
        robots = self._robots
        free = ~self._zones.is_cut
        for cells in (robots.goal, robots.cell):
            free[cells[cells != NOWHERE]] = False
        for places in (self._units.stands & self._aside, self._streets):
            cells = np.flatnonzero(free & places)
            if len(cells):
                return self._distances.nearest(int(robots.cell[robot]), cells)
        return NOWHERE
