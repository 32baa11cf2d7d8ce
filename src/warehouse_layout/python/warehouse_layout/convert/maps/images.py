# SPDX-License-Identifier: Apache-2.0
"""Reads pictures of maps, as grey values and transparency: PGM (P2 and P5), PNG, BMP and what else
Pillow reads."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from warehouse_layout.convert.common import FormatError, bytes_of

MOST_PIXELS = 64_000_000
DEEP = ("I", "F")  # Pillow's modes of more than 8 bits a pixel begin with these
_TOKEN = re.compile(rb"(?:\s|#[^\n]*\n)*([^\s#]+)")


@dataclass(frozen=True, eq=False)
class Pixels:
    """A picture, row 0 the highest: grey values (h, w) from 0, black, to 1, white; opacity (h, w)
    from 0 to 1, None where the picture has none."""

    grey: np.ndarray
    opacity: np.ndarray | None = None


def read(path: Path) -> Pixels:
    """Returns a picture. Raises FormatError."""
    data = bytes_of(path)
    if data[:2] in (b"P2", b"P5"):
        return Pixels(_pgm(path, data))
    return _of_pillow(path, data)


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
    numbers, at = [], 2
    for what, most in (("width", MOST_PIXELS), ("height", MOST_PIXELS), ("white", 65535)):
        match = _TOKEN.match(data, at)
        text = match.group(1) if match else b""
        if not text.isdigit() or len(text) > 9 or not 0 < int(text) <= most:
            raise FormatError(
                f"{path}: {what} is {text[:20].decode('latin-1')!r}; a number from 1 to {most} was"
                " expected"
            )
        assert match
        numbers.append(int(text))
        at = match.end()
    _check_pixels(path, numbers[0], numbers[1])
    return numbers[0], numbers[1], numbers[2], at


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


def _of_pillow(path: Path, data: bytes) -> Pixels:
    from PIL import Image, UnidentifiedImageError

    try:
        with Image.open(path) as picture:
            _check_pixels(path, *picture.size)
            return _pixels(picture)
    except FormatError:
        raise
    except UnidentifiedImageError as error:
        if data[:8] == b"\x89PNG\r\n\x1a\n":
            raise FormatError(f"{path}: the PNG can't be read: {error}") from error
        raise FormatError(
            f"{path}: begins with {data[:4]!r}; a PGM (P2, P5), BMP or PNG was expected"
        ) from error
    # Pillow raises these for what is broken.
    except (OSError, SyntaxError, ValueError, Image.DecompressionBombError) as error:
        raise FormatError(f"{path}: the picture can't be read: {error}") from error


def _pixels(picture: Any) -> Pixels:
    if picture.mode.startswith(DEEP):
        values = np.asarray(picture, np.float32)
        return Pixels(values / np.float32(65535 if picture.mode.startswith("I") else 1))
    is_clear = picture.mode in ("RGBA", "LA", "PA") or "transparency" in picture.info
    colours = np.asarray(picture.convert("RGBA" if is_clear else "RGB"), np.float32) / 255
    return Pixels(colours[:, :, :3].mean(axis=2), colours[:, :, 3] if is_clear else None)
