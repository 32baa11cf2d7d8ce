# SPDX-License-Identifier: Apache-2.0
"""The search for layouts, in stages, each of which leaves fewer and judges them longer.

1. By hand: what has no room, or too few stations for the day's pieces, is not simulated.
2. Ideal and short: a shift of ideal robots up to the end of the busiest hour. Optuna chooses what
   is tried next (several objectives: to buy, cost a piece; constraint: late orders).
3. Ideal and whole: the best by whole days, with the same seeds for all.
4. Physics: the last five.

Trials are asked for in batches of the same size on any number of cores, and the budget counts
simulated robot-hours: so the answer depends on arguments and seed alone. Shifts are kept; started
again, a search comes by the same trials without simulating them again.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, wait
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from warehouse_layout.file.layout_file import LayoutFile
from warehouse_operations.design.plans import Space
from warehouse_operations.sizing import point as shift
from warehouse_operations.sizing.costs import Bill, Costs, LayoutCosts
from warehouse_operations.sizing.day import RUN_IN
from warehouse_operations.sizing.point import Point, Record
from warehouse_operations.sizing.store import Store
from warehouse_operations.sizing.verdict import Verdict
from warehouse_operations.sizing.wish import Wish, WishError

BATCH = 4  # trials that are asked for together
SECONDS_A_ORDER = 0.012  # of a core, about, that an order of an ideal shift takes
FIRST_SHARE = 0.6  # of the budget, for the short shifts
LAST, WHOLE = 5, 12  # layouts that physics sees, and that have whole days
SEEDS = (101, 102, 103)  # of the whole days: none that the search saw
SEARCH_SEED = 1
TRIED = 0.35  # of short shifts: more late orders than that are as bad as any
MOST_TRIALS = 2000


@dataclass
class Candidate:
    """A layout that was judged. late: share of the orders, by the longest shifts it had.

    contacts: of simulated robots; None: it was not simulated with physics.
    """

    number: int
    chosen: Mapping[str, Any]
    file: LayoutFile
    late: float
    bill: Bill
    verdict: Verdict | None = None
    contacts: int | None = None

    @property
    def robots(self) -> int:
        """How many robots it has."""
        return int(self.chosen["robots"])

    @property
    def stations(self) -> int:
        """How many picking stations it has."""
        return int(self.chosen["stations"])


@dataclass(eq=False)
class Search:
    """Searches a Space. hours: of a core, about. on_shift(done, text): after each shift."""

    space: Space
    costs: Costs
    late: float
    store: Store
    executor: Executor
    hours: float = 0.25
    seed: int = 1
    realism: str = ""
    is_random: bool = False
    physics_hours: float = 0.0
    on_shift: Callable[[float, str], object] = lambda *_: None
    trials: int = 0
    shifts: int = 0
    wall_s: float = 0.0
    simulated: int = 0  # shifts that were not kept from before
    by_hand: int = 0  # trials that were given up without a shift
    candidates: list[Candidate] = field(default_factory=list)
    importance: dict[str, float] = field(default_factory=dict)

    def run(self) -> list[Candidate]:
        """Returns the layouts that had whole days, the cheapest that keeps the limit first; []
        where no layout has room for a fleet at all."""
        self._search()
        best = self._whole(self._best(WHOLE))
        if self.physics_hours:
            self._with_physics(best[:LAST])
        return best

    # The search.

    @property
    def most_trials(self) -> int:
        """How many trials the budget has room for."""
        orders = self.space.day.orders * self._short_hours / max(self.space.day.hours, 1.0)
        seconds = FIRST_SHARE * 3600 * self.hours
        return min(max(int(seconds / (SECONDS_A_ORDER * max(orders, 1.0))), BATCH), MOST_TRIALS)

    @property
    def _short_hours(self) -> float:
        """Hours up to the end of the busiest each."""
        by_hour = list(self.space.day.by_hour)
        return float(min(by_hour.index(max(by_hour)) + 1, len(by_hour)))

    def _search(self) -> None:
        import optuna

        optuna.logging.set_verbosity(optuna.logging.ERROR)
        samplers = optuna.samplers
        sampler = (
            samplers.RandomSampler(seed=self.seed)
            if self.is_random
            else samplers.TPESampler(seed=self.seed, n_startup_trials=3 * BATCH)
        )
        study = optuna.create_study(directions=["minimize"] * 3, sampler=sampler)
        known: dict[str, Candidate | None] = {}
        while self.trials < self.most_trials:
            trials = [study.ask() for _ in range(min(BATCH, self.most_trials - self.trials))]
            chosen = [self.space.choose(trial) for trial in trials]
            fresh = {str(each): each for each in chosen if str(each) not in known}
            known |= self._judged(fresh)
            for trial, parameters in zip(trials, chosen):
                self.trials += 1
                self._tell(study, trial, known[str(parameters)])
        self.candidates = [candidate for candidate in known.values() if candidate]
        self.importance = _importance(study)

    def _tell(self, study: Any, trial: Any, candidate: Candidate | None) -> None:
        """Tells Optuna what came of a trial: a layout without room is as bad as can be."""
        late = candidate.late if candidate else 1.0
        worst = LayoutCosts(self.costs, self.space.building.file, 1000).bill(1000, 50, 1, 1)
        bill = candidate.bill if candidate else worst
        trial.set_constraint("late", late - self.late)
        study.tell(trial, [bill.to_buy, bill.a_piece, max(late, self.late)])

    def _judged(self, fresh: Mapping[str, Mapping[str, Any]]) -> dict[str, Candidate | None]:
        """Returns the candidates of new parameters, judged by a short shift each."""
        files = {key: self.space.file_of(chosen) for key, chosen in fresh.items()}
        points: dict[str, Point] = {}
        for key, file in files.items():
            if file is not None and (made := self._points(file, (SEARCH_SEED,), True)):
                points[key] = made[0]
        self.by_hand += len(fresh) - len(points)
        records = dict(zip(points, self._shifts(list(points.values()))))
        out: dict[str, Candidate | None] = dict.fromkeys(fresh)
        for key, record in records.items():
            file = files[key]
            assert file is not None
            number = self.trials + 1 + list(fresh).index(key)
            out[key] = self._candidate(number, fresh[key], file, [record])
        return out

    def _wish(self, file: LayoutFile, short: bool) -> Wish:
        day = self.space.day
        hours = self._short_hours if short else day.hours
        return Wish(
            file, day.orders_per_hour, late=self.late, hours=hours, day=day, realism=self.realism
        )

    def _points(self, file: LayoutFile, seeds: Sequence[int], short: bool) -> list[Point]:
        try:
            wish = self._wish(file, short)
            stations = len(wish.stations)
            return wish.points(_robots(file), stations, seeds)
        except WishError:
            return []

    def _candidate(
        self, number: int, chosen: Mapping[str, Any], file: LayoutFile, records: list[Record]
    ) -> Candidate:
        verdict = Verdict(
            int(chosen["robots"]), int(chosen["stations"]), tuple(records), self.late,
            len(records), RUN_IN, True,
        )  # fmt: skip
        late = float(np.mean([figures["late"] for figures in verdict.figures]))
        # What is done in all of the day: a short shift has its busiest hours alone.
        day = self.space.day
        orders = day.orders / day.hours * (1 - late)
        priced = LayoutCosts(self.costs, self.space.building.file, int(chosen["units"]))
        priced.replenishing = int(chosen["replenish"])
        priced.chargers = LayoutCosts(self.costs, file, 0).chargers
        bill = priced.bill(
            verdict.robots,
            verdict.stations,
            orders,
            orders * day.pieces_per_order,
            verdict.estimate("robots_at_work").mean,
        )
        return Candidate(number, chosen, file, late, bill, verdict)

    # The last stages.

    def _best(self, count: int) -> list[Candidate]:
        """Returns the candidates that go on: the cheapest a piece of those that are late seldom,
        then those that are late least."""
        able = sorted(
            (each for each in self.candidates if each.late <= 2 * self.late),
            key=lambda each: (each.bill.a_piece, each.number),
        )
        rest = sorted(
            (each for each in self.candidates if each.late > 2 * self.late),
            key=lambda each: (each.late, each.number),
        )
        return [*able, *rest][:count]

    def _whole(self, candidates: Sequence[Candidate]) -> list[Candidate]:
        """Returns candidates judged by whole days, those that keep the limit first."""
        points = {each.number: self._points(each.file, SEEDS, False) for each in candidates}
        records = iter(self._shifts([point for part in points.values() for point in part]))
        out = [
            self._candidate(
                each.number, each.chosen, each.file, [next(records) for _ in points[each.number]]
            )
            for each in candidates
        ]
        return sorted(out, key=lambda each: (each.late > self.late, each.bill.a_piece, each.number))

    def _with_physics(self, candidates: Sequence[Candidate]) -> None:
        points = [
            replace(
                point, physics=True, run_in=0, minutes=max(math.ceil(60 * self.physics_hours), 1)
            )
            for each in candidates
            for point in self._points(each.file, SEEDS[:1], False)
        ]
        for candidate, record in zip(candidates, self._shifts(points)):
            counts = [int(fault.split()[0]) for fault in record.faults if "collisions" in fault]
            candidate.contacts = sum(counts)

    def _shifts(self, points: Sequence[Point]) -> list[Record]:
        """Returns the Record of each Point, simulating those that are not kept."""
        records = [self.store.get(point) for point in points]
        left = [i for i, record in enumerate(records) if record is None]
        pending = {self.executor.submit(shift.simulate, points[i]): i for i in left}
        self.shifts += len(points)
        try:
            while pending:
                for future in wait(pending, return_when=FIRST_COMPLETED).done:
                    i = pending.pop(future)
                    record = records[i] = future.result()
                    self.store.put(points[i], record)
                    self.simulated += 1
                    self.wall_s += record.wall_s
                    self._show(points[i])
        finally:
            for future in pending:
                future.cancel()
        return [record for record in records if record is not None]

    def _show(self, point: Point) -> None:
        kind = "physics" if point.physics else "ideal"
        text = (
            f"trial {self.trials} of {self.most_trials}, {self.simulated} shifts ({kind}),"
            f" {self.wall_s / 3600:.2f} h of computing"
        )
        self.on_shift(self.trials / max(self.most_trials, 1), text)


def _robots(file: LayoutFile) -> int:
    return file.robots if isinstance(file.robots, int) else len(file.robots)


def _importance(study: Any) -> dict[str, float]:
    """Returns how much each parameter decides of the cost a piece, by PED-ANOVA (Watanabe et al.,
    2023); {} for too few trials."""
    import warnings

    import optuna

    if len(study.trials) < 2 * BATCH:
        return {}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            shares = optuna.importance.get_param_importances(
                study,
                target=lambda trial: trial.values[1],
                evaluator=optuna.importance.PedAnovaImportanceEvaluator(),
            )
    except (ValueError, RuntimeError):
        return {}
    return {name: float(value) for name, value in shares.items()}


def front(candidates: Sequence[Candidate], late: float) -> list[Candidate]:
    """Returns those that no other each beats in what they cost to buy and a piece: of those that
    keep the limit, or of all where none does."""
    able = [each for each in candidates if each.late <= late] or list(candidates)

    def is_beaten(each: Candidate) -> bool:
        return any(
            other.bill.to_buy <= each.bill.to_buy
            and other.bill.a_piece <= each.bill.a_piece
            and (other.bill.to_buy < each.bill.to_buy or other.bill.a_piece < each.bill.a_piece)
            for other in able
        )

    return sorted(
        (each for each in able if not is_beaten(each)), key=lambda each: each.bill.a_piece
    )
