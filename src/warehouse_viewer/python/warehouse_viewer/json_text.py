# SPDX-License-Identifier: Apache-2.0
"""JSON as every reader takes it: without NaN and Infinity, which JSON has no words for."""

import json
import math

from starlette import responses


def dumps(value: object) -> str:
    """Returns compact JSON text; null where a number is not finite."""
    try:
        return _compact(value)
    except ValueError:  # seldom: to look for them beforehand would cost more than to write
        return _compact(_finite(value))


class JSONResponse(responses.JSONResponse):
    """A response in such JSON."""

    def render(self, content: object) -> bytes:
        """Returns the body."""
        return dumps(content).encode()


def _compact(value: object) -> str:
    return json.dumps(value, separators=(",", ":"), allow_nan=False)


def _finite(value: object) -> object:
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: _finite(inner) for key, inner in value.items()}
    return [*map(_finite, value)] if isinstance(value, list | tuple) else value
