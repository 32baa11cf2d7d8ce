# SPDX-License-Identifier: Apache-2.0
"""How many cases conform, by chapter."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from warehouse_vda5050.conform.runner import Result
from warehouse_vda5050.conform.verdict import Verdict


@dataclass(frozen=True)
class Score:
    """The verdicts of one chapter, or of all."""

    name: str
    counts: Counter[Verdict]

    @property
    def tried(self) -> int:
        """The count of cases that came to conforms or differs."""
        return self.counts[Verdict.CONFORMS] + self.counts[Verdict.DIFFERS]

    @property
    def text(self) -> str:
        """The share of those tried that conform, as 17 of 18."""
        return f"{self.counts[Verdict.CONFORMS]} of {self.tried}"


@dataclass(frozen=True)
class Run:
    """What was tried, how, and what it came to. vehicle: or the master; seconds: how long it took
    [s]."""

    vehicle: str
    version: str
    broker: str
    began: str  # date and time
    seconds: float
    results: Sequence[Result]
    series: str = ""  # seriesName of the factsheet
    interrupted: bool = False

    @property
    def chapters(self) -> list[Score]:
        """The scores of the chapters, as they were tried."""
        names = dict.fromkeys(result.case.chapter for result in self.results)
        return [Score(name, self._count(name)) for name in names]

    @property
    def whole(self) -> Score:
        """The score of all."""
        return Score("all", self._count())

    def _count(self, chapter: str = "") -> Counter[Verdict]:
        return Counter(r.verdict for r in self.results if chapter in ("", r.case.chapter))


CONFORMS, DIFFERS, NOT_TRIED = 0, 1, 2


def exit_code(run: Run) -> int:
    """Returns what the program ends with."""
    if run.whole.counts[Verdict.DIFFERS]:
        return DIFFERS
    return NOT_TRIED if run.interrupted or not run.whole.tried else CONFORMS


def line_of(count: int, total: int, result: Result) -> str:
    """Returns the line of one case in the progress of a run."""
    reason = f": {result.reason}" if result.reason else ""
    return f"{count:3}/{total} {result.verdict.value:12} {result.case.id}{reason}"


def lines(run: Run) -> list[str]:
    """Returns the scores by chapter, and what differs, for a terminal."""
    rows = [f"{score.name:12} {score.text:>10}{_others(score)}" for score in run.chapters]
    differs = [f"  {r.case.id}: {r.reason}" for r in run.results if r.verdict is Verdict.DIFFERS]
    ended = "; interrupted, so the others were not tried" if run.interrupted else ""
    end = f"{run.whole.text} cases conform{_others(run.whole)}, in {run.seconds:.0f} s{ended}"
    return [*rows, *(["differs:", *differs] if differs else []), end]


def _others(score: Score) -> str:
    kinds = (Verdict.UNSUPPORTED, Verdict.UNTESTABLE)
    texts = [f"{score.counts[kind]} {kind.value}" for kind in kinds if score.counts[kind]]
    return f" ({', '.join(texts)})" if texts else ""
