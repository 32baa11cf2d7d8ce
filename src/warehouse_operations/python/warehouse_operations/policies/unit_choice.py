# SPDX-License-Identifier: Apache-2.0
"""Policies that choose the storage unit brought to a picking station for its orders."""

from typing import TYPE_CHECKING

import numpy as np

from warehouse_operations.stock.candidates import Candidates
from warehouse_operations.stock.stations import WorkStation

if TYPE_CHECKING:
    from warehouse_operations.policies.view import View


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
        units = candidates.units
        return int(units[np.argmin(view.seconds_to_all(station.name, units))])


class MostLines:
    """Chooses the unit that completes most lines; of equals, the one with most pieces for others.

    reach: how much longer than the nearest unit it may take [s]; None: as Whereabouts.reach says. A
    station without units on the way gets the nearest one: it stands idle until then. Raises
    ValueError for a reach below 0.
    """

    def __init__(self, reach: float | None = None) -> None:
        self.reach = _checked(reach)

    def choose(self, station: WorkStation, candidates: Candidates, view: "View") -> int:
        """Returns the unit, one of candidates, that is brought to a station."""
        seconds = view.seconds_to_all(station.name, candidates.units)
        if not station.coming:
            return int(candidates.units[np.argmin(seconds)])
        near = _within(self.reach, seconds, view)
        completes = candidates.completes[near]
        return _most_work(near[completes == completes.max()], seconds, candidates, view)


class MostWork:
    """Chooses the unit with most pieces for the station's orders and the backlog.

    reach: as that of MostLines. Raises ValueError for one below 0.
    """

    def __init__(self, reach: float | None = None) -> None:
        self.reach = _checked(reach)

    def choose(self, station: WorkStation, candidates: Candidates, view: "View") -> int:
        """Returns the unit, one of candidates, that is brought to a station."""
        seconds = view.seconds_to_all(station.name, candidates.units)
        return _most_work(_within(self.reach, seconds, view), seconds, candidates, view)


def _checked(reach: float | None) -> float | None:
    if reach is not None and not reach >= 0:
        raise ValueError(f"reach is {reach}; 0 s or more was expected")
    return reach


def _within(reach: float | None, seconds: np.ndarray, view: "View") -> np.ndarray:
    """Returns the indices of units that take at most `reach` longer than the nearest one, (m,)."""
    if reach is None:
        reach = view.floor.reach
    return np.flatnonzero(seconds <= seconds.min() + reach)


def _most_work(among: np.ndarray, seconds: np.ndarray, candidates: Candidates, view: "View") -> int:
    """Returns the unit, of those at the indices `among`, with most pieces for the station and the
    backlog; of equals the nearest, then that of the lowest number."""
    units = candidates.units[among].tolist()
    work = candidates.pieces[among] + [view.work(unit) for unit in units]
    best = among[work == work.max()]
    return int(candidates.units[best[np.argmin(seconds[best])]])


NAMES: dict[str, type] = {
    "random": Random,
    "nearest": Nearest,
    "most lines": MostLines,
    "most work": MostWork,
}
