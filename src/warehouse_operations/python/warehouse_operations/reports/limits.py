# SPDX-License-Identifier: Apache-2.0
"""The limits of a warehouse over the day, for reports, sweeps, sizings and what-if.

A shift is divided into windows of ten minutes, each with a limit of its own: of stations and robots
those with the higher utilisation, which are the bottleneck (Denning and Buzen, The Operational
Analysis of Queueing Network Models, ACM Computing Surveys 10, 1978). The limit of the shift is that
of the windows in which orders become late, else the one that holds longest: so an hour of peak
shows in a quiet day.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import groupby

import numpy as np

from warehouse_operations.runs.run_files import Run
from warehouse_operations.shift.tally import INTERVAL

WINDOW = 600.0  # [s]
HOUR = 3600.0  # [s]
SATURATED = 0.95  # utilisation from which stations are the limit
IDLE = 0.15  # share of the robots' time from which they lack work
HELD_UP = 1.15  # driven over planned time from which traffic is the limit


class Limit(StrEnum):
    """The limits that a warehouse can have."""

    STATIONS = "the picking stations"
    REPLENISHING = "the replenishing stations"
    ORDERS = "the orders and the stock"
    STREETS = "the streets"
    ROBOTS = "the robots"


@dataclass(frozen=True)
class Window:
    """A part of one shift or of several with the same times, summed; times of the shift [s].

    arrived, completed, late: numbers of orders. bound: pieces that the open picking stations could
    pick at most. robots_s: robot-seconds, of which idle_s without work and queue_s before stations.
    replenishing: share of their time that replenishing stations work. delay: driven over planned
    time.
    """

    begin: float
    end: float
    arrived: float
    completed: float
    late: float
    pieces: float
    bound: float
    robots_s: float
    idle_s: float
    queue_s: float
    replenishing: float = 0.0
    delay: float = 1.0

    @property
    def of_bound(self) -> float:
        """Pieces picked over the most that the open picking stations could pick."""
        return self.pieces / self.bound if self.bound else 0.0

    @property
    def idle(self) -> float:
        """The share of the robots' time without work."""
        return self.idle_s / self.robots_s if self.robots_s else 0.0

    @property
    def queue(self) -> float:
        """The share of the robots' time before stations."""
        return self.queue_s / self.robots_s if self.robots_s else 0.0

    @property
    def at_work(self) -> float:
        """The share of the robots' time with work and without waits for stations."""
        return 1 - self.idle - self.queue

    @property
    def limit(self) -> Limit:
        """The limit of the warehouse in this window."""
        if self.of_bound >= SATURATED:
            return Limit.STATIONS
        if self.idle > IDLE:
            return Limit.REPLENISHING if self.replenishing >= SATURATED else Limit.ORDERS
        if self.of_bound > self.at_work:
            return Limit.STATIONS
        return Limit.STREETS if self.delay > HELD_UP else Limit.ROBOTS


def windows_of(
    series: Mapping[str, Sequence[float]], late: Sequence[float], delay: float = 1.0
) -> list[Window]:
    """Returns the Windows of a shift.

    series: by minute, see minute_log.SERIES. late: orders that became late, by minute.
    """
    step = int(WINDOW / INTERVAL)
    count = len(series["pieces"])
    out = []
    for first in range(0, count, step):
        last = min(first + step, count)
        total = {name: float(sum(values[first:last])) for name, values in series.items()}
        out.append(
            Window(
                first * INTERVAL,
                last * INTERVAL,
                total["arrived"],
                total["completed"],
                float(sum(late[first:last])),
                total["pieces"],
                total["bound"],
                total["robots_s"],
                total["idle_s"],
                total["queue_s"],
                total["replenishing_s"] / max(total["open_replenishing_s"], 1.0),
                delay,
            )
        )
    return out


def windows(runs: Sequence[Run]) -> list[Window]:
    """Returns the Windows of runs of one configuration, summed."""
    delay = float(np.mean([run.kpis.get("executed_over_planned", 1.0) for run in runs]))
    if any("minutes" not in run.data for run in runs):
        return [_whole(runs, delay)]
    each = [run.data["minutes"] for run in runs]
    count = min(len(minutes["pieces"]) for minutes in each)
    series = {
        name: np.sum([minutes[name][:count] for minutes in each], axis=0).tolist()
        for name in each[0]
    }
    return windows_of(series, series["late"], delay) or [_whole(runs, delay)]


def _whole(runs: Sequence[Run], delay: float) -> Window:
    """Returns the Window of runs without minutes: short ones, or those of older versions."""
    spent: dict[str, float] = {}
    for run in runs:
        for activity, seconds in run.data.get("robots", {}).items():
            spent[activity] = spent.get(activity, 0.0) + seconds
    total = {
        name: sum(run.kpis.get(name, 0.0) * run.kpis.get("simulated_s", 0.0) / HOUR for run in runs)
        for name in (
            "order_throughput_per_hour",
            "item_throughput_per_hour",
            "item_upper_bound_per_hour",
        )
    }
    orders, pieces, bound = total.values()
    late = sum(
        run.kpis.get("late_orders_fraction", 0.0)
        * run.kpis.get("order_throughput_per_hour", 0.0)
        * run.kpis.get("simulated_s", 0.0)
        / HOUR
        for run in runs
    )
    end = max(run.kpis.get("simulated_s", 0.0) for run in runs)
    robots_s = sum(spent.values())
    idle_s, queue_s = spent.get("idle", 0.0), spent.get("queue", 0.0)
    return Window(
        0.0, end, orders, orders, late, pieces, bound, robots_s, idle_s, queue_s, 0.0, delay
    )


def merged(parts: Sequence[Window]) -> Window:
    """Returns the sum of Windows, from the begin of the first to the end of the last."""
    seconds = np.array([part.end - part.begin for part in parts])
    sums = {
        name: sum(getattr(part, name) for part in parts)
        for name in (
            "arrived", "completed", "late", "pieces", "bound", "robots_s", "idle_s", "queue_s",
        )
    }  # fmt: skip
    means = {
        name: float(np.average([getattr(part, name) for part in parts], weights=seconds))
        for name in ("replenishing", "delay")
    }
    return Window(parts[0].begin, parts[-1].end, **sums, **means)


def limit(parts: Sequence[Window]) -> Limit:
    """Returns the limit of a shift: where orders become late, else the one that holds longest."""
    late: dict[Limit, float] = {}
    time: dict[Limit, float] = {}
    for part in parts:
        late[part.limit] = late.get(part.limit, 0.0) + part.late
        time[part.limit] = time.get(part.limit, 0.0) + part.end - part.begin
    weights = late if any(late.values()) else time
    return max(weights, key=lambda it: (weights[it], time[it]))


def limiting(parts: Sequence[Window]) -> list[Window]:
    """Returns the Windows in which the limit of the shift holds."""
    limit_of_all = limit(parts)
    return [part for part in parts if part.limit == limit_of_all]


def hours(parts: Sequence[Window]) -> list[tuple[Window, Limit]]:
    """Returns the hours of a shift with their limits."""
    each = [list(of) for _, of in groupby(parts, key=lambda part: int(part.begin // HOUR))]
    return [(merged(of), limit(of)) for of in each]


def when(parts: Sequence[Window]) -> str:
    """Returns the times in which the limit of a shift holds, as `3:20 to 5:20, 7:00 to 7:10`; ""
    for all of it."""
    chosen = limiting(parts)
    if len(chosen) == len(parts):
        return ""
    spans: list[list[float]] = []
    for part in chosen:
        if spans and spans[-1][1] == part.begin:
            spans[-1][1] = part.end
        else:
            spans.append([part.begin, part.end])
    return ", ".join(f"{clock(begin)} to {clock(end)}" for begin, end in spans)


def clock(seconds: float) -> str:
    """Returns a time of the shift as text: hours and minutes."""
    minutes = round(seconds / 60)
    return f"{minutes // 60}:{minutes % 60:02}"


def share_of_late(parts: Iterable[Window], of: Iterable[Window]) -> float:
    """Returns the share of the late orders of Windows that fall into some of them."""
    late = sum(part.late for part in parts)
    return sum(part.late for part in of) / late if late else 0.0
