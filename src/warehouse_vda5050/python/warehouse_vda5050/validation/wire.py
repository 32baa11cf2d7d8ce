# SPDX-License-Identifier: Apache-2.0
"""JSON as strangers send it: bounded in size and depth, and without NaN."""

import json
import math
from typing import Any, NoReturn

from warehouse_vda5050.validation import MessageError

MAX_BYTES = 1 << 20
MAX_DEPTH = 16
MAX_VALUES = 200_000
MAX_TEXT = 10_000  # characters of one text


def parse(payload: bytes, max_bytes: int = MAX_BYTES) -> dict[str, Any]:
    """Returns the JSON object that a message is. Raises MessageError."""
    if len(payload) > max_bytes:
        raise MessageError(f"a message of {len(payload)} bytes; at most {max_bytes} were expected")
    try:
        value = json.loads(payload.decode("utf-8-sig"), parse_constant=_refuse)
    except MessageError:
        raise
    except RecursionError:
        raise MessageError(f"JSON deeper than {MAX_DEPTH}") from None
    except ValueError as error:  # of UTF-8, of JSON, of numbers too long
        raise MessageError(f"not JSON: {error}") from None
    if not isinstance(value, dict):
        raise MessageError(f"the message is a {type(value).__name__}; an object was expected")
    _check(value)
    return value


def _refuse(name: str) -> NoReturn:
    raise MessageError(f"{name} is not a number of JSON")


def _check(value: Any) -> None:
    """Raises MessageError where depth, number of values, or a number is out of bounds."""
    level, count = [value], 0
    for _ in range(MAX_DEPTH):
        count += len(level)
        if count > MAX_VALUES:
            raise MessageError(f"more than {MAX_VALUES} values in one message")
        level = [child for item in level for child in _children(item)]
        if not level:
            return
    raise MessageError(f"JSON deeper than {MAX_DEPTH}")


def _children(value: Any) -> list[Any]:
    if isinstance(value, dict):
        return [*value.values(), *(key for key in value if len(key) > MAX_TEXT)]
    if isinstance(value, list):
        return value
    if isinstance(value, float) and not math.isfinite(value):
        raise MessageError("a number beyond what a double holds")
    if isinstance(value, str) and len(value) > MAX_TEXT:
        raise MessageError(f"a text of more than {MAX_TEXT} characters")
    return []
