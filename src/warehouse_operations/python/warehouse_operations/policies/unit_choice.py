# SPDX-License-Identifier: Apache-2.0
"""Which storage unit is brought to a picking station for its orders."""


class Random:
    def choose(self, station, candidates, view):
        units = sorted(candidates)
        return units[view.rng.integers(len(units))]


class Nearest:
    def choose(self, station, candidates, view):
        return min(candidates, key=lambda unit: (view.seconds_to(station.name, unit), unit))


class MostLines:
    """The one that completes most lines; of equals, the one with most work in lines to come. A
    station that nothing is on the way to would stand idle until it comes: it gets the nearest."""

    def choose(self, station, candidates, view):
        if not station.coming:
            return Nearest().choose(station, candidates, view)

        def lines(unit):
            return sum(pieces >= line.missing for line, pieces in candidates[unit].items())

        completed = {unit: lines(unit) for unit in candidates}
        most = max(completed.values())
        best = [unit for unit in candidates if completed[unit] == most]
        return max(best, key=lambda unit: _with_backlog(unit, candidates[unit], station, view))


class MostWork:
    """The one with most pieces for the station's orders and those that wait."""

    def choose(self, station, candidates, view):
        return max(
            candidates, key=lambda unit: _with_backlog(unit, candidates[unit], station, view)
        )


def _with_backlog(unit, lines, station, view):
    """Pieces for the station and for orders that wait; then the nearer, then the lower number."""
    demand = view.backlog.demand
    waiting = sum(
        min(one.available, demand.get(one.sku, 0)) for one in view.inventory.of_unit[unit]
    )
    return sum(lines.values()) + waiting, -view.seconds_to(station.name, unit), -unit


NAMES = {
    "random": Random,
    "nearest": Nearest,
    "most lines": MostLines,
    "most work": MostWork,
}
