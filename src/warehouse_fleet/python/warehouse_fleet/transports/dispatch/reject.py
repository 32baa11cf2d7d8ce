# SPDX-License-Identifier: Apache-2.0
"""Takes transports from robots that can't carry the unit."""

from warehouse_fleet.robots.robot_table import NOWHERE, RobotTable
from warehouse_fleet.transports.completion import Completion
from warehouse_fleet.transports.transport_book import (
    FETCHING,
    LIFTING,
    OPEN,
    Transport,
    TransportBook,
)
from warehouse_fleet.transports.unfit_units import UnfitUnits


class Rejection:
    """Gives units that robots reject to others; a transport whose unit no robot of the warehouse
    can carry fails."""

    def __init__(
        self, book: TransportBook, robots: RobotTable, unfit: UnfitUnits, completion: Completion
    ) -> None:
        self._book, self._robots, self._unfit = book, robots, unfit
        self._completion = completion
        self._rejected: list[tuple[int, int, str]] = []  # kiva id, unit, reason

    def add(self, kiva_id: int, unit: int, why: str) -> None:
        """Adds a unit that a robot has rejected, for the reason `why`."""
        self._rejected.append((kiva_id, unit, why))

    def run(self) -> None:
        """Takes back what has been rejected since the last call."""
        rejected, self._rejected = self._rejected, []
        for kiva_id, unit, why in rejected:
            robot = self._robots.index(kiva_id)
            if robot != NOWHERE:
                self._unfit.note(robot, unit, why)
                self._take_back(robot, unit)
                self._fail_hopeless(unit)

    def _take_back(self, robot: int, unit: int) -> None:
        transport = self._book.of_robot.get(robot)
        if transport is None or transport.shelf != unit or transport.step > LIFTING:
            return
        if transport.step == LIFTING:
            self._book.go_on(transport, FETCHING)
        self._robots.busy[robot] = False
        self._book.unassign(transport)
        self._robots.send(robot, NOWHERE)

    def _fail_hopeless(self, unit: int) -> None:
        why = self._unfit.why_all(unit)
        for transport in self._of(unit) if why else ():
            self._completion.fail(transport, f"no robot can carry its unit: {why}")

    def _of(self, unit: int) -> list[Transport]:
        return [t for t in self._book.open if t.shelf == unit and t.step == OPEN]
