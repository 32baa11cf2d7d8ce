# SPDX-License-Identifier: Apache-2.0
"""The faults that one vehicle has, and until when."""

import math
from collections.abc import Callable

from warehouse_vda5050.errors import ErrorLevel
from warehouse_vda5050.faults.kinds import MEANINGS, Fault, FaultRequest

Happened = Callable[[str, bool], None]  # (what, whether a fault begins)


class ActiveFaults:
    """Several may be active at a time. happened(text, begins) is called when one begins or ends."""

    def __init__(self, happened: Happened) -> None:
        self._happened = happened
        self._until: dict[Fault, float] = {}
        self.level = ErrorLevel.FATAL  # of Fault.ERROR

    def begin(self, request: FaultRequest, now: float) -> None:
        """Begins a fault, or sets how long it lasts from now on; ends all where the request says
        so."""
        if request.fault is None:
            for fault in [*self._until]:
                self._end(fault)
            return
        if request.fault is Fault.ERROR:
            self.level = request.level
        self._until[request.fault] = now + request.seconds if request.seconds else math.inf
        lasting = f", for {request.seconds:g} s" if request.seconds else ""
        self._happened(f"fault on demand: {MEANINGS[request.fault]}{lasting}", True)

    def update(self, now: float) -> None:
        """Ends what is over."""
        for fault in [fault for fault, until in self._until.items() if now >= until]:
            self._end(fault)

    def _end(self, fault: Fault) -> None:
        del self._until[fault]
        self._happened(f"fault on demand is over: {fault.value}", False)

    def __contains__(self, fault: Fault) -> bool:
        return fault in self._until

    def __len__(self) -> int:
        return len(self._until)

    @property
    def names(self) -> str:
        """Their names, with commas between; '' without any."""
        return ", ".join(
            f"{fault.value}:{self.level.value}" if fault is Fault.ERROR else fault.value
            for fault in self._until
        )
