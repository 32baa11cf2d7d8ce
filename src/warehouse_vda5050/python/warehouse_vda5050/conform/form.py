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


def _text(value: Any) -> bool:
    return isinstance(value, str)


def _flag(value: Any) -> bool:
    return isinstance(value, bool)


def _number(value: Any) -> bool:
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return is_number and math.isfinite(value)


def _natural(value: Any) -> bool:
    return _number(value) and value == int(value) and 0 <= value < 1 << 32


def _any(_value: Any) -> bool:
    return True


def _list(value: Any) -> bool:
    return isinstance(value, list)


def _of(*words: str) -> Check:
    def check(value: Any) -> bool:
        return value in words

    check.__name__ = f"_one of {', '.join(words)}"
    return check


HEADER: Form = {
    "headerId": _natural,
    "timestamp": _text,
    "version": _text,
    "manufacturer": _text,
    "serialNumber": _text,
}
POSITION: Form = {"x": _number, "y": _number, "theta?": _number, "mapId": _text}
POSE: Form = {
    "x": _number,
    "y": _number,
    "theta": _number,
    "mapId": _text,
    "positionInitialized": _flag,
}
VELOCITY: Form = {"vx?": _number, "vy?": _number, "omega?": _number}
STATUS = ("WAITING", "INITIALIZING", "RUNNING", "PAUSED", "FINISHED", "FAILED")
MODES = ("AUTOMATIC", "SEMIAUTOMATIC", "MANUAL", "SERVICE", "TEACHIN")
REFERENCE: Form = {"referenceKey": _text, "referenceValue": _text}
ERROR: Form = {
    "errorType": _text,
    "errorLevel": _of("WARNING", "FATAL"),
    "errorDescription?": _text,
    "errorReferences?": [REFERENCE],
}
STATE: Form = {
    **HEADER,
    "orderId": _text,
    "orderUpdateId": _natural,
    "lastNodeId": _text,
    "lastNodeSequenceId": _natural,
    "nodeStates": [
        {"nodeId": _text, "sequenceId": _natural, "released": _flag, "nodePosition?": POSITION}
    ],
    "edgeStates": [{"edgeId": _text, "sequenceId": _natural, "released": _flag}],
    "driving": _flag,
    "paused?": _flag,
    "newBaseRequest?": _flag,
    "distanceSinceLastNode?": _number,
    "agvPosition?": POSE,
    "velocity?": VELOCITY,
    "loads?": [{"loadId?": _text, "loadType?": _text}],
    "actionStates": [
        {"actionId": _text, "actionType?": _text, "actionStatus": _of(*STATUS)},
    ],
    "batteryState": {"batteryCharge": _number, "charging": _flag},
    "operatingMode": _of(*MODES),
    "errors": [ERROR],
    "information?": _list,
    "safetyState": {"eStop": _of("AUTOACK", "MANUAL", "REMOTE", "NONE"), "fieldViolation": _flag},
}
FACTSHEET: Form = {
    **HEADER,
    "typeSpecification": {
        "seriesName": _text,
        "agvKinematic": _text,
        "agvClass": _text,
        "maxLoadMass": _number,
        "localizationTypes": _list,
        "navigationTypes": _list,
    },
    "physicalParameters": {
        "speedMin": _number,
        "speedMax": _number,
        "accelerationMax": _number,
        "decelerationMax": _number,
        "heightMax": _number,
        "width": _number,
        "length": _number,
    },
    "protocolLimits": _any,
    "protocolFeatures": {
        "optionalParameters": [{"parameter": _text, "support": _text}],
        "agvActions": [{"actionType": _text, "actionScopes": _list}],
    },
    "agvGeometry": _any,
    "loadSpecification": _any,
}
FORMS: dict[Kind, Form] = {
    Kind.STATE: STATE,
    Kind.CONNECTION: {
        **HEADER,
        "connectionState": _of("ONLINE", "OFFLINE", "CONNECTIONBROKEN"),
    },
    Kind.VISUALIZATION: {**HEADER, "agvPosition?": POSE, "velocity?": VELOCITY},
    Kind.FACTSHEET: FACTSHEET,
}


def faults(kind: Kind, value: dict[str, Any] | None) -> list[str]:
    """Returns what is wrong with a message, a line each."""
    if value is None:
        return ["it is no JSON object"]
    return [*_faults(FORMS[kind], value, "")]


def _faults(form: Any, value: Any, path: str) -> Iterator[str]:
    if isinstance(form, list):
        yield from _faults_of_list(form[0], value, path)
    elif isinstance(form, dict):
        yield from _faults_of_object(form, value, path)
    elif not form(value):
        yield f"{path} is {value!r:.60}; {form.__name__[1:]} was expected"


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
