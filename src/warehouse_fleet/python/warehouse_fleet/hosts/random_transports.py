# SPDX-License-Identifier: Apache-2.0
"""Random demand for a fleet without orders: any unit to any station, each served for a while."""

from collections.abc import Iterable

import numpy as np

from warehouse_fleet.transports.transports import Kind, TransportEvent, Transports
from warehouse_layout.floor.stations import PICK


class RandomTransports:
    """Submits and releases transports so that every picking station stays busy.

    `exchange` is the time from one unit to the next at a station [s]; each unit is served for that
    time less `CHANGE`.
    """

    CHANGE = 4.0  # from the release of a unit until the next one stands in its place [s]

    def __init__(self, transports: Transports, seed: int = 1, exchange: float = 20.0) -> None:
        self._transports = transports
        self._dwell = max(0.0, exchange - self.CHANGE)
        self._random = np.random.default_rng(seed)
        self._stations = [s.name for s in transports.stations.values() if s.kind == PICK]
        self._idle = sorted(transports.cell_of_unit)  # units without a transport
        self._own: set[int] = set()  # numbers of the transports submitted here
        self._served: dict[int, float] = {}  # end of service [s], by transport number

    def advance(self, time: float, events: Iterable[TransportEvent]) -> None:
        """Releases the units whose service is over at `time` [s], and submits new transports.
        `events`: what happened to transports since the last call."""
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
                if not answer.accepted:  # perhaps another client has a transport for it
                    self._idle.append(unit)
                    break
                self._own.add(answer.transport_id)

    def _wants(self, station: str) -> bool:
        """Returns whether the station is open and none of its transports waits for a robot."""
        return self._transports.open_for(station) == 0 and self._transports.is_open[station]
