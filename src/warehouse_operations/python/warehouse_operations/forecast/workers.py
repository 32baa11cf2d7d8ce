# SPDX-License-Identifier: Apache-2.0
"""Runs of a forecast in processes of low priority; a new forecast kills those of the last one."""

import contextlib
import itertools
import os
import pickle
import queue
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from typing import Any

from warehouse_operations.forecast.ahead import Outcome, Task
from warehouse_operations.forecast.worker import receive, send

MEMORY = 900_000_000  # of all processes of a forecast [bytes]
LEAST = 200_000_000  # of a process [bytes]
TRIES = 2  # of a run whose process is killed
FEWEST, MOST = 5, 1000  # runs, if their number is not given
BUDGET = 20.0  # time for them, if it is not given, either [s, wall]
GIVEN_UP = "the forecast was given up for a newer one"


class RunsError(Exception):
    """Raised where runs of a forecast can't be made; says why."""


class Runs:
    """Makes the runs of Tasks, each of all of them by the same numbers.

    count: runs of each task; 0: as many as fit into `budget` [s, wall], FEWEST at least. processes:
    at once; None: one a core, at most as many as have LEAST memory.
    """

    def __init__(
        self,
        tasks: Sequence[Task],
        count: int,
        *,
        processes: int | None = None,
        budget: float = BUDGET,
    ) -> None:
        self._content = pickle.dumps(list(tasks), 5)
        self._count, self._budget = count, budget
        most = min(processes or os.cpu_count() or 1, MEMORY // LEAST)
        self._processes = min(most, count * len(tasks)) if count else most
        self._jobs = self._numbers(len(tasks))
        self._lock = threading.Lock()
        self._answers: queue.Queue[tuple[int, Outcome] | str | None] = queue.Queue()
        self._running: set[subprocess.Popen[bytes]] = set()
        self._killed = self._given_up = False
        self._began = time.monotonic()

    def _numbers(self, tasks: int) -> Iterator[tuple[int, int]]:
        """Yields (index of the task, number of the run): all tasks of a number in a row."""
        for number in range(self._count) if self._count else itertools.count():
            late = time.monotonic() - self._began > self._budget
            if not self._count and (number >= MOST or (late and number >= FEWEST)):
                return
            for index in range(tasks):
                yield index, number

    def outcomes(self) -> Iterator[tuple[int, Outcome]]:
        """Yields (index of the task, Outcome) as the runs end. Raises RunsError."""
        threads = [
            threading.Thread(target=self._work, name="forecast", daemon=True)
            for _ in range(self._processes)
        ]
        for thread in threads:
            thread.start()
        working = len(threads)
        try:
            while working:
                answer = self._answers.get()
                if answer is None:
                    working -= 1
                elif isinstance(answer, str):
                    raise RunsError(answer)
                else:
                    yield answer
        finally:
            self.kill()
        if self._given_up:
            raise RunsError(GIVEN_UP)

    def give_up(self) -> None:
        """Kills all processes at once; outcomes() raises RunsError."""
        self._given_up = True
        self.kill()

    def kill(self) -> None:
        """Kills all processes."""
        with self._lock:
            self._killed = True
            for process in self._running:
                process.kill()

    def _work(self) -> None:
        """Has runs made by a process, which another one replaces if it is killed."""
        process: subprocess.Popen[bytes] | None = None
        try:
            while (job := self._next()) is not None:
                answer: Any = None
                for _ in range(TRIES):
                    try:
                        process = process or self._start()
                        answer = self._ask(process, job)
                        break
                    except (OSError, EOFError, pickle.UnpicklingError):
                        if process:
                            self._end(process)
                        process = None
                self._answers.put(self._judged(job, answer))
        finally:
            if process:
                self._end(process)
            self._answers.put(None)

    def _next(self) -> tuple[int, int] | None:
        with self._lock:
            return None if self._killed else next(self._jobs, None)

    def _judged(self, job: tuple[int, int], answer: Any) -> tuple[int, Outcome] | str:
        """Returns the Outcome of a run with the index of its task, or the reason why there is
        none."""
        index, number = job
        if isinstance(answer, Outcome):
            return index, answer
        if self._killed:
            return GIVEN_UP
        if answer is None:
            lost = f"its process was killed {TRIES} times, by hand or for lack of memory"
            return f"run {number + 1} has no result: {lost}"
        return f"run {number + 1} failed: {answer}"

    def _start(self) -> "subprocess.Popen[bytes]":
        memory = MEMORY // self._processes
        environment = os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
        with self._lock:
            if self._killed:
                raise EOFError
            process = subprocess.Popen(
                [sys.executable, "-m", "warehouse_operations.forecast.worker", str(memory)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                env=environment,
            )
            self._running.add(process)
        assert process.stdin
        send(process.stdin, self._content)
        return process

    def _ask(self, process: "subprocess.Popen[bytes]", job: tuple[int, int]) -> Any:
        assert process.stdin and process.stdout
        send(process.stdin, job)
        return receive(process.stdout)

    def _end(self, process: "subprocess.Popen[bytes]") -> None:
        process.kill()
        for stream in (process.stdin, process.stdout):
            with contextlib.suppress(OSError):
                if stream:
                    stream.close()
        process.wait()
        with self._lock:
            self._running.discard(process)
