# SPDX-License-Identifier: Apache-2.0
"""What limits a warehouse, hour by hour: a peak is not lost in a quiet day."""

import contextlib
import csv
import sqlite3

import pytest
from instance_file import write_instance

from warehouse_operations.reports import comparison, limits, report
from warehouse_operations.reports import front as report_front
from warehouse_operations.reports.limits import Window, when
from warehouse_operations.runs.simulation import Description, open_operations, simulate

HOURS, QUIET, PEAK = 6, 60, 420  # orders an hour; the peak is the third and fourth hour


@pytest.fixture(scope="module")
def day(tmp_path_factory):
    """A day with a peak beyond what its station can pick, at twelve robots."""
    folder = tmp_path_factory.mktemp("day")
    instance = write_instance(folder / "a.xinst", bots=12, picking=1, replenishing=1, rows=3)
    probe, _ = simulate(
        Description(instance=str(instance), orders="poisson:60", seconds=600, physics=False),
        folder / "probe",
    )
    skus = _skus(folder / "probe")
    path = folder / "day.csv"
    with open(path, "w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(("reference", "sku", "quantity", "at", "due"))
        number = 0
        for hour in range(HOURS):
            count = PEAK if hour in (2, 3) else QUIET
            for i in range(count):
                at = 3600 * hour + 3600 * i / count
                rows.writerow((f"o{number}", skus[number % len(skus)], 1, at, at + 1200))
                number += 1
    run, _ = simulate(
        Description(instance=str(instance), orders=str(path), seconds=3600 * HOURS, physics=False),
        folder / "out",
        write_report=report.write,
    )
    return comparison.grouped([run])[0], (folder / "out" / "report.html").read_text()


def _skus(folder):
    with contextlib.closing(sqlite3.connect(folder / "run.db")) as database:
        rows = database.execute("SELECT sku, SUM(quantity) FROM bin GROUP BY sku ORDER BY 2 DESC")
        return [sku for sku, _ in rows][:40]


def test_what_limits_a_day_is_what_does_in_its_peak(day):
    group, html = day
    assert group.estimate("late_orders_fraction").mean > 0.05
    assert report_front.limit(group) == "the picking stations"
    assert "What limits it: the picking stations<" in html


def test_each_hour_has_its_limit(day):
    group, html = day
    parts = limits.windows(group.runs)
    hours = limits.hours(parts)
    assert [limit for _, limit in hours][:2] == ["the orders and the stock"] * 2
    assert [limit for _, limit in hours][2:4] == ["the picking stations"] * 2
    assert sum(hour.late for hour, _ in hours) == pytest.approx(
        group.estimate("late_orders_fraction").mean * (2 * PEAK + 4 * QUIET), rel=0.05
    )
    assert limits.share_of_late(parts, limits.limiting(parts)) > 0.9
    assert "of the late orders became late then" in html and "<h2>Hour by hour" in html


def test_spans_of_a_limit_are_told_as_times():
    def window(begin, pieces):
        return Window(begin, begin + 600, 9, 9, pieces > 90, pieces, 100, 600, 300, 0)

    parts = [window(600 * i, 99 if i in (2, 3, 8) else 20) for i in range(12)]
    assert when(parts) == "0:20 to 0:40, 1:20 to 1:30"
    assert when(parts[2:4]) == ""


@pytest.mark.parametrize("robots, minutes", [(7, 30), (10, 30), (12, 10)])
def test_more_of_what_is_the_limit_brings_more_than_more_of_the_other(robots, minutes):
    """A fifth more robots, or pickers that are a fifth quicker."""
    pieces, parts = picked(robots, minutes)
    by_robots = picked(round(1.2 * robots), minutes)[0] - pieces
    by_pickers = picked(robots, minutes, quicker=1.2)[0] - pieces
    best = "the robots" if by_robots > by_pickers else "the picking stations"
    assert limits.limit(parts) == best


def picked(robots, minutes, quicker=1.0):
    """The pieces of a shift with orders that never run out, and its Windows."""
    with open_operations(Description("medium", robots=robots, physics=False)) as ops:
        for station in ops.shift.stations:
            if station.picks:
                station.set_pace(station.seconds_a_piece / quicker)
        ops.run(minutes=minutes)
        series = ops.log.series
        return ops.kpis()["items_picked"], limits.windows_of(series, [0] * minutes)
