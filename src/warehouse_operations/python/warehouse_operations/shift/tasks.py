# SPDX-License-Identifier: Apache-2.0
"""What a person at a station is asked to do: each thing by a number of its own, done but once."""

import itertools
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from warehouse_operations.stock.message_enums import Mode, Outcome
from warehouse_operations.stock.stations import WorkStation

if TYPE_CHECKING:
    from warehouse_operations.shift.shift import Shift

KEPT = 10_000  # reports that are known when they come again
UNDO_WITHIN = 60.0  # after a write-off [s], simulated: ten of a person where time runs faster


@dataclass(frozen=True)
class Report:
    """A person's report of a task, which station, order, item and sequence name.

    id: the sender's name of the report; one that comes again under it is the same. "": none.
    """

    station: str
    order_id: int
    item: str
    sequence: int
    quantity: int
    outcome: Outcome
    id: str = field(default="", compare=False)


@dataclass
class Answer:
    """The result of a Report; `undo()` takes it back, and returns why it can't."""

    success: bool
    message: str = ""
    quantity: int = 0  # taken, put in or written off
    undo: Callable[[], str] | None = None


@dataclass
class Done:
    """A Report and its Answer; `time` [s] as it came."""

    report: Report
    answer: Answer
    time: float
    undone: bool = False


class Tasks:
    """Takes the reports of people at a Shift's stations."""

    def __init__(self, shift: "Shift") -> None:
        self._shift = shift
        self._done: dict[int, Done] = {}  # carried out, by sequence
        self._answered: dict[str, Done] = {}  # those with an id, refused ones too, by it
        self._numbers = itertools.count(1)

    def number_from(self, first: int) -> None:
        """Numbers tasks from `first` on, above the numbers of earlier runs."""
        self._numbers = itertools.count(first)

    def number(self) -> int:
        """Returns the number of a new task, or of the rest of one."""
        return next(self._numbers)

    def remember(self, reports: Iterable[tuple[Report, Answer]]) -> None:
        """Takes in reports of earlier runs, with their answers, as they are to be given again."""
        for report, answer in reports:
            self._answered[report.id] = Done(report, answer, self._shift.now)

    def report(self, report: Report) -> Answer:
        """Carries out a Report; a repeated one gets the same answer and changes nothing."""
        known = self._answered.get(report.id) if report.id else None
        if known:
            text = f"the id {report.id} is of another report"
            return known.answer if known.report == report else Answer(False, text)
        answer = self._carry_out(report)
        if report.id:
            self._answered[report.id] = Done(report, answer, self._shift.now)
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
        part: Any = self._shift.manual_part_of(station)
        now = self._shift.now
        task = part.task(station, report)
        if task is None:
            return Answer(False, f"that is no longer asked for; {part.asks(station)}")
        answer = part.report(station, task, report)
        if answer.success:
            station.attended = now
            self._keep(Done(report, answer, now))
        return answer

    def undo(self, station: str, sequence: int) -> tuple[bool, str]:
        """Takes back what a report has led to; returns success and why not."""
        done = self._done.get(sequence)
        if not done or done.report.station != station or not done.answer.undo:
            return False, f"nothing was reported at {station} under {sequence}"
        if done.undone:
            return True, ""
        is_write_off = done.report.outcome != Outcome.DONE  # else: until the unit leaves
        if is_write_off and self._shift.now - done.time > UNDO_WITHIN:
            return False, f"it was written off more than {UNDO_WITHIN:g} s ago"
        refusal = done.answer.undo()
        done.undone = not refusal
        return done.undone, refusal

    def _station(self, name: str) -> tuple[WorkStation | None, str]:
        station = self._shift.find_station(name)
        if not station:
            return None, f"there is no station '{name}'"
        return station, "" if station.mode == Mode.MANUAL else f"{name} works by itself"

    def _keep(self, done: Done) -> None:
        self._done[done.report.sequence] = done
        _forget(self._done)
        if done.report.id:
            self._shift.journal.report(done.time, done.report, done.answer)


def _forget(reports: dict[Any, Done]) -> None:
    """Removes the oldest report where there are more than are KEPT."""
    if len(reports) > KEPT:
        del reports[next(iter(reports))]
