# SPDX-License-Identifier: Apache-2.0
"""The recordings that a hub plays, without a simulation that runs.

The last hour of each simulation that was stopped, files and folders of `simulate --record` in
~/.ros/warehouse/recordings, and one that comes with the package: the first view plays that.
"""

import re
from collections import OrderedDict
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

from starlette.types import ASGIApp

from warehouse_viewer.replay import standalone
from warehouse_viewer.replay.blocks import RecordingError
from warehouse_viewer.replay.file import NAME, FileRecording
from warehouse_viewer.shared_files import WEB

EXAMPLE = "at_work"  # can't be a simulation's name
EXAMPLE_FILE = WEB / "recordings" / "at_work.kiva"
SUFFIX = Path(NAME).suffix
KEY = re.compile(r"[A-Za-z0-9][\w.-]{0,79}")
MOST_OPEN = 8  # files
MOST_LISTED = 200


class UnknownRecording(LookupError):  # noqa: N818 (an answer)
    """Raised for the name of no recording."""


class Recordings:
    """Recordings by name. One thread at a time may call.

    folder: of files that people put there; simulations: returns (name, folder) of each simulation.
    """

    def __init__(
        self, folder: Path, simulations: Callable[[], Iterable[tuple[str, Path]]] = lambda: ()
    ) -> None:
        self._folder, self._simulations = folder, simulations
        self._open: OrderedDict[tuple[Path, int], tuple[FileRecording, ASGIApp]] = OrderedDict()

    def rows(self) -> list[dict[str, Any]]:
        """Returns the recordings as the API lists them; those that can't be played with the
        reason."""
        files = [*self._files()][:MOST_LISTED]
        return [self._row(name, path, kind) for name, path, kind in files]

    def application(self, name: str) -> ASGIApp:
        """Returns the pages of a recording. Raises UnknownRecording, RecordingError."""
        for known, path, _ in self._files():
            if known == name:
                return self._opened(path)[1]
        raise UnknownRecording(f"there is no recording '{name[:80]}'")

    def _files(self) -> Iterator[tuple[str, Path, str]]:
        """Yields (name, file, kind) of each recording."""
        if EXAMPLE_FILE.is_file():
            yield EXAMPLE, EXAMPLE_FILE, "example"
        for name, folder in self._simulations():
            if (folder / NAME).is_file():
                yield name, folder / NAME, "simulation"
        for path in sorted(self._folder.glob("*")):
            file = path / NAME if path.is_dir() else path
            # A file's name has a dot, which keeps it apart from those of simulations.
            name = f"{path.name}{SUFFIX}" if path.is_dir() else path.name
            if KEY.fullmatch(name) and file.suffix == SUFFIX and file.is_file():
                yield name, file, "file"

    def _row(self, name: str, path: Path, kind: str) -> dict[str, Any]:
        out: dict[str, Any] = {
            "name": name,
            "kind": kind,
            "url": f"/recordings/{name}/",
            "seconds": 0.0,
            "bytes": 0,
            "time": 0,
            "reason": "",
        }
        try:
            status = path.stat()
            out |= {"bytes": status.st_size, "time": round(status.st_mtime)}
            recording, _ = self._opened(path)
            chunks = recording.chunks
            out["seconds"] = round(chunks[-1].end - chunks[0].begin, 1)
            out["reason"] = recording.cut
        except (OSError, RecordingError) as error:
            out |= {"url": "", "reason": str(error)}
        return out

    def _opened(self, path: Path) -> tuple[FileRecording, ASGIApp]:
        """Returns an open recording; a file that was written again is opened again."""
        try:
            key = path, path.stat().st_mtime_ns
        except OSError as error:
            raise RecordingError(f"{path}: {error.strerror}") from error
        if key not in self._open:
            recording = FileRecording(path)
            self._open[key] = recording, standalone.application(recording)
        self._open.move_to_end(key)
        while len(self._open) > MOST_OPEN:
            self._close(next(iter(self._open)))
        return self._open[key]

    def _close(self, key: tuple[Path, int]) -> None:
        recording, _ = self._open.pop(key)
        with suppress(OSError):
            recording.close()

    def close(self) -> None:
        """Closes all files."""
        for key in [*self._open]:
            self._close(key)
