# SPDX-License-Identifier: Apache-2.0
"""The blocks of a recording's file, little-endian:

    8 bytes        kivarec1, once
    then blocks    4 bytes what: HEAD, SCEN, CHNK or DONE
                   u32 CRC-32 of all that follows the head
                   u32 length of the JSON in it, u64 length of the data after that [bytes]
                   …   JSON in UTF-8, then data compressed by zlib

HEAD comes first and describes the whole; SCEN is a scene as JSON, CHNK a stretch as in chunk.py.
DONE ends a recording that is whole: one without it was cut off, and is played up to there.
"""

import json
import os
import struct
import zlib
from typing import Any, BinaryIO, NamedTuple

MAGIC = b"kivarec1"
HEAD, SCENE, CHUNK, DONE = b"HEAD", b"SCEN", b"CHNK", b"DONE"
MOST_JSON = 1 << 20  # of a block [bytes]
_BLOCK = struct.Struct("<4sIIQ")


class RecordingError(ValueError):
    """A recording can't be written or read; the text names the file and what was expected."""


class Block(NamedTuple):
    """A block: its kind, its description, and where its JSON and data lie [bytes]."""

    what: bytes
    about: Any
    at: int
    crc: int
    json_length: int
    length: int


def write_block(file: BinaryIO, what: bytes, about: object, data: bytes = b"") -> Block:
    """Appends a block to a file; returns it. Raises OSError."""
    text = json.dumps(about, separators=(",", ":")).encode()
    crc = zlib.crc32(data, zlib.crc32(text))
    file.write(_BLOCK.pack(what, crc, len(text), len(data)))
    at = file.tell()
    file.write(text)
    file.write(data)
    return Block(what, about, at, crc, len(text), len(data))


def read_blocks(file: BinaryIO, name: str) -> tuple[list[Block], str]:
    """Returns all blocks of a file without reading their data, and why there are no more: an
    empty text where DONE was reached. Raises RecordingError where it is not a recording."""
    if file.read(len(MAGIC)) != MAGIC:
        raise RecordingError(f"{name}: a recording was expected; this file is not one")
    blocks: list[Block] = []
    size = os.fstat(file.fileno()).st_size
    while not blocks or blocks[-1].what != DONE:
        try:
            blocks.append(_next_block(file, size))
        except ValueError as error:
            return blocks, str(error)
    return blocks, ""


def read_data(file: BinaryIO, block: Block) -> bytes:
    """Returns a block's data, compressed. Raises ValueError if they are damaged."""
    file.seek(block.at)
    text, data = file.read(block.json_length), file.read(block.length)
    if zlib.crc32(data, zlib.crc32(text)) != block.crc:
        raise ValueError(f"byte {block.at}: the block is damaged (its CRC-32 is another)")
    return data


def _next_block(file: BinaryIO, size: int) -> Block:
    begin = file.tell()
    head = file.read(_BLOCK.size)
    if len(head) < _BLOCK.size:
        raise ValueError(f"byte {begin}: it was cut off")
    what, crc, json_length, length = _BLOCK.unpack(head)
    if what not in (HEAD, SCENE, CHUNK, DONE):
        raise ValueError(f"byte {begin}: a block was expected; the file is damaged from there on")
    at = begin + _BLOCK.size
    if json_length > MOST_JSON or at + json_length + length > size:
        raise ValueError(f"byte {begin}: the block reaches beyond the end of the file")
    about = _parsed(file.read(json_length), at)
    file.seek(at + json_length + length)
    return Block(what, about, at, crc, json_length, length)


def _parsed(text: bytes, at: int) -> Any:
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise ValueError(f"byte {at}: JSON was expected: {error}") from error
