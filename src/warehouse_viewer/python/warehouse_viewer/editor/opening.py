# SPDX-License-Identifier: Apache-2.0
"""Reads the files that a person opens in the page: layouts, and all that can be converted."""

import base64
import binascii
import importlib
import tempfile
from collections.abc import Mapping
from pathlib import Path, PurePath

from warehouse_layout.file import layout_file
from warehouse_layout.file.layout_file import SUFFIX, LayoutFile, LayoutFileError

COMPANIONS = (".pgm", ".png", ".bmp", ".csv")  # of files that name them; a grid stands alone


def read(path: str | Path) -> tuple[LayoutFile, list[str]]:
    """Reads a layout file, or one of another format, with sentences about what could not be
    carried over. Raises LayoutFileError, or a ValueError for other formats."""
    if str(path).endswith(SUFFIX):
        return layout_file.read(path), []
    try:
        formats = importlib.import_module("warehouse_layout.convert")
    except ImportError as error:
        raise LayoutFileError(
            f"{PurePath(path).name}: only {SUFFIX} files can be opened here: {error}"
        ) from error
    opened_file: tuple[LayoutFile, list[str]] = formats.read(Path(path))
    return opened_file


def opened(files: Mapping[str, str]) -> tuple[LayoutFile, list[str]]:
    """Reads files by name, in base64: one to open, and those that it names (the picture of a map).

    Returns what read() does. Raises LayoutFileError, in which files have their names alone.
    """
    with tempfile.TemporaryDirectory() as folder:
        paths = [_put(Path(folder), name, content) for name, content in files.items()]
        layouts = [path for path in paths if path.suffix.lower() not in COMPANIONS] or paths
        if len(layouts) != 1:
            names = ", ".join(path.name for path in paths) or "nothing"
            raise LayoutFileError(f"one file to open was expected, not {names}")
        try:
            return read(layouts[0])
        except (OSError, ValueError) as error:
            raise LayoutFileError(str(error).replace(f"{folder}/", "")) from error


def _put(folder: Path, name: str, content: str) -> Path:
    """Writes a file into the folder, whatever its name would lead to."""
    path = folder / (PurePath(name.replace("\\", "/")).name or "unnamed")
    try:
        path.write_bytes(base64.b64decode(content, validate=True))
    except (binascii.Error, OSError, ValueError) as error:
        raise LayoutFileError(f"{path.name}: can't be taken: {error}") from error
    return path
