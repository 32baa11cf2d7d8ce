# SPDX-License-Identifier: Apache-2.0
"""The floor in a report: where robots drove and where they stood, with the stations' names."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from warehouse_operations.document import tokens
from warehouse_operations.document.canvas import WIDE, Canvas
from warehouse_operations.document.chart import Chart
from warehouse_operations.reports.comparison import Group

# Opacity of the cells' grey beneath the heat: lanes and streets, storage, closed cells.
GROUND = {"s": 0.14, "p": 0.08, "l": 0.05, "#": 0.45}
SIDE = (WIDE - 28) / 2  # [px] of one of two maps beside each other
TALL = 420  # [px] at most
NAMED = 24  # stations whose names have room
NEAR = 6.0  # cells from a station
MARGINS = (6, 6, 22, 46)  # the lowest part is the scale's
# Each map: words, its token, how to write the maximum.
MAPS = {
    "traffic": (
        "Loaded robots through a cell",
        "moving",
        "{} loaded robots passed the busiest cell",
    ),
    "waiting": ("Time robots stood in a cell [s]", "waiting", "Robots stand up to {} s in a cell"),
}
NOTE = "Triangles are stations: upright ones for picking, the others for replenishing."
Stations = Sequence[tuple[str, str, float, float]]  # name, kind and cell


def maps(group: Group) -> list[Chart]:
    """Returns the maps of a group that its runs have: means over the runs."""
    data = [run.data for run in group.runs]
    floor = data[0].get("floor") or []  # runs of older versions lack it, and places of stations
    stations = [
        (row["name"], row["kind"], *row["cell"]) for row in data[0]["stations"] if row.get("cell")
    ]
    return [
        heat_map(np.mean([maps[what] for maps in data], axis=0), what, floor, stations)
        for what in MAPS
        if all(maps.get(what) for maps in data)
    ]


def heat_map(values: Any, what: str, floor: Sequence[str] = (), stations: Stations = ()) -> Chart:
    """Returns a chart of values over the floor, (h, w); what: one of MAPS.

    floor: its rows as runs.floor_rows() writes them, the lowest first; they lie beneath the values.
    """
    values = np.asarray(values, float)
    quantity, token, most = MAPS[what]
    top = np.percentile(values[values > 0], 99) if (values > 0).any() else 1.0

    def draw(canvas: Canvas) -> None:
        if len(floor) == len(values):
            _paint(canvas.axes, _ground(floor), "edge")
        _paint(canvas.axes, np.minimum(values / top, 1), token)
        canvas.axes.set(xticks=[], yticks=[])
        canvas.axes.spines[:].set_color(tokens.colour("line"))
        _name(canvas, stations, values.shape)
        _scale(canvas, top, values.max() > top, token)

    height = min(SIDE * values.shape[0] / values.shape[1], TALL) + MARGINS[2] + MARGINS[3]
    title = most.format(f"{values.max():,.0f}") + _near(values, stations)
    return Chart(title, quantity, draw, height, MARGINS)


def _paint(axes: Any, opaque: np.ndarray, token: str) -> None:
    """Draws cells in a colour with an opacity from 0 to 1, (h, w)."""
    from matplotlib import colors

    # The same colour on light and dark pages: a picture has no variables.
    light, dark = (colors.to_rgb(each[token]) for each in (tokens.LIGHT, tokens.DARK))
    shown = np.empty((*opaque.shape, 4))
    shown[..., :3] = (np.array(light) + np.array(dark)) / 2
    # The smallest value differs visibly from zero.
    shown[..., 3] = np.where(opaque > 0, 0.1 + 0.9 * opaque, 0) if token != "edge" else opaque
    axes.imshow(shown, origin="lower", interpolation="nearest")


def _ground(floor: Sequence[str]) -> np.ndarray:
    """Returns the opacity of a floor's cells, (h, w)."""
    rows = np.array([list(row) for row in floor])
    out = np.zeros(rows.shape)
    for character, opaque in GROUND.items():
        out[rows == character] = opaque
    return out


def _name(canvas: Canvas, stations: Stations, shape: tuple[int, ...]) -> None:
    """Marks where units stand at stations, and names those, if there is room."""
    for name, kind, x, y in stations:
        mark = "v" if kind == "REPLENISH" else "^"
        canvas.axes.plot(x, y, mark, ms=5, color=tokens.colour("text"), clip_on=False, zorder=4)
        if len(stations) > NAMED:
            continue
        low = y < shape[0] / 2
        canvas.say(
            x,
            y,
            name,
            "text",
            xytext=(0, -7 if low else 6),
            ha="center",
            va="top" if low else "bottom",
            fontsize=10,
        )


def _scale(canvas: Canvas, top: float, is_cut: bool, token: str) -> None:
    """Draws the colour scale below the map."""
    whole_w, whole_h = canvas.figure.get_size_inches() * 72
    wide = min(160, whole_w - 60)
    box = canvas.figure.add_axes((10 / whole_w, 18 / whole_h, wide / whole_w, 8 / whole_h))
    box.patch.set_visible(False)
    _paint(box, np.tile(np.linspace(0, 1, 64), (1, 1)), token)
    box.set_aspect("auto")
    most = f"{top:,.0f}{' and more' if is_cut else ''}"
    box.set(yticks=[], xticks=[0, 63])
    box.set_xticklabels(["0", most])
    box.spines[:].set_color(tokens.colour("line"))


def _near(values: np.ndarray, stations: Stations) -> str:
    """Returns words for the station near the maximum; "" without a near one."""
    if not stations or not values.any():
        return ""
    y, x = np.unravel_index(np.argmax(values), values.shape)
    far = [np.hypot(x - at_x, y - at_y) for *_, at_x, at_y in stations]
    nearest = int(np.argmin(far))
    return f", near {stations[nearest][0]}" if far[nearest] <= NEAR else ""
