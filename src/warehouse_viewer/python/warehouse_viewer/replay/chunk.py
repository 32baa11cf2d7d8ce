# SPDX-License-Identifier: Apache-2.0
"""A stretch of a recording: what a page would have been sent in it, compressed as one.

Decompressed, it is messages in a row, little-endian, each at a multiple of 8 bytes:

    u32 kind       1 = an update as in page/protocol.py, 4 = JSON in UTF-8
    u32 length     of what follows the head [bytes]
    f64 stamp      simulated time [s]
    …              the message, and zeros up to a multiple of 8 bytes

The first update holds everything, each later update what has changed. web/js/replay/chunk.js
reads it.
"""

import struct
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from warehouse_viewer.json_text import dumps

UPDATE, TEXT = 1, 4
LEVEL = 6  # of zlib; 1 is a third faster and a fifth larger
COMPRESSOR = 1 << 18  # memory of a compressor [bytes]
MOST_MARKS = 50  # of a chunk
MOST_BYTES = 256 << 20  # of a chunk, decompressed
_HEAD = struct.Struct("<IId")


@dataclass(frozen=True)
class Mark:
    """A moment that a person may look for: a trouble of a model, or an alarm."""

    time: float  # simulated [s]
    kind: str
    model: str
    text: str


@dataclass(frozen=True)
class Chunk:
    """The description of a chunk: its number, that of its scene, when it begins and ends
    (simulated [s]), when it began on the clock on the wall (seconds since 1970; None: unknown),
    its marks, and its data, compressed."""

    number: int
    scene: int
    begin: float
    end: float
    wall: float | None
    marks: tuple[Mark, ...]
    data: bytes


class OpenChunk:
    """A chunk to which is still added. It is compressed as it grows: all of it as it came, kept
    until its end, would be the most that the last hour takes of a large warehouse, and would leave
    as much free memory between what stays."""

    def __init__(self, scene: int, begin: float, wall: float | None) -> None:
        self.scene, self.begin, self.end, self.wall = scene, begin, begin, wall
        self._deflate, self._data = zlib.compressobj(LEVEL), bytearray()
        self._marks: list[Mark] = []

    @property
    def size(self) -> int:
        """How much memory it takes [bytes]."""
        return COMPRESSOR + len(self._data)

    def add_update(self, stamp: float, data: bytes) -> None:
        """Adds an update; `stamp` is in simulated time [s]."""
        self._add(UPDATE, stamp, data)

    def add_text(self, stamp: float, message: dict[str, Any]) -> None:
        """Adds a message that JSON can say; `stamp` is in simulated time [s]."""
        self._add(TEXT, stamp, dumps(message).encode())

    def add_marks(self, marks: Sequence[Mark]) -> None:
        """Adds marks, up to MOST_MARKS of them."""
        self._marks += marks[: MOST_MARKS - len(self._marks)]

    def _add(self, kind: int, stamp: float, data: bytes) -> None:
        for part in (_HEAD.pack(kind, len(data), stamp), data, bytes(-len(data) % 8)):
            self._data += self._deflate.compress(part)
        self.end = max(self.end, stamp)

    def packed(self, number: int) -> Chunk:
        """Returns the Chunk as it is now."""
        data = bytes(self._data) + self._deflate.copy().flush()
        return Chunk(number, self.scene, self.begin, self.end, self.wall, tuple(self._marks), data)


def messages(data: bytes) -> list[tuple[int, float, bytes]]:
    """Returns (kind, stamp [s], message) of each message in a decompressed chunk.

    Raises ValueError where a message is cut off.
    """
    out, at = [], 0
    while at < len(data):
        if at + _HEAD.size > len(data):
            raise ValueError(f"byte {at}: the head of a message was expected")
        kind, length, stamp = _HEAD.unpack_from(data, at)
        at += _HEAD.size
        if at + length > len(data):
            raise ValueError(f"byte {at}: {length} bytes of a message were expected")
        out.append((kind, stamp, data[at : at + length]))
        at += length + -length % 8
    return out


def unpacked(data: bytes, most: int = MOST_BYTES) -> bytes:
    """Returns what was compressed. Raises ValueError if it is damaged, or above `most` bytes."""
    inflate = zlib.decompressobj()
    try:
        out = inflate.decompress(data, most)
    except zlib.error as error:
        raise ValueError(f"compressed data were expected: {error}") from error
    if inflate.unconsumed_tail or not inflate.eof:
        raise ValueError(f"whole compressed data of {most} bytes at most were expected")
    return out
