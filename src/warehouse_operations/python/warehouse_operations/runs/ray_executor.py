# SPDX-License-Identifier: Apache-2.0
"""Runs a sweep's shifts on a Ray cluster, behind the interface of concurrent.futures."""

from collections.abc import Callable
from concurrent.futures import Executor, Future
from threading import Thread
from typing import Any

import ray


class RayExecutor(Executor):
    """Runs each call as a task of Ray; address: "local" starts a cluster on this machine."""

    def __init__(self, address: str = "local") -> None:
        options: dict[str, Any] = (
            {"include_dashboard": False} if address == "local" else {"address": address}
        )
        ray.init(log_to_driver=False, **options)
        self._threads: list[Thread] = []

    def submit(self, function: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Starts function(*args, **kwargs) on the cluster; returns the Future of its result."""
        future: Future[Any] = Future()
        future.set_running_or_notify_cancel()
        reference = ray.remote(function).remote(*args, **kwargs)
        thread = Thread(target=self._finish, args=(future, reference), daemon=True)
        thread.start()
        self._threads.append(thread)
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Waits until all calls have ended, even with wait=False, and leaves the cluster."""
        # A reference to a result that is dropped after ray.shutdown() ends the process.
        for thread in self._threads:
            thread.join()
        self._threads.clear()
        ray.shutdown()

    @staticmethod
    def _finish(future: Future[Any], reference: Any) -> None:
        try:
            future.set_result(ray.get(reference))
        except ray.exceptions.RayTaskError as error:
            future.set_exception(error.cause or error)
        except ray.exceptions.RayError as error:
            future.set_exception(error)
