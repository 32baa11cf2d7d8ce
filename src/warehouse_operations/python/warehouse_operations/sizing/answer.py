# SPDX-License-Identifier: Apache-2.0
"""The answer of a sizing, in words and figures: the numbers, their confidence and their limit."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from warehouse_operations.reports import limits
from warehouse_operations.reports.comparison import CONFIDENCE
from warehouse_operations.reports.limits import Limit
from warehouse_operations.sizing import helps, hourly
from warehouse_operations.sizing.study import Study
from warehouse_operations.sizing.verdict import Verdict, difference
from warehouse_operations.sizing.wish import count, named

SHOWN = {
    "met": "met",
    "missed": "missed",
    "undecided": "not shown to be met",
    "drawn": "not judged",
}
KNEE = 0.99  # share of the highest order rate of any number of robots


@dataclass(frozen=True)
class Answer:
    """The chosen point of a Study, with the points around it.

    others: the points with a robot or a station more. verdict: of ideal robots. check: of simulated
    ones, which may be more; None: not requested.
    """

    study: Study
    verdict: Verdict
    check: Verdict | None = None
    others: list[Verdict] = field(default_factory=list)

    @property
    def robots(self) -> int:
        """The number of robots: of simulated ones, if they were checked."""
        return self.check.robots if self.check and self.check.met else self.verdict.robots

    @property
    def stations(self) -> int:
        """The number of picking stations that have to be open."""
        return self.verdict.stations

    @property
    def names(self) -> str:
        """The names of these stations."""
        return named(self.study.wish.stations[: self.stations])

    @property
    def measured(self) -> Verdict:
        """The Verdict that the answer rests on: on simulated robots, if they were checked."""
        return self.check or self.verdict

    @property
    def confirmed(self) -> bool:
        """Whether simulated robots met the wish, or were not requested."""
        return self.check is None or self.check.met

    def headline(self) -> str:
        """Returns the answer as a sentence."""
        wish = self.study.wish
        robots = count(self.robots, "robot")
        stations = count(self.stations, "open picking station")
        if not self.confirmed:
            return (
                f"{robots} and {stations} would meet {wish.asked}"
                " without traffic; simulated robots were not shown to."
            )
        return (
            f"{robots} and {stations} ({self.names}) meet {wish.asked}:"
            f" at most {100 * self.measured.at_most:.2f} % of them are not done in time,"
            f" where {100 * wish.late:g} % may be ({100 * CONFIDENCE:.0f} % confidence,"
            f" {len(self.measured.records)} shifts)."
        )

    @property
    def limit(self) -> Limit:
        """The limit of the answer; without one, the part nearest to its limit."""
        verdict = self.measured
        if not self.confirmed or self.robots > self.verdict.robots:
            return Limit.STREETS
        limit = limits.limit(verdict.windows)
        if limit != Limit.ORDERS:
            return limit
        use = {
            Limit.STATIONS: verdict.estimate("of_bound").mean,
            Limit.REPLENISHING: verdict.estimate("replenishing").mean,
            Limit.ROBOTS: verdict.estimate("robots_at_work").mean,
        }
        return max(use, key=lambda limit: use[limit])

    def reasons(self) -> Iterator[str]:
        """Yields sentences about the limit of the answer."""
        verdict = self.measured
        yield (
            f"At work: robots {percent(verdict, 'robots_at_work')} of their time (before stations"
            f" {percent(verdict, 'robots_queue')}), picking stations {percent(verdict, 'picking')},"
            f" replenishing ones {percent(verdict, 'replenishing')}; the open stations pick"
            f" {percent(verdict, 'of_bound')} of what they can at most."
        )
        yield from self._streets()
        yield from self._fewer_robots()
        yield from self._fewer_stations()
        yield from self._more_stations()
        yield from self._hours()
        yield from helps.sentences(self.study, self.verdict, self.others)

    def _hours(self) -> Iterator[str]:
        if self.study.wish.day:
            yield from hourly.sentences(hourly.hours_of(self.measured))

    def _streets(self) -> Iterator[str]:
        check = self.check
        if check is None:
            yield "Traffic is not in it: ideal robots do not meet. Check it with --physics."
            return
        more = check.robots - self.verdict.robots
        if not check.met:
            yield (
                f"Of simulated robots' orders {percent(check, 'late')} are late with"
                f" {count(check.robots, 'robot')}: more of them get in each other's way."
            )
        elif more:
            yield f"Traffic takes {count(more, 'robot')} more than ideal robots would be."
        else:
            yield "Simulated robots meet it too: traffic takes no robot more."
        for fault in sorted({text for record in check.records for text in record.faults}):
            yield f"With physics: {fault}."

    def _fewer_robots(self) -> Iterator[str]:
        fewer = self.study.verdicts.get((self.verdict.robots - 1, self.stations))
        if fewer:
            more = difference(self.verdict, fewer, "late")
            yield (
                f"With {count(fewer.robots, 'robot')} it is {SHOWN[fewer.word]}:"
                f" {100 * more.mean:+.2f} ± {100 * more.half:.2f} points of late orders, seed by"
                " seed."
            )

    def _fewer_stations(self) -> Iterator[str]:
        wish, fewer = self.study.wish, self.stations - 1
        if not fewer:
            return
        name, bound = named(wish.stations[:fewer]), wish.bound(fewer)
        if bound < wish.pieces_per_hour:
            yield (
                f"{name} can do {bound:,.0f} pieces an hour;"
                f" {wish.pieces_per_hour:,.0f} are asked for."
            )
        elif self.study.frontier.get(fewer, 0) is None:
            yield f"With {name} alone no number of robots meets it."
        elif robots := self.study.frontier.get(fewer):
            yield f"With {name} alone {count(robots, 'robot')} would do."

    def _more_stations(self) -> Iterator[str]:
        more = self.stations + 1
        if more > len(self.study.wish.stations):
            return
        robots = self.study.frontier.get(more)
        word = count(more, "picking station")
        yield (
            f"With {word} {count(robots, 'robot')} would do."
            if robots
            else (f"With {word} no robot is saved.")
        )


def knee(verdicts: list[Verdict]) -> int | None:
    """Returns the fewest robots with KNEE of the highest order rate of these points."""
    hourly = {verdict.robots: verdict.estimate("orders_per_hour").mean for verdict in verdicts}
    if len(hourly) < 2:
        return None
    return min(robots for robots, orders in hourly.items() if orders >= KNEE * max(hourly.values()))


def percent(verdict: Verdict, name: str) -> str:
    """Returns a share as text."""
    return f"{100 * verdict.estimate(name).mean:.1f} %"
