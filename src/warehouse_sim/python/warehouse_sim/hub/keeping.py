# SPDX-License-Identifier: Apache-2.0
"""Keeps the last hour of a simulation that is about to end, as a recording in a file."""

import json
import time
import urllib.request
from pathlib import Path
from typing import Any

from warehouse_viewer.replay.blocks import RecordingError
from warehouse_viewer.replay.chunk import Chunk, Mark, unpacked
from warehouse_viewer.replay.file import FileWriter
from warehouse_viewer.server.hub_link import open_here

PATIENCE = 5.0  # for all of it [s, wall]
ERRORS = (RecordingError, OSError, ValueError, KeyError, TypeError)  # of keep()
AS_IT_IS = {"accept-encoding": "deflate"}  # chunks are compressed already


def keep(viewer: str, path: Path, about: dict[str, Any]) -> int:
    """Writes what the pages at `viewer` have recorded into a file.

    Returns its size [bytes], 0 where nothing is recorded. Raises one of ERRORS, and leaves no file
    then.
    """
    end = time.monotonic() + PATIENCE
    index = json.loads(_get(f"{viewer}/recording/index", end))
    if not index["chunks"]:
        return 0
    part = path.with_name(f".{path.name}.part")
    try:
        size = _write(viewer, index, part, about, end)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
    return size


def _write(
    viewer: str, index: dict[str, Any], path: Path, about: dict[str, Any], end: float
) -> int:
    marks = [Mark(*row) for row in index["marks"]]
    writer = FileWriter(path, about)
    scenes: dict[int, int] = {}
    try:
        for number, scene, begin, last, wall in index["chunks"]:
            if scene not in scenes:
                packed = _get(f"{viewer}/recording/scenes/{scene}", end)
                scenes[scene] = writer.add_scene(unpacked(packed).decode())
            data = _get(f"{viewer}/recording/chunks/{number}", end)
            own = tuple(mark for mark in marks if begin <= mark.time <= last)
            at = writer.next_number()
            writer.add(Chunk(at, scenes[scene], begin, last, wall, own, data))
    finally:
        writer.close()
    return writer.size


def _get(url: str, end: float) -> bytes:
    """Returns the body at an address, as it was sent. Raises OSError, also where time is up."""
    left = end - time.monotonic()
    if left <= 0:
        raise TimeoutError(f"the recording was not read within {PATIENCE:g} s")
    with open_here(urllib.request.Request(url, headers=AS_IT_IS), left) as answer:
        return bytes(answer.read())
