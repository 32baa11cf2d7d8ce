# SPDX-License-Identifier: Apache-2.0
"""A coordinator that begins knows nothing of what robots were told before. Until all of that is
over it releases nothing: so no robot drives into cells that another was released once."""

import numpy as np

from warehouse_fleet.traffic import IDLE, Mode

ON_ITS_WAY = 2.0  # for which a message may still come to a robot [s]
MOST = 30.0  # after which it begins whatever a robot is still at [s]


class Takeover:
    """Of the robots of a Traffic, which counts none as its own meanwhile; from `time` [s] on."""

    def __init__(self, traffic, time):
        self._traffic, self._since = traffic, time
        traffic.takes_over = True

    def advance(self, time, report):
        """Ends it when all of them stand, or are at work for a person."""
        elapsed = time - self._since
        is_over = elapsed > ON_ITS_WAY and not self._drive(report).any()
        self._traffic.takes_over = not is_over and elapsed < MOST

    def _drive(self, report):
        traffic = self._traffic
        under_way = (np.asarray(report.path_id) != 0) & (np.asarray(report.status) != IDLE)
        return under_way & (traffic.mode == Mode.AUTOMATIC) & ~traffic.broken
