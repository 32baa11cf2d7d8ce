# SPDX-License-Identifier: Apache-2.0
"""Reads pictures of maps: PGM (P2 and P5) and PNG, as grey values from 0 (black) to 1 (white)."""

import re
from pathlib import Path

import numpy as np

from warehouse_layout.formats.common import FormatError, bytes_of

MOST_PIXELS = 64_000_000
_TOKEN = re.compile(rb"(?:\s|#[^\n]*\n)*([^\s#]+)")


def read(path: Path) -> np.ndarray:
    """Returns the grey values (h, w) of a picture, row 0 the highest. Raises FormatError."""
    data = bytes_of(path)
    if data[:2] in (b"P2", b"P5"):
        return _pgm(path, data)
    if data[:8] == b"\x89PNG\r\n\x1a\n":
        return _png(path)
    raise FormatError(f"{path}: begins with {data[:4]!r}; a PGM (P2, P5) or PNG was expected")


def _pgm(path: Path, data: bytes) -> np.ndarray:
    width, height, most, begin = _header(path, data)
    count = width * height
    if data[:2] == b"P2":
        values = _numbers(path, data[begin:])
    else:
        kind = np.dtype(">u1" if most < 256 else ">u2")
        pixels = data[begin + 1 :]
        values = np.frombuffer(pixels[: len(pixels) // kind.itemsize * kind.itemsize], kind)
    if len(values) < count:
        raise FormatError(f"{path}: {len(values)} pixels; {width} x {height} were expected")
    return np.minimum(values[:count].reshape(height, width) / np.float32(most), 1)


def _header(path: Path, data: bytes) -> tuple[int, int, int, int]:
    """Returns width, height, the value of white, and where the header ends."""
    found, at = [], 2
    for what, most in (("width", MOST_PIXELS), ("height", MOST_PIXELS), ("white", 65535)):
        match = _TOKEN.match(data, at)
        text = match.group(1) if match else b""
        if not text.isdigit() or len(text) > 9 or not 0 < int(text) <= most:
            raise FormatError(
                f"{path}: {what} is {text[:20].decode('latin-1')!r}; a number from 1 to {most} was"
                " expected"
            )
        assert match
        found.append(int(text))
        at = match.end()
    _check_pixels(path, found[0], found[1])
    return found[0], found[1], found[2], at


def _numbers(path: Path, text: bytes) -> np.ndarray:
    try:
        values = np.array(re.sub(rb"#[^\n]*", b"", text).split(), np.float32)
    except ValueError as error:
        raise FormatError(f"{path}: a pixel is not a number: {error}") from error
    if not (values >= 0).all():
        raise FormatError(f"{path}: a pixel is below 0")
    return values


def _check_pixels(path: Path, width: int, height: int) -> None:
    if width * height > MOST_PIXELS:
        raise FormatError(f"{path}: {width} x {height} pixels; {MOST_PIXELS} at most were expected")


def _png(path: Path) -> np.ndarray:
    from PIL import Image

    try:
        with Image.open(path) as picture:
            _check_pixels(path, *picture.size)
            colours = np.asarray(picture.convert("RGB"), np.float32)
    except FormatError:
        raise
    # Pillow raises these for what is broken.
    except (OSError, SyntaxError, ValueError, Image.DecompressionBombError) as error:
        raise FormatError(f"{path}: the PNG can't be read: {error}") from error
    return colours.mean(axis=2) / 255
