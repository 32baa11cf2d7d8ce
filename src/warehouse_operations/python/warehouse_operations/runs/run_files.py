# SPDX-License-Identifier: Apache-2.0
"""The files that a shift leaves in its folder: kpis.json, and run.json with data for the report.

run.json: config {site, orders, policies, physics, settings}, seed, intervals {seconds, picked,
stored, completed: a list each}, driven_m [metres in each of these], minutes {a list for each of
minute_log.SERIES, and late: orders that became late}, stations [{name, kind, cell
[x, y], busy_fraction, pieces, visits}], completed_s, turnover_s and throughput_s of each order,
robots {activity: seconds}, floor [a text a row], traffic and waiting (h, w) or null,
failures [{kind, count, repairs, mean_repair_s}],
lateness, date [when it was simulated], version.
"""

import itertools
import json
import os
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from warehouse_layout.file import user_file
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_operations.runs.version import version
from warehouse_operations.shift.tally import INTERVAL, Tally
from warehouse_operations.stock.orders import Order
from warehouse_operations.stock.stations import WorkStation

if TYPE_CHECKING:
    from warehouse_operations.runs.operations import Operations

KPIS, RUN, DATABASE, REPORT = "kpis.json", "run.json", "run.db", "report.html"
FOLDER = "shift"  # where nothing else is asked for


class RunError(Exception):
    """Raised for a folder without a complete run; says what is missing."""


@dataclass(frozen=True)
class Run:
    """A shift that is over, with the content of kpis.json and of run.json."""

    folder: Path
    kpis: dict[str, Any]
    data: dict[str, Any]

    @property
    def config(self) -> dict[str, Any]:
        """The configuration of the shift, without its seed."""
        return self.data["config"]

    @property
    def seed(self) -> int:
        """The seed of the shift."""
        return self.data["seed"]


def write(
    folder: str | os.PathLike[str], ops: "Operations", config: dict[str, Any], seed: int
) -> Run:
    """Writes both files of a shift; returns the Run."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    run = Run(folder, ops.kpis(), describe(ops, config, seed))
    # kpis.json is written last and atomically: a run with it is complete.
    (folder / RUN).write_text(json.dumps(run.data) + "\n", encoding="utf-8")
    unfinished = folder / f"{KPIS}.new"
    unfinished.write_text(json.dumps(run.kpis, indent=1) + "\n", encoding="utf-8")
    unfinished.replace(folder / KPIS)
    return run


def new_folder(parent: Path) -> Path:
    """Returns a folder in which there is no run: FOLDER, or FOLDER-2 and so on."""
    names = itertools.chain([FOLDER], (f"{FOLDER}-{number}" for number in itertools.count(2)))
    return next(folder for folder in map(parent.joinpath, names) if not _holds_run(folder))


def _holds_run(folder: Path) -> bool:
    return any((folder / name).exists() for name in (KPIS, RUN, DATABASE))


def read(folder: str | os.PathLike[str]) -> Run:
    """Returns the Run of a folder. Raises RunError."""
    content = []
    for name in (KPIS, RUN):
        path = Path(folder) / name
        try:
            content.append(json.loads(user_file.read_text(path)))
        except OSError as error:
            raise RunError(f"{path}: {error.strerror}") from error
        except ValueError as error:
            raise RunError(f"{path}: {error}; JSON was expected") from error
    try:
        return Run(Path(folder), *content)
    except (KeyError, TypeError) as error:
        raise RunError(f"{folder}: {error} is missing") from error


def describe(ops: "Operations", config: dict[str, Any], seed: int) -> dict[str, Any]:
    """Returns the content of run.json."""
    tally, plan = ops.context.tally, ops.site.plan
    now, began = ops.context.clock.now, ops.context.clock.began
    count = int(now // INTERVAL)
    log = getattr(ops.fleet, "failures", None)
    series = {
        "picked": tally.picked_in,
        "stored": tally.stored_in,
        "completed": tally.completed_in,
    }
    return {
        "config": config,
        "seed": seed,
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
        "version": version(),
        "intervals": {"seconds": INTERVAL}
        | {name: [values.get(i, 0) for i in range(count)] for name, values in series.items()},
        "stations": [_station(station, plan, now) for station in ops.stations],
        "driven_m": ops.log.series["metres"],
        "minutes": ops.log.series | {"late": _late(tally, ops.orders.values(), now, count)},
        "completed_s": [round(value - began, 1) for value in tally.completed_s],
        "turnover_s": [round(value, 1) for value in tally.turnover_s],
        "throughput_s": [round(value, 1) for value in tally.throughput_s],
        "robots": ops.fleet.activities(),
        "floor": floor_rows(plan),
        "traffic": _map(ops.fleet, "passages"),
        "waiting": _map(ops.fleet, "waiting_map"),
        "failures": log.by_kind() if log else [],
        "mishaps": dict(log.mishaps) if log else {},
        "robot_h": log.robot_s / 3600 if log else 0.0,
    }


def floor_rows(plan: FloorPlan) -> list[str]:
    """Returns a text for each row of cells, the lowest first.

    s is storage, p parking, l a lane, # where no robot drives, . any other street.
    """
    cells = np.full(plan.shape, ".")
    cells[plan.lane], cells[plan.parking], cells[plan.storage] = "l", "p", "s"
    cells[~plan.passable] = "#"
    return ["".join(row) for row in cells.tolist()]


def _late(tally: Tally, orders: Iterable[Order], now: float, count: int) -> list[int]:
    """Returns the number of orders that became late in each interval; `orders` are not over."""
    late = Counter(tally.late_in)
    late.update(int(order.due // INTERVAL) for order in orders if 0 < order.due < now)
    return [late[i] for i in range(count)]


def _station(station: WorkStation, plan: FloorPlan, now: float) -> dict[str, Any]:
    return {
        "name": station.name,
        "kind": station.kind,
        "cell": _cell(station.name, plan),
        "busy_fraction": station.busy_fraction(now),
        "pieces": station.pieces,
        "visits": station.visits,
    }


def _cell(name: str, plan: FloorPlan) -> list[int]:
    """Returns [x, y] of the cell in which units stand at a station."""
    place = next(station for station in plan.stations if station.name == name)
    return list(divmod(place.service_cell, plan.shape[1]))[::-1]


def _map(fleet: Any, name: str) -> list[list[float]] | None:
    values = getattr(fleet, name, None)
    return np.round(values(), 1).tolist() if values else None
