# SPDX-License-Identifier: Apache-2.0
"""How fast simulated time passes where somebody watches."""

import threading
import time

LATE = 0.5  # whoever decides may take longer than that: it is not made up for [s, wall]
MEASURED = 1.0  # over which the factor is told [s, wall]


class Pace:
    """factor: simulated seconds a wall second; 0 = as fast as it goes. Any thread may call."""

    def __init__(self, factor):
        self.factor, self.paused, self.reached = factor, False, 0.0
        self._change, self._ended = threading.Condition(), False
        self._allowed = 0.0  # up to where steps lead while it is paused [s, simulated]
        self._since = None  # (simulated, wall) from which time is counted
        self._measure = (0.0, time.monotonic(), 0.0)  # simulated and wall of the last one, factor

    def wait(self, now):
        """Returns when simulated time may go on from `now` [s]."""
        with self._change:
            self._note(now)
            while not self._ended:
                if self.paused and now >= self._allowed:
                    self._since = None
                    self._change.wait()
                elif (left := self._left(now)) > 0:
                    self._change.wait(left)
                else:
                    return

    def pause(self):
        self._set(paused=True, _allowed=0.0)

    def resume(self):
        self._set(paused=False)

    def run_at(self, factor):
        self._set(factor=factor)

    def step(self, seconds):
        """Goes on for so long, if it is paused [s, simulated]."""
        self._set(_allowed=self.reached + seconds - 1e-9)

    def end(self):
        """Nobody waits any more."""
        self._set(_ended=True)

    @property
    def real_time_factor(self):
        """Simulated seconds a wall second, lately."""
        return self._measure[2]

    def _set(self, **values):
        with self._change:
            vars(self).update(values)
            self._since = None
            self._change.notify_all()

    def _left(self, now):
        """To be waited [s, wall]."""
        if self.paused or not self.factor:
            return 0.0
        wall = time.monotonic()
        if self._since is None:
            self._since = now, wall
        left = self._since[1] + (now - self._since[0]) / self.factor - wall
        if not -LATE < left < MEASURED + 60 / self.factor:  # late, or an episode began anew
            self._since = now, wall
            return 0.0
        return left

    def _note(self, now):
        self.reached = now
        simulated, wall, factor = self._measure
        passed = time.monotonic() - wall
        if now < simulated:
            self._measure = now, wall + passed, factor
        elif passed >= MEASURED:
            self._measure = now, wall + passed, (now - simulated) / passed
