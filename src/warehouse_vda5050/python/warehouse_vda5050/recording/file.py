# SPDX-License-Identifier: Apache-2.0
"""A file of recorded messages: JSON lines, compressed by zstd."""

import io
from collections.abc import Iterator
from pathlib import Path
from typing import cast

import zstandard

from warehouse_layout.file import user_file
from warehouse_vda5050.recording.entry import Entry, EntryError, read_line

LEVEL = 6  # of compression
MOST_LINE = 4 << 20  # bytes


class RecordingError(ValueError):
    """A file that can't be read; the message names file and line."""


class Writer:
    """Writes a new file; what flush() has written can be read even if the program is killed. Raises
    OSError (the file is there already)."""

    def __init__(self, path: Path) -> None:
        self._file = path.open("xb")
        compressor = zstandard.ZstdCompressor(level=LEVEL)
        self._stream = compressor.stream_writer(self._file, closefd=False)

    def write(self, entry: Entry) -> None:
        """Adds a message. Raises OSError."""
        self._stream.write(entry.line().encode("utf-8", "surrogatepass") + b"\n")

    def flush(self) -> None:
        """Puts all of it into the file. Raises OSError."""
        self._stream.flush(zstandard.FLUSH_BLOCK)
        self._file.flush()

    def close(self) -> int:
        """Ends the file; returns its size in bytes. Raises OSError."""
        self._stream.close()
        size = self._file.tell()
        self._file.close()
        return size


def read(path: Path) -> Iterator[Entry]:
    """Yields the messages of a file; one that was cut off ends after its last whole line. Raises
    RecordingError, OSError."""
    with user_file.opened(path, None) as file:
        decompressor = zstandard.ZstdDecompressor()
        stream = decompressor.stream_reader(file, read_across_frames=True)
        lines, number = io.BufferedReader(cast(io.RawIOBase, stream), 1 << 16), 0
        while True:
            number += 1
            try:
                line = lines.readline(MOST_LINE)
            except zstandard.ZstdError as error:
                raise RecordingError(f"{path}:{number}: no zstd: {error}") from None
            if not line.endswith(b"\n"):
                if len(line) == MOST_LINE:
                    raise RecordingError(f"{path}:{number}: longer than {MOST_LINE} bytes")
                return
            yield _entry(f"{path}:{number}", line)


def _entry(where: str, line: bytes) -> Entry:
    try:
        return read_line(line.decode())
    except (EntryError, UnicodeDecodeError) as error:
        raise RecordingError(f"{where}: {error}") from None
