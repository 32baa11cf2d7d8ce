# SPDX-License-Identifier: Apache-2.0
"""Layouts that came over HTTP, kept as files for the nodes that build and run them."""

import hashlib
import re
from dataclasses import replace
from pathlib import Path

import rospkg

from warehouse_layout.file import layout_file
from warehouse_layout.file.layout_file import SUFFIX, LayoutFileError
from warehouse_layout.generate import layout_choice

FOLDER = Path("warehouse", "layouts")  # below ROS_HOME


def kept(text: str, name: str = "") -> str:
    """Returns the path of the file of a layout's text; a `name` replaces the one in it.

    Equal texts have one file. Raises LayoutFileError with a sentence a line where no fleet can work
    there.
    """
    file = layout_file.parse(text)
    folder = Path(rospkg.get_ros_home()) / FOLDER
    # Files that it names are beside the one in which it will be.
    file = replace(file, name=name or file.name, path=str(folder / "layout"))
    try:
        layout_choice.check(file)
    except LayoutFileError as error:
        raise LayoutFileError(str(error).replace(f"{file.path}: ", "layout: ")) from error
    text = layout_file.text_of(file)
    path = folder / f"{_stem(file.title)}-{hashlib.sha256(text.encode()).hexdigest()[:8]}{SUFFIX}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise LayoutFileError(f"{folder}: {error.strerror}") from error
    layout_file.write(file, path)
    return str(path)


def _stem(title: str) -> str:
    return re.sub(r"[^A-Za-z0-9_-]+", "-", title)[:40].strip("-") or "layout"
