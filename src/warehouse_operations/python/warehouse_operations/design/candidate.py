# SPDX-License-Identifier: Apache-2.0
"""Layouts judged by shifts, and the Pareto front of several."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from warehouse_layout.file.layout_file import LayoutFile
from warehouse_operations.reports.comparison import Estimate
from warehouse_operations.sizing import sites
from warehouse_operations.sizing.costs import Bill, Costs, LayoutCosts
from warehouse_operations.sizing.day import RUN_IN, Day
from warehouse_operations.sizing.point import Record
from warehouse_operations.sizing.verdict import Verdict


@dataclass
class Candidate:
    """A judged layout. late: share of late orders in its longest shifts. contacts: between
    simulated robots; None: it was not simulated with physics. traffic: pieces picked by simulated
    robots over those by ideal ones in the same time. unseen: shifts of seeds that had no part in
    its choice.
    """

    number: int
    chosen: Mapping[str, Any]
    file: LayoutFile
    late: float
    bill: Bill
    verdict: Verdict | None = None
    contacts: int | None = None
    traffic: float | None = None
    unseen: Verdict | None = None
    unseen_a_piece: tuple[float, ...] = ()

    @property
    def robots(self) -> int:
        """The number of robots."""
        return int(self.chosen["robots"])

    @property
    def stations(self) -> int:
        """The number of picking stations."""
        return int(self.chosen["stations"])

    @property
    def unseen_late(self) -> Estimate:
        """The share of late orders by unseen seeds."""
        assert self.unseen is not None
        return self.unseen.estimate("late")

    @property
    def unseen_cost(self) -> Estimate:
        """The cost a piece by unseen seeds."""
        return Estimate.of(self.unseen_a_piece)


@dataclass(frozen=True)
class Judge:
    """Judges layouts by their shifts. area: the building, whose whole floor is paid for."""

    costs: Costs
    day: Day
    late: float
    area: LayoutFile

    def verdict(self, file: LayoutFile, records: Sequence[Record]) -> Verdict:
        """Returns the Verdict on a layout."""
        stations = len(sites.picking_stations(file))
        return Verdict(
            robots_of(file), stations, tuple(records), self.late, len(records), RUN_IN, True
        )

    def bill(self, file: LayoutFile, late: float = 0.0, at_work: float = 0.0) -> Bill:
        """Returns what a layout costs if a share of the orders is not done in time, and robots are
        at work for a share of their time."""
        # The mean of the whole day: a short shift has the busiest hours alone.
        orders = self.day.orders / self.day.hours * (1 - late)
        units = file.storage_units
        assert isinstance(units, int), "what the search draws has a count of them"
        priced = LayoutCosts(self.costs, self.area, units)
        own = LayoutCosts(self.costs, file, 0)
        priced.replenishing, priced.chargers = own.replenishing, own.chargers
        pieces = orders * self.day.pieces_per_order
        stations = len(sites.picking_stations(file))
        return priced.bill(robots_of(file), stations, orders, pieces, at_work)

    def judged(
        self,
        number: int,
        chosen: Mapping[str, Any],
        file: LayoutFile,
        records: Sequence[Record],
    ) -> Candidate:
        """Returns the Candidate of shifts."""
        verdict = self.verdict(file, records)
        late = float(np.mean([figures["late"] for figures in verdict.figures]))
        bill = self.bill(file, late, verdict.estimate("robots_at_work").mean)
        return Candidate(number, chosen, file, late, bill, verdict)

    def test(self, candidate: Candidate, records: Sequence[Record]) -> None:
        """Adds the Verdict and the costs of a candidate by unseen seeds."""
        candidate.unseen = self.verdict(candidate.file, records)
        candidate.unseen_a_piece = tuple(
            self.bill(candidate.file, figures["late"], figures["robots_at_work"]).a_piece
            for figures in candidate.unseen.figures
        )


def robots_of(file: LayoutFile) -> int:
    """Returns the number of robots of a layout."""
    return file.robots if isinstance(file.robots, int) else len(file.robots)


def beats(first: Bill, second: Bill) -> bool:
    """Returns whether a bill dominates another: no cost is higher, one is lower."""
    pairs = ((first.to_buy, second.to_buy), (first.a_piece, second.a_piece))
    return all(a <= b for a, b in pairs) and any(a < b for a, b in pairs)


def front(candidates: Sequence[Candidate], late: float) -> list[Candidate]:
    """Returns the Pareto front by purchase cost and cost a piece: of the candidates within the
    limit, or of all where no candidate is."""
    able = [each for each in candidates if each.late <= late] or list(candidates)
    return sorted(
        (each for each in able if not any(beats(other.bill, each.bill) for other in able)),
        key=lambda each: each.bill.a_piece,
    )
