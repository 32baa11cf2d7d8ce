# SPDX-License-Identifier: Apache-2.0
"""Progress of a shift: for people as a line with a bar, for programs as lines of JSON."""

import json
import sys
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, TextIO

from warehouse_layout.cli.progress_line import ProgressLine, hms

if TYPE_CHECKING:
    from warehouse_operations.runs.operations import Operations


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
