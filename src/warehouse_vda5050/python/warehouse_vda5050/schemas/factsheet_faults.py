# SPDX-License-Identifier: Apache-2.0
"""What of a factsheet does not fit its schema or can't be, field by field, for a person."""

import math
from collections.abc import Iterator
from typing import Any

from warehouse_vda5050.schemas import validator_of
from warehouse_vda5050.topics import Kind
from warehouse_vda5050.validation import MessageError
from warehouse_vda5050.validation.wire import parse

MOST = 5  # faults that are named; of the others there is the count
# No value fits these of the schema of 2.1.0: the type of the list is that of its entries.
UNFITTING = "blockingTypes"
# Numbers with which the master reckons, by their parent and their name in 2.1.0 and in 3.0.0.
ABOVE_ZERO = (
    ("physicalParameters", ("speedMax", "maximumSpeed")),
    ("physicalParameters", ("accelerationMax", "maximumAcceleration")),
    ("physicalParameters", ("width",)),
    ("physicalParameters", ("length",)),
)
WORDS = {
    "number": "a number",
    "integer": "a whole number",
    "string": "a text",
    "boolean": "true or false",
    "object": "an object",
    "array": "a list",
}


def factsheet_faults(payload: bytes, version: str) -> tuple[str, ...]:
    """Returns a sentence for each field of a factsheet that is not as the schema of a version has
    it, at most MOST and one that counts the rest."""
    try:
        value = parse(payload)
    except MessageError as error:
        return (str(error),)
    faults = [*_schema_faults(value, version), *_impossible(value)]
    rest = len(faults) - MOST
    return (*faults[:MOST], *([f"{rest} fields more"] if rest > 0 else ()))


def _schema_faults(value: dict[str, Any], version: str) -> Iterator[str]:
    errors = validator_of(Kind.FACTSHEET, version).iter_errors(value)
    for error in sorted(errors, key=lambda error: [*map(str, error.absolute_path)]):
        if version.startswith("2") and UNFITTING in error.absolute_path:
            continue
        yield from _sentences(error)


def _sentences(error: Any) -> Iterator[str]:
    """Yields where an error of the validator is, and what was expected there."""
    where = _path(error.absolute_path)
    if error.validator == "required":
        parts = error.schema.get("properties", {})
        for name in error.validator_value:
            if name not in error.instance:
                expected = WORDS.get(str(parts.get(name, {}).get("type")), "a value")
                yield f"{_path([*error.absolute_path, name])} is missing; {expected} was expected"
                return
    elif error.validator == "type":
        expected = WORDS.get(error.validator_value, str(error.validator_value))
        yield f"{where} is {_shown(error.instance)}; {expected} was expected"
    elif error.validator == "enum":
        words = ", ".join(map(str, error.validator_value))
        yield f"{where} is {_shown(error.instance)}; one of {words} was expected"
    elif error.validator == "minimum":
        least = f"{error.validator_value:g}"
        yield f"{where} is {_shown(error.instance)}; {least} or more was expected"
    else:
        yield f"{where}: {error.message[:120]}"


def _impossible(value: dict[str, Any]) -> Iterator[str]:
    """Yields the fields that have the right type, and values that no vehicle has."""
    for parent, names in ABOVE_ZERO:
        holder = value.get(parent)
        holder = holder if isinstance(holder, dict) else {}
        for name in names:
            number = holder.get(name)
            if not isinstance(number, (int, float)) or isinstance(number, bool):
                continue
            if not (math.isfinite(number) and number > 0):
                yield f"{parent}.{name} is {number:g}; more than 0 was expected"


def _path(parts: Any) -> str:
    out = ""
    for part in parts:
        out += f"[{part}]" if isinstance(part, int) else f".{part}"
    return out.removeprefix(".") or "the factsheet"


def _shown(value: Any) -> str:
    if isinstance(value, (dict, list)):
        return "an object" if isinstance(value, dict) else "a list"
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
