# SPDX-License-Identifier: Apache-2.0
"""One simulation of the hub: its wish, its process and its state."""

import enum
import json
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

from warehouse_sim.hub import keeping
from warehouse_sim.hub.process import Process
from warehouse_sim.hub.wish import Wish
from warehouse_viewer.replay.file import NAME as RECORDING
from warehouse_viewer.server.hub_link import ask

TIMEOUT = 3.0  # for the pages of a simulation to answer [s, wall]
KEEPING = 300.0  # between two recordings, of which the last one outlives a crash [s, wall]


class State(enum.Enum):
    """The state of a simulation.

    STOPPED -> STARTING at start(); STARTING -> RUNNING <-> PAUSED by its pages; these three ->
    FAILED when its process ends by itself, or exceeds its memory; any -> STOPPED at stop().
    """

    STARTING = "STARTING"
    RUNNING = "RUNNING"
    PAUSED = "PAUSED"
    FAILED = "FAILED"
    STOPPED = "STOPPED"


class Simulation:
    """A simulation with its files in `folder`: simulation.json, log.txt, recordings, databases.

    Methods block; one thread at a time may call them, but row() and its fields any.
    """

    def __init__(self, wish: Wish, folder: Path) -> None:
        self.wish, self.folder = wish, folder
        self.state, self.reason = State.STOPPED, ""
        self.viewer = ""  # address of its pages; "" until these are served
        self.process: Process | None = None
        self.used = time.monotonic()  # time of the last request to its pages [s, wall]
        self._begun = self._kept = 0.0  # [s, wall]
        self._warehouse: dict[str, Any] = {}
        self._orders: dict[str, Any] = {}

    @property
    def lives(self) -> bool:
        """Whether its process runs."""
        return self.state in (State.STARTING, State.RUNNING, State.PAUSED)

    def row(self) -> dict[str, Any]:
        """Returns the simulation as the API lists it."""
        seen_now = self._warehouse if self.lives else {}
        return {
            "name": self.wish.name,
            "state": self.state.value,
            "arguments": self.wish.arguments | self._kind(),
            "world": seen_now.get("name") or self.wish.arguments.get("world", ""),
            "robots": seen_now.get("robots", 0),
            "storage_units": seen_now.get("storage_units", 0),
            "items": seen_now.get("items", 0),
            "rtf": seen_now.get("real_time_factor", 0.0),
            "orders": self._orders if self.lives else {},
            "uptime_s": round(time.monotonic() - self._begun, 1) if self.lives else 0.0,
            "url": f"/s/{self.wish.name}/",
            "reason": self.reason,
        }

    def _kind(self) -> dict[str, str]:
        kinds = {"operations.launch": "shift", "empty_world.launch": "empty"}
        return {kinds[self.wish.file]: "true"} if self.wish.file in kinds else {}

    def start(self, environment: dict[str, str]) -> None:
        """Starts its process. Raises OSError."""
        (self.folder / "simulation.json").write_text(json.dumps(self.wish.as_json(), indent=1))
        (self.folder / "log.txt").write_bytes(b"")
        self._warehouse, self._orders, self.viewer, self.reason = {}, {}, "", ""
        self.process = Process(self.wish, self.folder, environment)
        self._begun = self._kept = self.used = time.monotonic()
        self.state = State.STARTING

    def keep_recording(self) -> int:
        """Writes the last hour of its pages into a file of its folder; returns the size [bytes], 0
        where there is nothing yet.

        Raises OSError, ValueError.
        """
        if not self.viewer:
            raise OSError("its pages are not served")
        try:
            return keeping.keep(self.viewer, self.folder / RECORDING, {"name": self.wish.name})
        except keeping.ERRORS as error:
            raise OSError(f"its recording can't be kept: {error}") from error

    def stop(
        self, state: State = State.STOPPED, reason: str = "", keeps_recording: bool = True
    ) -> None:
        """Ends its process, cleanly if that is quick; its state becomes STOPPED or FAILED."""
        if self.viewer and keeps_recording:
            with suppress(OSError):
                self.keep_recording()
        if self.process:
            self.process.end()
        self.process, self.viewer = None, ""
        self.state, self.reason = state, reason

    def look(self, most_memory: int) -> None:
        """Updates its state; ends it above `most_memory` [bytes]."""
        if not self.lives or self.process is None:
            return
        if (code := self.process.exit_code()) is not None:
            reason = self.process.reason() or f"roslaunch ended with exit code {code}"
            self.stop(State.FAILED, reason)
        elif (memory := self.process.memory()) > most_memory:
            reason = f"it took {memory >> 20} MB; {most_memory >> 20} MB at most were expected"
            self.stop(State.FAILED, reason)
        else:
            self._look_at_pages(self.process)
            self._keep_now_and_then()

    def _keep_now_and_then(self) -> None:
        """Keeps a recording every KEEPING: the pages of a process that dies can't be asked."""
        if self.viewer and time.monotonic() - self._kept > KEEPING:
            self._kept = time.monotonic()
            with suppress(OSError):
                self.keep_recording()

    def _look_at_pages(self, process: Process) -> None:
        self.viewer = self.viewer or process.viewer()
        if not self.viewer:
            return
        with suppress(OSError, ValueError):
            self._warehouse = ask("GET", f"{self.viewer}/api/v1/warehouse", timeout=TIMEOUT)
            self.state = State.PAUSED if self._warehouse["paused"] else State.RUNNING
            self._orders = orders_of(self.viewer)


def orders_of(viewer: str) -> dict[str, Any]:
    """Returns how the orders of a shift stand, by the pages at `viewer`; {} without a shift."""
    try:
        kpis = ask("GET", f"{viewer}/api/v1/kpis", timeout=TIMEOUT)
        return {key: kpis[f"orders_{key}"] for key in ("waiting", "at_stations", "completed")}
    except (OSError, ValueError, KeyError):
        return {}
