# SPDX-License-Identifier: Apache-2.0
"""Finds the files of a package, in the source tree or where it was installed; without ROS."""

import xml.etree.ElementTree as ElementTree
from pathlib import Path


def share(module: str) -> Path:
    """Returns the folder of the files beside a package's Python code.

    `module` is the __file__ of one of the package's own modules. In a wheel the folder lies within
    the package.
    """
    package = Path(module).resolve().parent
    while (package.parent / "__init__.py").exists():
        package = package.parent
    packaged = package / "share"
    if packaged.is_dir():
        return packaged
    installed = package.parents[3] / "share" / package.name
    return installed if installed.is_dir() else package.parents[1]


def worlds() -> Path:
    """Returns the folder of world files, with their models/ and realism/."""
    return share(__file__) / "worlds"


def model(name: str) -> Path:
    """Returns the path of the SDF file of one of worlds/models."""
    return worlds() / "models" / name / "model.sdf"


def box_size(name: str) -> tuple[float, ...]:
    """Returns the edges (x, y, z) [m] of the box in a model's collision. Raises ValueError."""
    size = ElementTree.parse(model(name)).findtext(".//collision/geometry/box/size")
    if size is None:
        raise ValueError(f"the model {name} has no collision with a box")
    return tuple(map(float, size.split()))
