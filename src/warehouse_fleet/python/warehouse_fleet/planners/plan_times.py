# SPDX-License-Identifier: Apache-2.0
"""How long the newest plans took."""

import numpy as np

KEPT = 10_000  # plans


class PlanTimes:
    """The computing times of the newest `kept` plans [s].

    Their array has its full size from the beginning, so that memory stays the same in a long shift.
    One thread may append while others read.
    """

    def __init__(self, kept: int = KEPT) -> None:
        self._times, self._count = np.zeros(kept), 0

    def __len__(self) -> int:
        return min(self._count, len(self._times))

    def append(self, seconds: float) -> None:
        """Adds the time of a plan [s]; the oldest one gives way."""
        self._times[self._count % len(self._times)] = seconds
        self._count += 1

    def all(self) -> np.ndarray:
        """Returns the times [s], (n,), the oldest first."""
        if self._count <= len(self._times):
            return self._times[: self._count].copy()
        return np.roll(self._times, -(self._count % len(self._times)))
