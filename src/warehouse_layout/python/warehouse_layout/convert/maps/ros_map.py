# SPDX-License-Identifier: Apache-2.0
"""Maps of ROS's map_server: a YAML file that names a picture and says how to read it.

Such maps are mostly made by SLAM: walls waver and lie askew, specks are noise. The picture is
turned until its walls lie along the axes, specks are left out, and a cell with a wall in it becomes
a wall. What was never seen is not a floor.
"""

import math
from dataclasses import replace
from pathlib import Path, PureWindowsPath
from typing import Any, NamedTuple

import numpy as np
import yaml

from warehouse_layout.convert import straight
from warehouse_layout.convert.common import (
    FormatError,
    Note,
    PathName,
    check_spacing,
    plural,
    text_of,
    trimmed,
)
from warehouse_layout.convert.maps import images, map_cells
from warehouse_layout.convert.maps.images import Pixels
from warehouse_layout.convert.maps.map_cells import Picture
from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import LayoutFile

SPECK = 0.12  # what is smaller than this along x and y is noise [m]
OFF = 1.5  # pixels that walls are off their axis at their ends, at most, where an angle was found
CLEAR = math.radians(0.5)  # an angle known within this is given without its uncertainty
ISLAND = 4  # cells of floor that are joined to no other: fewer are noise

MODES = TRINARY, SCALE, RAW = "trinary", "scale", "raw"
OCCUPIED, HALF, UNKNOWN = 100, 50, -1  # of what map_server publishes; from HALF on it is a wall
SAVERS = 0, 205, 254  # what map_saver writes: occupied, unknown, free
SAVED = (
    "205 of a picture in 0, 205 and 254 is unknown: {count:,} pixels, which free_thresh {free:g}"
    " would make free"
)


class Thresholds(NamedTuple):
    """Chances from 0 to 1: above `occupied` a pixel is occupied, below `free` it is free."""

    occupied: float
    free: float


def read(
    path: PathName, spacing: float | None = None, angle: float | None = None
) -> tuple[LayoutFile, list[str]]:
    """Returns the layout of a map, and what was changed.

    `spacing` is the edge of a cell [m], 1 m by default; `angle` [rad] by which the map is turned
    about z, by default as its walls lie. Raises FormatError.
    """
    spacing = check_spacing(path, spacing)
    whole, notes = _picture(Path(path))
    picture, specks = _without_specks(whole)
    if not picture.free.any():
        raise FormatError(f"{path}: no pixel is free: see negate, free_thresh and the picture")
    within = 0.0
    if angle is None:
        angle, within = _angle(picture)
    floor, centre = map_cells.floor_of(path, picture, angle, spacing)
    floor, islands = _without_islands(floor)
    remarks = [f"turned by {math.degrees(angle):.2f} degrees{_doubt(within)}"] if angle else []
    remarks += [f"{plural(specks, 'speck')} of noise left out"] if specks else []
    remarks += (
        [f"{plural(islands, 'cell')} of floor without a way to the others left out"]
        if islands
        else []
    )
    if not (floor == lf.FLOOR).any():
        raise FormatError(f"{path}: no cell is free; a smaller spacing might find some")
    at = np.round(centre / spacing) * spacing
    if (shift := np.round(at - centre, 4)).any():
        x, y = shift.tolist()
        remarks.append(f"poses of the map are moved by ({x:+g}, {y:+g}) m, to the middle of cells")
    x, y = np.round(at, 6).tolist()
    return trimmed(LayoutFile(floor=floor, spacing=spacing, at=(x, y))), [*remarks, *notes]


# --- the file


def _picture(path: Path) -> tuple[Picture, list[Note]]:
    fields = _mapping(path)
    resolution = _number(path, fields, "resolution", None, 1e-4, 10)
    thresholds = Thresholds(
        _number(path, fields, "occupied_thresh", 0.65, 0, 1),
        _number(path, fields, "free_thresh", 0.196, 0, 1),
    )
    negate = bool(_number(path, fields, "negate", 0, 0, 1))
    mode = fields.get("mode", TRINARY)
    if mode not in MODES:
        raise FormatError(f"{path}: mode is {mode!r}; {', '.join(MODES)} are known")
    image, notes = _image(path, fields)
    pixels = images.read(image)
    values = occupancy(pixels, mode, negate, thresholds)
    if mode == TRINARY and not negate and (unseen := _saved_as_unknown(pixels)) is not None:
        if (values[unseen] != UNKNOWN).any():
            notes.append(Note(SAVED.format(count=int(unseen.sum()), free=thresholds.free)))
        values[unseen] = UNKNOWN
    notes.append(Note(_counted(values)))
    x, y, yaw = _origin(path, fields)
    values = values[::-1]
    free = (values >= 0) & (values < HALF)
    return Picture(resolution, yaw, values >= HALF, free, (x, y)), notes


def occupancy(pixels: Pixels, mode: str, negate: bool, thresholds: Thresholds) -> np.ndarray:
    """Returns what map_server publishes of a picture, (h, w) int8: 0 is free, 100 is occupied,
    UNKNOWN unknown; in mode `scale` chances lie between, in mode `raw` values are as they are."""
    grey, opacity = pixels.grey, pixels.opacity
    if mode == TRINARY and opacity is not None:
        grey = (3 * grey + opacity) / 4  # it takes transparency for a fourth colour
    if negate:
        grey = 1 - grey
    if mode == RAW:
        raw = np.rint(255 * grey)
        return np.where(raw <= OCCUPIED, raw, UNKNOWN).astype(np.int8)
    chance = np.round(1 - grey, 6)  # thresholds are hit by some grey values
    between = np.full(grey.shape, float(UNKNOWN))
    if mode == SCALE:
        width = max(thresholds.occupied - thresholds.free, 1e-9)
        scaled = np.floor(99 * (chance - thresholds.free) / width)
        between = np.where(opacity < 1, UNKNOWN, scaled) if opacity is not None else scaled
    chosen = [chance > thresholds.occupied, chance < thresholds.free]
    return np.select(chosen, [OCCUPIED, 0], between).astype(np.int8)


def _saved_as_unknown(pixels: Pixels) -> np.ndarray | None:
    """Returns the pixels (h, w) bool that map_saver wrote as unknown; None for other pictures."""
    values = np.rint(255 * pixels.grey)
    is_saved = pixels.opacity is None and np.isin(values, SAVERS).all()
    return values == SAVERS[1] if is_saved else None


def _counted(values: np.ndarray) -> str:
    free, occupied = (int((values == value).sum()) for value in (0, OCCUPIED))
    unknown = int((values == UNKNOWN).sum())
    between = values.size - free - occupied - unknown
    parts = [f"{free:,} are free", f"{occupied:,} occupied", f"{unknown:,} unknown"]
    parts += [f"{between:,} between"] if between else []
    return f"of {values.size:,} pixels {', '.join(parts)}"


def _mapping(path: Path) -> dict[str, Any]:
    text = text_of(path)
    try:
        fields = yaml.safe_load(text)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f":{mark.line + 1}" if mark else ""
        raise FormatError(f"{path}{place}: is not YAML: {error.problem}") from error
    except (yaml.YAMLError, ValueError) as error:
        raise FormatError(f"{path}: is not YAML: {' '.join(str(error).split())}") from error
    if not isinstance(fields, dict) or "image" not in fields:
        raise FormatError(f"{path}: image is missing; a map.yaml of map_server was expected")
    return fields


def _image(path: Path, fields: dict[str, Any]) -> tuple[Path, list[Note]]:
    """Returns the picture of a map: where it says, or of another computer's path beside it."""
    name = fields["image"]
    if not isinstance(name, str) or not name or "\0" in name:
        raise FormatError(f"{path}: image is {name!r}; the name of a file was expected")
    image = path.parent / Path(name)
    beside = path.parent / PureWindowsPath(name).name
    if not image.exists() and beside.is_file():
        return beside, [Note(f"{name} is not here: {beside.name} beside {path.name} was read")]
    return image, []


def _number(
    path: Path, fields: dict[str, Any], name: str, default: float | None, low: float, high: float
) -> float:
    value = fields.get(name, default)
    if not isinstance(value, (int, float)) or not low <= value <= high:
        raise FormatError(
            f"{path}: {name} is {value!r}; a number from {low:g} to {high:g} was expected"
        )
    return float(value)


def _origin(path: Path, fields: dict[str, Any]) -> tuple[float, float, float]:
    """Returns x, y [m] and yaw [rad] of the lower left corner."""
    origin = fields.get("origin", [0, 0, 0])
    fine = isinstance(origin, list) and len(origin) == 3
    if not fine or not all(isinstance(v, (int, float)) and math.isfinite(v) for v in origin):
        hint = ""
        if fine and isinstance(origin[2], float) and math.isnan(origin[2]):
            hint = "; some programs write nan as the yaw of a map that is not turned: make it 0"
        raise FormatError(
            f"{path}: origin is {origin!r}; x, y [m] and yaw [rad] were expected{hint}"
        )
    x, y, yaw = map(float, origin)
    return x, y, yaw


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
