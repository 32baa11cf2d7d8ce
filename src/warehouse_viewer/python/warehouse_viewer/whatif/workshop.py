# SPDX-License-Identifier: Apache-2.0
"""Scenarios and their runs: what the page shows, and what it asks for."""

import contextlib
import functools
import shutil
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from warehouse_operations.design import packages
from warehouse_operations.runs import run_files as runs
from warehouse_operations.runs.run_files import KPIS, REPORT, Run
from warehouse_operations.runs.simulation import ERRORS
from warehouse_operations.runs.sweep import SweepError
from warehouse_operations.store.locks import FileLock, InUseError
from warehouse_viewer.whatif import figures, shown, stored
from warehouse_viewer.whatif.designs import Designs
from warehouse_viewer.whatif.estimate import Done, Pace
from warehouse_viewer.whatif.folder import Folder, check
from warehouse_viewer.whatif.queue import Active, Job, Outcome, Queue
from warehouse_viewer.whatif.scenario import FILE, LAYOUTS, Scenario, ScenarioError
from warehouse_viewer.whatif.stored import States

COMPARED = (2, 6)  # scenarios, least and most
WRONG = (*ERRORS, SweepError, OSError)

Json = dict[str, Any]


class Workshop:
    """Works in a folder, alone, from open() on. Any thread may call."""

    def __init__(self, path: Path, processes: int = 0, command: list[str] | None = None) -> None:
        self.folder = Folder(path.absolute())
        self._queue = Queue(self._ended, processes, command)
        self.designs = Designs(self.folder.path, self._queue)
        self._lock = threading.RLock()
        self._held: FileLock | None = None
        self._pace = Pace()

    def open(self) -> None:
        """Takes the folder, and makes it if need be. Raises ScenarioError, also where another
        program has it."""
        with self._lock:
            if self._held:
                return
            try:
                self.folder.path.mkdir(parents=True, exist_ok=True)
                self._held = FileLock(self.folder.path)
            except (InUseError, OSError) as error:
                raise ScenarioError(f"no scenarios can be kept: {error}") from error
            self._note_cut()

    def close(self) -> None:
        """Ends all runs, which can be run again later, and leaves the folder."""
        self._queue.close()
        with self._lock:
            if self._held:
                self._held.release()
                self._held = None

    def _note_cut(self) -> None:
        """Notes the runs that were under way or waited when the server ended."""
        for name in self.folder.names():
            states = States(self.folder.path / name)
            cut = [int(k) for k, v in states.read().items() if v.get("state") in ("waits", "runs")]
            if cut:
                states.put(cut, shown.CUT)
        self.designs.note_cut()

    # --- what is shown
    def about(self) -> Json:
        """Returns the choices."""
        return {
            "folder": str(self.folder.path.resolve()),
            "layouts": self.folder.layouts(),
            "orders": self.folder.orders(),
            "costs": self.folder.costs_file.is_file(),
            "processes": self._queue.processes,
            "lacks": packages.lack_of_optuna("whatif"),
        }

    def scenarios(self) -> Json:
        """Returns all scenarios with their runs, all searches, and how long the queue takes
        [s, wall]."""
        active = {process.job: process for process in self._queue.active()}
        waiting = set(self._queue.waiting())
        done: list[Done] = []
        each = [self._shown(name, active, waiting, done) for name in self.folder.names()]
        self._pace = Pace(done)
        designs = self.designs.all()
        busy = [row for row in (*each, *designs) if row["state"] in ("runs", "waits")]
        left = sum(row["left"] for row in busy)
        parallel = min(self._queue.processes, max(1, len(active) + len(waiting)))
        return {
            "scenarios": each,
            "designs": designs,
            "running": len(active),
            "waiting": len(waiting),
            "left": left / parallel,
        }

    def _shown(
        self, name: str, active: dict[Job, Active], waiting: set[Job], done: list[Done]
    ) -> Json:
        folder = self.folder.path / name
        out: Json = {"name": name, "state": "wrong", "left": 0.0, "runs": [], "summary": None}
        try:
            scenario = self.folder.read(name)
            plan = shown.planned(folder / FILE, self._version(name, scenario))
        except (ScenarioError, *WRONG) as error:
            return out | {"error": self._own(str(error))}
        site = shown.site(plan[0].config["site"], *self._counts(scenario))
        states = States(folder).read()
        each = []
        complete: list[Run] = []
        for planned in plan:
            run = stored.complete(planned)
            job = Job(name, planned.seed, folder / FILE)
            state = states.get(str(planned.seed), {})
            if run:
                complete.append(run)
                done.append(Done(run, state.get("took", 0.0)))
            each.append(shown.run(planned, run, active.get(job), job in waiting, state))
        missing = [planned for planned in each if planned["state"] != "done"]
        cost = self._pace.seconds(site["robots"], plan[0].seconds, scenario.physics)
        return out | {
            "settings": scenario.to_json(),
            "site": site,
            "runs": each,
            "state": shown.state(each),
            "left": sum(shown.left(planned, cost, self._pace.start) for planned in missing),
            "summary": figures.summary(complete) if complete else None,
        }

    def estimate(self, settings: object) -> Json:
        """Returns how long a scenario would take on this machine [s, wall]."""
        scenario = Scenario.of_json(settings)
        description = check(scenario, self.folder.path)
        robots, stations = self._counts(scenario)
        each = self._pace.seconds(robots, description.seconds, scenario.physics)
        rounds = -(-scenario.seeds // self._queue.processes)
        return {"seconds": rounds * each, "robots": robots, "stations": stations}

    def compare(self, names: Sequence[str]) -> Json:
        """Returns scenarios side by side. Raises ScenarioError where there is nothing to show."""
        least, most = COMPARED
        if not least <= len(set(names)) <= most or len(set(names)) != len(names):
            raise ScenarioError(f"{least} to {most} scenarios were expected")
        return figures.comparison(
            {name: self._runs(name) for name in names},
            {name: bill for name in names if (bill := self._bill(name))},
        )

    def _bill(self, name: str) -> "figures.BillOf | None":
        """Returns what a scenario costs by what it does; None where no costs are known."""
        costs = self.folder.costs()
        if not costs:
            return None
        scenario = self.folder.read(name)
        path = self.folder.path / LAYOUTS / scenario.layout
        layout = str(path) if path.is_file() else scenario.layout
        priced = shown.layout_costs(costs, layout, shown.changed(path))
        robots, stations = self._counts(scenario)
        return functools.partial(priced.bill, robots, stations)

    def report(self, names: Sequence[str]) -> str:
        """Returns the report about all runs of scenarios, one at least, HTML."""
        from warehouse_operations.reports import report

        if not names:
            raise ScenarioError("a scenario's name was expected")
        results = [runs.read(run.folder) for name in names for run in self._runs(name)]
        return report.page(results)

    def report_of(self, name: str, seed: int) -> str:
        """Returns the report that a run has written, HTML."""
        path = self.folder.of(name) / f"seed-{seed:d}" / REPORT
        try:
            return path.read_text("utf-8")
        except OSError as error:
            raise ScenarioError(f"{name}: there is no report of seed {seed}") from error

    def _runs(self, name: str) -> list[Run]:
        scenario = self.folder.read(name)
        plan = shown.planned(self.folder.of(name) / FILE, self._version(name, scenario))
        complete = [run for planned in plan if (run := stored.complete(planned))]
        if not complete:
            raise ScenarioError(f"no run of '{name}' has ended yet")
        return complete

    # --- queries
    def create(self, name: str, settings: object) -> Json:
        """Makes a scenario."""
        with self._lock:
            return {"name": self.folder.create(name, Scenario.of_json(settings))}

    def change(self, name: str, settings: object) -> Json:
        """Changes a scenario. Runs that are of another one now are removed."""
        self._check_quiet(name)
        with self._lock:
            scenario = Scenario.of_json(settings)
            self.folder.change(name, scenario)
            folder = self.folder.of(name)
            kept = {
                planned.folder.name
                for planned in shown.planned(folder / FILE, self._version(name, scenario))
                if stored.complete(planned)
            }
            for old in folder.glob("seed-*"):
                if old.name not in kept:
                    shutil.rmtree(old, ignore_errors=True)
        return {"name": name}

    def duplicate(self, name: str) -> Json:
        """Copies a scenario, without its runs."""
        with self._lock:
            return {"name": self.folder.duplicate(name)}

    def rename(self, name: str, to: str) -> Json:
        """Gives a scenario another name."""
        self._check_quiet(name)
        with self._lock:
            return {"name": self.folder.rename(name, to)}

    def delete(self, name: str) -> Json:
        """Deletes a scenario; its runs end."""
        self.folder.of(name)
        self._queue.cancel(name)
        with self._lock:
            self.folder.delete(name)
        return {"name": name}

    def run(self, name: str) -> Json:
        """Runs what a scenario lacks. Raises QueueError."""
        folder = self.folder.of(name)
        scenario = self.folder.read(name)
        check(scenario, self.folder.path)
        plan = shown.planned(folder / FILE, self._version(name, scenario))
        with self._lock:
            missing = [item.seed for item in plan if not stored.complete(item)]
            known = {job.seed for job in self._queue.waiting() if job.scenario == name}
            known |= {item.job.seed for item in self._queue.active() if item.job.scenario == name}
            fresh = [seed for seed in missing if seed not in known]
            self._queue.add([Job(name, seed, folder / FILE) for seed in fresh])
            States(folder).put(fresh, "waits")
        return {"runs": len(fresh)}

    def cancel(self, name: str) -> Json:
        """Cancels the waiting and running runs of a scenario; completed ones stay."""
        self.folder.of(name)
        self._queue.cancel(name)
        return {"name": name}

    def add_layout(self, name: str, text: str) -> Json:
        """Keeps a layout for scenarios."""
        with self._lock:
            return {"name": self.folder.add_layout(name, text)}

    def add_stock(self, name: str, text: str) -> Json:
        """Keeps the stock of a layout."""
        with self._lock:
            return {"name": self.folder.add_stock(name, text)}

    def add_orders(self, name: str, text: str) -> Json:
        """Keeps a file of orders for scenarios."""
        with self._lock:
            return {"name": self.folder.add_orders(name, text)}

    def set_costs(self, name: str, text: str) -> Json:
        """Keeps what things, people, floor and energy cost, for all scenarios. Raises
        PriceError."""
        with self._lock:
            self.folder.set_costs(name, text)
        return {"name": name}

    def drop_costs(self) -> Json:
        """Leaves costs out of comparisons again."""
        with self._lock:
            self.folder.costs_file.unlink(missing_ok=True)
        return {}

    def _check_quiet(self, name: str) -> None:
        self.folder.of(name)
        jobs = [*self._queue.waiting(), *(active.job for active in self._queue.active())]
        if any(job.scenario == name for job in jobs):
            raise ScenarioError(f"'{name}' runs; cancel that first")

    def _ended(self, job: Job, outcome: Outcome) -> None:
        """Notes how a run ended; what it leaves unfinished is removed."""
        if self.designs.owns(job):
            with self._lock, contextlib.suppress(OSError):
                self.designs.ended(job, outcome)
            return
        folder = job.file.parent
        with self._lock, contextlib.suppress(OSError):
            states = States(folder)
            if outcome.faults is not None:
                states.put([job.seed], "done", faults=outcome.faults, took=outcome.took)
                return
            below = folder / f"seed-{job.seed}"
            if not (below / KPIS).exists():
                shutil.rmtree(below, ignore_errors=True)
            text = self._own(outcome.text)
            states.put([job.seed], "failed" if text else "cancelled", text=text)

    def _own(self, text: str) -> str:
        """Returns a text with the names of files as they are within the folder."""
        return text.replace(f"{self.folder.path}/", "")

    # --- what is known of layouts
    def _version(self, name: str, scenario: Scenario) -> tuple[int, int]:
        """Returns what differs between two contents of a scenario's files."""
        layout = self.folder.path / LAYOUTS / scenario.layout
        return shown.changed(self.folder.path / name / FILE), shown.changed(layout)

    def _counts(self, scenario: Scenario) -> tuple[int, int]:
        """Returns how many robots and open picking stations a scenario has."""
        path = self.folder.path / LAYOUTS / scenario.layout
        robots, stations = shown.layout_counts(
            str(path) if path.is_file() else scenario.layout, shown.changed(path)
        )
        return scenario.robots or robots, scenario.stations or stations
