# SPDX-License-Identifier: Apache-2.0
"""Errors in states: the few types of 2.1, and the more specific ones of 3.0."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class ErrorLevel(StrEnum):
    """WARNING: the vehicle continues. FATAL: a person has to come."""

    WARNING = "WARNING"
    FATAL = "FATAL"


class ErrorType(StrEnum):
    """The kinds of errors that 2.1 names, and those of robots of this project."""

    VALIDATION = "validationError"
    ORDER = "orderError"
    ORDER_UPDATE = "orderUpdateError"
    NO_ROUTE = "noRouteError"
    NO_ORDER_TO_CANCEL = "noOrderToCancel"
    ORDER_ACTION = "orderActionError"  # an action of an order failed
    INSTANT_ACTION = "instantActionError"  # an instant action cannot be carried out
    UNKNOWN_FIELD = "unknownField"  # reported, and otherwise ignored
    ZONE = "zoneError"  # of a zone in which the robot is, or loses its release
    LOST = "localizationError"
    MOTOR = "motorError"
    LIFT = "liftError"
    LASER = "laserError"
    BATTERY = "batteryEmpty"
    WHEELS = "wheelSlip"
    DEMANDED = "faultOnDemand"  # of a vehicle whose master is tried
    SILENT = "robotSilent"  # nothing is heard of the robot although its radio works


class Predefined(StrEnum):
    """The types that 3.0.0 predefines (6.6.5.4)."""

    UNSUPPORTED_PARAMETER = "UNSUPPORTED_PARAMETER"
    NO_ORDER_TO_CANCEL = "NO_ORDER_TO_CANCEL"
    VALIDATION_FAILURE = "VALIDATION_FAILURE"
    INVALID_ORDER_ACTION = "INVALID_ORDER_ACTION"
    INVALID_INSTANT_ACTION = "INVALID_INSTANT_ACTION"
    OUTDATED_ORDER_UPDATE = "OUTDATED_ORDER_UPDATE"
    SAME_ORDER_UPDATE_ID = "SAME_ORDER_UPDATE_ID"
    ORDER_UPDATE_FOLLOWING_CANCEL = "ORDER_UPDATE_FOLLOWING_CANCEL"
    OUTSIDE_OF_CORRIDOR = "OUTSIDE_OF_CORRIDOR"
    INSUFFICIENT_MEMORY = "INSUFFICIENT_MEMORY"
    DUPLICATE_MAP = "DUPLICATE_MAP"
    BLOCKED_ZONE_VIOLATION = "BLOCKED_ZONE_VIOLATION"
    DUPLICATE_ZONE_SET = "DUPLICATE_ZONE_SET"
    RELEASE_LOST = "RELEASE_LOST"
    ZONE_ACTION_CONFLICT = "ZONE_ACTION_CONFLICT"
    NODE_UNREACHABLE = "NODE_UNREACHABLE"
    LOCALIZATION_ERROR = "LOCALIZATION_ERROR"
    NO_ROUTE_TO_TARGET = "NO_ROUTE_TO_TARGET"
    OTHER_ORDER_ACTIVE = "OTHER_ORDER_ACTIVE"
    START_NODE_OUT_OF_RANGE = "START_NODE_OUT_OF_RANGE"
    MOBILE_ROBOT_NOT_AVAILABLE = "MOBILE_ROBOT_NOT_AVAILABLE"
    UNKNOWN_MAP_ID = "UNKNOWN_MAP_ID"


# What 3.0 calls an error of which 2.1's type alone is known.
USUAL = {
    ErrorType.VALIDATION: Predefined.VALIDATION_FAILURE,
    ErrorType.ORDER_UPDATE: Predefined.OUTDATED_ORDER_UPDATE,
    ErrorType.NO_ROUTE: Predefined.NO_ROUTE_TO_TARGET,
    ErrorType.NO_ORDER_TO_CANCEL: Predefined.NO_ORDER_TO_CANCEL,
    ErrorType.INSTANT_ACTION: Predefined.INVALID_INSTANT_ACTION,
    ErrorType.LOST: Predefined.LOCALIZATION_ERROR,
}
# What 2.1 calls an error of a type that only 3.0 has; of the other predefined types, orderError.
FORMER = {precise: type for type, precise in USUAL.items()} | {
    Predefined.SAME_ORDER_UPDATE_ID: ErrorType.ORDER_UPDATE,
    Predefined.ORDER_UPDATE_FOLLOWING_CANCEL: ErrorType.ORDER_UPDATE,
    Predefined.INSUFFICIENT_MEMORY: ErrorType.VALIDATION,
    Predefined.START_NODE_OUT_OF_RANGE: ErrorType.NO_ROUTE,
}
# Levels of 3.0 that 2.1 has no word for, by predefined type.
LEVELS = {
    Predefined.INSUFFICIENT_MEMORY: "URGENT",
    Predefined.UNSUPPORTED_PARAMETER: "CRITICAL",
    Predefined.OUTSIDE_OF_CORRIDOR: "CRITICAL",
    Predefined.BLOCKED_ZONE_VIOLATION: "CRITICAL",
    Predefined.RELEASE_LOST: "CRITICAL",
    Predefined.ZONE_ACTION_CONFLICT: "CRITICAL",
    Predefined.NODE_UNREACHABLE: "CRITICAL",
}


@dataclass(frozen=True)
class Error:
    """What is wrong with a message or a vehicle; references are (key, value): orderId, nodeId …

    type is that of 2.1; `precise` is that of 3.0 where it is more specific.
    """

    type: str
    level: ErrorLevel = ErrorLevel.WARNING
    description: str = ""
    hint: str = ""
    references: tuple[tuple[str, str], ...] = ()
    precise: Predefined | None = None


def precise_type(error: Error) -> str:
    """Returns the type of an error in 3.0; types of a maker's own stay what they are."""
    return error.precise or USUAL.get(error.type, error.type)  # type: ignore[call-overload]


def former_type(name: str) -> tuple[str, Predefined | None]:
    """Returns the type of an error of 3.0 in 2.1, and what is lost by that."""
    if name not in set(Predefined):
        return name, None
    precise = Predefined(name)
    former = FORMER.get(precise, ErrorType.ORDER)
    return former.value, None if USUAL.get(former) is precise else precise
