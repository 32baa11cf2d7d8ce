# SPDX-License-Identifier: Apache-2.0
"""Detects the formats of files by their content, since names may be wrong."""

import re
import zipfile
from pathlib import Path
from typing import Any

import yaml

HEAD = 65_536  # bytes that are looked at
_ROOT = re.compile(r"<(?![?!])(?:[\w.-]+:)?([\w.-]+)")  # the first element
_COMMENTS = re.compile(r"<!--.*?(?:-->|$)", re.DOTALL)
# The root of an XML file, and the module that reads it.
ROOTS = {
    "sdf": "convert.from_world",
    "Instance": "convert.rawsim.xinst",
    "LayoutConfiguration": "convert.rawsim.xlayo",
    "model": "convert.graphs.opentcs",
}
_DXF = re.compile(r"(?:\s*999\r?\n[^\n]*\n)*\s*0\r?\n\s*SECTION\s")
_GRID = re.compile(r"(?:type|height|width)[ \t]+\S")
_KEY = re.compile(r"^(layout|image)\s*:", re.MULTILINE)
KEYS = {"layout": "file.layout_file", "image": "convert.maps.ros_map"}
_LIF = re.compile(r'"(?:layouts|metaInformation|origins)"\s*:')


def module_of(path: Path) -> str:
    """Returns the name of the module that reads a file's content; "" if no format matches."""
    try:
        with open(path, "rb") as file:
            data = file.read(HEAD)
    except OSError:
        return ""
    if data.startswith(b"AutoCAD Binary DXF"):
        return "convert.dxf.drawing"
    if data.startswith(b"PK") and _is_workbook(path):
        return "convert.maps.grid_table"
    text = data.decode("utf-8-sig", "ignore").lstrip("\ufeff")
    stripped = _COMMENTS.sub("", text).lstrip()
    if stripped.startswith("<"):
        root = _ROOT.search(stripped)
        return ROOTS.get(root[1], "") if root else ""
    if stripped.startswith(("{", "[")):
        return "convert.graphs.lif" if _LIF.search(text) else ""
    if _DXF.match(text):
        return "convert.dxf.drawing"
    if _GRID.match(text):
        return "convert.maps.grid_map"
    key = _KEY.search(text)
    return KEYS[key[1]] if key and _is_mapping(text) else ""


def _is_workbook(path: Path) -> bool:
    try:
        with zipfile.ZipFile(path) as archive:
            return "xl/workbook.xml" in archive.namelist()
    except (zipfile.BadZipFile, OSError):
        return False


def _is_mapping(text: str) -> bool:
    """Returns whether a text begins as a mapping in YAML does."""
    try:
        events: Any = yaml.parse(text)
        kinds = [type(next(events)) for _ in range(3)]
    except (yaml.YAMLError, StopIteration, ValueError):
        return False
    return yaml.MappingStartEvent in kinds
