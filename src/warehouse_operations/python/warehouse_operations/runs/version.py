# SPDX-License-Identifier: Apache-2.0
"""The version of the project."""

import functools
import importlib.metadata
import xml.etree.ElementTree as ElementTree

from warehouse_layout.file import files

WHEEL = "kiva-warehouse"


@functools.cache
def version() -> str:
    """Returns the version, of package.xml or of the wheel; "" where neither is there."""
    try:
        return ElementTree.parse(files.share(__file__) / "package.xml").findtext("version") or ""
    except OSError:
        pass
    try:
        return importlib.metadata.version(WHEEL)
    except importlib.metadata.PackageNotFoundError:
        return ""
