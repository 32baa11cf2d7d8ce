# SPDX-License-Identifier: Apache-2.0
"""Messages as cases see them: JSON with the names of 2.1.0, whatever version is on the wire."""

import json
from typing import Any

from warehouse_vda5050.codec import Codec
from warehouse_vda5050.topics import Kind


def to_wire(codec: Codec, kind: Kind, value: dict[str, Any]) -> bytes:
    """Returns the payload of a message; numbers that JSON lacks are written as Python does."""
    return json.dumps(codec.newer(kind, value), separators=(",", ":")).encode()


def of_wire(codec: Codec, kind: Kind, payload: bytes) -> dict[str, Any] | None:
    """Returns the message that a payload is, None if it is no JSON object."""
    try:
        value = json.loads(payload)
    except ValueError:
        return None
    return codec.of_json(kind, value) if isinstance(value, dict) else None
