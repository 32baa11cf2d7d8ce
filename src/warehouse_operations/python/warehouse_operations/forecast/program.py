# SPDX-License-Identifier: Apache-2.0
"""What the program `forecast` does: reads a database, makes the runs, shows what comes."""

import argparse
import json
import math
import tempfile
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from warehouse_layout.cli.progress_line import ProgressLine
from warehouse_layout.file.layout_file import LayoutFileError
from warehouse_layout.generate import layout_choice
from warehouse_layout.place import placement
from warehouse_operations.fleets import availability, measured
from warehouse_operations.fleets.availability import RealismError
from warehouse_operations.forecast import comparison, of_database
from warehouse_operations.forecast.ahead import Outcome, Task
from warehouse_operations.forecast.bands import Forecast, forecast_of
from warehouse_operations.forecast.fork import ForkError
from warehouse_operations.forecast.request import ForecastError, Request, tasks_of
from warehouse_operations.forecast.workers import Runs, RunsError
from warehouse_operations.policies import PolicyError
from warehouse_operations.reports.limits import clock
from warehouse_operations.runs import layout_site
from warehouse_operations.runs.event_file import seconds_of
from warehouse_operations.stock.order_file import DemandError
from warehouse_operations.stock.site import Site
from warehouse_operations.store import moment
from warehouse_operations.store.engines import DatabaseError
from warehouse_operations.store.moment import Moment
from warehouse_operations.store.returning import SiteError

ERRORS = (
    DatabaseError,
    DemandError,
    ForecastError,
    ForkError,
    LayoutFileError,
    PolicyError,
    RealismError,
    RunsError,
    SiteError,
)
ROWS = 6  # of the table
NAMED = 20  # late orders that are shown


@dataclass(frozen=True)
class Prepared:
    """The tasks of a forecast, as it is and with changes; the orders that were known, with
    reference and due time; the size of the fork [bytes]."""

    tasks: list[Task]
    known: dict[int, tuple[str, float]]
    size: int


def prepare(args: argparse.Namespace, asked: Request) -> Prepared:
    """Forks the shift of a database. Raises one of ERRORS, before anything starts."""
    asked.check()
    at = _time(args.at)
    then = moment.read(args.database, at)
    site = _site(then, args.layout, args.robots or None)
    site = measured.read(args.realism).at(site)
    remembered = of_database.remember(then, site, args.database, args.orders or None)
    shift, fork = remembered.shift, remembered.fork
    tasks = tasks_of(asked, site, shift, fork, availability.read(args.realism))
    known = {order.order_id: (order.reference, order.due) for order in shift.orders.values()}
    return Prepared(tasks, known, fork.size)


def _time(text: str | None) -> float | None:
    if text is None:
        return None
    try:
        return seconds_of(text)
    except ValueError as error:
        raise ForecastError(f"at {error}") from error


def _site(then: Moment, layout: str, robots: int | None) -> Site:
    """Returns the site of a layout, with the bins of a database."""
    name = layout or then.site
    try:
        file = layout_choice.chosen(name)
    except LayoutFileError as error:
        if layout:
            raise
        raise ForecastError(
            f"the database is of '{then.site}', which is no preset; --layout has to name its file"
        ) from error
    site = Site.of_layout(placement.place(file, robots=robots), file.title)
    site = layout_site.of_file(site, file)
    return replace(site, items=[(bin_.item, bin_.unit) for bin_ in then.bins], stock=())


def answer(prepared: Prepared, asked: Request, processes: int | None, out: Path | None) -> str:
    """Makes the runs, with a progress line, and returns what comes. Raises RunsError, and
    ForecastError for a folder that can't be written to, before anything starts."""
    if out:
        _check_folder(out)
    outcomes = _outcomes(prepared.tasks, asked, processes)
    forecasts = [
        forecast_of(task, asked.minutes, runs, prepared.known, changes=changes)
        for task, runs, changes in zip(prepared.tasks, outcomes, ((), asked.changes))
    ]
    parts = [shown(forecasts[0], "as it is" if asked.changes else "")]
    if len(forecasts) > 1:
        parts += [shown(forecasts[1], "; ".join(asked.changes)), difference(outcomes, asked)]
    if out:
        content = [_plain(asdict(forecast)) for forecast in forecasts]
        path = out / "forecast.json"
        path.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
        parts.append(f"{path}: the bands, minute by minute")
    return "\n\n".join(parts)


def _check_folder(out: Path) -> None:
    try:
        out.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=out):
            pass
    except OSError as error:
        raise ForecastError(f"out is {out}: {error.strerror}") from error


def _outcomes(tasks: list[Task], asked: Request, processes: int | None) -> list[list[Outcome]]:
    runs = Runs(tasks, asked.runs, processes=processes)
    line, whole = ProgressLine(), asked.runs * len(tasks)
    out: list[list[Outcome]] = [[] for _ in tasks]
    try:
        for count, (index, outcome) in enumerate(runs.outcomes(), start=1):
            out[index].append(outcome)
            if line.is_due():
                line.show(count / whole if whole else 0.0, f"{count} of {whole or 'some'} runs")
    finally:
        runs.kill()
        line.replace("")
    return [sorted(each, key=lambda outcome: outcome.number) for each in out]


def shown(forecast: Forecast, title: str) -> str:
    """Returns a forecast as text: a sentence, a table, late orders."""
    head = f"{title}: {forecast.text}" if title else forecast.text
    lines = [head[0].upper() + head[1:] + ".", ""]
    lines.append(f"{'at':>8}{'done':>18}{'open':>18}{'late':>18}{'pieces an hour':>20}")
    count = len(forecast.times)
    for i in sorted({round((row + 1) * count / ROWS) - 1 for row in range(ROWS)} - {-1}):
        cells = [_cell(forecast.bands[name][:, i]) for name in ("done", "open", "late")]
        recent = slice(max(i - 9, 0), i + 1)  # minutes
        pace = _cell(forecast.bands["pieces_per_hour"][:, recent].mean(axis=1))
        row = "".join(f"{cell:>18}" for cell in cells)
        lines.append(f"{clock(float(forecast.times[i])):>8}{row}{pace:>20}")
    for order in forecast.late[:NAMED]:
        odds = f"{100 * order.odds:.0f} %"
        lines.append(f"late with odds of {odds:>5}: {order.reference}, due {clock(order.due)}")
    if len(forecast.late) > NAMED:
        lines.append(f"… and {len(forecast.late) - NAMED} more orders with smaller odds")
    return "\n".join(lines)


def difference(outcomes: list[list[Outcome]], asked: Request) -> str:
    """Returns what changes make of the shift, as text."""
    lines = [f"The changes make, after {asked.minutes:g} minutes (95 % interval):"]
    for each in comparison.differences(*outcomes):
        lines.append(f"{each.name:>8} {each.without:10.1f} {each!s:>16}")
    return "\n".join(lines)


def _cell(values: Any) -> str:
    low, middle, high = (f"{value:.0f}" for value in values)
    return f"{middle} ({low}–{high})"


def _plain(value: Any) -> Any:
    """Returns values that JSON has: lists for arrays, null for what is not within."""
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, dict):
        return {name: _plain(each) for name, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(each) for each in value]
    return None if isinstance(value, float) and math.isnan(value) else value
