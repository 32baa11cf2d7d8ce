# SPDX-License-Identifier: Apache-2.0
"""Policies that choose the storage unit brought to a picking station for its orders."""

from typing import TYPE_CHECKING

import numpy as np

from warehouse_operations.candidates import Candidates
from warehouse_operations.stations import WorkStation

if TYPE_CHECKING:
    from warehouse_operations.view import View


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

    A station without units on the way gets the nearest one: it stands idle until then.
    """

    def choose(self, station: WorkStation, candidates: Candidates, view: "View") -> int:
        """Returns the unit, one of candidates, that is brought to a station."""
        if not station.coming:
            return Nearest().choose(station, candidates, view)
        completes_most = candidates.completes == candidates.completes.max()
        return _most_work(np.flatnonzero(completes_most), station, candidates, view)


class MostWork:
    """Chooses the unit with most pieces for the station's orders and the backlog."""

    def choose(self, station: WorkStation, candidates: Candidates, view: "View") -> int:
        """Returns the unit, one of candidates, that is brought to a station."""
        return _most_work(np.arange(len(candidates)), station, candidates, view)


def _most_work(
    among: np.ndarray, station: WorkStation, candidates: Candidates, view: "View"
) -> int:
    """Returns the unit, of those at the indices `among`, with most pieces for the station and the
    backlog; of equals the nearest, then that of the lowest number."""
    units = candidates.units[among]
    work = candidates.pieces[among] + [view.work(unit) for unit in units.tolist()]
    best = units[work == work.max()]
    return int(best[np.argmin(view.seconds_to_all(station.name, best))])


NAMES: dict[str, type] = {
    "random": Random,
    "nearest": Nearest,
    "most lines": MostLines,
    "most work": MostWork,
}
