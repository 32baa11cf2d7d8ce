# SPDX-License-Identifier: Apache-2.0
"""Executors for shifts: processes on this machine, or a Ray cluster."""

import contextlib
import multiprocessing
import signal
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor


class ExecutorError(Exception):
    """Raised where an executor is unavailable; says why, and what to do."""


def make(processes: int | None = None, ray: str | None = None) -> Executor:
    """Returns an Executor: on the Ray cluster at an address, "local": one on this machine; else
    with a number of processes, None: one a core. Raises ExecutorError.
    """
    if not ray:
        return ProcessPoolExecutor(processes, initializer=_end_by_ctrl_c)
    try:
        from warehouse_operations.runs.ray_executor import RayExecutor
    except ImportError as error:
        raise ExecutorError(
            f"{error}; --ray needs packages: pip install ray 'pydantic>=2'"
        ) from error
    return RayExecutor(ray)


@contextlib.contextmanager
def running(executor: Executor) -> Iterator[Executor]:
    """Shuts an Executor down at the end; after Ctrl-C without waiting for its processes."""
    try:
        yield executor
    except BaseException:
        for process in multiprocessing.active_children():
            process.terminate()
        raise
    finally:
        executor.shutdown(cancel_futures=True)


def _end_by_ctrl_c() -> None:
    """Lets Ctrl-C end a process without a traceback."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
