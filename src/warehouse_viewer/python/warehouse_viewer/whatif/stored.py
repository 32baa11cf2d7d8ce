# SPDX-License-Identifier: Apache-2.0
"""Runs as they lie in a folder: which belong to a scenario, and what became of the others."""

import contextlib
import functools
import json
import os
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from warehouse_operations.runs import run_files as runs
from warehouse_operations.runs import sweep
from warehouse_operations.runs.run_files import KPIS, Run, RunError
from warehouse_viewer.json_text import dumps

STATE = "state.json"  # what became of runs that left no figures
LARGE = ("traffic", "waiting", "floor", "throughput_s")  # of run.json, which only a report needs


class Planned(NamedTuple):
    """A planned run: its folder, and the configuration that decides its outcome."""

    seed: int
    folder: Path
    config: dict[str, Any]
    seconds: float


def planned(file: Path) -> tuple[Planned, ...]:
    """Returns the runs of a scenario's file. Raises SweepError and simulation.ERRORS."""
    plan = sweep.read(file)
    first = plan.jobs[0][0]
    config = json.loads(json.dumps(first.config))  # as it is read from run.json
    return tuple(Planned(job.seed, folder, config, job.seconds) for job, folder in plan.jobs)


def complete(planned_run: Planned) -> Run | None:
    """Returns the run of that configuration if it is complete, without its maps."""
    path = planned_run.folder / KPIS
    try:
        run = _read(path, path.stat().st_mtime_ns)
    except (OSError, RunError):
        return None
    return run if run.config == planned_run.config and run.seed == planned_run.seed else None


@functools.lru_cache(2000)
def _read(path: Path, _: int) -> Run:
    run = runs.read(path.parent)
    return replace(run, data={k: v for k, v in run.data.items() if k not in LARGE})


class States:
    """What became of a scenario's runs, by seed: {state, text, faults}, kept in its folder."""

    def __init__(self, folder: Path) -> None:
        self._path = folder / STATE

    def read(self) -> dict[str, dict[str, Any]]:
        """Returns what is known; nothing where the file is not there or damaged."""
        with contextlib.suppress(OSError, ValueError):
            states = json.loads(self._path.read_text("utf-8"))
            if isinstance(states, dict):
                return {key: value for key, value in states.items() if isinstance(value, dict)}
        return {}

    def put(self, seeds: list[int], state: str, **more: Any) -> None:
        """Notes the state of runs."""
        states = self.read() | {str(seed): {"state": state} | more for seed in seeds}
        beside = self._path.with_name(f".{STATE}.part")
        beside.write_text(dumps(states), "utf-8")
        os.replace(beside, self._path)

    def clear(self) -> None:
        """Forgets all."""
        self._path.unlink(missing_ok=True)
