# SPDX-License-Identifier: Apache-2.0
"""The part of a floor that a fleet still reaches while some of its cells are closed."""

from collections.abc import Set as AbstractSet

import numpy as np

from warehouse_fleet.traffic.station_ways import StationWays
from warehouse_layout.floor.floor_edges import NOWHERE, FloorEdges
from warehouse_layout.floor.floor_plan import FloorPlan


class Reach:
    """The reach of a fleet on a FloorPlan while `closed` cells are barred: that of the largest
    connected part of each tier's streets. `is_cut`, (cells,) bool: closed, or no robot comes there
    with a unit; `stations`: the names of those to which no unit can be brought and taken away.

    Streets connect whichever way they lead: where a closed cell cuts a one-way street, the planner
    lets robots drive it both ways (severed.h), so what is before the cut is left by the way in.
    """

    def __init__(
        self, plan: FloorPlan, edges: FloorEdges, ways: StationWays, closed: AbstractSet[int]
    ) -> None:
        self.is_cut = np.zeros(plan.passable.size, bool)
        self.stations: frozenset[str] = frozenset()
        if not closed:
            return
        self.is_cut[list(closed)] = True
        streets = (plan.passable & ~plan.storage & ~plan.parking & ~plan.lane).ravel()
        tier = plan.tier.ravel()
        for number in range(tier.max(initial=0) + 1):
            of_tier = streets & (tier == number)
            self.is_cut |= of_tier & ~edges.largest_part(of_tier & ~self.is_cut)
        self._cut_places(plan, edges.ahead(True))
        cut = frozenset(np.flatnonzero(self.is_cut).tolist())
        self.stations = frozenset(s.name for s in plan.stations if ways.are_barred(s.name, cut))

    def _cut_places(self, plan: FloorPlan, ahead: np.ndarray) -> None:
        """Cuts off the storage places whose exits are all cut off."""
        places = np.flatnonzero(plan.storage.ravel() & ~self.is_cut)
        exits = ahead[places]
        is_open = (exits != NOWHERE) & ~self.is_cut[exits]
        self.is_cut[places[~is_open.any(1)]] = True
