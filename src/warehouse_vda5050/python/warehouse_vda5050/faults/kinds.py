# SPDX-License-Identifier: Apache-2.0
"""The faults that a vehicle can be asked for."""

import math
from dataclasses import dataclass
from enum import StrEnum

from warehouse_vda5050.errors import ErrorLevel


class FaultError(ValueError):
    """A request that no vehicle can carry out; the message says what was expected."""


class Fault(StrEnum):
    """A fault on demand."""

    SILENT = "silent"
    LOST = "lost"
    DOUBLED = "doubled"
    REORDERED = "reordered"
    JUMP = "jump"
    REFUSE = "refuse"
    SLOW = "slow"
    BATTERY = "battery"
    HEADING = "heading"
    ERROR = "error"
    CLOCK = "clock"


JUMP = 2.0  # [m]
SLOW = 0.3  # [m/s]
LOW = 4.0  # [%]
LATE = 3600.0  # [s]

MEANINGS = {
    Fault.SILENT: "sends nothing and hears nothing, while its connection stands",
    Fault.LOST: "half of its states are lost",
    Fault.DOUBLED: "each of its states comes twice",
    Fault.REORDERED: "of each two states the later one comes first",
    Fault.JUMP: f"its position is {JUMP:g} m off along x",
    Fault.REFUSE: "refuses all orders and updates",
    Fault.SLOW: f"drives at {SLOW:g} m/s or so",
    Fault.BATTERY: f"its battery is at {LOW:g} %",
    Fault.HEADING: "its heading is a quarter turn off",
    Fault.ERROR: "has an error: FATAL, with which it stands, or WARNING",
    Fault.CLOCK: f"its clock is {LATE / 3600:g} h late",
}


@dataclass(frozen=True)
class FaultRequest:
    """A fault for some time [s, wall], 0: until it is ended. fault None: all end. level: that of
    Fault.ERROR."""

    fault: Fault | None
    seconds: float = 0.0
    level: ErrorLevel = ErrorLevel.FATAL

    @property
    def text(self) -> str:
        """The fault as read_request() takes it."""
        if self.fault is Fault.ERROR:
            return f"error:{self.level.value}"
        return self.fault.value if self.fault else ""


def read_request(fault: str, seconds: float) -> FaultRequest:
    """Returns the request for a fault by its name; '' ends all. Raises FaultError."""
    if not math.isfinite(seconds) or seconds < 0:
        raise FaultError(f"seconds is {seconds:g}; 0 or more was expected")
    if not fault:
        return FaultRequest(None)
    name, _, level = fault.partition(":")
    if name not in set(Fault):
        raise FaultError(f"fault is {fault[:60]!r}; one of {', '.join(Fault)} was expected")
    if not level:
        return FaultRequest(Fault(name), seconds)
    if name != Fault.ERROR or level not in set(ErrorLevel):
        raise FaultError(f"fault is {fault[:60]!r}; error:WARNING or error:FATAL was expected")
    return FaultRequest(Fault.ERROR, seconds, ErrorLevel(level))
