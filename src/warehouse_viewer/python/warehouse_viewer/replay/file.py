# SPDX-License-Identifier: Apache-2.0
"""A recording in a file, written continuously and read a chunk at a time."""

import math
import secrets
import zlib
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

from warehouse_layout.file import user_file
from warehouse_viewer.page import protocol
from warehouse_viewer.replay import blocks
from warehouse_viewer.replay.blocks import Block, RecordingError
from warehouse_viewer.replay.chunk import MOST_MARKS, Chunk, Mark, unpacked

NAME = "recording.kiva"  # in the folder of a run
FIELDS = ("number", "scene", "begin", "end", "wall", "marks")  # of CHNK's JSON
MOST_TEXT = 500  # characters of a mark


class FileWriter:
    """Writes a recording into a file in place of what it held; see recorder.Store.

    about: what a person wants to know of the recording. Raises RecordingError, as all its methods.
    """

    def __init__(self, path: Path, about: dict[str, Any]) -> None:
        self._path, self._numbers, self.size = path, 0, 0
        try:
            self._file = path.open("wb")
        except OSError as error:
            raise RecordingError(f"{path}: {error.strerror}") from error
        self._write_raw(blocks.MAGIC)
        self._write(blocks.HEAD, {"protocol": protocol.VERSION, "about": about})

    def add_scene(self, text: str) -> int:
        """Writes a scene, JSON; returns its number."""
        self._numbers += 1
        self._write(blocks.SCENE, {"number": self._numbers}, zlib.compress(text.encode()))
        return self._numbers

    def next_number(self) -> int:
        """Returns the number of the next chunk."""
        return self._numbers + 1

    def add(self, chunk: Chunk) -> None:
        """Writes a chunk of the number next_number()."""
        self._numbers += 1
        about = asdict(replace(chunk, data=b""))
        del about["data"]
        self._write(blocks.CHUNK, about, chunk.data)

    def forget_after(self, time: float) -> None:
        """Has a reader leave out what came after a simulated time [s]."""
        self._write(blocks.HEAD, {"back_to": time})

    def close(self) -> None:
        """Ends the recording."""
        if not self._file.closed:
            self._write(blocks.DONE, {})
            self._file.close()

    def _write(self, what: bytes, about: object, data: bytes = b"") -> None:
        try:
            blocks.write_block(self._file, what, about, data)
            self._file.flush()
            self.size = self._file.tell()
        except OSError as error:
            raise RecordingError(f"{self._path}: {error.strerror}") from error

    def _write_raw(self, data: bytes) -> None:
        try:
            self._file.write(data)
        except OSError as error:
            raise RecordingError(f"{self._path}: {error.strerror}") from error


class FileRecording:
    """A recording in a file, to be read.

    about: what a person wants to know of it. cut: why it ends before its end; "": it does not.
    Raises RecordingError where there is nothing to play, and where a block is damaged.
    """

    def __init__(self, path: Path) -> None:
        self.path, self.id = path, secrets.token_hex(4)
        self._chunks: dict[int, tuple[Chunk, Block]] = {}
        self._scenes: dict[int, Block] = {}
        self.about: dict[str, Any] = {}
        try:
            self._file = user_file.opened(path, None)
            read, self.cut = blocks.read_blocks(self._file, str(path))
        except OSError as error:
            raise RecordingError(f"{path}: {error.strerror}") from error
        for block in read:
            self._take(block)
        if not self._chunks:
            raise RecordingError(f"{path}: nothing is recorded in it{self._and_why()}")

    @property
    def chunks(self) -> Sequence[Chunk]:
        """All chunks without their data, the oldest first."""
        return [chunk for chunk, _ in self._chunks.values()]

    def chunk_data(self, number: int) -> bytes:
        """Returns a chunk's data, compressed. Raises KeyError if there is none."""
        return self._data(self._chunks[number][1])

    def scene_data(self, number: int) -> bytes:
        """Returns a scene's JSON, compressed. Raises KeyError if there is none."""
        return self._data(self._scenes[number])

    def close(self) -> None:
        """Closes the file."""
        self._file.close()

    def _and_why(self) -> str:
        return f"; {self.cut}" if self.cut else ""

    def _data(self, block: Block) -> bytes:
        try:
            data = blocks.read_data(self._file, block)
            unpacked(data)
        except (OSError, ValueError) as error:
            raise RecordingError(f"{self.path}: {error}") from error
        return data

    def _take(self, block: Block) -> None:
        try:
            self._take_checked(block)
        except (KeyError, TypeError, ValueError) as error:
            reason = error if isinstance(error, RecordingError) else f"{error!r}"
            raise RecordingError(
                f"{self.path}: byte {block.at}: the head of a {block.what.decode()} block was"
                f" expected: {reason}"
            ) from error

    def _take_checked(self, block: Block) -> None:
        about = block.about
        if block.what == blocks.HEAD:
            self._take_head(about)
        elif block.what == blocks.SCENE:
            self._scenes[int(about["number"])] = block
        elif block.what == blocks.CHUNK:
            chunk = _chunk(about)
            if chunk.scene not in self._scenes:
                raise RecordingError(f"scene {chunk.scene} has not come before")
            last = self.chunks[-1].end if self._chunks else -math.inf
            if not last <= chunk.begin <= chunk.end:
                raise RecordingError(f"times from {last} on were expected, not {chunk.begin}")
            self._chunks[chunk.number] = chunk, block

    def _take_head(self, about: dict[str, Any]) -> None:
        if "back_to" in about:
            self._forget_after(_finite(about["back_to"]))
            return
        if about["protocol"] != protocol.VERSION:
            raise RecordingError(
                f"protocol {protocol.VERSION} was expected, not {about['protocol']}: it is of"
                " another version of the warehouse"
            )
        self.about = dict(about["about"])

    def _forget_after(self, time: float) -> None:
        kept = [(chunk, block) for chunk, block in self._chunks.values() if chunk.begin < time]
        self._chunks = {
            chunk.number: (replace(chunk, end=min(chunk.end, time)), block) for chunk, block in kept
        }


def _chunk(about: dict[str, Any]) -> Chunk:
    """Returns a Chunk without data. Raises KeyError, TypeError or ValueError."""
    number, scene, begin, end, wall, marks = (about[name] for name in FIELDS)
    begin, end = _finite(begin), _finite(end)
    wall = None if wall is None else _finite(wall)
    shown = tuple(_mark(mark) for mark in marks[:MOST_MARKS])
    return Chunk(int(number), int(scene), begin, end, wall, shown, b"")


def _mark(about: dict[str, Any]) -> Mark:
    texts = [str(about[name])[:MOST_TEXT] for name in ("kind", "model", "text")]
    return Mark(_finite(about["time"]), *texts)


def _finite(number: float | None) -> float:
    """Returns a number as a float. Raises ValueError if it is no number, or not finite."""
    if isinstance(number, bool) or not isinstance(number, int | float) or not math.isfinite(number):
        raise ValueError(f"a number was expected, not {number!r}")
    return float(number)
