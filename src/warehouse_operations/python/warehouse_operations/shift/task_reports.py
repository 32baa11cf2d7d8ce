# SPDX-License-Identifier: Apache-2.0
"""Reports of people at stations about their tasks, and the answers."""

import itertools
from collections.abc import Callable
from dataclasses import dataclass, field

from warehouse_layout.message_enums import PickOutcome


@dataclass(frozen=True)
class Report:
    """A person's report of a task, which station, order, item and sequence name.

    id: the sender's name of the report: a report with the same id is a repetition; "": without.
    """

    station: str
    order_id: int
    item: str
    sequence: int
    quantity: int
    outcome: PickOutcome
    id: str = field(default="", compare=False)


@dataclass
class Answer:
    """The result of a Report; `undo()` takes it back, and returns the reason of a refusal."""

    success: bool
    message: str = ""
    quantity: int = 0  # taken, put in or written off
    undo: Callable[[], str] | None = None


class TaskNumbers:
    """Numbers for tasks, each used once."""

    def __init__(self) -> None:
        self._numbers = itertools.count(1)

    def number_from(self, first: int) -> None:
        """Numbers tasks from `first` on, above the numbers of earlier runs."""
        self._numbers = itertools.count(first)

    def number(self) -> int:
        """Returns the number of a new task, or of the rest of one."""
        return next(self._numbers)
