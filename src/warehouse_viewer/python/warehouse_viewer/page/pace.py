# SPDX-License-Identifier: Apache-2.0
"""How fast simulated time passes in a world of this process that a page shows."""

import threading
import time

LATE = 0.5  # a program that takes longer to decide is not hurried afterwards [s, wall]
MEASURED = 1.0  # over which the real-time factor is measured [s, wall]


class Pace:
    """Holds the stepping thread back. Any thread may call.

    `factor` is the target, simulated seconds per wall second, 0 for as fast as possible; `reached`
    is the simulated time of the last wait() [s].
    """

    def __init__(self, factor: float) -> None:
        self.factor, self.paused, self.reached = factor, False, 0.0
        self._change, self._ended = threading.Condition(), False
        self._allowed = 0.0  # up to where steps lead while it is paused [s, simulated]
        self._since: tuple[float, float] | None = None  # (simulated, wall) to count time from
        self._measure = (0.0, time.monotonic(), 0.0)  # simulated and wall of the last one, factor

    def wait(self, now: float) -> None:
        """Waits until simulated time may advance from `now` [s]."""
        with self._change:
            self._measure_factor(now)
            while not self._ended:
                if self.paused and now >= self._allowed:
                    self._since = None
                    self._change.wait()
                elif (left := self._left(now)) > 0:
                    self._change.wait(left)
                else:
                    return

    def pause(self) -> None:
        """Stops simulated time."""
        self._set(paused=True, _allowed=0.0)

    def resume(self) -> None:
        """Resumes simulated time."""
        self._set(paused=False)

    def run_at(self, factor: float) -> None:
        """Sets the target: simulated seconds per wall second, 0 for as fast as possible."""
        self._set(factor=factor)

    def step(self, seconds: float) -> None:
        """Steps a paused world by a duration [s, simulated]."""
        self._set(_allowed=self.reached + seconds - 1e-9)

    def end(self) -> None:
        """Releases every waiting thread for good."""
        self._set(_ended=True)

    @property
    def real_time_factor(self) -> float:
        """Simulated seconds per wall second over the last second or so."""
        return self._measure[2]

    def _set(self, **values: float) -> None:
        with self._change:
            vars(self).update(values)
            self._since = None
            self._change.notify_all()

    def _left(self, now: float) -> float:
        """Returns how long to wait [s, wall]."""
        if self.paused or not self.factor:
            return 0.0
        wall = time.monotonic()
        if self._since is None:
            self._since = now, wall
        left = self._since[1] + (now - self._since[0]) / self.factor - wall
        if not -LATE < left < MEASURED + 60 / self.factor:  # late, or another episode began
            self._since = now, wall
            return 0.0
        return left

    def _measure_factor(self, now: float) -> None:
        self.reached = now
        simulated, wall, factor = self._measure
        passed = time.monotonic() - wall
        if now < simulated:
            self._measure = now, wall + passed, factor
        elif passed >= MEASURED:
            self._measure = now, wall + passed, (now - simulated) / passed
