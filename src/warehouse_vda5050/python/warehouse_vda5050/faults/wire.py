# SPDX-License-Identifier: Apache-2.0
"""What becomes of a vehicle's messages on their way to the broker."""

import random
from dataclasses import replace

from warehouse_vda5050.faults.active import ActiveFaults
from warehouse_vda5050.faults.kinds import LATE, Fault
from warehouse_vda5050.headers import shifted
from warehouse_vda5050.model import Header
from warehouse_vda5050.mqtt.loop import Outgoing
from warehouse_vda5050.topics import Kind

LATEST = 2.0  # until which a state waits for a later one [s]


class FaultyWire:
    """The messages of one vehicle; without faults each goes out as it is."""

    def __init__(self, faults: ActiveFaults) -> None:
        self._faults = faults
        self._random = random.Random(5050)
        self._waiting: list[Outgoing] = []
        self._since = 0.0

    @property
    def hears(self) -> bool:
        """Whether messages to the vehicle reach it."""
        return Fault.SILENT not in self._faults

    def stamped(self, header: Header) -> Header:
        """Returns the header by the vehicle's clock."""
        if Fault.CLOCK not in self._faults:
            return header
        return replace(header, timestamp=shifted(header.timestamp, -LATE))

    def outgoing(self, kind: Kind, message: Outgoing, now: float) -> list[Outgoing]:
        """Returns what goes out now in place of a message."""
        faults = self._faults
        if Fault.SILENT in faults:
            return []
        if kind is not Kind.STATE:
            return [message]
        if Fault.LOST in faults and self._random.random() < 0.5:
            return []
        messages = [message] * (2 if Fault.DOUBLED in faults else 1)
        return self._reordered(messages, now) if Fault.REORDERED in faults else messages

    def _reordered(self, messages: list[Outgoing], now: float) -> list[Outgoing]:
        if self._waiting:
            waiting, self._waiting = self._waiting, []
            return messages + waiting
        self._waiting, self._since = messages, now
        return []

    def late(self, now: float) -> list[Outgoing]:
        """Returns the states that have waited long enough for a later one."""
        if Fault.REORDERED in self._faults and now - self._since < LATEST:
            return []
        waiting, self._waiting = self._waiting, []
        return waiting

    @property
    def is_waiting(self) -> bool:
        """Whether a state waits for a later one."""
        return bool(self._waiting)
