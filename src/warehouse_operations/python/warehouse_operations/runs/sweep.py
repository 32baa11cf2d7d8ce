# SPDX-License-Identifier: Apache-2.0
"""A grid of configurations and seeds, each shift in a process of its own.

out: results                  # folder; beside the file
size: medium                  # or layout: FILE, or instance: FILE.xinst, settings: FILE.xsett
robots: 30                    # overrides the layout's or size's number; also stations
minutes: 60
physics: false
seeds: 10                     # 1 to 10, or a list
orders: fill                  # or day:FILE.csv, demand:FILE.demand.yaml, either with *1.3, …
policies: {storage: nearest}  # what all have
events: [{at: 600, close: pick1}]  # or a file; see event_file
grid:                         # each key is an axis
  policies.orders: [random, pile-on]
  policies.units: [nearest, most lines]
  orders: [fill, "poisson:300"]

Files are beside this one. Without a grid and with `out: .` the shifts are beside it, too, as
seed-1, seed-2, …
"""

import contextlib
import hashlib
import itertools
import json
import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, Executor, ProcessPoolExecutor, wait
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

from warehouse_layout.generate import layout_choice
from warehouse_operations.policies import ROLES
from warehouse_operations.runs import early_check, event_file
from warehouse_operations.runs import run_files as runs
from warehouse_operations.runs.event_file import Event, EventError
from warehouse_operations.runs.simulation import (
    ERRORS,
    MOST_SEED,
    Description,
    WriteReport,
    simulate,
    with_settings,
)
from warehouse_operations.stock import orders_text
from warehouse_operations.stock.lined_yaml import LinedYaml, Place
from warehouse_operations.stock.order_file import DemandError
from warehouse_operations.stock.yaml_file import read_yaml
from warehouse_operations.store.locks import FileLock, InUseError

KINDS: dict[str, tuple[Any, str]] = {
    "out": (str, "the name of a folder"),
    "size": (str, "the name of a preset"),
    "layout": (str, "a file"),
    "instance": (str, "a file"),
    "settings": (str, "a file"),
    "robots": (int, "a whole number above 0"),
    "stations": (int, "a whole number above 0"),
    "minutes": ((int, float), "a number above 0"),
    "physics": (bool, "true or false"),
    "realism": (str, "ideal, typical, bad_day or a file"),
    "orders": (str, orders_text.EXPECTED),
    "policies": ((dict, type(None)), "roles with a policy each"),
    "events": ((list, str), "a list of events, or the name of a file with them"),
}
KEYS = {*KINDS, "seeds"}
MOST_SEEDS, MOST_MINUTES = 10_000, 1e7


class SweepError(Exception):
    """Raised for an invalid sweep; names file and key, and what was expected."""


@dataclass(frozen=True)
class Sweep:
    """The shifts of a sweep and the folder of each."""

    folder: Path
    jobs: tuple[tuple[Description, Path], ...]

    def done(self) -> tuple[list[runs.Run], list[tuple[Description, Path]]]:
        """Returns the complete Runs of this sweep, and the remaining jobs."""
        complete, left = [], []
        for description, folder in self.jobs:
            try:
                run = runs.read(folder)
            except runs.RunError:
                run = None
            if run and run.config == description.config and run.seed == description.seed:
                complete.append(run)
            else:
                left.append((description, folder))
        return complete, left


def read(path: str | Path) -> Sweep:
    """Reads a sweep from a YAML file; raises SweepError."""
    path = Path(path)
    data = read_yaml(path, SweepError)
    if not isinstance(data, dict):
        raise SweepError(f"{path}: keys with values were expected")
    for key in data:
        if key not in KEYS | {"grid"}:
            raise SweepError(f"{path}: '{key}' is unknown; {', '.join(sorted(KEYS))} or grid")
        _check(path, key, data[key])
    folder = path.parent / data.get("out", path.stem)
    jobs = []
    for point in _points(path, data.get("grid") or {}):
        description = _description(path, data, point)
        words = [f"{key.rpartition('.')[2]}={_word(value)}" for key, value in point.items()]
        name = re.sub(r"[^\w=.,-]+", "-", ",".join(words)) or _only(data)
        for seed in _seeds(path, data.get("seeds", 1)):
            jobs.append((replace(description, seed=seed), folder / name / f"seed-{seed}"))
    return Sweep(folder, tuple(jobs))


def run_all(
    sweep: Sweep,
    processes: int | None = None,
    executor: Executor | None = None,
    on_done: Callable[[int, int], object] | None = None,
    write_report: WriteReport | None = None,
) -> tuple[list[runs.Run], list[str]]:
    """Runs the remaining jobs; returns all Runs and sentences about those that failed.

    executor: a concurrent.futures Executor, else processes on this machine. on_done(done, all) is
    called after each. write_report: a function of a module, see simulate.
    """
    with _alone(sweep.folder):
        pool = executor or ProcessPoolExecutor(processes)
        return _run_all(sweep, pool, on_done, write_report)


@contextlib.contextmanager
def _alone(folder: Path) -> Iterator[None]:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with FileLock(folder):
            yield
    except InUseError as error:
        raise SweepError(str(error)) from error


def _run_all(
    sweep: Sweep,
    executor: Executor,
    on_done: Callable[[int, int], object] | None,
    write_report: WriteReport | None,
) -> tuple[list[runs.Run], list[str]]:
    complete, left = sweep.done()
    failures = []
    with executor as pool:
        pending = {pool.submit(_one, *job, write_report): job for job in left}
        while pending:
            finished, _ = wait(pending, return_when=FIRST_COMPLETED)
            for future in finished:
                _, folder = pending.pop(future)
                try:
                    faults = future.result()
                    failures += [f"{folder}: {fault}" for fault in faults]
                    complete.append(runs.read(folder))
                except ERRORS as error:
                    failures.append(f"{folder}: {error}")
                if on_done:
                    on_done(len(sweep.jobs) - len(pending), len(sweep.jobs))
    order = {folder: i for i, (_, folder) in enumerate(sweep.jobs)}
    return sorted(complete, key=lambda run: order[run.folder]), failures


def _one(description: Description, folder: Path, write_report: WriteReport | None) -> list[str]:
    _, faults = simulate(description, folder, write_report=write_report)
    return faults


def _check(path: Path, key: str, value: Any) -> None:
    kind, expected = KINDS.get(key, (object, ""))
    is_other = isinstance(value, bool) and kind is not bool and kind is not object
    if (
        is_other
        or not isinstance(value, kind)
        or (key == "minutes" and not 0 < value < MOST_MINUTES)
        or (key in ("robots", "stations") and value < 1)
    ):
        raise SweepError(f"{path}: {key} is {value!r}; {expected} was expected")


def _points(path: Path, grid: Any) -> Iterator[dict[str, Any]]:
    if not isinstance(grid, dict) or not all(isinstance(v, list) and v for v in grid.values()):
        raise SweepError(f"{path}: grid: a list of values for each key was expected")
    for key, values in zip(map(str, grid), grid.values()):
        for value in values:
            _check(path, key, value)
        role = key.removeprefix("policies.")
        known = key in KEYS - {"out", "seeds", "policies"} or (role != key and role in ROLES)
        if not known:
            raise SweepError(f"{path}: grid: '{key}' can't be varied; policies.orders, for example")
    for values in itertools.product(*grid.values()):
        yield dict(zip(grid, values))


def _only(data: dict[str, Any]) -> str:
    """Returns the folder of the only configuration."""
    return "" if data.get("out") == "." else "all"


def _beside(path: Path, name: str) -> str:
    """Returns the absolute path of a file that a sweep names."""
    return os.path.abspath(path.parent / name)


def _orders_beside(path: Path, orders: str) -> str:
    """Returns an orders text with its file, if it names one that is beside a sweep."""

    def beside(file: str) -> str:
        return _beside(path, file) if os.path.exists(_beside(path, file)) else file

    try:
        return orders_text.with_file(orders, beside)
    except DemandError as error:
        raise SweepError(f"{path}: {error}") from error


def _events(path: Path, events: list[Any] | str, place: Place) -> tuple[Event, ...]:
    """Returns the events of a list at a place in a sweep, or of a file beside it. Raises
    EventError."""
    if isinstance(events, str):
        return event_file.read(_beside(path, events))
    if not events:
        return ()
    file = LinedYaml(path, EventError)
    return event_file.events_of(events, path.parent, file.fault, place, str(path), file.line)


def _description(path: Path, data: dict[str, Any], point: Mapping[str, Any]) -> Description:
    merged = data | {k: v for k, v in point.items() if not k.startswith("policies.")}
    policies = dict(data.get("policies") or {})
    for key, value in point.items():
        if key.startswith("policies."):
            policies[key.removeprefix("policies.")] = value
    known = {field.name for field in fields(Description)} - {"events"}
    options = {key: merged[key] for key in merged.keys() & known}
    for key in ("layout", "instance", "settings"):
        if options.get(key) and not (key == "layout" and layout_choice.is_preset(options[key])):
            options[key] = _beside(path, options[key])
    if "orders" in options:
        options["orders"] = _orders_beside(path, options["orders"])
    sites = [key for key in ("size", "layout", "instance") if key in options]
    if len(sites) > 1:
        raise SweepError(f"{path}: {' and '.join(sites)}: only one of them was expected")
    try:
        options |= {"seconds": 60 * float(merged.get("minutes", 60)), "policies": policies}
        events: list[Any] | str = merged.get("events", [])
        place: Place = ("events",)
        if "events" in point:
            place = ("grid", "events", data["grid"]["events"].index(events))
        options["events"] = _events(path, events, place)
        description = with_settings(Description(**options))
        description.config  # noqa: B018 - policies that don't exist are refused before anything runs
        early_check.check(description)
        return description
    except EventError as error:
        raise SweepError(str(error)) from error
    except (TypeError, ValueError, *ERRORS) as error:
        raise SweepError(f"{path}: {error}") from error


def _seeds(path: Path, seeds: Any) -> Iterable[int]:
    counted = isinstance(seeds, int) and 0 < seeds <= MOST_SEEDS
    result = range(1, seeds + 1) if counted else seeds
    if not isinstance(result, (list, range)) or not all(map(_is_seed, result)) or not result:
        raise SweepError(
            f"{path}: seeds is {seeds!r}; how many, 1 to {MOST_SEEDS}, or a list of whole numbers "
            f"from 0 to {MOST_SEED} was expected"
        )
    return list(result)


def _is_seed(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= MOST_SEED


def _word(value: Any) -> str:
    if isinstance(value, list):  # of events
        text = json.dumps(value, sort_keys=True, default=str).encode()
        return hashlib.blake2b(text, digest_size=4).hexdigest() if value else "none"
    return value.get("name", "") if isinstance(value, dict) else str(value)
