# SPDX-License-Identifier: Apache-2.0
"""A screen that no monitor shows, for programs with windows, and pictures of it."""

import io
import struct
from contextlib import contextmanager
from pathlib import Path

import running
from PIL import Image

# Of a file in X's window dump format: 32-bit numbers, big-endian.
HEADER_SIZE, WIDTH, HEIGHT, LINE_BYTES, COLOURS = 0, 4, 5, 12, 19
COLOUR_BYTES = 12


class Screen:
    """Its name for DISPLAY, and what it shows."""

    def __init__(self, name: str, file: Path) -> None:
        self.name, self._file = name, file

    def picture(self) -> bytes:
        """Returns what it shows, as PNG."""
        data = self._file.read_bytes()
        header = struct.unpack(">25I", data[:100])
        begin = header[HEADER_SIZE] + COLOUR_BYTES * header[COLOURS]
        size, line = (header[WIDTH], header[HEIGHT]), header[LINE_BYTES]
        out = io.BytesIO()
        Image.frombytes("RGB", size, data[begin:], "raw", "BGRX", line).save(out, "PNG")
        return out.getvalue()


@contextmanager
def screen(folder: Path, width: int, height: int):
    """A screen of Xvfb's [px]; its number is the first that is free."""
    file = folder / "Xvfb_screen0"
    arguments = ("-displayfd", 1, "-screen", 0, f"{width}x{height}x24", "-fbdir", folder)
    with running.process("Xvfb", *arguments, stdout=-1, stderr=-3) as server:
        number = server.stdout.readline().strip()
        running.wait(file.exists, "a screen")
        yield Screen(f":{number}", file)
