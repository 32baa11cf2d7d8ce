# SPDX-License-Identifier: Apache-2.0
"""A simulated shift by which forecasts are judged: its forks, and what happened after them."""

import hashlib
import pickle
import tempfile
import time
import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from warehouse_operations.fleets import fleet_now
from warehouse_operations.forecast import ahead, fork
from warehouse_operations.forecast.fork import Fork
from warehouse_operations.runs.operations import Operations
from warehouse_operations.runs.simulation import Description, open_operations
from warehouse_operations.stock.site import Site

HORIZONS = (10, 30, 60)  # [min]
CLOSES_AT = 40  # [min]
SKUS = {"medium": 200, "large": 1000}
NEAR_BOUND = {"medium": 820, "large": 1900}  # orders an hour
DAY = {"medium": (500, 600, 900, 1300, 900, 500), "large": (1200, 1400, 2000, 2800, 2000, 1200)}
OF_RUNS = ("forecast", "fleets")  # rooms whose objects are those of a run
INTERVAL = 20  # [min] of each rate of DAY

Forked = tuple[Fork, dict[int, float], float]
Show = Callable[[str, float], None]  # (what is done, its part that is done)


class Case(NamedTuple):
    """What is simulated: a preset, one of three demands, a realism ("none": without), a station
    that closes ("": none does), and the seed."""

    size: str
    demand: str
    realism: str
    closes: str
    seed: int


@dataclass(frozen=True)
class JudgedShift:
    """A simulated shift. forks: by minute, with the due times of the orders then, and how long the
    fork took [s]. over: when each order was over [s]. rows: by minute, orders completed, open,
    late, pieces, and late orders that are over. past: series of its log. took: [s]."""

    site: Site
    forks: dict[int, Forked]
    over: dict[int, float]
    rows: dict[int, tuple[int, int, int, int, int]]
    past: dict[str, list[float]]
    took: float


def shift_of(case: Case, minutes: Sequence[int], folder: Path | None, show: Show) -> JudgedShift:
    """Returns a shift with forks at some minutes: from a folder, or simulated, and kept there."""
    path = folder / f"{'-'.join(map(str, case))}-{_version()}.shift" if folder else None
    if path and path.exists():
        kept: JudgedShift = pickle.loads(zlib.decompress(path.read_bytes()))
        if kept.forks.keys() >= set(minutes):
            return kept
    shift = simulated(case, minutes, show)
    if path:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(zlib.compress(pickle.dumps(shift, fork.PROTOCOL), 1))
    return shift


def _version() -> str:
    """Returns a digest of the code whose objects a kept shift has. Those of runs are not kept."""
    source, digest = Path(fork.__file__).parents[1], hashlib.blake2b(digest_size=4)
    files = [Path(fork.__file__), Path(fleet_now.__file__)]
    for room in sorted(source.iterdir()):
        files += sorted(room.glob("*.py")) if room.name not in OF_RUNS else []
    for path in files:
        digest.update(path.read_bytes())
    return digest.hexdigest()


def simulated(case: Case, minutes: Sequence[int], show: Show) -> JudgedShift:
    """Simulates a shift, until the last horizon after the last of its minutes is over."""
    physics = "" if case.realism == "none" else case.realism
    begin = time.monotonic()
    with tempfile.TemporaryDirectory() as made:
        orders = orders_of(case, Path(made))
        description = Description(case.size, orders=orders, seed=case.seed, realism=physics)
        with open_operations(description) as ops:
            forks, over, rows = _simulate(ops, case.closes, minutes, show)
            names = "completed", "pieces", "arrived"
            past = {name: list(ops.log.series[name]) for name in names}
            return JudgedShift(ops.site, forks, over, rows, past, time.monotonic() - begin)


def orders_of(case: Case, folder: Path) -> str:
    """Returns the orders text of a case; a file that it names is made in a folder."""
    if case.demand == "fill":
        return "fill"
    if case.demand == "poisson":
        return f"poisson:{NEAR_BOUND[case.size]}"
    file, count = folder / "day.demand.yaml", SKUS[case.size]
    day = {
        "demand": 1,
        "of": "forecast_bench",
        "interval_s": 60 * INTERVAL,
        "orders": [rate * INTERVAL / 60 for rate in DAY[case.size]],
        "lines": {1: 0.554, 2: 0.35, 3: 0.088, 4: 0.009},
        "pieces": {1: 0.95, 2: 0.05},
        "due": {"none": 0.0, "seconds": [900, 1800, 3600, 7200]},
        "skus": {f"sku-{i}": max(round(1000 * 0.99**i), 1) for i in range(1, count + 1)},
    }
    file.write_text(yaml.safe_dump(day), encoding="utf-8")
    return f"demand:{file}"


def _simulate(ops: Operations, closes: str, minutes: Sequence[int], show: Show) -> Any:
    """Returns the forks, when orders were over, and what was counted, as of a JudgedShift."""
    forks: dict[int, Forked] = {}
    over: dict[int, float] = {}
    rows: dict[int, tuple[int, int, int, int, int]] = {}
    ops.shift.on_order_event = lambda order, kind, *_: (
        over.setdefault(order.order_id, ops.time) if kind in ahead.OVER else None
    )
    end = max(minutes) + max(HORIZONS)
    for minute in range(1, end + 1):
        ops.step_until(60.0 * minute)
        if minute == CLOSES_AT and closes:
            ops.shift.set_station(closes, False, ops.shift.station(closes).mode)
        rows[minute] = _counted(ops)
        if minute in minutes:
            known = {order.order_id: order.due for order in ops.orders.values()}
            begin = time.monotonic()
            forked = fork.of_shift(ops.shift, fleet_now.of(ops.fleet))
            forks[minute] = forked, known, time.monotonic() - begin
        show("shift", minute / end)
    return forks, over, rows


def _counted(ops: Operations) -> tuple[int, int, int, int, int]:
    tally, now = ops.context.tally, ops.time
    overdue = sum(0 < order.due < now for order in ops.orders.values())
    late = tally.late_orders + overdue
    counted = tally.orders_completed, len(ops.orders), late, tally.items_picked
    return *counted, tally.late_orders
