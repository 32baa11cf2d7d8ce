# SPDX-License-Identifier: Apache-2.0
"""Which fields a message must have, and of which type: those of 2.1.0, by whose names it is
read."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

from warehouse_vda5050.topics import Kind

Check = Callable[[Any], bool]
Form = dict[str, Any]  # a name to a check, a form, or a list of one form; "name?" may be missing


def text(value: Any) -> bool:
    """Returns whether a value is a string."""
    return isinstance(value, str)


def flag(value: Any) -> bool:
    """Returns whether a value is true or false."""
    return isinstance(value, bool)


def number(value: Any) -> bool:
    """Returns whether a value is a finite number."""
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return is_number and math.isfinite(value)


def natural(value: Any) -> bool:
    """Returns whether a value is an unsigned number of 32 bits."""
    return number(value) and value == int(value) and 0 <= value < 1 << 32


def anything(_value: Any) -> bool:
    """Returns True."""
    return True


def array(value: Any) -> bool:
    """Returns whether a value is a list."""
    return isinstance(value, list)


def word_of(*words: str) -> Check:
    """Returns a check for some words."""

    def check(value: Any) -> bool:
        return value in words

    check.__name__ = f"one of {', '.join(words)}"
    return check


HEADER: Form = {
    "headerId": natural,
    "timestamp": text,
    "version": text,
    "manufacturer": text,
    "serialNumber": text,
}
POSITION: Form = {"x": number, "y": number, "theta?": number, "mapId": text}
POSE: Form = {
    "x": number,
    "y": number,
    "theta": number,
    "mapId": text,
    "positionInitialized": flag,
}
VELOCITY: Form = {"vx?": number, "vy?": number, "omega?": number}
STATUS = ("WAITING", "INITIALIZING", "RUNNING", "PAUSED", "FINISHED", "FAILED")
MODES = ("AUTOMATIC", "SEMIAUTOMATIC", "MANUAL", "SERVICE", "TEACHIN")
REFERENCE: Form = {"referenceKey": text, "referenceValue": text}
ERROR: Form = {
    "errorType": text,
    "errorLevel": word_of("WARNING", "FATAL"),
    "errorDescription?": text,
    "errorReferences?": [REFERENCE],
}
STATE: Form = {
    **HEADER,
    "orderId": text,
    "orderUpdateId": natural,
    "lastNodeId": text,
    "lastNodeSequenceId": natural,
    "nodeStates": [
        {"nodeId": text, "sequenceId": natural, "released": flag, "nodePosition?": POSITION}
    ],
    "edgeStates": [{"edgeId": text, "sequenceId": natural, "released": flag}],
    "driving": flag,
    "paused?": flag,
    "newBaseRequest?": flag,
    "distanceSinceLastNode?": number,
    "agvPosition?": POSE,
    "velocity?": VELOCITY,
    "loads?": [{"loadId?": text, "loadType?": text}],
    "actionStates": [
        {"actionId": text, "actionType?": text, "actionStatus": word_of(*STATUS)},
    ],
    "batteryState": {"batteryCharge": number, "charging": flag},
    "operatingMode": word_of(*MODES),
    "errors": [ERROR],
    "information?": array,
    "safetyState": {
        "eStop": word_of("AUTOACK", "MANUAL", "REMOTE", "NONE"),
        "fieldViolation": flag,
    },
}
FACTSHEET: Form = {
    **HEADER,
    "typeSpecification": {
        "seriesName": text,
        "agvKinematic": text,
        "agvClass": text,
        "maxLoadMass": number,
        "localizationTypes": array,
        "navigationTypes": array,
    },
    "physicalParameters": {
        "speedMin": number,
        "speedMax": number,
        "accelerationMax": number,
        "decelerationMax": number,
        "heightMax": number,
        "width": number,
        "length": number,
    },
    "protocolLimits": anything,
    "protocolFeatures": {
        "optionalParameters": [{"parameter": text, "support": text}],
        "agvActions": [{"actionType": text, "actionScopes": array}],
    },
    "agvGeometry": anything,
    "loadSpecification": anything,
}
FORMS: dict[Kind, Form] = {
    Kind.STATE: STATE,
    Kind.CONNECTION: {
        **HEADER,
        "connectionState": word_of("ONLINE", "OFFLINE", "CONNECTIONBROKEN"),
    },
    Kind.VISUALIZATION: {**HEADER, "agvPosition?": POSE, "velocity?": VELOCITY},
    Kind.FACTSHEET: FACTSHEET,
}


def faults(kind: Kind, value: dict[str, Any] | None) -> list[str]:
    """Returns what is wrong with a message, a line each."""
    if value is None:
        return ["it is no JSON object"]
    return faults_of(FORMS[kind], value)


def faults_of(form: Form, value: Any) -> list[str]:
    """Returns in what a value differs from a form, a line each."""
    return [*_faults(form, value, "")]


def _faults(form: Any, value: Any, path: str) -> Iterator[str]:
    if isinstance(form, list):
        yield from _faults_of_list(form[0], value, path)
    elif isinstance(form, dict):
        yield from _faults_of_object(form, value, path)
    elif not form(value):
        yield f"{path} is {value!r:.60}; {form.__name__} was expected"


def _faults_of_list(form: Form, value: Any, path: str) -> Iterator[str]:
    if not isinstance(value, list):
        yield f"{path} is {value!r:.60}; a list was expected"
        return
    for k, item in enumerate(value):
        yield from _faults(form, item, f"{path}[{k}]")


def _faults_of_object(form: Form, value: Any, path: str) -> Iterator[str]:
    if not isinstance(value, dict):
        yield f"{path} is {value!r:.60}; an object was expected"
        return
    for key, part in form.items():
        name = key.removesuffix("?")
        inner = f"{path}.{name}" if path else name
        if name in value:
            yield from _faults(part, value[name], inner)
        elif name == key:
            yield f"{inner} is missing"
