# SPDX-License-Identifier: Apache-2.0
"""Policies that choose the storage unit brought to a picking station for its orders."""

from typing import TYPE_CHECKING

import numpy as np

from warehouse_operations.stock.candidates import Candidates
from warehouse_operations.stock.stations import WorkStation

if TYPE_CHECKING:
    from warehouse_operations.policies.view import View

LEAD_TIME = "lead time"  # of `ahead`


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
    station without units on the way gets the nearest one: it stands idle until then. ahead: as
    that of is_early(). Raises ValueError for a reach below 0, or an ahead that is no such one.
    """

    def __init__(self, reach: float | None = None, ahead: float | str | None = None) -> None:
        self.reach, self.ahead = _checked("reach", reach), _checked_ahead(ahead)

    def is_early(self, station: WorkStation) -> bool:
        """Returns whether no unit is to be chosen yet."""
        return is_early(station, self.ahead)

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

    reach, ahead: as those of MostLines. Raises ValueError for one that is neither.
    """

    def __init__(self, reach: float | None = None, ahead: float | str | None = None) -> None:
        self.reach, self.ahead = _checked("reach", reach), _checked_ahead(ahead)

    def is_early(self, station: WorkStation) -> bool:
        """Returns whether no unit is to be chosen yet."""
        return is_early(station, self.ahead)

    def choose(self, station: WorkStation, candidates: Candidates, view: "View") -> int:
        """Returns the unit, one of candidates, that is brought to a station."""
        seconds = view.seconds_to_all(station.name, candidates.units)
        return _most_work(_within(self.reach, seconds, view), seconds, candidates, view)


def is_early(station: WorkStation, ahead: float | str | None) -> bool:
    """Returns whether the units at a station and on their way to it are work for longer than
    `ahead`: a later choice knows more orders. ahead: a time [s]; LEAD_TIME: as long as units
    lately took there, which is the reorder point of inventory theory, with a mean deviation for
    safety; None: never."""
    if ahead is None:
        return False
    return station.seconds_to_pick() > (
        station.lead_time.horizon if isinstance(ahead, str) else ahead
    )


def _checked(name: str, seconds: float | None) -> float | None:
    if seconds is not None and not seconds >= 0:
        raise ValueError(f"{name} is {seconds}; 0 s or more was expected")
    return seconds


def _checked_ahead(ahead: float | str | None) -> float | str | None:
    if not isinstance(ahead, str):
        return _checked("ahead", ahead)
    if ahead != LEAD_TIME:
        raise ValueError(f"ahead is '{ahead}'; seconds or '{LEAD_TIME}' were expected")
    return ahead


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
