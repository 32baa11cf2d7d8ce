# SPDX-License-Identifier: Apache-2.0
"""Runs that wait for a processor, and those that are under way, each in a process of its own."""

import contextlib
import json
import os
import subprocess
import sys
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

COMMAND = [sys.executable, "-m", "warehouse_viewer.whatif.run"]
MOST_WAITING = 500
PATIENCE = 5.0  # between the request that a process end and its kill [s, wall]
KEPT = 12  # lines of what a run said, for the case that it fails


class QueueError(ValueError):
    """Says why no run is taken."""


class Job(NamedTuple):
    """A run: the name of its scenario, and its file."""

    scenario: str
    seed: int
    file: Path


@dataclass
class Outcome:
    """How a run ended: done with `faults`, or failed with a `text`; cancelled: neither. took: by
    its whole process [s, wall]."""

    faults: list[str] | None = None
    text: str = ""
    took: float = 0.0


@dataclass
class Active:
    """A run that is under way. progress: the last line that it wrote."""

    job: Job
    process: subprocess.Popen[str] | None = None
    began: float = field(default_factory=time.monotonic)
    progress: dict[str, Any] = field(default_factory=dict)
    is_cancelled: bool = False

    def end(self) -> None:
        """Asks the process to end."""
        self.is_cancelled = True
        if self.process:
            self.process.terminate()


OnEnd = Callable[[Job, Outcome], object]


def processors() -> int:
    """Returns the count of runs at a time: one processor is left to all else."""
    return max(1, len(os.sched_getaffinity(0)) - 1)


class Queue:
    """Takes runs in their order. on_end(job, outcome) is called, in a thread, after each."""

    def __init__(self, on_end: OnEnd, processes: int = 0, command: list[str] | None = None) -> None:
        self.processes = processes or processors()
        self._on_end, self._command = on_end, command or COMMAND
        self._waiting: deque[Job] = deque()
        self._active: list[Active] = []
        self._changed = threading.Condition()
        self._threads: list[threading.Thread] = []
        self._is_closed = False

    def add(self, jobs: list[Job]) -> None:
        """Adds runs that are not there already. Raises QueueError where there are too many."""
        with self._changed:
            known = {*self._waiting, *(active.job for active in self._active)}
            fresh = [job for job in jobs if job not in known]
            if self._is_closed or len(self._waiting) + len(fresh) > MOST_WAITING:
                raise QueueError(f"{MOST_WAITING} runs wait at most; let some end first")
            self._waiting.extend(fresh)
            self._start_threads()
            self._changed.notify_all()

    def cancel(self, scenario: str) -> None:
        """Takes the runs of a scenario out of the queue, and waits until those that run end."""
        with self._changed:
            taken = [job for job in self._waiting if job.scenario == scenario]
            self._waiting = deque(job for job in self._waiting if job.scenario != scenario)
            for active in self._active:
                if active.job.scenario == scenario:
                    active.end()
        for job in taken:
            self._on_end(job, Outcome())
        with self._changed:
            self._changed.wait_for(lambda: not self._runs(scenario), PATIENCE)

    def _runs(self, scenario: str) -> bool:
        return any(active.job.scenario == scenario for active in self._active)

    def waiting(self) -> list[Job]:
        """Returns the runs that wait."""
        with self._changed:
            return list(self._waiting)

    def active(self) -> list[Active]:
        """Returns the runs that are under way."""
        with self._changed:
            return list(self._active)

    def close(self) -> None:
        """Ends all processes and waits for them. Their runs are marked as interrupted."""
        with self._changed:
            self._is_closed = True
            self._waiting.clear()
            for active in self._active:
                active.end()
            self._changed.notify_all()
        for thread in self._threads:
            thread.join(PATIENCE)

    def _start_threads(self) -> None:
        while len(self._threads) < min(self.processes, len(self._waiting) + len(self._active)):
            thread = threading.Thread(target=self._work, daemon=True)
            self._threads.append(thread)
            thread.start()

    def _work(self) -> None:
        while active := self._next():
            outcome = self._run(active)
            if not self._is_closed:
                self._on_end(active.job, Outcome() if active.is_cancelled else outcome)
            with self._changed:
                self._active.remove(active)
                self._changed.notify_all()

    def _next(self) -> Active | None:
        with self._changed:
            self._changed.wait_for(lambda: self._waiting or self._is_closed)
            if self._is_closed:
                return None
            active = Active(self._waiting.popleft())
            self._active.append(active)
            return active

    def _run(self, active: Active) -> Outcome:
        command = [*self._command, str(active.job.file), str(active.job.seed)]
        try:
            process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                errors="replace",
                start_new_session=True,
            )
        except OSError as error:
            return Outcome(text=f"the run could not start: {error.strerror}")
        with self._changed:
            active.process = process
            if active.is_cancelled:
                process.terminate()
        return _followed(active, process)


def _followed(active: Active, process: "subprocess.Popen[str]") -> Outcome:
    """Reads the lines of a process until it ends."""
    said: deque[str] = deque(maxlen=KEPT)
    last: dict[str, Any] = {}
    assert process.stdout and process.stdin
    with process.stdout:
        for line in process.stdout:
            news = _parsed(line)
            if news is None:
                said.append(line.rstrip())
            elif "of" in news:
                active.progress = news
            else:
                last = news
    with contextlib.suppress(OSError):
        process.stdin.close()
    code = _waited(process)
    if "done" in last:
        return Outcome(faults=last["done"], took=time.monotonic() - active.began)
    return Outcome(text=last.get("error") or f"the run ended early ({_ended(code)}){_tail(said)}")


def _parsed(line: str) -> dict[str, Any] | None:
    """Returns the object of a line of JSON; None for other lines."""
    try:
        news = json.loads(line) if line.startswith("{") else None
    except ValueError:
        return None
    return news if isinstance(news, dict) else None


def _waited(process: "subprocess.Popen[str]") -> int:
    try:
        return process.wait(PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        return process.wait()


def _ended(code: int) -> str:
    return f"signal {-code}" if code < 0 else f"exit code {code}"


def _tail(said: "deque[str]") -> str:
    return ": " + "\n".join(said) if said else ""
