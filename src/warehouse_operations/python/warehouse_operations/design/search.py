# SPDX-License-Identifier: Apache-2.0
"""The search for layouts, in rounds of two stages, and three more at the end.

A layout without room, or with higher costs than one known to be in time, is not simulated.
1. Ideal and short: a shift of ideal robots up to the end of the busiest hour. First floors as
   `layout new` makes them, then what Optuna proposes (objectives: to buy, cost a piece;
   constraint: late orders), then neighbours of the best with less to pay, and of late ones that
   would cost less.
2. Ideal and whole: the cheapest by whole days, with the same seeds for all. A late layout is
   tried with more robots, another one with fewer.
3. Confirming: the front by more days; those that are late then leave it.
4. Physics: the front.
5. Unseen: the front by new seeds, which had no part in its choice and don't change it.

Trials are asked for in batches of the same size on any number of cores, and the budget counts
simulated pieces: so the answer depends on arguments and seed alone. Shifts are kept: a search that
is started again repeats its trials without simulating them.
"""

import itertools
import math
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, wait
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from warehouse_layout.file.layout_file import LayoutFile
from warehouse_operations.design.candidate import Candidate, Judge, beats, front, robots_of
from warehouse_operations.design.plans import POLICY, Chosen, Space
from warehouse_operations.sizing import point as shift
from warehouse_operations.sizing import sites
from warehouse_operations.sizing.costs import Bill, Costs
from warehouse_operations.sizing.day import RUN_IN
from warehouse_operations.sizing.point import Point, Record
from warehouse_operations.sizing.store import Store
from warehouse_operations.sizing.wish import Wish, WishError, count

BATCH = 4  # trials that are asked for together
# Seconds of a core, about, that an ideal shift takes, and each of its pieces.
SECONDS_A_SHIFT, SECONDS_A_PIECE = 0.1, 0.0003
ROUNDS = 4
SHORT_SHARE = 0.5  # of a round's budget, for the short shifts
PROPOSING = 2  # rounds in which Optuna proposes; in the others neighbours are tried
LAST = 5  # layouts simulated with physics, at most
RESCUES = 3  # batches of whole days, at most, beyond the budget where nothing is in time
SEARCH_SEED = 1
SEEDS = ((101,), (102, 103), (104, 105))  # of whole days, in stages; short shifts have another seed
DAYS = (*itertools.chain(*SEEDS),)
FRESH = (106, 107, 108, 109, 110)  # of the layouts that are recommended
UNSEEN = tuple(range(201, 216))  # of the last judgement
ASKED = 500  # batches of trials a round, at most
# Layouts with the same stations: most in a batch, and late ones that rule out the others.
SAME, HOPELESS = 2, 8
FAR = 3.0  # limits of late orders: a layout with more on its first day gets no other
NEARLY = 2.0  # limits of late orders: below them another layout with the same stations may do
PARENTS = 3  # layouts whose neighbours are tried
SHORT, WHOLE = "short shifts", "whole days"
WORST = 1e12  # price, and cost a piece, of a layout without room
RISK = 0.05  # probability that a layout in time exceeds the limit of late orders


@dataclass(eq=False)
class Search:
    """Searches a Space. hours: the budget in core hours, approximate. on_shift(done, text): called
    after each shift. is_random: draws all parameters, with the same budget. physics_hours: length
    of the shift with physics of each of the last layouts; 0: no such shift.
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
    simulated: int = 0  # shifts that were not read from the store
    by_hand: int = 0  # trials dropped without a shift
    importance: dict[str, float] = field(default_factory=dict)
    _known: dict[str, Candidate | None] = field(default_factory=dict)
    _beaten: dict[str, Bill] = field(default_factory=dict)  # of layouts that cost more than others
    _days: dict[str, Candidate] = field(default_factory=dict)  # judged by whole days
    _beside: list[Candidate] = field(default_factory=list)  # to be judged by whole days, too
    _spent: float = 0.0  # of the budget [s]
    _stage: str = SHORT

    def run(self) -> list[Candidate]:
        """Searches; returns the front of the layouts judged by whole days, LAST at most: the
        cheapest within the limit first, after them those whose simulated robots touched. [] where
        no layout has room for a fleet."""
        study, rng = self._study(), np.random.default_rng(self.seed)
        for number in range(ROUNDS):
            proposes = self.is_random or number < PROPOSING
            self._stage = SHORT
            end = self.budget * (number + SHORT_SHARE) / ROUNDS
            self._short(end, study if proposes else None, rng)
            self._stage = WHOLE
            self._whole(self.budget * (number + 1) / ROUNDS)
        self.importance = _importance(study)
        for _ in range(RESCUES):
            if any(each.late <= self.late for each in self._days.values()):
                break
            self._judge_days(self._least_late())
        self._stage = "confirming"
        chosen = self._confirm()
        if self.physics_hours:
            self._stage = "physics"
            self._with_physics(chosen)
        self._stage = "unseen seeds"
        self.test(chosen)
        return sorted(chosen, key=lambda each: bool(each.contacts))

    @cached_property
    def judge(self) -> Judge:
        """The Judge of layouts, by their shifts."""
        return Judge(self.costs, self.space.day, self.late, self.space.building.file)

    # The budget.

    @property
    def budget(self) -> float:
        """Seconds of a core, about, for short shifts and whole days: some batches at least."""
        whole = len(DAYS) * self._seconds(self.space.day.hours)
        least = BATCH * (2 * self._seconds(self._short_hours) + whole)
        return max(3600 * self.hours, least)

    def _seconds(self, hours: float) -> float:
        """Returns what a shift takes of a core, about [s]."""
        by_hour = list(self.space.day.by_hour)
        orders = sum(by_hour[: math.ceil(hours)]) + by_hour[0] * RUN_IN / 60
        return SECONDS_A_SHIFT + SECONDS_A_PIECE * orders * self.space.day.pieces_per_order

    @property
    def _short_hours(self) -> float:
        """Hours up to the end of the busiest one."""
        by_hour = list(self.space.day.by_hour)
        return float(min(by_hour.index(max(by_hour)) + 1, len(by_hour)))

    # The search by short shifts.

    def _study(self) -> Any:
        """Returns a study of Optuna, which begins with the floors that are tried first."""
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
        return study

    def _short(self, end: float, study: Any, rng: np.random.Generator) -> None:
        """Judges layouts by short shifts until a part of the budget is spent: what a study
        proposes, or without it neighbours of the best."""
        for _ in range(ASKED):
            if self._spent >= end:
                break
            if study is None:
                self._judge_short(self._neighbours(rng))
                continue
            trials = [study.ask() for _ in range(BATCH)]
            chosen = [self.space.choose(trial) for trial in trials]
            self._judge_short(chosen)
            for trial, parameters in zip(trials, chosen):
                self._report_to_optuna(study, trial, self._known[self.space.known_as(parameters)])

    def _report_to_optuna(self, study: Any, trial: Any, candidate: Candidate | None) -> None:
        """Reports the result of a trial to Optuna: a layout without room gets the WORST cost."""
        if candidate is None:
            bill = self._beaten.get(self.space.known_as(trial.params))
            trial.set_constraint("late", 0.0 if bill else 1.0)
            study.tell(trial, [bill.to_buy, bill.a_piece] if bill else [WORST, WORST])
            return
        trial.set_constraint("late", candidate.late - self.late)
        study.tell(trial, [candidate.bill.to_buy, candidate.bill.a_piece])

    def _neighbours(self, rng: np.random.Generator) -> list[dict[str, Any]]:
        """Returns neighbours of the best: with less to pay where they are in time, else more."""
        return [
            self.space.neighbour(parent.chosen, rng, self._is_able(parent))
            for parent in itertools.islice(itertools.cycle(self._parents()), BATCH)
        ]

    def _parents(self) -> list[Candidate]:
        """Returns the layouts whose neighbours are tried: the cheapest in time, each followed by
        one that is late and would cost less than all of these, the least late first."""
        judged = [each for each in self._known.values() if each]
        able = [each for each in judged if self._is_able(each)]
        able.sort(key=lambda each: (each.bill.a_piece, each.number))
        least = able[0].bill.a_piece if able else math.inf
        tempting = [
            each
            for each in judged
            if each.late > self.late and each.bill.a_piece < least and not self._is_hopeless(each)
        ]
        tempting.sort(key=lambda each: (each.late, each.number))
        pairs = itertools.zip_longest(able[:PARENTS], tempting[:PARENTS])
        return [each for pair in pairs for each in pair if each]

    def _is_able(self, each: Candidate) -> bool:
        """Returns whether a candidate is in time by all that is known."""
        return each.late <= self.late and not self._is_refuted(each)

    def _is_refuted(self, each: Candidate) -> bool:
        """Returns whether whole days rule a layout out: all with the same stations were late, and
        these are many, or one of them had the same policies and no fewer robots."""
        return self._is_hopeless(each) or any(
            day.robots >= each.robots and _policies_of(day) == _policies_of(each)
            for day in self._late_alike(each)
        )

    def _is_hopeless(self, each: Candidate) -> bool:
        """Returns whether many with the same stations were late by whole days, and none nearly in
        time."""
        late = [day.late for day in self._late_alike(each)]
        return len(late) >= HOPELESS and min(late) > NEARLY * self.late

    def _late_alike(self, each: Candidate) -> list[Candidate]:
        """Returns the layouts with the same stations that were late by whole days; [] where one of
        them was in time."""
        alike = [day for day in self._days.values() if _stations_of(day) == _stations_of(each)]
        return alike if all(day.late > self.late for day in alike) else []

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
        self._spent += len(points) * self._seconds(self._short_hours)
        for key, record in zip(points, self._shifts(list(points.values()))):
            self.trials += 1
            self._known[key] = self.judge.judged(self.trials, fresh[key], files[key], [record])

    def _costs_more(self, file: LayoutFile) -> bool:
        """Returns whether a layout, even without late orders, costs more than one in time by whole
        days."""
        bill = self.judge.bill(file)
        return any(day.late <= self.late and beats(day.bill, bill) for day in self._days.values())

    # Whole days.

    def _whole(self, end: float) -> None:
        """Judges the cheapest by whole days until a part of the budget is spent."""
        while self._spent < end:
            known = [each for each in self._known.values() if each and each.late <= self.late]
            queue = [each for each in (*known, *self._beside) if self._is_open(each)]
            queue.sort(key=lambda each: (each.bill.a_piece, each.number))
            batch = _mixed(queue)
            if not batch:
                break
            self._judge_days(batch)

    def _is_open(self, each: Candidate) -> bool:
        """Returns whether whole days of a candidate could still change the front."""
        if self.space.known_as(each.chosen) in self._days or self._is_refuted(each):
            return False
        return not any(
            other.late <= self.late and beats(other.bill, each.bill)
            for other in self._days.values()
        )

    def _least_late(self) -> list[Candidate]:
        """Returns the candidates with the fewest late orders by short shifts; of equals, with the
        most stations."""
        left = [
            each
            for key, each in self._known.items()
            if each and key not in self._days and not self._is_refuted(each)
        ]
        left.sort(key=lambda each: (each.late, -each.stations, -each.robots, each.number))
        return left[:BATCH]

    def _judge_days(self, batch: Sequence[Candidate]) -> None:
        """Judges candidates by whole days, and adds their variants with other numbers of robots."""
        for each in self.by_whole_days(batch):
            key = self.space.known_as(each.chosen)
            self._days[key] = self._known[key] = each
            self._beside += self._with_other_robots(each)

    def _with_other_robots(self, each: Candidate) -> list[Candidate]:
        """Returns variants of a candidate: with one robot more and with half as many again if it is
        late, else with one fewer and with two thirds."""
        out = []
        robots = self.space.parameters["robots"]
        is_late = each.late > self.late
        steps = (1, max(2, each.robots // 2)) if is_late else (-1, -max(2, each.robots // 3))
        for more in () if self.is_random else steps:
            chosen = dict(each.chosen) | {"robots": each.robots + more}
            if not robots[0] <= each.robots + more <= robots[-1]:
                continue
            file = self.space.file_of(chosen)
            if file is not None and self.space.known_as(chosen) not in self._days:
                out.append(Candidate(each.number, chosen, file, 0.0, self.judge.bill(file)))
        return out

    def by_whole_days(self, batch: Sequence[Candidate]) -> list[Candidate]:
        """Returns candidates judged by whole days, more of them for those in time, whose `late` is
        the upper limit in the end."""
        judged, records = list(batch), [list[Record]() for _ in batch]
        going = list(range(len(batch)))
        for seeds, limit in zip(SEEDS, (FAR * self.late, self.late, self.late)):
            for i, more in zip(going, self._records([batch[i] for i in going], seeds)):
                records[i] += more
                judged[i] = self._judged(batch[i], records[i])
            going = [i for i in going if judged[i].late <= limit]
        for i in going:
            _set_upper_limit(judged[i])
        return judged

    def _judged(self, each: Candidate, records: Sequence[Record]) -> Candidate:
        return self.judge.judged(each.number, each.chosen, each.file, records)

    def _confirm(self) -> list[Candidate]:
        """Returns the front after more days: of many layouts the luckiest by its days is in time,
        too. Those that are late by all days leave the front."""
        seeds = (*DAYS, *FRESH)
        while True:
            chosen = front(list(self._days.values()), self.late)[:LAST]
            left = [
                each
                for each in chosen
                if each.late <= self.late
                and each.verdict
                and len(each.verdict.records) < len(seeds)
            ]
            if not left:
                return chosen
            for each, records in zip(left, self._records(left, seeds)):
                judged = self._days[self.space.known_as(each.chosen)] = self._judged(each, records)
                _set_upper_limit(judged)

    def by_short_shifts(self, candidates: Sequence[Candidate]) -> list[Candidate]:
        """Returns candidates judged by a short shift each."""
        points = [self._points(each.file, (SEARCH_SEED,), True)[0] for each in candidates]
        return [
            self._judged(each, [record]) for each, record in zip(candidates, self._shifts(points))
        ]

    def _records(self, batch: Sequence[Candidate], seeds: Sequence[int]) -> list[list[Record]]:
        """Returns the records of whole days of each candidate."""
        points = [self._points(each.file, seeds, False) for each in batch]
        self._spent += len(seeds) * len(batch) * self._seconds(self.space.day.hours)
        records = iter(self._shifts([point for part in points for point in part]))
        return [[next(records) for _ in part] for part in points]

    # The last stages.

    def _with_physics(self, candidates: Sequence[Candidate]) -> None:
        """Counts contacts of simulated robots, and measures which share of the ideal pieces they
        pick."""
        minutes = max(math.ceil(60 * self.physics_hours), 1)
        ideal = [
            replace(point, run_in=0, minutes=minutes)
            for each in candidates
            for point in self._points(each.file, SEEDS[0], False)
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
        for candidate, records in zip(candidates, self._records(candidates, UNSEEN)):
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
        """Returns the Record of each Point, simulating those that the store lacks."""
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
        """Shows the approximate progress: the later stages may end sooner."""
        text = f"{self._stage}: {self.trials} trials, {count(self.simulated, 'shift')} simulated"
        share = self._spent / self.budget
        self.on_shift(min(share, 1.0), text)


def _mixed(queue: Sequence[Candidate]) -> list[Candidate]:
    """Returns the next candidates for whole days, BATCH at most: the cheapest, few of them with the
    same stations."""
    out: list[Candidate] = []
    for each in queue:
        alike = sum(_stations_of(other) == _stations_of(each) for other in out)
        if alike < SAME and len(out) < BATCH:
            out.append(each)
    return out


def _set_upper_limit(candidate: Candidate) -> None:
    """Sets a candidate's share of late orders to its upper limit."""
    assert candidate.verdict is not None
    candidate.late = max(candidate.verdict.limit(RISK, 1), 0.0)


def _stations_of(candidate: Candidate) -> tuple[int, int]:
    return candidate.stations, int(candidate.chosen["replenish"])


def _policies_of(candidate: Candidate) -> dict[str, Any]:
    return {name: what for name, what in candidate.chosen.items() if name.startswith(POLICY)}


def _importance(study: Any) -> dict[str, float]:
    """Returns the importance of each parameter for the cost a piece, by PED-ANOVA (Watanabe et al.,
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
