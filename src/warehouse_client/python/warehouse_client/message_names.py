# SPDX-License-Identifier: Apache-2.0
"""The names of numbers in messages, as the messages define them.

The pages show the same words: web/js/base/words.js, which a test compares with these.
"""

from typing import Any

from warehouse_msgs.msg import Event, KivaStatus, TransportEvent
from warehouse_msgs.srv import FailRequest, SetRobotModeRequest, TransportRequest


def constants(kind: Any, prefix: str = "") -> dict[int, str]:
    """Returns {value: name} of a message type's constants with that prefix, without the prefix."""
    named = {n: v for n, v in vars(kind).items() if n.isupper() and isinstance(v, int)}
    return {v: n.removeprefix(prefix) for n, v in named.items() if n.startswith(prefix)}


EVENT = constants(Event)
STATUS = constants(KivaStatus, "STATUS_")
STATE = constants(KivaStatus, "STATE_")
TRANSPORT = constants(TransportEvent)
MODE = constants(SetRobotModeRequest)
THEN = constants(TransportRequest)
WORK = ("fetching", "ready", "lifting", "bringing", "waiting", "storing", "dropping", "idle")


# By bit of FleetState.failures: an empty battery, then the kinds of Fail.
FAILURES = {
    0: "battery empty",
    FailRequest.MOTOR: "drive",
    FailRequest.LIFT_STUCK: "lift stuck",
    FailRequest.LASER_BLIND: "laser blind",
    FailRequest.RADIO_LOST: "radio lost",
    FailRequest.WHEEL_SLIPS: "wheels slip",
    6: "out of order",  # of a vehicle of another maker, which reports the reason itself
}


def failures_of(bits: int) -> list[str]:
    """Returns the names of a robot's failures."""
    return [name for bit, name in FAILURES.items() if bits >> bit & 1]
