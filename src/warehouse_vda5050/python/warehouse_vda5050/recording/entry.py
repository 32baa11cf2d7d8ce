# SPDX-License-Identifier: Apache-2.0
"""One recorded message, as a line of JSON."""

import base64
import binascii
import json
import math
from dataclasses import dataclass
from typing import Any


class EntryError(ValueError):
    """A line that is no message; the message says which field is wrong."""


@dataclass(frozen=True)
class Entry:
    """time: seconds since 1970 at which the message arrived. retain: whether the broker had kept it
    from before the recording. valid: whether it fits the official schema, and `why` not; None: not
    checked."""

    time: float
    topic: str
    payload: bytes
    qos: int = 0
    retain: bool = False
    valid: bool | None = None
    why: str = ""

    def line(self) -> str:
        """Returns the line; a payload that is no text stands in it as base64."""
        fields: dict[str, Any] = {"time": round(self.time, 6), "topic": self.topic}
        try:
            fields["payload"] = self.payload.decode()
        except UnicodeDecodeError:
            fields["payload_base64"] = base64.b64encode(self.payload).decode()
        fields |= {"qos": self.qos, "retain": self.retain, "valid": self.valid}
        if self.why:
            fields["why"] = self.why
        return json.dumps(fields, ensure_ascii=False)


def read_line(line: str) -> Entry:
    """Returns the message of a line. Raises EntryError."""
    try:
        fields = json.loads(line)
    except (ValueError, RecursionError) as error:
        raise EntryError(f"not JSON: {error}") from None
    if not isinstance(fields, dict):
        raise EntryError(f"an object was expected, not {line[:40]!r}")
    time, topic, qos = fields.get("time"), fields.get("topic"), fields.get("qos", 0)
    if isinstance(time, bool) or not isinstance(time, (int, float)) or not math.isfinite(time):
        raise EntryError(f"time is {time!r}; seconds since 1970 were expected")
    if not isinstance(topic, str) or not topic or set(topic) & {"+", "#", "\0"}:
        raise EntryError(f"topic is {topic!r}; the name of a topic was expected")
    if isinstance(qos, bool) or qos not in (0, 1, 2):
        raise EntryError(f"qos is {qos!r}; 0, 1 or 2 was expected")
    retain = fields.get("retain", False)
    if not isinstance(retain, bool):
        raise EntryError(f"retain is {retain!r}; true or false was expected")
    valid, why = fields.get("valid"), str(fields.get("why", ""))
    return Entry(time, topic, _payload(fields), qos, retain, valid, why)


def _payload(fields: dict[str, Any]) -> bytes:
    name = "payload" if "payload" in fields else "payload_base64"
    value = fields.get(name)
    if not isinstance(value, str):
        raise EntryError(f"{name} is {value!r:.60}; a text was expected")
    if name == "payload":
        return value.encode("utf-8", "surrogatepass")
    try:
        return base64.b64decode(value, validate=True)
    except (binascii.Error, ValueError):
        raise EntryError("payload_base64 is not base64") from None
