# SPDX-License-Identifier: Apache-2.0
"""The report's figures as CSV, for a spreadsheet: links that hold their file themselves."""

import base64
import csv
import io
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from warehouse_operations.comparison import Group, value_of
from warehouse_operations.runs import Run

Row = Sequence[Any]


def links(groups: Sequence[Group], names: Iterable[str]) -> str:
    """Returns HTML links to CSV files: figures (those of `names`), throughput and stations."""
    runs = [(group.label, run) for group in groups for run in group.runs]
    files = {
        "figures.csv": figures(runs, list(names)),
        "throughput.csv": throughput(runs),
        "stations.csv": stations(runs),
    }
    text = " ".join(_link(name, rows) for name, rows in files.items())
    return f'<p class="export">For a spreadsheet: {text}</p>'


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


def stations(runs: Sequence[tuple[str, Run]]) -> Iterator[Row]:
    """Yields a row a station of each run."""
    columns = ("name", "kind", "busy_fraction", "pieces", "visits")
    yield "configuration", "seed", *columns
    for label, run in runs:
        for station in run.data["stations"]:
            yield label, run.seed, *(station[column] for column in columns)


def _link(name: str, rows: Iterable[Row]) -> str:
    file = io.StringIO()
    csv.writer(file, lineterminator="\n").writerows(rows)
    content = base64.b64encode(file.getvalue().encode()).decode()
    return f'<a download="{name}" href="data:text/csv;base64,{content}">{name}</a>'
