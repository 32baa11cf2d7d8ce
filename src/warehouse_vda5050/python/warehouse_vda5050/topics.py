# SPDX-License-Identifier: Apache-2.0
"""Names of topics: prefix/manufacturer/serial/kind, as in uagv/v2/kiva/7/order."""

import re
from dataclasses import dataclass
from enum import StrEnum

NAME = re.compile(r"[A-Za-z0-9_.:-]+")
PREFIXES = {2: "uagv/v2", 3: "vda5050/v3"}


class TopicError(ValueError):
    """A name that no topic may have; the message says which."""


class Kind(StrEnum):
    """The last part of a topic."""

    ORDER = "order"
    INSTANT_ACTIONS = "instantActions"
    ZONE_SET = "zoneSet"  # 3.0 alone has this one and the next
    RESPONSES = "responses"
    STATE = "state"
    VISUALIZATION = "visualization"
    CONNECTION = "connection"
    FACTSHEET = "factsheet"

    @property
    def qos(self) -> int:
        """MQTT's quality of service: 1 for connection, else 0."""
        return int(self is Kind.CONNECTION)

    @property
    def retained(self) -> bool:
        """Whether the broker keeps the last message for whom subscribes later."""
        return self in (Kind.CONNECTION, Kind.FACTSHEET)


TO_VEHICLE = (Kind.ORDER, Kind.INSTANT_ACTIONS)
ABOUT_ZONES = (Kind.ZONE_SET, Kind.RESPONSES)
FROM_VEHICLE = (Kind.STATE, Kind.CONNECTION, Kind.FACTSHEET, Kind.VISUALIZATION)


@dataclass(frozen=True)
class Identity:
    """One vehicle among all that a broker knows. Raises TopicError."""

    manufacturer: str
    serial: str

    def __post_init__(self) -> None:
        for name, value in (("manufacturer", self.manufacturer), ("serial", self.serial)):
            if not NAME.fullmatch(value):
                raise TopicError(f"{name} is {value!r}; letters, digits and _.:- were expected")


@dataclass(frozen=True)
class Topics:
    """All topics below one prefix, such as uagv/v2. Raises TopicError."""

    prefix: str = PREFIXES[2]

    def __post_init__(self) -> None:
        parts = self.prefix.split("/")
        if not all(NAME.fullmatch(part) for part in parts):
            raise TopicError(f"prefix is {self.prefix!r}; words separated by / were expected")

    def of(self, vehicle: Identity, kind: Kind) -> str:
        """Returns the topic of one kind of message of one vehicle."""
        return f"{self.prefix}/{vehicle.manufacturer}/{vehicle.serial}/{kind.value}"

    def everyone(self, kind: Kind) -> str:
        """Returns the filter that fits one kind of message of all vehicles."""
        return f"{self.prefix}/+/+/{kind.value}"

    def parse(self, topic: str) -> tuple[Identity, Kind]:
        """Returns whose topic it is and of which kind. Raises TopicError."""
        rest = topic.removeprefix(self.prefix + "/")
        parts = rest.split("/")
        if rest == topic or len(parts) != 3 or parts[2] not in {kind.value for kind in Kind}:
            raise TopicError(f"{topic!r} is not {self.prefix}/<manufacturer>/<serial>/<kind>")
        return Identity(parts[0], parts[1]), Kind(parts[2])


def heard_by_vehicle(version: str) -> tuple[Kind, ...]:
    """Returns what a vehicle of a version subscribes to."""
    return (*TO_VEHICLE, *ABOUT_ZONES) if version.startswith("3") else TO_VEHICLE


def prefix_of(version: str) -> str:
    """Returns the prefix that a version suggests: uagv/v2 for 2.1.0."""
    return PREFIXES.get(int(version.split(".")[0]), PREFIXES[2])
