# SPDX-License-Identifier: Apache-2.0
"""Work for a fleet that has no orders: any units to any stations, each served for a while."""

import numpy as np

from warehouse_fleet.transports import Kind
from warehouse_layout.stations import PICK


class RandomTransports:
    """Keeps every picking station busy. `exchange` is the time from one unit to the next there [s],
    of which a unit is served all but `CHANGE`.
    """

    CHANGE = 4.0  # until the next unit stands where the last one stood [s]

    def __init__(self, transports, seed=1, exchange=20.0):
        self._transports = transports
        self._dwell = max(0.0, exchange - self.CHANGE)
        self._random = np.random.default_rng(seed)
        self._stations = [s.name for s in transports.stations.values() if s.kind == PICK]
        self._idle = sorted(transports.cell_of_unit)  # units without a transport
        self._own = set()  # numbers of transports
        self._served = {}  # number of a transport: until when [s]

    def advance(self, time, events):
        """Goes on, by what has become of transports since the last call: TransportEvents."""
        for event in events:
            if event.transport_id not in self._own:
                continue
            if event.kind == Kind.ARRIVED:
                self._served[event.transport_id] = time + self._dwell
            elif event.kind in (Kind.STORED, Kind.FAILED):
                self._own.discard(event.transport_id)
                self._served.pop(event.transport_id, None)
                self._idle.append(event.shelf_id)
        for number in [n for n, until in self._served.items() if time >= until]:
            del self._served[number]
            self._transports.release(number)
        for station in self._stations:
            while self._idle and self._wants(station):
                chosen = int(self._random.integers(len(self._idle)))
                unit = self._idle.pop(chosen)
                answer = self._transports.submit(unit, station)
                if not answer.accepted:  # somebody else has it brought somewhere
                    self._idle.append(unit)
                    break
                self._own.add(answer.transport_id)

    def _wants(self, station):
        """One waits for a robot always."""
        return self._transports.open_for(station) == 0 and self._transports.is_open[station]
