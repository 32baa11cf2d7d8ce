# SPDX-License-Identifier: Apache-2.0
"""A search by its arguments: what the program `design` and the page /whatif have run."""

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from warehouse_layout.file.layout_file import LayoutFileError
from warehouse_operations.design.building import Building, BuildingError
from warehouse_operations.design.plans import POLICIES, Space
from warehouse_operations.fleets import availability
from warehouse_operations.runs import executors
from warehouse_operations.runs.simulation import ERRORS as OF_SHIFTS
from warehouse_operations.sizing import costs
from warehouse_operations.sizing.costs import Costs
from warehouse_operations.sizing.day import Day
from warehouse_operations.sizing.prices import PriceError
from warehouse_operations.sizing.store import Store
from warehouse_operations.stock import days
from warehouse_operations.store.locks import FileLock

if TYPE_CHECKING:
    from warehouse_operations.design.search import Search

POINTS = "points"  # folder of the shifts within that of a search
# Errors of wrong arguments or files.
ERRORS = (*OF_SHIFTS, executors.ExecutorError, LayoutFileError, PriceError, BuildingError, OSError)


@dataclass(frozen=True)
class Task:
    """The arguments of a search. building, demand, costs: as Building.read, Day.read and costs.read
    take them; hours: of a core, about; physics: length of the shifts with physics [h], 0: none."""

    building: str
    demand: str
    costs: str
    late: float = 0.01
    hours: float = 0.25
    seed: int = 1
    realism: str = ""
    is_random: bool = False
    physics: float = 0.25

    def space(self) -> Space:
        """Returns the range of its parameters. Raises one of ERRORS for a wrong building or
        demand."""
        day = Day.read(self.demand)
        skus = len(days.assortment_of(day.text).skus)
        return Space(Building.read(self.building), day, skus, POLICIES)

    def money(self) -> Costs:
        """Returns its costs. Raises PriceError."""
        return costs.read(self.costs)

    def run(
        self,
        folder: Path,
        pool: Executor,
        begin: "Callable[[Search], object]" = lambda _: None,
        on_shift: Callable[[float, str], object] = lambda *_: None,
    ) -> "Answer":
        """Searches in a folder, writes what it found there, and returns the answer. begin is called
        before the first shift. Raises one of ERRORS."""
        from warehouse_operations.design.search import Search

        space, money = self.space(), self.money()
        availability.read(self.realism)
        folder.mkdir(parents=True, exist_ok=True)
        with FileLock(folder), executors.running(pool):
            search = Search(
                space,
                money,
                self.late,
                Store(folder / POINTS, space.day.text.file),
                pool,
                self.hours,
                self.seed,
                self.realism,
                self.is_random,
                self.physics,
                on_shift,
            )
            begin(search)
            return _answer(search, folder)


@dataclass(frozen=True)
class Answer:
    """The answer of a search in sentences: the layout, or why no layout is recommended, and the
    effort."""

    text: str
    why: str
    effort: str
    report: Path


def _answer(search: "Search", folder: Path) -> Answer:
    """Searches and writes the answer."""
    from warehouse_operations.design import page

    chosen, why = search.run(), ""
    if not chosen:
        why = "no layout with room for robots, storage and stations was found"
    elif chosen[0].late > search.late:
        why = f"no layout was found with at most {100 * search.late:g} % late orders"
    report = page.write(folder, search, chosen, why)
    return Answer(why or page.answer(search, chosen), why, page.effort(search), report)
