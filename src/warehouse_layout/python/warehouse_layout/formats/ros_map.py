# SPDX-License-Identifier: Apache-2.0
"""Maps of ROS's map_server: a YAML file that names a picture and says how to read it.

Such maps are mostly made by SLAM: walls waver and lie askew, specks are noise. The picture is
turned until its walls lie along the axes, specks are left out, and a cell with a wall in it becomes
a wall. What was never seen is not a floor.
"""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from warehouse_layout import layout_file as lf
from warehouse_layout.formats import images, map_cells, straight
from warehouse_layout.formats.common import (
    FormatError,
    PathName,
    check_spacing,
    plural,
    text_of,
    trimmed,
)
from warehouse_layout.formats.map_cells import Picture
from warehouse_layout.layout_file import LayoutFile

SPECK = 0.12  # what is smaller than this along x and y is noise [m]
OFF = 1.5  # pixels that walls are off their axis at their ends, at most, where an angle was found
CLEAR = math.radians(0.5)  # an angle that is right within this is told without a doubt
ISLAND = 4  # cells of floor that are joined to no other: fewer are noise

MODES = ("trinary", "scale", "raw")


def read(
    path: PathName, spacing: float | None = None, angle: float | None = None
) -> tuple[LayoutFile, list[str]]:
    """Returns the layout of a map, and what was changed.

    `spacing` is the edge of a cell [m], 1 m by default; `angle` [rad] by which the map is turned
    about z, by default as its walls lie. Raises FormatError.
    """
    spacing = check_spacing(path, spacing)
    picture, specks = _without_specks(_picture(Path(path)))
    if not picture.free.any():
        raise FormatError(f"{path}: no pixel is free: see negate, free_thresh and the picture")
    within = 0.0
    if angle is None:
        angle, within = _angle(picture)
    floor = map_cells.floor_of(path, picture, angle, spacing)
    floor, islands = _without_islands(floor)
    told = [f"turned by {math.degrees(angle):.2f} degrees{_doubt(within)}"] if angle else []
    told += [f"{plural(specks, 'speck')} of noise left out"] if specks else []
    told += (
        [f"{plural(islands, 'cell')} of floor without a way to the others left out"]
        if islands
        else []
    )
    if not (floor == lf.FLOOR).any():
        raise FormatError(f"{path}: no cell is free; a smaller spacing might find some")
    return trimmed(LayoutFile(floor=floor, spacing=spacing)), told


# --- the file


def _picture(path: Path) -> Picture:
    told = _mapping(path)
    resolution = _number(path, told, "resolution", None, 1e-4, 10)
    occupied = _number(path, told, "occupied_thresh", 0.65, 0, 1)
    free = _number(path, told, "free_thresh", 0.196, 0, 1)
    negate = _number(path, told, "negate", 0, 0, 1)
    if told.get("mode", MODES[0]) not in MODES:
        raise FormatError(f"{path}: mode is {told['mode']!r}; {', '.join(MODES)} are known")
    grey = images.read(_image(path, told))[::-1]
    chance = grey if negate else 1 - grey
    return Picture(resolution, _yaw(path, told), chance > occupied, chance < free)


def _mapping(path: Path) -> dict[str, Any]:
    text = text_of(path)
    try:
        told = yaml.safe_load(text)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f":{mark.line + 1}" if mark else ""
        raise FormatError(f"{path}{place}: is not YAML: {error.problem}") from error
    except (yaml.YAMLError, ValueError) as error:
        raise FormatError(f"{path}: is not YAML: {' '.join(str(error).split())}") from error
    if not isinstance(told, dict) or "image" not in told:
        raise FormatError(f"{path}: image is missing; a map.yaml of map_server was expected")
    return told


def _image(path: Path, told: dict[str, Any]) -> Path:
    name = told["image"]
    if not isinstance(name, str) or not name or "\0" in name:
        raise FormatError(f"{path}: image is {name!r}; the name of a file was expected")
    return path.parent / Path(name)


def _number(
    path: Path, told: dict[str, Any], name: str, default: float | None, low: float, high: float
) -> float:
    value = told.get(name, default)
    if not isinstance(value, (int, float)) or not low <= value <= high:
        raise FormatError(
            f"{path}: {name} is {value!r}; a number from {low:g} to {high:g} was expected"
        )
    return float(value)


def _yaw(path: Path, told: dict[str, Any]) -> float:
    origin = told.get("origin", [0, 0, 0])
    fine = isinstance(origin, list) and len(origin) == 3
    if not fine or not all(isinstance(v, (int, float)) and math.isfinite(v) for v in origin):
        raise FormatError(f"{path}: origin is {origin!r}; x, y [m] and yaw [rad] were expected")
    return float(origin[2])


# --- the picture


def _without_specks(picture: Picture) -> tuple[Picture, int]:
    """Returns the picture with specks of noise made free, and how many there were."""
    from scipy import ndimage

    labels, count = ndimage.label(picture.occupied, np.ones((3, 3)))
    least = SPECK / picture.resolution
    keep = np.zeros(count + 1, bool)
    for number, part in enumerate(ndimage.find_objects(labels), 1):
        keep[number] = max(s.stop - s.start for s in part) >= least
    occupied = keep[labels]
    free = picture.free | (picture.occupied & ~occupied)
    return replace(picture, occupied=occupied, free=free), count - int(keep.sum())


def _angle(picture: Picture) -> tuple[float, float]:
    """Returns the angle [rad] by which the picture must be turned, as its walls lie, and within
    which [rad] that is right."""
    count = int(np.count_nonzero(picture.occupied))
    every = max(1, count // straight.MOST_POINTS)
    points = list(picture.points(picture.occupied, every))
    if not points:
        return 0.0, 0.0
    angle = straight.angle_of(points[0], picture.resolution)
    longest = np.ptp(straight.turned(points[0], angle), axis=0).max()
    return angle, math.atan2(OFF * picture.resolution, longest)


def _doubt(within: float) -> str:
    """Returns what is added to an angle that is right within another [rad]."""
    if within < CLEAR:
        return ""
    return f", give or take {math.degrees(within):.1f}: the picture is small; --angle sets it"


def _without_islands(floor: np.ndarray) -> tuple[np.ndarray, int]:
    """Returns the floor without small parts that nothing leads to, and how many cells they had."""
    from scipy import ndimage

    labels, _ = ndimage.label(floor == lf.FLOOR)
    sizes = np.bincount(labels.ravel())
    small = (sizes < min(ISLAND, sizes[1:].max(initial=0)))[labels] & (labels > 0)
    out = floor.copy()
    out[small] = lf.NO_FLOOR
    return out, int(small.sum())
