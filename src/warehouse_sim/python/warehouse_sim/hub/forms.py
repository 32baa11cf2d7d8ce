# SPDX-License-Identifier: Apache-2.0
"""The arguments of the launch files as fields of a form, with their documentation."""

import functools
import xml.etree.ElementTree as ElementTree
from typing import Any

from warehouse_layout.file import files
from warehouse_sim import launching
from warehouse_sim.hub.wish import DEFAULT_FILE, FILES, known_arguments
from warehouse_sim.launch_arguments import CHOICES


@functools.cache
def arguments() -> dict[str, Any]:
    """Returns {"worlds": names, "arguments": rows}.

    A row: name, documentation, default, choices (of a text; [] if any), files that take it.
    """
    rows: dict[str, dict[str, Any]] = {}
    for file in (DEFAULT_FILE, *FILES.values()):
        known = known_arguments(file)
        for element in _elements(file) | _elements(DEFAULT_FILE):
            name = element.get("name", "")
            if name in known:
                row = rows.setdefault(name, _row(name, element))
                row["files"] = sorted({*row["files"], file})
    realism = sorted(path.stem for path in (files.worlds() / "realism").glob("*.yaml"))
    if "realism" in rows:
        rows["realism"]["choices"] = ["", *realism]
    worlds = sorted(path.stem for path in files.worlds().glob("*.sdf"))
    return {"worlds": worlds, "arguments": [rows[name] for name in sorted(rows)]}


def _elements(file: str) -> dict[ElementTree.Element, None]:
    root = ElementTree.parse(launching.SHARE / "launch" / file).getroot()
    return {element: None for element in root.findall("arg") if "value" not in element.attrib}


def _row(name: str, element: ElementTree.Element) -> dict[str, Any]:
    default = element.get("default", "")
    return {
        "name": name,
        "documentation": element.get("doc", ""),
        "default": "" if default.startswith("$(") else default,
        "choices": [*CHOICES.get(name, ())],
        "files": [],
    }
