# SPDX-License-Identifier: Apache-2.0
"""The last hour of a running warehouse, in memory that is bounded."""

import secrets
import zlib
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from warehouse_viewer.replay.chunk import Chunk

SECONDS = 3600.0  # that are kept [s, simulated]
MOST_BYTES = 192 << 20  # of compressed chunks and scenes


class MemoryStore:
    """Chunks of a recording in memory, the oldest of which are dropped. One thread at a time.

    about: what a person wants to know of the recording. cut: nothing is ever missing at the end.
    """

    cut = ""

    def __init__(self, seconds: float = SECONDS, most_bytes: int = MOST_BYTES) -> None:
        self._seconds, self._most_bytes = seconds, most_bytes
        self._chunks: dict[int, Chunk] = {}
        self._scenes: dict[int, bytes] = {}
        self._numbers = 0
        self.id = secrets.token_hex(4)
        self.about: dict[str, Any] = {}

    # --- writing
    def add_scene(self, text: str) -> int:
        """Keeps a scene, JSON; returns its number."""
        number = self._next()
        self._scenes[number] = zlib.compress(text.encode())
        return number

    def add(self, chunk: Chunk) -> None:
        """Keeps a chunk of the number next_number(), and drops what is too old or too much."""
        self._next()
        self._chunks[chunk.number] = chunk
        while len(self._chunks) > 1 and self._has_too_much(chunk.end):
            del self._chunks[next(iter(self._chunks))]
        self._drop_scenes(chunk.scene)

    def next_number(self) -> int:
        """Returns the number of the next chunk."""
        return self._numbers + 1

    def forget_after(self, time: float) -> None:
        """Drops what comes after a simulated time [s]: the world went back to it."""
        kept = [chunk for chunk in self._chunks.values() if chunk.begin < time]
        self._chunks = {c.number: replace(c, end=min(c.end, time)) for c in kept}

    def close(self) -> None:
        """Does nothing: memory needs no end."""

    def _next(self) -> int:
        self._numbers += 1
        return self._numbers

    def _has_too_much(self, end: float) -> bool:
        oldest = next(iter(self._chunks.values()))
        return end - oldest.end > self._seconds or self.size > self._most_bytes

    def _drop_scenes(self, newest: int) -> None:
        used = {chunk.scene for chunk in self._chunks.values()} | {newest}
        self._scenes = {n: data for n, data in self._scenes.items() if n in used}

    # --- reading
    @property
    def size(self) -> int:
        """How much memory chunks and scenes take [bytes]. Any thread may ask."""
        chunks = sum(len(chunk.data) for chunk in list(self._chunks.values()))
        return chunks + sum(map(len, list(self._scenes.values())))

    @property
    def chunks(self) -> Sequence[Chunk]:
        """All chunks, the oldest first."""
        return list(self._chunks.values())

    def chunk_data(self, number: int) -> bytes:
        """Returns a chunk's data, compressed. Raises KeyError if there is none."""
        return self._chunks[number].data

    def scene_data(self, number: int) -> bytes:
        """Returns a scene's JSON, compressed. Raises KeyError if there is none."""
        return self._scenes[number]
