# SPDX-License-Identifier: Apache-2.0
"""The four figures by which a shift is led, with their last hour and their targets.

Pieces per hour: nine tenths of what the open stations can do at most, unless all that is ordered is
done: no order waits for a station, and as many are done as come in. Orders per hour: as many as
come in. Late orders: one in fifty at most. Robots available, that is, neither in need of help nor
commanded by a person nor out of service: nineteen in twenty. Pieces and orders are those of the
last quarter of an hour; a shift that is younger is early: until its first units have come it can't
do what it will.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from warehouse_msgs.msg import Kpis, Throughput

PIECES_OF_BOUND, MOST_LATE, LEAST_AVAILABLE = 0.9, 0.02, 0.95  # the targets
MINUTE, HOUR = 60.0, 3600.0  # [s, simulated]
SMOOTHED = 5  # intervals of a throughput that a point of a line is the mean of
RECENT = 15  # those of the figure itself


class Sample(NamedTuple):
    """Shares and counts at a time [s]; orders: count of those that have come in."""

    time: float
    late: float
    available: float
    orders: int


class Figures:
    """Keeps what the shift's messages leave out about its last hour. One thread at a time."""

    def __init__(self) -> None:
        self._samples: deque[Sample] = deque()

    def update(self, now: float, kpis: Kpis, available: float) -> None:
        """Updates from Kpis, and the share of robots that are available, at `now` [s]."""
        if self._samples and now < self._samples[-1].time:
            self._samples.clear()
        if not self._samples or now - self._samples[-1].time >= MINUTE:
            orders = kpis.orders_completed + kpis.orders_waiting + kpis.orders_at_stations
            late = kpis.late_orders_fraction
            self._samples.append(Sample(now, late, available, orders))
        while now - self._samples[0].time > HOUR:
            self._samples.popleft()

    def as_json(
        self, kpis: Kpis, throughput: Throughput, available: float, robots: int
    ) -> dict[str, Any]:
        """Returns the four figures as JSON; `throughput` a Throughput, `robots` how many
        there are."""
        bound = kpis.item_upper_bound_per_hour
        early = throughput.end - throughput.begin < RECENT * throughput.interval
        times = [sample.time for sample in self._samples]
        orders = _rates(throughput, throughput.orders_completed)
        incoming = self._incoming()
        is_enough = not kpis.orders_waiting and orders[0] >= PIECES_OF_BOUND * incoming
        return {
            "pieces": _figure(
                *_rates(throughput, throughput.items_picked),
                PIECES_OF_BOUND * bound,
                bound,
                early,
                bool(is_enough),
            ),
            "orders": _figure(*orders, incoming, early=early),
            "late": _figure(
                kpis.late_orders_fraction, times, [s.late for s in self._samples], MOST_LATE
            ),
            "available": _figure(
                available, times, [s.available for s in self._samples], LEAST_AVAILABLE, robots
            ),
        }

    def _incoming(self) -> float:
        """Returns how many orders come in an hour; 0 if that is not known yet."""
        first, last = self._samples[0], self._samples[-1]
        seconds = last.time - first.time
        return 3600 * max(0, last.orders - first.orders) / seconds if seconds else 0.0


def _figure(
    value: float,
    times: Sequence[float],
    values: Sequence[float],
    target: float,
    of: float = 0.0,
    early: bool = False,
    enough: bool = False,
) -> dict[str, Any]:
    return {
        "early": early,
        "enough": enough,
        "value": round(value, 4),
        "target": round(target, 4),
        "of": round(of, 1),
        "times": [round(time, 1) for time in times],
        "values": [round(value, 4) for value in values],
    }


def _rates(throughput: Throughput, counts: Sequence[int]) -> tuple[float, list[float], list[float]]:
    """Returns what is done in an hour now, and the ends of the intervals that are over [s] with
    what was done in an hour up to each."""
    interval, begin = throughput.interval, throughput.begin
    first = begin // interval
    ends = [(first + i + 1) * interval for i in range(len(counts) - 1)]

    def rate(last: int, most: int) -> float:
        start = max(0, last + 1 - most)
        seconds = ends[last] - max(begin, (first + start) * interval)
        return 3600 * sum(counts[start : last + 1]) / max(seconds, 1.0)

    values = [rate(i, SMOOTHED) for i in range(len(ends))]
    return (rate(len(ends) - 1, RECENT) if ends else 0.0), ends, values
