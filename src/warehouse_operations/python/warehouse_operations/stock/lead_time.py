# SPDX-License-Identifier: Apache-2.0
"""How long units take to a station, from being asked for until they are there."""

import math


class LeadTime:
    """The lead time of a station's units as it was lately [s]: a smoothed mean, and its smoothed
    mean deviation, with the gains of RFC 6298 (Jacobson, SIGCOMM 1988). Infinite until the first
    unit was lifted."""

    GAIN, GAIN_OF_DEVIATION = 1 / 8, 1 / 4

    def __init__(self) -> None:
        self.mean = self.deviation = math.inf

    def note(self, seconds: float) -> None:
        """Takes a unit's lead time into account [s]."""
        if math.isinf(self.mean):
            self.mean, self.deviation = seconds, seconds / 2
            return
        self.deviation += self.GAIN_OF_DEVIATION * (abs(seconds - self.mean) - self.deviation)
        self.mean += self.GAIN * (seconds - self.mean)

    @property
    def horizon(self) -> float:
        """How long before it is needed a unit has to be asked for [s]: most are in time then."""
        return self.mean + self.deviation
