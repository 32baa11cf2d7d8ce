# SPDX-License-Identifier: Apache-2.0
"""Zones, and what vehicles ask and masters answer about them, as plain values."""

from dataclasses import dataclass
from enum import StrEnum

Point = tuple[float, float]  # [m] in the frame of the map


class ZoneType(StrEnum):
    """The types that 3.0.0 has (6.4.1)."""

    BLOCKED = "BLOCKED"
    LINE_GUIDED = "LINE_GUIDED"
    RELEASE = "RELEASE"
    COORDINATED_REPLANNING = "COORDINATED_REPLANNING"
    SPEED_LIMIT = "SPEED_LIMIT"
    ACTION = "ACTION"
    PRIORITY = "PRIORITY"
    PENALTY = "PENALTY"
    DIRECTED = "DIRECTED"
    BIDIRECTED = "BIDIRECTED"


@dataclass(frozen=True)
class Parameters:
    """The fields of one type of zone: the name of its number, of its word, and the words it may
    be; '' for none."""

    number: str = ""
    word: str = ""
    words: tuple[str, ...] = ()


PARAMETERS = {
    ZoneType.RELEASE: Parameters("", "releaseLossBehavior", ("STOP", "CONTINUE", "EVACUATE")),
    ZoneType.SPEED_LIMIT: Parameters("maximumSpeed"),
    ZoneType.PRIORITY: Parameters("priorityFactor"),
    ZoneType.PENALTY: Parameters("penaltyFactor"),
    ZoneType.DIRECTED: Parameters(
        "direction", "directedLimitation", ("SOFT", "RESTRICTED", "STRICT")
    ),
    ZoneType.BIDIRECTED: Parameters("direction", "bidirectedLimitation", ("SOFT", "RESTRICTED")),
}


@dataclass(frozen=True)
class Zone:
    """A polygon with a rule. `number` and `word` are those of PARAMETERS: a DIRECTED zone has its
    direction [rad] and its limitation, a RELEASE zone what a vehicle does that loses its release.
    """

    id: str
    type: ZoneType
    vertices: tuple[Point, ...]
    number: float = 0.0
    word: str = ""


@dataclass(frozen=True)
class ZoneSetState:
    """A zone set that a vehicle has, and whether it drives by it."""

    id: str
    map_id: str
    enabled: bool


class RequestStatus(StrEnum):
    """The progress of a request; one that is QUEUED is REQUESTED still."""

    REQUESTED = "REQUESTED"
    GRANTED = "GRANTED"
    REVOKED = "REVOKED"
    EXPIRED = "EXPIRED"


@dataclass(frozen=True)
class ZoneRequest:
    """A vehicle's request to enter a RELEASE zone."""

    id: str
    zone: str
    zone_set: str
    status: RequestStatus
    type: str = "ACCESS"


class Grant(StrEnum):
    """A master's answer to a request."""

    GRANTED = "GRANTED"
    QUEUED = "QUEUED"
    REVOKED = "REVOKED"
    REJECTED = "REJECTED"


@dataclass(frozen=True)
class Response:
    """A master's answer. expiry: when a grant ends [s since 1970], None: it does not."""

    request: str
    grant: Grant
    expiry: float | None = None
