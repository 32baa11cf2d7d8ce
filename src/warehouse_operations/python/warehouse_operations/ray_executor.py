# SPDX-License-Identifier: Apache-2.0
"""Runs a sweep's shifts on a Ray cluster, behind the interface of concurrent.futures."""

from concurrent.futures import Executor, Future
from threading import Thread

import ray


class RayExecutor(Executor):
    """A task of Ray for each call; address: "local" starts a cluster on this machine."""

    def __init__(self, address="local"):
        options = {"include_dashboard": False} if address == "local" else {"address": address}
        ray.init(log_to_driver=False, **options)
        self._threads = []

    def submit(self, function, /, *args, **kwargs):
        future = Future()
        future.set_running_or_notify_cancel()
        reference = ray.remote(function).remote(*args, **kwargs)
        thread = Thread(target=self._finish, args=(future, reference), daemon=True)
        thread.start()
        self._threads.append(thread)
        return future

    def shutdown(self, wait=True, *, cancel_futures=False):
        # A reference to a result that is dropped after ray.shutdown() ends the process.
        for thread in self._threads:
            thread.join()
        self._threads.clear()
        ray.shutdown()

    @staticmethod
    def _finish(future, reference):
        try:
            future.set_result(ray.get(reference))
        except ray.exceptions.RayTaskError as error:
            future.set_exception(error.cause or error)
        except ray.exceptions.RayError as error:
            future.set_exception(error)
