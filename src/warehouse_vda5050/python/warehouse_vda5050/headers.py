# SPDX-License-Identifier: Apache-2.0
"""The header of each message sent: numbers that count up, times that never go back."""

import threading
import time
from collections import Counter
from collections.abc import Callable
from datetime import UTC, datetime

from warehouse_vda5050.model import Header
from warehouse_vda5050.topics import Identity, Kind

UINT32 = 1 << 32


def iso(seconds: float) -> str:
    """Returns seconds since 1970 as ISO 8601 in UTC with milliseconds."""
    moment = datetime.fromtimestamp(seconds, UTC)
    return moment.strftime("%Y-%m-%dT%H:%M:%S.") + f"{moment.microsecond // 1000:03d}Z"


def shifted(timestamp: str, seconds: float) -> str:
    """Returns a time of iso(), some seconds later."""
    return iso(datetime.fromisoformat(timestamp).timestamp() + seconds)


class Headers:
    """Makes the headers of one vehicle's messages, whichever side sends them.

    headerId counts up by one a topic, modulo 2³². Masters drop what is older than what they had,
    so a timestamp is never before the last of any topic, even where the wall clock is set back.
    `clock` returns seconds since 1970. Threads may share one.
    """

    def __init__(
        self, vehicle: Identity, version: str, clock: Callable[[], float] = time.time
    ) -> None:
        self._vehicle, self._version, self._clock = vehicle, version, clock
        self._counts: Counter[Kind] = Counter()
        self._last = 0.0
        self._lock = threading.Lock()

    def last(self, kind: Kind) -> int:
        """Returns the headerId of the last message of a kind, 0 before the first."""
        with self._lock:
            return max(0, self._counts[kind] - 1) % UINT32

    def next(self, kind: Kind) -> Header:
        """Returns the header of the next message of a kind."""
        with self._lock:
            number = self._counts[kind] % UINT32
            self._counts[kind] += 1
            self._last = max(self._last, self._clock())
            stamp = iso(self._last)
        vehicle = self._vehicle
        return Header(number, stamp, self._version, vehicle.manufacturer, vehicle.serial)
