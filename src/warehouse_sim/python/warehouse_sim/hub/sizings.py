# SPDX-License-Identifier: Apache-2.0
"""The sizings of a hub: how many robots and stations a warehouse needs."""

import shutil
import threading
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from warehouse_sim.hub import sizing
from warehouse_sim.hub.simulations import Conflict, Missing
from warehouse_sim.hub.sizing import FILE, REPORT, Sizing

MOST_KEPT = 50  # the oldest are deleted


class Sizings:
    """Sizings by number, in a folder that is made with the first of them. One runs at a time; any
    thread may call."""

    def __init__(self, folder: Path, environment: Mapping[str, str]) -> None:
        self._folder, self._environment = folder, dict(environment)
        self._lock = threading.RLock()
        self._all: dict[int, Sizing] = {}
        for file in folder.glob(f"*/{FILE}"):
            with suppress(OSError, ValueError):
                self._all[int(file.parent.name)] = Sizing.kept(file.parent)

    def rows(self) -> list[dict[str, Any]]:
        """Returns all sizings as the API lists them, the newest first."""
        with self._lock:
            return [self._all[number].row() for number in sorted(self._all, reverse=True)]

    def row(self, number: str) -> dict[str, Any]:
        """Returns a sizing. Raises Missing."""
        with self._lock:
            return self._of(number).row()

    def report(self, number: str) -> str:
        """Returns the report of a sizing that is over, HTML. Raises Missing."""
        with self._lock:
            folder = self._of(number).folder
        try:
            return (folder / REPORT).read_text(encoding="utf-8")
        except OSError:
            raise Missing(f"sizing {number} has no report yet") from None

    def start(self, body: Mapping[str, Any]) -> dict[str, Any]:
        """Starts a sizing. Raises WishError, Conflict while another one runs, OSError."""
        with self._lock:
            for number, known in self._all.items():
                if known.lives:
                    raise Conflict(f"sizing {number} runs; wait for it, or end it by DELETE")
            number = max(self._all, default=0) + 1
            folder = self._folder / str(number)
            folder.mkdir(parents=True)
            try:
                started = Sizing(folder, sizing.read(body, folder))
                started.start(self._environment)
            except BaseException:
                shutil.rmtree(folder, ignore_errors=True)
                raise
            self._all[number] = started
            for old in sorted(self._all)[:-MOST_KEPT]:
                self._delete(old)
            return started.row()

    def delete(self, number: str) -> dict[str, Any]:
        """Ends a sizing if it runs, and deletes what it wrote. Raises Missing."""
        with self._lock:
            sizing_of = self._of(number)
            sizing_of.end()
            row = sizing_of.row()
            self._delete(int(number))
            return row

    def _delete(self, number: int) -> None:
        shutil.rmtree(self._all.pop(number).folder, ignore_errors=True)

    def _of(self, number: str) -> Sizing:
        if number.isascii() and number.isdigit() and len(number) < 10:
            with suppress(KeyError):
                return self._all[int(number)]
        raise Missing(f"there is no sizing '{number[:40]}'")

    def close(self) -> None:
        """Ends what runs."""
        with self._lock:
            for known in self._all.values():
                known.end()
