# SPDX-License-Identifier: Apache-2.0
"""Tries one case after another on a master, and ends all accidents after each."""

from __future__ import annotations

from collections.abc import Iterable

from warehouse_vda5050.conform.case import Case
from warehouse_vda5050.conform.master.stage import Stage
from warehouse_vda5050.conform.runner import MISSHAPEN, Result
from warehouse_vda5050.conform.verdict import Ended, Interrupted, Verdict

LONGEST = 600.0  # case [s]


class Runner:
    """Tries cases on the master of a stage; once interrupted, it tries no more."""

    def __init__(self, stage: Stage) -> None:
        self.stage = stage
        self.results: list[Result] = []

    def run(self, cases: Iterable[Case]) -> Iterable[Result]:
        """Yields what the cases come to, one after another."""
        for case in cases:
            if self.stage.interrupted and not case.audit:
                continue
            result = self.try_case(case)
            self.results.append(result)
            yield result

    def try_case(self, case: Case) -> Result:
        """Returns what a case comes to."""
        stage, began, mark = self.stage, self.stage.now(), self.stage.mark
        verdict, reason = Verdict.CONFORMS, ""
        stage.limit(LONGEST)
        try:
            case.trial(stage)
        except Ended as ended:
            verdict, reason = ended.verdict, str(ended)
        except MISSHAPEN as error:
            verdict, reason = Verdict.DIFFERS, f"a message without its form: {error!r}"
        except Interrupted:
            verdict, reason = Verdict.UNTESTABLE, "interrupted"
        for actor in stage.actors:
            actor.calm()
        entries = stage.log.entries[mark:]
        return Result(case, verdict, reason, stage.now() - began, entries)
