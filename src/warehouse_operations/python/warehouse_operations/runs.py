# SPDX-License-Identifier: Apache-2.0
"""What a shift leaves in its folder: kpis.json, and run.json with what the report draws.

run.json: config {site, orders, policies, physics, settings}, seed, intervals {seconds, picked,
stored, completed: a list each}, stations [{name, kind, busy_fraction, pieces, visits}], turnover_s
and throughput_s of each order, robots {activity: seconds}, traffic and waiting (h, w) or null,
failures [{kind, count, repairs, mean_repair_s}],
lateness.
"""

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from warehouse_operations.kpis import INTERVAL

KPIS, RUN, DATABASE, REPORT = "kpis.json", "run.json", "run.db", "report.html"


class RunError(Exception):
    """A folder that holds no run; the text says what is missing."""


@dataclass(frozen=True)
class Run:
    """One shift that is over."""

    folder: Path
    kpis: dict
    data: dict

    @property
    def config(self):
        return self.data["config"]

    @property
    def seed(self):
        return self.data["seed"]


def write(folder, ops, config, seed):
    """Writes both files of an Operations; returns the Run."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    run = Run(folder, ops.kpis(), describe(ops, config, seed))
    # kpis.json comes last and at once: where it is, the run is complete.
    (folder / RUN).write_text(json.dumps(run.data) + "\n", encoding="utf-8")
    unfinished = folder / f"{KPIS}.new"
    unfinished.write_text(json.dumps(run.kpis, indent=1) + "\n", encoding="utf-8")
    unfinished.replace(folder / KPIS)
    return run


def read(folder):
    """The Run of a folder; raises RunError."""
    content = []
    for name in (KPIS, RUN):
        path = Path(folder) / name
        try:
            content.append(json.loads(path.read_text(encoding="utf-8")))
        except OSError as error:
            raise RunError(f"{path}: {error.strerror}") from error
        except ValueError as error:
            raise RunError(f"{path}: {error}; JSON was expected") from error
    try:
        return Run(Path(folder), *content)
    except (KeyError, TypeError) as error:
        raise RunError(f"{folder}: {error} is missing") from error


def describe(ops, config, seed):
    """What run.json holds."""
    shift, tally = ops.shift, ops.shift.tally
    count = int(shift.now // INTERVAL)
    log = getattr(ops.fleet, "failures", None)
    series = {
        "picked": tally.picked_in,
        "stored": tally.stored_in,
        "completed": tally.completed_in,
    }
    return {
        "config": config,
        "seed": seed,
        "intervals": {"seconds": INTERVAL}
        | {name: [values.get(i, 0) for i in range(count)] for name, values in series.items()},
        "stations": [_station(station, shift) for station in shift.stations],
        "turnover_s": [round(value, 1) for value in tally.turnover_s],
        "throughput_s": [round(value, 1) for value in tally.throughput_s],
        "robots": ops.fleet.activities(),
        "traffic": _map(ops.fleet, "passages"),
        "waiting": _map(ops.fleet, "waiting_map"),
        "failures": log.by_kind() if log else [],
        "mishaps": dict(log.mishaps) if log else {},
        "robot_h": log.robot_s / 3600 if log else 0.0,
    }


def _station(station, shift):
    return {
        "name": station.name,
        "kind": station.kind,
        "busy_fraction": station.busy_s / shift.now if shift.now else 0.0,
        "pieces": station.pieces,
        "visits": station.visits,
    }


def _map(fleet, name):
    values = getattr(fleet, name, None)
    return np.round(values(), 1).tolist() if values else None
