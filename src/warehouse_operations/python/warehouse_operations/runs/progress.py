# SPDX-License-Identifier: Apache-2.0
"""Progress of a shift: on one line of a terminal, elsewhere as a line now and then, and for
programs as lines of JSON."""

import json
import sys
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, TextIO

if TYPE_CHECKING:
    from warehouse_operations.runs.operations import Operations

WIDTH = 30


class ProgressLine:
    """Shows a bar with a text, on one line of a terminal; elsewhere a line now and then.

    period: between two of them [s, wall]; None: 0.2 on a terminal, else 10.
    """

    def __init__(
        self,
        stream: TextIO = sys.stderr,
        clock: Callable[[], float] = time.monotonic,
        period: float | None = None,
    ) -> None:
        self._stream, self._clock = stream, clock
        self._period = period or (0.2 if stream.isatty() else 10.0)
        self._began = clock()
        self._next = self._began + self._period

    @property
    def wall(self) -> float:
        """Time since the begin [s]."""
        return self._clock() - self._began

    def is_due(self) -> bool:
        """Returns whether the period is over, and begins the next one."""
        now = self._clock()
        if now < self._next:
            return False
        self._next = now + self._period
        return True

    def show(self, share: float, text: str) -> None:
        """Shows the completed share, 0…1, and a text."""
        done = round(WIDTH * min(share, 1.0))
        self.replace(f"[{'#' * done}{'.' * (WIDTH - done)}] {text}")

    def replace(self, text: str) -> None:
        """Shows a text: on a terminal in place of the last one, elsewhere as a new line."""
        self.write(f"\r{text}\033[K" if self._stream.isatty() else f"{text}\n")

    def write(self, text: str) -> None:
        """Writes a text as it is."""
        self._stream.write(text)
        self._stream.flush()

    def end(self) -> None:
        """Ends the line."""
        if self._stream.isatty():
            self._stream.write("\n")


class ProgressBar:
    """Shows simulated time, throughput and speed; call it with an Operations.

    seconds: the whole shift [s]. stopped: set to True, it stops the shift at the next call.
    """

    def __init__(
        self,
        seconds: float,
        stream: TextIO = sys.stderr,
        clock: Callable[[], float] = time.monotonic,
        period: float | None = None,
    ) -> None:
        self._seconds, self._line = seconds, ProgressLine(stream, clock, period)
        self.stopped = False

    def __call__(self, ops: "Operations") -> bool:
        """Shows the progress if the period is over. Returns whether to stop."""
        if self._line.is_due():
            self._show(ops)
        return self.stopped

    def end(self, ops: "Operations") -> None:
        """Shows the progress at the end of the shift."""
        self._show(ops)
        self._line.end()

    def _show(self, ops: "Operations") -> None:
        hourly = ops.context.tally.items_picked / max(ops.time, 1e-9) * 3600
        self._line.show(
            ops.time / self._seconds if self._seconds else 1.0,
            f"{hms(ops.time)} of {hms(self._seconds)}, {hourly:,.0f} pieces/h, "
            f"{ops.time / max(self._line.wall, 1e-9):,.1f} x real time",
        )


class ProgressLines(ProgressBar):
    """Writes the progress of a shift for programs, a JSON object a line.

    {time, of [simulated s], pieces, wall_s}
    """

    PERIOD = 0.5  # [s, wall]

    def __init__(
        self,
        seconds: float,
        stream: TextIO = sys.stderr,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(seconds, stream, clock, self.PERIOD)

    def _show(self, ops: "Operations") -> None:
        state = {
            "time": round(ops.time, 1),
            "of": self._seconds,
            "pieces": ops.context.tally.items_picked,
            "wall_s": round(self._line.wall, 2),
        }
        self._line.write(json.dumps(state) + "\n")


def hms(seconds: float) -> str:
    """Returns a time [s] as hours:minutes:seconds."""
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes // 60}:{minutes % 60:02}:{rest:02}"
