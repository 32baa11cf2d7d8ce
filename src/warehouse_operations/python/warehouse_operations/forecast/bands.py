# SPDX-License-Identifier: Apache-2.0
"""A forecast: quantiles over many runs, and what they mean in plain English."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from warehouse_operations.forecast.ahead import Outcome, Task
from warehouse_operations.reports.limits import clock

QUANTILES = (0.1, 0.5, 0.9)
SERIES = ("done", "open", "late", "pieces_per_hour")
LIKELY = 0.5  # odds from which on an order will likely be late
NAMED = 5  # late orders in a text


@dataclass(frozen=True)
class LateOrder:
    """An order that may be late. odds: the share of the runs in which it is."""

    order_id: int
    reference: str
    due: float
    odds: float


@dataclass(frozen=True)
class Forecast:
    """The result of runs. times [s]. bands: for each of SERIES three rows, of QUANTILES, (3, n).

    finish: quantiles of when all orders known at `made_at` are over [s]; NaN: not within. late:
    orders, the likeliest first. text: all of it in plain English.
    """

    made_at: float
    minutes: float
    runs: int
    changes: tuple[str, ...]
    times: np.ndarray
    bands: Mapping[str, np.ndarray]
    finish: tuple[float, float, float]
    late: Sequence[LateOrder] = field(default_factory=tuple)
    known: int = 0
    text: str = ""


def forecast_of(
    task: Task,
    minutes: float,
    outcomes: Sequence[Outcome],
    known: Mapping[int, tuple[str, float]],
    *,
    changes: Sequence[str] = (),
) -> Forecast:
    """Returns the forecast of some runs, at least one.

    known: reference and due time [s] of the orders that were not over at the fork, by id.
    """
    began = task.fork.time
    times = np.array(task.times)
    values = {name: np.array([getattr(o, name) for o in outcomes], float) for name in SERIES[:3]}
    pieces = np.array([outcome.pieces for outcome in outcomes], float)
    steps = np.diff(np.concatenate([[began], times]))
    values["pieces_per_hour"] = np.diff(pieces, axis=1, prepend=0.0) * 3600 / steps
    bands = {name: quantiles(rows) for name, rows in values.items()}
    late = late_orders(outcomes, known, float(times[-1]))
    finish = finish_quantiles([outcome.finish for outcome in outcomes])
    forecast = Forecast(
        began, minutes, len(outcomes), tuple(changes), times, bands, finish, late, len(known)
    )
    return Forecast(**{**vars(forecast), "text": text_of(forecast)})


def quantiles(rows: np.ndarray) -> np.ndarray:
    """Returns the QUANTILES of runs (n, times), (3, times): a further run is between the outer ones
    with a chance of 80 %, be they many or few (Weibull's plotting positions)."""
    return np.quantile(rows, QUANTILES, axis=0, method="weibull")


def finish_quantiles(ends: Sequence[float]) -> tuple[float, float, float]:
    """Returns the QUANTILES of ends [s], of which NaN come later than all others."""
    ordered = sorted(math.inf if math.isnan(end) else end for end in ends)
    count = len(ordered)
    places = (round(share * (count + 1)) - 1 for share in QUANTILES)
    values = [ordered[min(max(place, 0), count - 1)] for place in places]
    low, middle, high = (math.nan if math.isinf(end) else end for end in values)
    return low, middle, high


def late_orders(
    outcomes: Sequence[Outcome], known: Mapping[int, tuple[str, float]], end: float
) -> tuple[LateOrder, ...]:
    """Returns the known orders that are due before the end [s], and late in any run."""
    out = []
    for order_id, (reference, due) in known.items():
        if not 0 < due <= end:
            continue
        late = sum(outcome.over.get(order_id, math.inf) > due for outcome in outcomes)
        if late:
            out.append(LateOrder(order_id, reference, due, late / len(outcomes)))
    return tuple(sorted(out, key=lambda order: (-order.odds, order.due, order.order_id)))


def text_of(forecast: Forecast) -> str:
    """Returns the forecast in plain English."""
    low, middle, high = forecast.finish
    minutes = f"{forecast.minutes:g} minutes"
    if not forecast.known:
        first = "no order waits"
    elif math.isnan(middle):
        first = f"not all of the {forecast.known} orders of now are done within {minutes}"
    else:
        until = clock(high) if not math.isnan(high) else "later"
        first = f"all orders of now done at {clock(middle)} ({clock(low)} to {until})"
    done = forecast.bands["done"][:, -1]
    sentences = [
        first,
        f"{_range(done)} orders done within {minutes}",
        f"{_range(forecast.bands['open'][:, -1])} open then",
    ]
    likely = [order for order in forecast.late if order.odds >= LIKELY]
    if likely:
        named = ", ".join(order.reference for order in likely[:NAMED])
        more = f" and {len(likely) - NAMED} more" if len(likely) > NAMED else ""
        count = f"{len(likely)} order{'' if len(likely) == 1 else 's'}"
        sentences.append(f"{count} will likely be late: {named}{more}")
    else:
        sentences.append("no order of now will likely be late")
    return "; ".join(sentences)


def _range(values: Iterable[float]) -> str:
    low, middle, high = (round(value) for value in values)
    return f"{middle} ({low} to {high})"
