# SPDX-License-Identifier: Apache-2.0
"""Draws a layout file as a plan: to scale, with dimensions, a legend and the stations' names.

    draw(layout_file.read("north.layout.yaml"), "north.svg")        # or north.png

Text stays text in an SVG.
"""

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from warehouse_layout.convert.common import plural
from warehouse_layout.file.layout_file import LayoutFile, LayoutFileError
from warehouse_layout.floor.palette import PLAN

SUFFIXES = (".svg", ".png")
DPI = 200
INCH = 0.0254  # [m]
LONGEST = 14.0  # [in]: edge of the plan, unless cells get too small
LEAST_CELL, MOST_CELL = 0.02, 0.42  # [in], about
LEGEND, LEGEND_HEIGHT = 2.5, 5.2  # [in]
EDGE, TITLE, DIMENSIONS = 0.35, 0.85, 0.75  # [in]: around the page, above, below and at the left


def draw(file: LayoutFile, out: str | Path) -> None:
    """Draws a layout into an .svg or .png file. Raises LayoutFileError where it can't be written.

    A layout that lacks room for everything is drawn without the rest, and says what is missing.
    """
    if Path(out).suffix.lower() not in SUFFIXES:
        raise LayoutFileError(f"{out}: a file that ends in .svg or .png was expected")
    # What takes long to import is imported where it is needed.
    import matplotlib
    from matplotlib.figure import Figure

    from warehouse_layout.drawing.plan_layers import Subject

    page = _Page(Subject.of_file(file), Figure())
    page.draw()
    settings = {"svg.fonttype": "none", "svg.hashsalt": "warehouse", "path.simplify": False}
    metadata = {"Date": None} if Path(out).suffix.lower() == ".svg" else {}
    try:
        with matplotlib.rc_context(settings):
            page.figure.savefig(out, dpi=DPI, facecolor=PLAN["paper"], metadata=metadata)
    except OSError as error:
        raise LayoutFileError(f"{out}: {error.strerror or error}") from error


class _Page:
    """A page with the plan, dimensions beside it, the title above, and the legend at the right."""

    def __init__(self, subject: Any, figure: Any) -> None:
        from warehouse_layout.drawing.plan_layers import is_wide, name_width

        self._subject, self.figure = subject, figure
        file: LayoutFile = subject.file
        height, width = file.shape
        roomy = min(MOST_CELL, max(LEAST_CELL, LONGEST / max(width, height)))
        # A scale of those on rulers: 1:50, 1:100, 1:200 …
        self._ratio = _nice(file.spacing / (roomy * INCH))
        self._cell = file.spacing / (self._ratio * INCH)
        longest = max((station.name for station in subject.stations), key=len, default="")
        # Names may reach beyond the floor.
        self._beside = name_width(longest, self._cell) + 0.1
        self._above = self._beside if is_wide(longest, self._cell) else 0.25
        self._plan = width * self._cell + 2 * self._beside, height * self._cell + 2 * self._above
        self._size = (
            self._plan[0] + LEGEND + DIMENSIONS + 2 * EDGE,
            max(self._plan[1], LEGEND_HEIGHT) + TITLE + DIMENSIONS + 2 * EDGE,
        )
        figure.set_size_inches(*self._size)

    def draw(self) -> None:
        """Draws the page."""
        from warehouse_layout.drawing.plan_layers import Layers

        axes = self._axes_at(EDGE + DIMENSIONS, self._plan_bottom(), *self._plan)
        height, width = self._subject.file.shape
        beside, above = self._beside / self._cell, self._above / self._cell
        axes.set_xlim(-0.5 - beside, width - 0.5 + beside)
        axes.set_ylim(-0.5 - above, height - 0.5 + above)
        Layers(axes, self._subject, self._cell).draw()
        self._frame()
        self._title()
        self._dimensions()
        self._legend()

    def _plan_bottom(self) -> float:
        room = self._size[1] - TITLE - DIMENSIONS - 2 * EDGE
        return EDGE + DIMENSIONS + (room - self._plan[1])

    def _axes_at(self, left: float, bottom: float, width: float, height: float) -> Any:
        """Returns axes without decoration at a rectangle of the page [in]."""
        page_width, page_height = self._size
        axes = self.figure.add_axes(
            (left / page_width, bottom / page_height, width / page_width, height / page_height)
        )
        axes.set_axis_off()
        return axes

    def _inches(self) -> Any:
        """Returns axes over the whole page whose unit is an inch."""
        axes = self._axes_at(0, 0, *self._size)
        axes.set_xlim(0, self._size[0])
        axes.set_ylim(0, self._size[1])
        return axes

    def _frame(self) -> None:
        from matplotlib.patches import Rectangle

        width, height = self._size
        low = EDGE / 2
        frame = Rectangle((low, low), width - 2 * low, height - 2 * low, fill=False)
        frame.set(edgecolor=PLAN["ink"], linewidth=1.0)
        self._inches().add_patch(frame)

    # --- title

    def _title(self) -> None:
        axes, top = self._inches(), self._size[1] - EDGE
        axes.text(EDGE + 0.05, top - 0.05, self._subject.file.title, **_text(17, "top", "bold"))
        axes.text(EDGE + 0.05, top - 0.42, "   ".join(self._facts()), **_text(9, "top"))
        if self._subject.fault:
            style = _text(8, "top") | {"color": PLAN["fault"]}
            axes.text(EDGE + 0.05, top - 0.62, self._subject.fault, **style)

    def _facts(self) -> Iterator[str]:
        file = self._subject.file
        height, width = file.shape
        yield f"{_metres(width * file.spacing)} × {_metres(height * file.spacing)}"
        yield f"{width} × {height} cells of {_metres(file.spacing)}"
        layout = self._subject.layout
        if layout:
            yield plural(len(layout.robots), "robot")
            units, places = len(layout.units), len(layout.places)
            yield f"{plural(units, 'storage unit')} on {plural(places, 'place')}"
        yield plural(len(file.stations), "station")

    # --- dimensions

    def _dimensions(self) -> None:
        axes = self._inches()
        height, width = self._subject.file.shape
        spacing = self._subject.file.spacing
        left = EDGE + DIMENSIONS + self._beside
        bottom = self._plan_bottom() + self._above
        along = width * self._cell, height * self._cell
        y, x = self._plan_bottom() - 0.3, EDGE + DIMENSIONS - 0.3
        _dimension(axes, (left, y), (left + along[0], y), _metres(width * spacing))
        _dimension(axes, (x, bottom), (x, bottom + along[1]), _metres(height * spacing))
        step = _nice(0.32 / self._cell)
        style = _text(5.5, "center") | {"color": PLAN["faint"], "ha": "center"}
        for column in range(0, width, step):
            at = left + (column + 0.5) * self._cell
            axes.text(at, self._plan_bottom() - 0.08, str(column), **style)
        for row in range(0, height, step):
            at = bottom + (row + 0.5) * self._cell
            axes.text(EDGE + DIMENSIONS - 0.08, at, str(row), **style)

    # --- legend

    def _legend(self) -> None:
        axes = self._inches()
        left, y = self._size[0] - EDGE - LEGEND + 0.15, self._size[1] - EDGE - TITLE - 0.1
        axes.text(left, y, "Legend", **_text(10, "center", "bold"))
        for symbol, text in self._entries():
            y -= 0.27
            symbol(axes, np.array([[left + 0.12, y]]))
            axes.text(left + 0.38, y, text, **_text(8, "center"))
        self._scale(axes, left, y - 0.55)

    def _entries(self) -> Iterator[tuple[Callable[[Any, np.ndarray], None], str]]:
        """Yields symbols and what they mean, those that are on the plan."""
        from warehouse_layout.drawing.plan_legend import SYMBOLS, counted

        subject = self._subject
        present = counted(subject)
        for name, (symbol, text) in SYMBOLS.items():
            if present.get(name):
                count = present[name]
                yield symbol, text if count is True else f"{text} ({count:,})"

    def _scale(self, axes: Any, left: float, y: float) -> None:
        spacing = self._subject.file.spacing
        a_metre = self._cell / spacing  # [in]
        length = _nice(1.1 / a_metre) if a_metre < 1.1 else 1
        for i in range(4):
            colour = PLAN["paper" if i % 2 else "ink"]
            begin = left + i * length * a_metre / 4
            axes.add_patch(_bar(begin, y, length * a_metre / 4, colour))
        axes.text(left, y - 0.1, "0", **_text(7, "top") | {"ha": "center"})
        at = left + length * a_metre
        axes.text(at, y - 0.1, f"{length} m", **_text(7, "top") | {"ha": "center"})
        width, height = (edge * 25.4 for edge in self._size)
        axes.text(
            left, y - 0.35, f"1 : {self._ratio} on {width:.0f} × {height:.0f} mm", **_text(7, "top")
        )
        axes.text(left, y - 0.52, "grey numbers: column and row of a cell", **_text(7, "top"))


def _bar(x: float, y: float, length: float, colour: str) -> Any:
    from matplotlib.patches import Rectangle

    return Rectangle((x, y), length, 0.07, facecolor=colour, edgecolor=PLAN["ink"], linewidth=0.6)


def _dimension(axes: Any, begin: tuple[float, float], end: tuple[float, float], text: str) -> None:
    """Draws a dimension line with strokes at its ends and the length in its middle [in]."""
    (x, y), (to_x, to_y) = begin, end
    is_upright = x == to_x
    across = (0.06, 0.0) if is_upright else (0.0, 0.06)
    axes.plot([x, to_x], [y, to_y], color=PLAN["ink"], linewidth=0.7)
    for px, py in (begin, end):
        ends = [px - across[0], px + across[0]], [py - across[1], py + across[1]]
        axes.plot(*ends, color=PLAN["ink"], linewidth=0.7)
        axes.plot([px - 0.04, px + 0.04], [py - 0.04, py + 0.04], color=PLAN["ink"], linewidth=1.1)
    middle = (
        (x + to_x) / 2 - (0.09 if is_upright else 0),
        (y + to_y) / 2 - (0 if is_upright else 0.09),
    )
    style = _text(9, "center") | {"ha": "center", "rotation": 90 if is_upright else 0}
    axes.text(*middle, text, **style)


def _text(size: float, vertical: str, weight: str = "normal") -> dict[str, Any]:
    return {"fontsize": size, "va": vertical, "fontweight": weight, "color": PLAN["ink"]}


def _metres(length: float) -> str:
    return f"{length:,.2f}".rstrip("0").rstrip(".") + " m"


def _nice(least: float) -> int:
    """Returns the smallest of 1, 2, 5, 10, 20 … that is not below."""
    ten = 10 ** max(0, math.floor(math.log10(max(least, 1))))
    return next(ten * step for step in (1, 2, 5, 10) if ten * step >= least)
