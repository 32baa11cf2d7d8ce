# SPDX-License-Identifier: Apache-2.0
"""The units that stand in streets, which close them for loaded robots."""

from warehouse_fleet.traffic.station_ways import StationWays
from warehouse_fleet.transports.contracts import Roads
from warehouse_fleet.transports.unit_map import UnitMap


class Streets:
    """Lifts and puts down the units of a UnitMap, and closes the cells in which units stand off the
    storage places for loaded robots."""

    def __init__(self, units: UnitMap, roads: Roads, ways: StationWays) -> None:
        self._units, self._roads, self._ways = units, roads, ways

    def lift(self, unit: int) -> int:
        """Notes that a unit was lifted; returns the cell in which it stood."""
        cell = self._units.lift(unit)
        self.update()
        return cell

    def put_down(self, unit: int, cell: int, time: float) -> None:
        """Notes that a unit stands in a cell since `time` [s]."""
        self._units.put_down(unit, cell, time)
        self.update()

    def update(self) -> None:
        """Closes the cells in which units stand now, and opens the others."""
        self._roads.set_units(self._units.in_streets())

    def is_cut_off(self, station: str, unit: int) -> bool:
        """Returns whether no robot can bring a unit to a station, or away from there, now."""
        barred = {*self._roads.closed.tolist(), *self._units.in_streets()}
        barred.discard(self._units.cell_of[unit])
        return self._ways.are_barred(station, barred)
