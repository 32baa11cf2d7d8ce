# SPDX-License-Identifier: Apache-2.0
"""Finds what to play: a recording, the folder of a run with one, or a bag."""

from pathlib import Path

from warehouse_layout.cli.progress_line import ProgressLine
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
    """Tells how much of a bag is read."""

    def __init__(self, name: str) -> None:
        self._name, self._line = name, ProgressLine()

    def __call__(self, part: float) -> None:
        """Shows the part that is done, 0 … 1, if it is time to."""
        if self._line.is_due():
            self._line.show(part, f"{self._name}: {part:.0%} read")

    def end(self) -> None:
        """Takes the line away."""
        self._line.clear()
