# SPDX-License-Identifier: Apache-2.0
"""People who tow robots that are broken in others' way, or lost."""

import numpy as np

from warehouse_fleet.traffic import Mode


class Towing:
    """Has a robot towed that has been broken in others' way, or lost anywhere, for `after` [s]: the
    one is repaired in time, the other stands until somebody comes, and may keep a storage unit from
    being fetched. Who can't be towed is tried again. `tow(kiva_id)` does it, or raises
    ValueError."""

    def __init__(self, transports, tow, after):
        self._transports, self._tow, self._after = transports, tow, after
        self._since = np.full(len(transports.traffic.kiva_ids), np.inf)  # [s]

    def advance(self):
        """Whose time has come is towed. One that was lost drives on from there."""
        traffic = self._transports.traffic
        waits = self._transports.in_the_way(traffic.broken) | (traffic.lost & ~traffic.gone)
        self._since = np.where(waits, np.minimum(self._since, traffic.time), np.inf)
        for robot in np.flatnonzero(traffic.time - self._since > self._after):
            self._since[robot] = traffic.time
            try:
                self._tow(int(traffic.kiva_ids[robot]))
            except ValueError:
                continue
            if traffic.lost[robot]:
                traffic.mode[robot] = Mode.AUTOMATIC
