# SPDX-License-Identifier: Apache-2.0
"""Finds what to play: a recording, the folder of a run with one, or a bag."""

import sys
import time
from pathlib import Path
from typing import TextIO

from warehouse_viewer.replay.blocks import RecordingError
from warehouse_viewer.replay.file import NAME, FileRecording

BAG = ".bag"


def open_recording(path: Path, made: Path, progress: "Progress | None" = None) -> FileRecording:
    """Returns the recording at a path; a bag is converted into the folder `made` first.

    Raises RecordingError.
    """
    if path.is_dir():
        if not (path / NAME).is_file():
            raise RecordingError(
                f"{path}: no {NAME} in it; a folder of `simulate --record` was expected"
            )
        return FileRecording(path / NAME)
    if not path.exists():
        raise RecordingError(f"{path}: no such file or folder")
    if path.suffix != BAG:
        return FileRecording(path)
    return FileRecording(_converted(path, made, progress or Progress(path.name)))


def _converted(bag: Path, made: Path, progress: "Progress") -> Path:
    try:
        from warehouse_viewer.replay.bag import convert
    except ImportError as error:
        raise RecordingError(f"{bag}: bags need ROS's Python packages: {error}") from error
    path = made / NAME
    convert(bag, path, progress)
    progress.end()
    return path


class Progress:
    """Prints on a terminal how much of a bag is read; elsewhere nothing."""

    PERIOD = 0.2  # [s, wall]

    def __init__(self, name: str, stream: TextIO = sys.stderr) -> None:
        self._name, self._stream, self._next = name, stream, 0.0

    def __call__(self, part: float) -> None:
        """Shows the part that is done, 0 … 1."""
        if self._stream.isatty() and time.monotonic() >= self._next:
            self._next = time.monotonic() + self.PERIOD
            self._stream.write(f"\r{self._name}: {part:4.0%} read\033[K")
            self._stream.flush()

    def end(self) -> None:
        """Ends the line."""
        if self._stream.isatty():
            self._stream.write(f"\r{self._name}: read\033[K\n")
