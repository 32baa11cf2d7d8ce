# SPDX-License-Identifier: Apache-2.0
"""Starts a shift in a running warehouse, when a client asks for it."""

import signal
import subprocess
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from types import ModuleType
from typing import Any

from std_srvs.srv import TriggerRequest, TriggerResponse

from warehouse_client.message_check import subscribe
from warehouse_client.services import is_offered
from warehouse_msgs.msg import Notices

PATIENCE = 60.0  # for the shift to take orders [s, wall]
PERIOD = 0.1  # between two looks [s, wall]
FAREWELL = 2.5  # for its nodes to end [s, wall]
COORDINATOR, SHIFT = "warehouse/transport", "warehouse/find_orders"  # services that show who runs


class ShiftStart:
    """A roslaunch of shift.launch, which ends with this process; its orders and stock are kept for
    as long. `ros` is rospy; seed: as the warehouse's.
    """

    def __init__(self, ros: ModuleType, seed: int) -> None:
        self._ros, self._seed = ros, seed
        self._lock = threading.Lock()
        self._launch: subprocess.Popen[bytes] | None = None
        self._folder = tempfile.TemporaryDirectory(prefix="shift-", ignore_cleanup_errors=True)
        # The kernel takes the end of the thread that began a process for that of its parent.
        self._beginner = ThreadPoolExecutor(1)
        self._fault = ""
        ros.on_shutdown(self.end)

    def handle(self, request: TriggerRequest) -> TriggerResponse:
        """Answers once the shift takes orders, or with the reason why it does not."""
        if not self._lock.acquire(blocking=False):
            return TriggerResponse(False, "a shift is being started")
        try:
            fault = self._start()
        except OSError as error:
            fault = str(error)
        finally:
            self._lock.release()
        return TriggerResponse(not fault, fault or "a shift runs: orders come in")

    def _start(self) -> str:
        """Starts the shift; returns why it can't, or ""."""
        if is_offered(self._ros, SHIFT):
            return "a shift runs already"
        self.end()
        self._fault = ""
        notices = subscribe(self._ros, "warehouse/notices", Notices, self._on_notices)
        try:
            has_coordinator = is_offered(self._ros, COORDINATOR)
            self._launch = self._beginner.submit(self._begin, has_coordinator).result()
            fault = self._wait(self._launch)
        finally:
            notices.unregister()
        if fault:
            self.end()
        return fault

    def _begin(self, has_coordinator: bool) -> "subprocess.Popen[bytes]":
        # A shift of before may have been of another warehouse.
        database = Path(self._folder.name, f"{time.time_ns()}.db")
        arguments = {
            "coordinator": str(not has_coordinator).lower(),
            "database": str(database),
            "seed": str(self._seed),
            "checked": "true",
            "__ns": self._ros.get_namespace(),
        }
        words = [f"{name}:={text}" for name, text in arguments.items()]
        options = ["--sigint-timeout=2", "--sigterm-timeout=0.5"]
        return subprocess.Popen(
            ["setpriv", "--pdeathsig", "TERM", "roslaunch", *options]
            + ["warehouse_sim", "shift.launch", *words],
            stdin=subprocess.DEVNULL,
            start_new_session=True,  # Ctrl-C is for the launch of the warehouse, which ends this
        )

    def _on_notices(self, message: Notices) -> None:
        # The last notice of a shift that ends tells why.
        self._fault = next((text for text in message.notices if text.startswith("no shift")), "")

    def _wait(self, launch: "subprocess.Popen[bytes]") -> str:
        """Waits until the shift takes orders; returns why it does not, or ""."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            if self._fault:
                return self._fault
            if launch.poll() is not None:
                return "the shift ended at once; its launch says why"
            if is_offered(self._ros, SHIFT):
                return ""
            time.sleep(PERIOD)
        return f"the shift takes no orders after {PATIENCE:g} s; its launch says why"

    def end(self, *_: Any) -> None:
        """Ends the shift that was started, if one was."""
        launch, self._launch = self._launch, None
        if launch is None:
            return
        launch.send_signal(signal.SIGINT)
        with suppress(subprocess.TimeoutExpired):
            launch.wait(FAREWELL)
