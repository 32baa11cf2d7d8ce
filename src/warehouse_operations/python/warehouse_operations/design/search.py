# SPDX-License-Identifier: Apache-2.0
"""The search for layouts, in stages, each of which leaves fewer and judges them longer.

1. By hand: what has no room, or costs more than a layout that does, is not simulated.
2. Ideal and short: a shift of ideal robots up to the end of the busiest hour. First floors as
   `layout new` makes them, then what Optuna proposes (objectives: to buy, cost a piece;
   constraint: late orders), then neighbours of the best with less to pay.
3. Ideal and whole: the best by whole days, with the same seeds for all. What is late gets robots,
   what is not loses one, until one more and one less are known.
4. Physics: those of the front.
5. Unseen: the front by seeds of which none had a part in its choice; they decide nothing more.

Trials are asked for in batches of the same size on any number of cores, and the budget counts
simulated orders: so the answer depends on arguments and seed alone. Shifts are kept; started
again, a search comes by the same trials without simulating them again.
"""

import itertools
import math
from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, wait
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from warehouse_layout.file.layout_file import LayoutFile
from warehouse_operations.design.candidate import Candidate, Judge, beats, front, robots_of
from warehouse_operations.design.plans import Chosen, Space
from warehouse_operations.sizing import point as shift
from warehouse_operations.sizing import sites
from warehouse_operations.sizing.costs import Bill, Costs
from warehouse_operations.sizing.day import RUN_IN
from warehouse_operations.sizing.point import Point, Record
from warehouse_operations.sizing.store import Store
from warehouse_operations.sizing.wish import Wish, WishError, count

BATCH = 4  # trials that are asked for together
SECONDS_A_PIECE = 0.0005  # of a core, about, that a piece of an ideal shift takes
FIRST_SHARE = 0.5  # of the budget, for the short shifts
PROPOSED = 0.5  # of the short shifts, for what Optuna proposes
LAST, LEAST_WHOLE = 5, 4  # layouts that physics sees at most, and that have whole days at least
SEARCH_SEED = 1
SEEDS, MORE_SEEDS = (101, 102, 103), (104, 105)  # of whole days: none that the search saw
UNSEEN = (201, 202, 203, 204, 205)  # of the last judgement
ASKED = 20  # trials without a shift for each that has one, at most
SAME, HOPELESS = 2, 4  # layouts with the same stations: in a batch, and late before they are left
PARENTS = 3  # layouts whose neighbours are tried
MOST_TRIALS = 2000
SHORT = "short shifts"
ENDS = 2 * len(UNSEEN)  # shifts of the last stages, about
WORST = 1e12  # price, and cost a piece, of a layout without room
RISK = 0.05  # that more orders are late than may be, where a layout goes on


@dataclass(eq=False)
class Search:
    """Searches a Space. hours: of a core, about. on_shift(done, text): after each shift.

    is_random: parameters by chance alone, with the same budget. physics_hours: of the simulated
    shift of each of the last layouts; 0: none.
    """

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
    trials: int = 0  # with a shift
    shifts: int = 0
    cpu_s: float = 0.0  # of all its shifts, kept ones too
    simulated: int = 0  # shifts that were not kept from before
    by_hand: int = 0  # trials that were given up without a shift
    candidates: list[Candidate] = field(default_factory=list)
    importance: dict[str, float] = field(default_factory=dict)
    _known: dict[str, Candidate | None] = field(default_factory=dict)
    _beaten: dict[str, Bill] = field(default_factory=dict)  # of those that cost more than others
    _stage: str = ""

    def run(self) -> list[Candidate]:
        """Returns the layouts that had whole days, the cheapest that keeps the limit first; []
        where no layout has room for a fleet at all."""
        self._stage = SHORT
        self._propose()
        if not self.is_random:
            self._refine()
        self.candidates = [candidate for candidate in self._known.values() if candidate]
        self._stage = "whole days"
        best = self._whole()
        chosen = front(best, self.late)[:LAST]
        if self.physics_hours:
            self._stage = "physics"
            self._with_physics(chosen)
        self._stage = "unseen seeds"
        self.test(chosen)
        return best

    @cached_property
    def judge(self) -> Judge:
        """What judges layouts by their shifts."""
        return Judge(self.costs, self.space.day, self.late, self.space.building.file)

    # The budget.

    @property
    def most_trials(self) -> int:
        """The number of short shifts that the budget has room for."""
        seconds = FIRST_SHARE * 3600 * self.hours
        return min(max(int(seconds / self._seconds(self._short_hours)), 2 * BATCH), MOST_TRIALS)

    @property
    def most_whole(self) -> int:
        """The number of layouts with whole days that the budget has room for."""
        seconds = (1 - FIRST_SHARE) * 3600 * self.hours
        a_layout = len(SEEDS + MORE_SEEDS) * self._seconds(self.space.day.hours)
        return max(int(seconds / a_layout), LEAST_WHOLE)

    def _seconds(self, hours: float) -> float:
        """Returns what a shift takes of a core, about [s]."""
        by_hour = list(self.space.day.by_hour)
        orders = sum(by_hour[: math.ceil(hours)]) + by_hour[0] * RUN_IN / 60
        return SECONDS_A_PIECE * max(orders * self.space.day.pieces_per_order, 1.0)

    @property
    def _short_hours(self) -> float:
        """Hours up to the end of the busiest one."""
        by_hour = list(self.space.day.by_hour)
        return float(min(by_hour.index(max(by_hour)) + 1, len(by_hour)))

    # The search by short shifts.

    def _propose(self) -> None:
        """Tries what Optuna proposes."""
        import optuna

        optuna.logging.set_verbosity(optuna.logging.ERROR)
        samplers = optuna.samplers
        sampler = (
            samplers.RandomSampler(seed=self.seed)
            if self.is_random
            else samplers.TPESampler(seed=self.seed, n_startup_trials=3 * BATCH)
        )
        study = optuna.create_study(directions=["minimize"] * 2, sampler=sampler)
        if not self.is_random:
            for start in self.space.starts():
                study.enqueue_trial(start)
        most = self.most_trials if self.is_random else int(PROPOSED * self.most_trials)
        for _ in range(ASKED * max(most // BATCH, 1)):
            if self.trials >= most:
                break
            trials = [study.ask() for _ in range(BATCH)]
            chosen = [self.space.choose(trial) for trial in trials]
            self._judge_short(chosen)
            for trial, parameters in zip(trials, chosen):
                self._tell(study, trial, self._known[self.space.known_as(parameters)])
        self.importance = _importance(study)

    def _tell(self, study: Any, trial: Any, candidate: Candidate | None) -> None:
        """Tells Optuna what came of a trial: a layout without room is as bad as can be."""
        if candidate is None:
            bill = self._beaten.get(self.space.known_as(trial.params))
            trial.set_constraint("late", 0.0 if bill else 1.0)
            study.tell(trial, [bill.to_buy, bill.a_piece] if bill else [WORST, WORST])
            return
        trial.set_constraint("late", candidate.late - self.late)
        study.tell(trial, [candidate.bill.to_buy, candidate.bill.a_piece])

    def _refine(self) -> None:
        """Tries neighbours of the best: with less to pay where they are in time, else with more."""
        rng = np.random.default_rng(self.seed)
        for _ in range(ASKED * max(self.most_trials // BATCH, 1)):
            if self.trials >= self.most_trials:
                break
            parents = self._parents()
            if not parents:
                break
            chosen = [
                self.space.neighbour(parent.chosen, rng, parent.late <= self.late)
                for parent in itertools.islice(itertools.cycle(parents), BATCH)
            ]
            self._judge_short(chosen)

    def _parents(self) -> list[Candidate]:
        """Returns the best so far: the cheapest in time, else those that are late least."""
        judged = [candidate for candidate in self._known.values() if candidate]
        return sorted(
            judged,
            key=lambda each: (
                max(each.late, self.late), each.bill.a_piece, each.number
            ),
        )[:PARENTS]  # fmt: skip

    def _judge_short(self, chosen: Sequence[Chosen]) -> None:
        """Judges parameters that are new by a short shift each."""
        fresh = {self.space.known_as(each): each for each in chosen}
        fresh = {key: each for key, each in fresh.items() if key not in self._known}
        files: dict[str, LayoutFile] = {}
        points: dict[str, Point] = {}
        for key, each in fresh.items():
            self._known[key] = None
            file = self.space.file_of(each)
            if file is None:
                continue
            if self._costs_more(file):
                self._beaten[key] = self.judge.bill(file)
                continue
            if made := self._points(file, (SEARCH_SEED,), True):
                files[key], points[key] = file, made[0]
        self.by_hand += len(fresh) - len(points)
        for key, record in zip(points, self._shifts(list(points.values()))):
            self.trials += 1
            self._known[key] = self.judge.judged(self.trials, fresh[key], files[key], [record])

    def _costs_more(self, file: LayoutFile) -> bool:
        """Returns whether a layout would be beaten by one that is known, even if all went well."""
        bill = self.judge.bill(file)
        return any(
            candidate.late <= self.late and beats(candidate.bill, bill)
            for candidate in self._known.values()
            if candidate
        )

    # Whole days.

    def _whole(self) -> list[Candidate]:
        """Returns candidates judged by whole days, the cheapest in time first."""
        judged: dict[str, Candidate] = {}
        queue = sorted(
            (each for each in self.candidates if each.late <= 2 * self.late),
            key=lambda each: (each.bill.a_piece, each.number),
        )
        queue = queue or sorted(self.candidates, key=lambda each: (each.late, each.number))
        most = self.shifts + len(SEEDS + MORE_SEEDS) * self.most_whole
        while self.shifts < most:
            queue = [each for each in queue if self._is_open(each, judged)]
            batch = _mixed(queue, judged.values(), self.late)
            if not batch:
                break
            whole = self.by_whole_days(batch)
            for each in whole:
                judged[self.space.known_as(each.chosen)] = each
            queue += [near for each in whole for near in self._beside(each, judged)]
            queue.sort(key=lambda each: (each.bill.a_piece, each.number))
        return sorted(
            judged.values(),
            key=lambda each: (each.late > self.late, each.bill.a_piece, each.number),
        )

    def _is_open(self, each: Candidate, judged: Mapping[str, Candidate]) -> bool:
        """Returns whether whole days of a candidate could still change the front."""
        if self.space.known_as(each.chosen) in judged:
            return False
        return not any(
            other.late <= self.late and beats(other.bill, each.bill) for other in judged.values()
        )

    def _beside(self, each: Candidate, judged: Mapping[str, Candidate]) -> list[Candidate]:
        """Returns candidates with a robot or two more than one that is late, or one less than one
        that is not."""
        if self.is_random:
            return []
        out = []
        for more in (1, 2) if each.late > self.late else (-1,):
            chosen = dict(each.chosen) | {"robots": each.robots + more}
            robots = self.space.parameters["robots"]
            if not robots[0] <= each.robots + more <= robots[-1]:
                continue
            file = self.space.file_of(chosen)
            if file is None or self.space.known_as(chosen) in judged:
                continue
            out.append(Candidate(each.number, chosen, file, 0.0, self.judge.bill(file)))
        return out

    def by_whole_days(self, batch: Sequence[Candidate]) -> list[Candidate]:
        """Returns candidates judged by whole days: more of those that are in time so far. late is
        its upper limit then."""
        records = self._days(batch, SEEDS)
        judged = [
            self.judge.judged(each.number, each.chosen, each.file, mine)
            for each, mine in zip(batch, records)
        ]
        going = [i for i, each in enumerate(judged) if each.late <= self.late]
        for i, more in zip(going, self._days([batch[i] for i in going], MORE_SEEDS)):
            each = batch[i]
            judged[i] = self.judge.judged(each.number, each.chosen, each.file, [*records[i], *more])
            verdict = judged[i].verdict
            assert verdict is not None
            judged[i].late = max(verdict.limit(RISK, 1), 0.0)
        return judged

    def by_short_shifts(self, candidates: Sequence[Candidate]) -> list[Candidate]:
        """Returns candidates judged by a short shift each."""
        points = [self._points(each.file, (SEARCH_SEED,), True)[0] for each in candidates]
        return [
            self.judge.judged(each.number, each.chosen, each.file, [record])
            for each, record in zip(candidates, self._shifts(points))
        ]

    def _days(self, batch: Sequence[Candidate], seeds: Sequence[int]) -> list[list[Record]]:
        """Returns the records of whole days of each candidate."""
        points = [self._points(each.file, seeds, False) for each in batch]
        records = iter(self._shifts([point for part in points for point in part]))
        return [[next(records) for _ in part] for part in points]

    # The last stages.

    def _with_physics(self, candidates: Sequence[Candidate]) -> None:
        """Counts contacts of simulated robots, and what traffic takes of the ideal pieces."""
        minutes = max(math.ceil(60 * self.physics_hours), 1)
        ideal = [
            replace(point, run_in=0, minutes=minutes)
            for each in candidates
            for point in self._points(each.file, SEEDS[:1], False)
        ]
        records = self._shifts([*ideal, *(replace(point, physics=True) for point in ideal)])
        for candidate, before, record in zip(
            candidates, records[: len(ideal)], records[len(ideal) :]
        ):
            counts = [int(fault.split()[0]) for fault in record.faults if "collisions" in fault]
            candidate.contacts = sum(counts)
            pieces = sum(before.series["pieces"])
            candidate.traffic = sum(record.series["pieces"]) / pieces if pieces else None

    def test(self, candidates: Sequence[Candidate]) -> None:
        """Judges candidates by unseen seeds."""
        for candidate, records in zip(candidates, self._days(candidates, UNSEEN)):
            self.judge.test(candidate, records)

    # Shifts.

    def _points(self, file: LayoutFile, seeds: Sequence[int], short: bool) -> list[Point]:
        day = self.space.day
        hours = self._short_hours if short else day.hours
        try:
            wish = Wish(
                file, day.orders_per_hour, late=self.late, hours=hours, day=day,
                realism=self.realism,
            )  # fmt: skip
            return wish.points(robots_of(file), len(sites.picking_stations(file)), seeds)
        except WishError:
            return []

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
                    self._show()
        finally:
            for future in pending:
                future.cancel()
        complete = [record for record in records if record is not None]
        self.cpu_s += sum(record.cpu_s for record in complete)
        return complete

    def _show(self) -> None:
        """Shows how far it is, about: the later stages may end sooner."""
        share = FIRST_SHARE * self.trials / max(self.most_trials, 1)
        if self._stage != SHORT:
            whole = len(SEEDS + MORE_SEEDS) * self.most_whole
            share = FIRST_SHARE + (1 - FIRST_SHARE) * (self.shifts - self.trials) / (whole + ENDS)
        text = (
            f"{self._stage}: {self.trials} of {self.most_trials} trials,"
            f" {count(self.simulated, 'shift')} simulated"
        )
        self.on_shift(min(share, 1.0), text)


def _mixed(
    queue: Sequence[Candidate], judged: Collection[Candidate], late: float
) -> list[Candidate]:
    """Returns the next to have whole days, BATCH at most: the cheapest, but few with the same
    stations, and none with stations that were late often and never in time."""
    tried, able = Counter(_stations_of(each) for each in judged), set[tuple[int, int]]()
    able.update(_stations_of(each) for each in judged if each.late <= late)
    out: list[Candidate] = []
    for each in queue:
        stations = _stations_of(each)
        alike = sum(_stations_of(other) == stations for other in out)
        hopeless = stations not in able and tried[stations] >= HOPELESS
        if alike < SAME and not hopeless and len(out) < BATCH:
            out.append(each)
    return out


def _stations_of(candidate: Candidate) -> tuple[int, int]:
    return candidate.stations, int(candidate.chosen["replenish"])


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
