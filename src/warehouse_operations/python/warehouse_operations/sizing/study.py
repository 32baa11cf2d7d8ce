# SPDX-License-Identifier: Apache-2.0
"""A whole sizing: from a wish to its answer, with all points that were judged on the way."""

from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, wait
from dataclasses import dataclass, field

from warehouse_operations.sizing import point as shift
from warehouse_operations.sizing.point import Point, Record
from warehouse_operations.sizing.prices import Pricing
from warehouse_operations.sizing.search import Search
from warehouse_operations.sizing.store import Store
from warehouse_operations.sizing.verdict import FIRST, Verdict, looks
from warehouse_operations.sizing.wish import ImpossibleError, Wish, count, named

STEP = 0.05  # share of robots added where simulated ones miss the wish; it doubles each time
# Points to draw: factors on the fewest robots, and shifts of each.
CURVE, DRAWN = (0.4, 0.6, 0.8, 1.25, 1.75), 3
TRIES = 4  # numbers of simulated robots

OnShift = Callable[["Study", Point, Record], object]


@dataclass(eq=False)
class Study:
    """Judges points of a wish. Shifts run on an Executor, and are kept in a Store.

    on_shift is called after each shift that was simulated. verdicts: by (robots, stations), of
    ideal robots; checks: the same of simulated ones. simulated_h, wall_s: of the shifts that this
    Study simulated, without those from the Store.
    """

    wish: Wish
    store: Store
    executor: Executor
    on_shift: OnShift = lambda *_: None
    verdicts: dict[tuple[int, int], Verdict] = field(default_factory=dict)
    checks: dict[tuple[int, int], Verdict] = field(default_factory=dict)
    frontier: dict[int, int | None] = field(default_factory=dict)
    shifts: int = 0
    simulated_h: float = 0.0
    wall_s: float = 0.0

    def search(self) -> dict[int, int | None]:
        """Returns the fewest robots for each number of stations. Raises ImpossibleError."""
        wish = self.wish
        least, most = wish.least_stations(), len(wish.stations)
        self.frontier = Search(self.judge, wish.robots).run(least, most)
        if not any(self.frontier.values()):
            raise ImpossibleError(self._why_not(most))
        return self.frontier

    def judge(self, robots: int, stations: int) -> Verdict:
        """Returns the Verdict on ideal robots at a number of stations."""
        return self._judge(self.verdicts, robots, stations, 0.0)

    def draw(self) -> None:
        """Judges points around the fewest robots for each number of stations, for the figure."""
        for stations, fewest in self.frontier.items():
            for share in CURVE if fewest else ():
                robots = round(share * (fewest or 0))
                if 0 < robots <= self.wish.robots(stations):
                    points = self.wish.points(robots, stations, range(1, DRAWN + 1))
                    self._judged(self.verdicts, robots, stations, self._shifts(points))

    def beside(self, verdict: Verdict, robots: int, stations: int) -> Verdict:
        """Returns the Verdict on a point by the seeds of a point that was judged."""
        points = self.wish.points(robots, stations, [record.seed for record in verdict.records])
        return self._judged(self.verdicts, robots, stations, self._shifts(points))

    def check(self, robots: int, stations: int, hours: float) -> int | None:
        """Returns the number of simulated robots that meet the wish, `robots` or a few more; or
        None.

        hours: of a shift.
        """
        most, add = self.wish.robots(stations), 0
        for _ in range(TRIES):
            if self._judge(self.checks, robots + add, stations, hours).met:
                return robots + add
            if robots + add >= most:
                return None
            add = min(max(2 * add, round(STEP * robots), 1), most - robots)
        return None

    def _judge(
        self,
        verdicts: dict[tuple[int, int], Verdict],
        robots: int,
        stations: int,
        physics_hours: float,
    ) -> Verdict:
        records: list[Record] = []
        seeds = self.wish.seeds
        for enough in sorted({FIRST, *looks(seeds)}):
            numbers = range(len(records) + 1, max(enough, len(records)) + 1)
            records += self._shifts(self.wish.points(robots, stations, numbers, physics_hours))
            verdict = self._judged(verdicts, robots, stations, records)
            if verdict.decided:
                break
        return verdict

    def _judged(
        self,
        verdicts: dict[tuple[int, int], Verdict],
        robots: int,
        stations: int,
        records: Sequence[Record],
    ) -> Verdict:
        """Returns the Verdict on these shifts, and adds it to `verdicts`."""
        verdict = Verdict(
            robots,
            stations,
            tuple(records),
            self.wish.late,
            self.wish.seeds,
            self.wish.run_in,
            self.wish.day is not None,
        )
        known = verdicts.get((robots, stations))
        if known is None or len(known.records) < len(records):
            verdicts[robots, stations] = verdict
        return verdict

    def _shifts(self, points: Sequence[Point]) -> list[Record]:
        """Returns the Record of each Point, simulating those that the store lacks."""
        records = {point.seed: self.store.get(point) for point in points}
        left = [point for point in points if records[point.seed] is None]
        pending = {self.executor.submit(shift.simulate, point): point for point in left}
        try:
            while pending:
                for future in wait(pending, return_when=FIRST_COMPLETED).done:
                    point = pending.pop(future)
                    records[point.seed] = future.result()
                    self._keep(point, future.result())
        finally:
            for future in pending:
                future.cancel()
        return [record for point in points if (record := records[point.seed]) is not None]

    def _keep(self, point: Point, record: Record) -> None:
        self.store.put(point, record)
        self.shifts += 1
        self.simulated_h += (point.run_in + point.minutes) / 60
        self.wall_s += record.wall_s
        self.on_shift(self, point, record)

    def _why_not(self, stations: int) -> str:
        wish = self.wish
        verdict = self.judge(wish.robots(stations), stations)
        pieces = verdict.estimate("pieces_per_hour").mean
        return (
            f"{count(verdict.robots, 'robot')} and {named(wish.stations)} pick {pieces:,.0f} pieces"
            f" an hour where {wish.pieces_per_hour:,.0f} are asked for, and"
            f" {100 * verdict.estimate('late').mean:.1f} % of the orders are late;"
            f" {100 * wish.late:g} % may be"
        )


def choose(
    frontier: dict[int, int | None], prices: Pricing | None, units: int, replenishing: int
) -> tuple[int, int]:
    """Returns the (robots, picking stations) of a frontier to recommend.

    units, replenishing: storage units and replenishing stations, the same at all points.
    With prices these are the cheapest; without, the fewest stations, each of which takes a person,
    and the fewest robots for them.
    """
    able = [(robots, stations) for stations, robots in frontier.items() if robots]
    if prices is None:
        return min(able, key=lambda point: (point[1], point[0]))
    return min(able, key=lambda point: prices.per_hour(point[0], point[1] + replenishing, units))
