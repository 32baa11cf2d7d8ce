# SPDX-License-Identifier: Apache-2.0
"""The report's figures as tables for a spreadsheet."""

from collections.abc import Iterator, Sequence
from typing import Any

from warehouse_operations.document.sheets import Rows
from warehouse_operations.reports import limits
from warehouse_operations.reports.comparison import Group, value_of
from warehouse_operations.reports.figures import ROWS
from warehouse_operations.runs.run_files import Run

Row = Sequence[Any]
HOURS = (
    "hour",
    "orders in an hour",
    "done",
    "became late",
    "pieces",
    "stations, % of most",
    "robots at work %",
    "before stations %",
    "idle %",
    "limit",
)


def tables(groups: Sequence[Group]) -> dict[str, Rows]:
    """Returns the tables by name: figures, throughput and stations of all runs."""
    runs = [(group.label, run) for group in groups for run in group.runs]
    return {
        "figures": list(figures(runs, [name for name, *_ in ROWS])),
        "throughput": list(throughput(runs)),
        "stations": list(stations(runs)),
        "hours": [
            ("configuration", *HOURS),
            *((group.label, *row) for group in groups for row in list(hours(group))[1:]),
        ],
    }


def figures(runs: Sequence[tuple[str, Run]], names: Sequence[str]) -> Iterator[Row]:
    """Yields a row a run: configuration, seed and the figures of kpis.json of these names."""
    yield "configuration", "seed", *names
    for label, run in runs:
        yield label, run.seed, *(value_of(run.kpis, name) for name in names)


def throughput(runs: Sequence[tuple[str, Run]]) -> Iterator[Row]:
    """Yields a row an interval of each run: when it ends [s], pieces picked, orders completed."""
    yield "configuration", "seed", "until_s", "pieces_picked", "orders_completed"
    for label, run in runs:
        intervals = run.data["intervals"]
        pairs = zip(intervals["picked"], intervals["completed"])
        for i, (pieces, orders) in enumerate(pairs, start=1):
            yield label, run.seed, i * intervals["seconds"], pieces, orders


def hours(group: Group) -> Iterator[Row]:
    """Yields HOURS, and a row an hour of the shift: means of the runs."""
    yield HOURS
    count = len(group.runs)
    for hour, limit in limits.hours(limits.windows(group.runs)):
        hourly = limits.HOUR / max(hour.end - hour.begin, 1.0) / count
        counts = (hour.arrived, hour.completed, hour.late, hour.pieces)
        shares = (hour.of_bound, hour.at_work, hour.queue, hour.idle)
        yield (
            f"{limits.clock(hour.begin)} to {limits.clock(hour.end)}",
            *(round(hourly * value, 1) for value in counts),
            *(round(100 * value, 1) for value in shares),
            str(limit),
        )


def stations(runs: Sequence[tuple[str, Run]]) -> Iterator[Row]:
    """Yields a row a station of each run."""
    columns = ("name", "kind", "busy_fraction", "pieces", "visits")
    yield "configuration", "seed", *columns
    for label, run in runs:
        for station in run.data["stations"]:
            yield label, run.seed, *(station[column] for column in columns)
