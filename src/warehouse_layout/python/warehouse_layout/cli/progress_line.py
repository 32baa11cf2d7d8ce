# SPDX-License-Identifier: Apache-2.0
"""The progress of a long run: on one line of a terminal, elsewhere as a line now and then."""

import sys
import time
from collections.abc import Callable
from typing import TextIO

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

    def clear(self) -> None:
        """Takes the line away, where it is on a terminal."""
        if self._stream.isatty():
            self.write("\r\033[K")

    def end(self) -> None:
        """Ends the line."""
        if self._stream.isatty():
            self._stream.write("\n")


def hms(seconds: float) -> str:
    """Returns a time [s] as hours:minutes:seconds."""
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes // 60}:{minutes % 60:02}:{rest:02}"
