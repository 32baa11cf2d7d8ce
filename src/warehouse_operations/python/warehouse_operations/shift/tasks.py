# SPDX-License-Identifier: Apache-2.0
"""Tasks of people at stations: each has a number of its own and is done once."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from warehouse_layout.message_enums import PickOutcome, StationMode
from warehouse_operations.shift.context import Context
from warehouse_operations.shift.task_reports import Answer, Report
from warehouse_operations.stock.stations import WorkStation

KEPT = 10_000  # reports whose repetitions are recognised
UNDO_WITHIN = 60.0  # after a write-off [s, simulated]: less for a person where time runs faster


class ManualPart(Protocol):
    """Carries out the reports of people about tasks of one kind."""

    def task(self, station: WorkStation, report: Report) -> Any:
        """Returns the task that a Report names, of the unit at its station, or None."""

    def asks(self, station: WorkStation) -> str:
        """Returns a sentence about the current task of a person."""

    def report(self, station: WorkStation, task: Any, report: Report) -> Answer:
        """Carries out a Report of a task."""


@dataclass
class Done:
    """A Report and its Answer; `time` [s] as it came."""

    report: Report
    answer: Answer
    time: float
    undone: bool = False


class Tasks:
    """Takes the reports of people at stations, by name; part_of(station) carries them out now."""

    def __init__(
        self,
        context: Context,
        stations: Mapping[str, WorkStation],
        part_of: Callable[[WorkStation], ManualPart],
    ) -> None:
        self._context, self._clock = context, context.clock
        self._stations, self._part_of = stations, part_of
        self._done: dict[int, Done] = {}  # carried out, by sequence
        self._answered: dict[str, Done] = {}  # those with an id, refused ones too, by it

    def remember(self, reports: Iterable[tuple[Report, Answer]]) -> None:
        """Adds reports of earlier runs with their answers, to recognise repetitions."""
        for report, answer in reports:
            self._answered[report.id] = Done(report, answer, self._clock.now)

    def report(self, report: Report) -> Answer:
        """Carries out a Report; a repeated one gets the same answer and changes nothing."""
        known = self._answered.get(report.id) if report.id else None
        if known:
            text = f"the id {report.id} is of another report"
            return known.answer if known.report == report else Answer(False, text)
        answer = self._carry_out(report)
        if report.id:
            self._answered[report.id] = Done(report, answer, self._clock.now)
            _forget(self._answered)
        return answer

    def _carry_out(self, report: Report) -> Answer:
        done = self._done.get(report.sequence)
        if done:
            same = done.report == report
            text = f"that was reported as {done.report.outcome.name} already"
            return done.answer if same else Answer(False, text)
        station, refusal = self._station(report.station)
        if refusal or station is None:
            return Answer(False, refusal)
        part = self._part_of(station)
        now = self._clock.now
        task = part.task(station, report)
        if task is None:
            return Answer(False, f"that is no longer asked for; {part.asks(station)}")
        answer = part.report(station, task, report)
        if answer.success:
            station.attended = now
            self._keep(Done(report, answer, now))
        return answer

    def undo(self, station: str, sequence: int) -> tuple[bool, str]:
        """Undoes a report; returns success and the reason of a refusal."""
        done = self._done.get(sequence)
        if not done or done.report.station != station or not done.answer.undo:
            return False, f"nothing was reported at {station} under {sequence}"
        if done.undone:
            return True, ""
        is_write_off = done.report.outcome != PickOutcome.DONE  # else: until the unit leaves
        if is_write_off and self._clock.now - done.time > UNDO_WITHIN:
            return False, f"it was written off more than {UNDO_WITHIN:g} s ago"
        refusal = done.answer.undo()
        done.undone = not refusal
        return done.undone, refusal

    def _station(self, name: str) -> tuple[WorkStation | None, str]:
        station = self._stations.get(name)
        if not station:
            return None, f"there is no station '{name}'"
        return station, "" if station.mode == StationMode.MANUAL else f"{name} works by itself"

    def _keep(self, done: Done) -> None:
        self._done[done.report.sequence] = done
        _forget(self._done)
        if done.report.id:
            self._context.journal.report(done.time, done.report, done.answer)


def _forget(reports: dict[Any, Done]) -> None:
    """Removes the oldest report where there are more than are KEPT."""
    if len(reports) > KEPT:
        del reports[next(iter(reports))]
