# SPDX-License-Identifier: Apache-2.0
"""What all codecs share: JSON in and out, the header, and whose version a message is of."""

import abc
import json
from typing import Any, NamedTuple

from warehouse_vda5050.model import Header, Message
from warehouse_vda5050.topics import Kind
from warehouse_vda5050.validation import MessageError
from warehouse_vda5050.validation.fields import REQUIRED, Fields
from warehouse_vda5050.validation.wire import MAX_BYTES, parse


class Decoded(NamedTuple):
    """A message, and the paths of the fields in it that no version of VDA 5050 has."""

    message: Any
    unknown: tuple[str, ...] = ()


class Codec(abc.ABC):
    """One version of VDA 5050. `strict`: whether what peers in the field are known to leave out or
    to name otherwise is refused."""

    def __init__(self, version: str, strict: bool = False) -> None:
        self.version, self.strict = version, strict

    def encode(self, message: Message) -> bytes:
        """Returns the JSON of a message; its header goes in as it is."""
        text = json.dumps(self.to_json(message), separators=(",", ":"), allow_nan=False)
        return text.encode()

    def decode(self, kind: Kind, payload: bytes, max_bytes: int = MAX_BYTES) -> Decoded:
        """Returns the message that a payload is. Raises MessageError, whatever the payload is."""
        fields = Fields(self.of_json(kind, parse(payload, max_bytes)), strict=self.strict)
        message = self.read(kind, fields)
        return Decoded(message, tuple(fields.unread))

    def of_json(self, kind: Kind, value: dict[str, Any]) -> dict[str, Any]:
        """Returns what read() understands; for versions whose names differ."""
        return value

    def newer(self, kind: Kind, value: dict[str, Any]) -> dict[str, Any]:
        """Returns a message of a master with the names of this version, of one with those of
        2.1.0; whatever else stands in it is kept."""
        return value

    @abc.abstractmethod
    def to_json(self, message: Message) -> dict[str, Any]:
        """Returns the object that stands for a message."""

    @abc.abstractmethod
    def read(self, kind: Kind, fields: Fields) -> Any:
        """Returns the message that an object stands for. Raises MessageError."""

    def read_header(self, fields: Fields) -> Header:
        """Returns the header; what is missing is 0 or '', or an error if it is strict. Raises
        MessageError (another version)."""
        number, text = (REQUIRED, REQUIRED) if self.strict else (0, "")
        header = Header(
            fields.natural("headerId", number),
            fields.text("timestamp", text),
            fields.text("version", text),
            fields.text("manufacturer", text),
            fields.text("serialNumber", text),
        )
        ours, theirs = self.version.split(".")[0], header.version.lstrip("vV").split(".")[0]
        if theirs and theirs != ours:
            raise MessageError(f"version is {header.version!r}; {self.version} was expected")
        return header


def header_json(header: Header) -> dict[str, Any]:
    """Returns the fields of a header, which lie flat in each message."""
    return {
        "headerId": header.header_id,
        "timestamp": header.timestamp,
        "version": header.version,
        "manufacturer": header.manufacturer,
        "serialNumber": header.serial,
    }


def without_nothing(**fields: Any) -> dict[str, Any]:
    """Returns the fields that are neither None nor ''."""
    return {key: value for key, value in fields.items() if value is not None and value != ""}
