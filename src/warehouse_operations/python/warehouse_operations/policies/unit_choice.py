# SPDX-License-Identifier: Apache-2.0
"""Policies that choose the storage unit brought to a picking station for its orders."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from warehouse_operations.orders import Line
from warehouse_operations.stations import WorkStation

if TYPE_CHECKING:
    from warehouse_operations.view import View

Candidates = Mapping[int, Mapping[Line, int]]  # {unit: {line: pieces}}


class Random:
    """Chooses any unit."""

    def choose(self, station: WorkStation, candidates: Candidates, view: "View") -> int:
        """Returns the unit, one of candidates, that is brought to a station."""
        units = sorted(candidates)
        return units[view.rng.integers(len(units))]


class Nearest:
    """Chooses the unit that is fastest at the station."""

    def choose(self, station: WorkStation, candidates: Candidates, view: "View") -> int:
        """Returns the unit, one of candidates, that is brought to a station."""
        return min(candidates, key=lambda unit: (view.seconds_to(station.name, unit), unit))


class MostLines:
    """Chooses the unit that completes most lines; of equals, the one with most pieces for others.

    A station without units on the way gets the nearest one: it stands idle until then.
    """

    def choose(self, station: WorkStation, candidates: Candidates, view: "View") -> int:
        """Returns the unit, one of candidates, that is brought to a station."""
        if not station.coming:
            return Nearest().choose(station, candidates, view)

        def lines(unit: int) -> int:
            return sum(pieces >= line.missing for line, pieces in candidates[unit].items())

        completed = {unit: lines(unit) for unit in candidates}
        most = max(completed.values())
        best = [unit for unit in candidates if completed[unit] == most]
        return max(best, key=lambda unit: _with_backlog(unit, candidates[unit], station, view))


class MostWork:
    """Chooses the unit with most pieces for the station's orders and the backlog."""

    def choose(self, station: WorkStation, candidates: Candidates, view: "View") -> int:
        """Returns the unit, one of candidates, that is brought to a station."""
        return max(
            candidates, key=lambda unit: _with_backlog(unit, candidates[unit], station, view)
        )


def _with_backlog(
    unit: int, lines: Mapping[Line, int], station: WorkStation, view: "View"
) -> tuple[int, float, int]:
    """Returns a sort key: pieces for the station and the backlog, then nearness, then number."""
    demand = view.backlog.demand
    waiting = sum(
        min(one.available, demand.get(one.sku, 0)) for one in view.inventory.of_unit[unit]
    )
    return sum(lines.values()) + waiting, -view.seconds_to(station.name, unit), -unit


NAMES: dict[str, type] = {
    "random": Random,
    "nearest": Nearest,
    "most lines": MostLines,
    "most work": MostWork,
}
