# SPDX-License-Identifier: Apache-2.0
"""The floor as PNG: storage units, robots by what they do, and stations where a unit stands."""

import io
import math
from collections.abc import Mapping, Sequence
from typing import Any

from PIL import Image, ImageDraw, ImageFont

MOST_PIXELS = 900  # of the longer side
LEAST_CELL, MOST_CELL = 3, 32  # pixels of a metre
MARGIN = 1.0  # around all objects [m]
LEGEND = 22  # pixels
FLOOR, GRID, UNIT, CARRIED = "#f7f7f5", "#e3e3df", "#b9a27c", "#7d5a1e"
ACTIVITIES = {
    "RESTING": "#8a8f98",
    "MOVING": "#2166ac",
    "WORKING": "#1b7837",
    "WAITING": "#e08214",
    "NEEDS_HELP": "#c51b1b",
}

Rows = Sequence[Mapping[str, Any]]


def png(robots: Rows, units: Rows, stations: Rows) -> bytes:
    """Returns a picture of robots, storage units and stations as the HTTP API has them."""
    places = [(r["x"], r["y"]) for r in robots]
    places += [(u["pose"]["x"], u["pose"]["y"]) for u in units]
    # Distant objects, thrown or fallen, would shrink the rest.
    places = [p for p in places if all(math.isfinite(v) and abs(v) < 10_000 for v in p)]
    floor = _Floor(places or [(0.0, 0.0)])
    floor.draw_grid()
    at = {u["id"]: u["pose"] for u in units}
    for unit in units:
        floor.square(unit["pose"], CARRIED if unit["carrier"] else UNIT)
    for robot in robots:
        floor.robot(robot)
    for station in stations:
        if pose := at.get(station["shelf_id"]):
            floor.label(pose, str(station["name"])[:20])
    return floor.png()


class _Floor:
    def __init__(self, places: Sequence[tuple[float, float]]) -> None:
        xs, ys = [x for x, _ in places], [y for _, y in places]
        self._left, self._top = min(xs) - MARGIN, max(ys) + MARGIN
        width, height = max(xs) + MARGIN - self._left, self._top - min(ys) + MARGIN
        fitting = MOST_PIXELS / max(width, height)
        self._scale = min(max(fitting, LEAST_CELL), MOST_CELL)
        size = [min(4 * MOST_PIXELS, round(side * self._scale)) for side in (width, height)]
        self._size = (max(size[0], 460), size[1])
        self._image = Image.new("RGB", (self._size[0], self._size[1] + LEGEND), FLOOR)
        self._draw = ImageDraw.Draw(self._image)
        self._font = ImageFont.load_default()

    def _pixel(self, x: float, y: float) -> tuple[float, float]:
        return (x - self._left) * self._scale, (self._top - y) * self._scale

    def draw_grid(self) -> None:
        """Draws a line for each metre, or for ten where these are small."""
        step = 1 if self._scale >= 10 else 10
        for metre in range(math.ceil(self._left), 10**6, step):
            x, _ = self._pixel(metre, 0)
            if x > self._size[0]:
                break
            self._draw.line([(x, 0), (x, self._size[1])], GRID)
        for metre in range(math.floor(self._top), -(10**6), -step):
            _, y = self._pixel(0, metre)
            if y > self._size[1]:
                break
            self._draw.line([(0, y), (self._size[0], y)], GRID)

    def square(self, pose: Mapping[str, float], colour: str) -> None:
        """Draws a storage unit."""
        x, y = self._pixel(pose["x"], pose["y"])
        half = 0.42 * self._scale
        self._draw.rectangle([x - half, y - half, x + half, y + half], colour)

    def robot(self, robot: Mapping[str, Any]) -> None:
        """Draws a robot, its heading and its number, in the colour of its state."""
        x, y = self._pixel(robot["x"], robot["y"])
        half = max(2.0, 0.32 * self._scale)
        colour = ACTIVITIES.get(robot["activity"], "black")
        self._draw.ellipse([x - half, y - half, x + half, y + half], colour)
        dx, dy = half * math.cos(robot["yaw"]), half * math.sin(robot["yaw"])
        self._draw.line([(x, y), (x + dx, y - dy)], "white", 2)
        if self._scale >= 8:
            self._draw.text((x + half, y - half - 6), str(robot["id"]), "black", self._font)

    def label(self, pose: Mapping[str, float], text: str) -> None:
        """Writes a station's name beside the unit that is there."""
        x, y = self._pixel(pose["x"], pose["y"])
        line = text.encode("ascii", "replace").decode()
        length = self._draw.textlength(line, self._font)
        self._draw.text((x - 0.5 * self._scale - length - 2, y - 6), line, "black", self._font)

    def png(self) -> bytes:
        """Returns the picture with its legend."""
        x, y = 6.0, self._size[1] + 5
        for name, colour in (*ACTIVITIES.items(), ("unit", UNIT), ("carried", CARRIED)):
            self._draw.rectangle([x, y, x + 10, y + 10], colour)
            text = name.lower().replace("_", " ")
            self._draw.text((x + 14, y - 1), text, "black", self._font)
            x += 26 + self._draw.textlength(text, self._font)
        out = io.BytesIO()
        self._image.save(out, "PNG", optimize=True)
        return out.getvalue()
