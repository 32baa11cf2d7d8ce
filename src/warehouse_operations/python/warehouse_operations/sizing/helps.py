# SPDX-License-Identifier: Apache-2.0
"""Improvements of an answer: the points with one robot more and with one station more."""

from collections.abc import Iterator

from warehouse_operations.sizing.study import Study
from warehouse_operations.sizing.verdict import Verdict, difference


def simulate(study: Study, verdict: Verdict) -> list[Verdict]:
    """Returns the points with one robot more and with one station more that have room."""
    wish, robots, stations = study.wish, verdict.robots, verdict.stations
    points = []
    if robots < wish.room:
        points.append((robots + 1, stations))
    if stations < len(wish.stations):
        points.append((robots, stations + 1))
    return [study.beside(verdict, *point) for point in points]


def sentences(study: Study, verdict: Verdict, others: list[Verdict]) -> Iterator[str]:
    """Yields the differences of each of these points, seed by seed."""
    for other in others:
        more = "A robot more"
        if other.stations > verdict.stations:
            more = f"A picking station more ({study.wish.stations[other.stations - 1]})"
        late = difference(verdict, other, "late")
        done = difference(verdict, other, "orders_per_hour")
        unclear = abs(late.mean) <= late.half
        yield (
            f"{more}: {100 * late.mean:+.2f} ± {100 * late.half:.2f} points of late orders,"
            f" {done.mean:+.1f} ± {done.half:.1f} orders an hour"
            f"{'; that is within chance' if unclear else ''}."
        )
