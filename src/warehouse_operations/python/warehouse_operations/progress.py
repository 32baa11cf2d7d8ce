# SPDX-License-Identifier: Apache-2.0
"""Shows the progress of a shift on one line of a terminal; elsewhere as a line now and then, and to
programs as lines of JSON."""

import json
import sys
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, TextIO

if TYPE_CHECKING:
    from warehouse_operations.operations import Operations

WIDTH = 30


class ProgressBar:
    """Shows simulated time, throughput and speed; to be called with an Operations now and then.

    seconds: the whole shift [s]. stopped: set to True, it stops the shift at the next call.
    """

    def __init__(
        self,
        seconds: float,
        stream: TextIO = sys.stderr,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._seconds, self._stream, self._clock = seconds, stream, clock
        self._period = 0.2 if stream.isatty() else 10.0
        self._began = clock()
        self._next = self._began + self._period
        self.stopped = False

    def __call__(self, ops: "Operations") -> bool:
        """Shows the progress if the period is over. Returns whether to stop."""
        now = self._clock()
        if now >= self._next:
            self._next = now + self._period
            self._show(ops, now - self._began)
        return self.stopped

    def end(self, ops: "Operations") -> None:
        """Shows the progress at the end of the shift."""
        self._show(ops, self._clock() - self._began)
        if self._stream.isatty():
            self._stream.write("\n")

    def _show(self, ops: "Operations", wall: float) -> None:
        share = min(ops.time / self._seconds, 1.0) if self._seconds else 1.0
        done = round(WIDTH * share)
        hourly = ops.shift.tally.items_picked / max(ops.time, 1e-9) * 3600
        text = (
            f"[{'#' * done}{'.' * (WIDTH - done)}] {_hms(ops.time)} of {_hms(self._seconds)}, "
            f"{hourly:,.0f} pieces/h, {ops.time / max(wall, 1e-9):,.1f} x real time"
        )
        self._stream.write(f"\r{text}\033[K" if self._stream.isatty() else f"{text}\n")
        self._stream.flush()


class ProgressLines(ProgressBar):
    """Tells programs how far a shift is: {time, of [simulated s], pieces, wall_s}, a line each."""

    PERIOD = 0.5  # [s, wall]

    def __init__(
        self,
        seconds: float,
        stream: TextIO = sys.stderr,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(seconds, stream, clock)
        self._period = self.PERIOD
        self._next = self._began + self._period

    def _show(self, ops: "Operations", wall: float) -> None:
        told = {
            "time": round(ops.time, 1),
            "of": self._seconds,
            "pieces": ops.shift.tally.items_picked,
            "wall_s": round(wall, 2),
        }
        self._stream.write(json.dumps(told) + "\n")
        self._stream.flush()


def _hms(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes // 60}:{minutes % 60:02}:{rest:02}"
