# SPDX-License-Identifier: Apache-2.0
"""Where the package's own files are, in the source tree or where it was installed; without ROS."""

import xml.etree.ElementTree as ElementTree
from pathlib import Path

_HERE = Path(__file__).resolve()


def share():
    """The folder with launch/, worlds/ and web/; of a wheel with worlds/ and web/."""
    packaged = _HERE.parent / "share"
    if packaged.is_dir():
        return packaged
    source, installed = _HERE.parents[2], _HERE.parents[4] / "share" / "warehouse_sim"
    return installed if installed.is_dir() else source


def model(name):
    """The SDF file of one of worlds/models."""
    return share() / "worlds" / "models" / name / "model.sdf"


def box_size(name):
    """Edges of the one box that a model's collision is (x, y, z) [m]."""
    size = ElementTree.parse(model(name)).findtext(".//collision/geometry/box/size")
    return tuple(map(float, size.split()))
