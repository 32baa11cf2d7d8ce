# SPDX-License-Identifier: Apache-2.0
"""A canvas for charts: matplotlib in the pages' type and colours, axes from zero.

matplotlib is imported with the first chart: programs that draw nothing, or refuse what they are
asked for, start a third of a second sooner.
"""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from html import escape
from itertools import count
from typing import TYPE_CHECKING, Any

import numpy as np

from warehouse_layout.drawing import page_font
from warehouse_operations.document import tokens

if TYPE_CHECKING:
    from matplotlib.figure import Figure

WIDE, NARROW = 680, 350  # [px]
SMALL = 12  # size of type [px]
_LOOK = {
    "font.size": SMALL,
    "svg.hashsalt": "report",
    "svg.fonttype": "none",
    "text.color": tokens.colour("dim"),
    "axes.edgecolor": tokens.colour("edge"),
    "axes.labelcolor": tokens.colour("dim"),
    "xtick.color": tokens.colour("dim"),
    "ytick.color": tokens.colour("dim"),
    "xtick.major.size": 0,
    "ytick.major.size": 0,
    "grid.color": tokens.colour("line"),
    "grid.linewidth": 1,
    "axes.axisbelow": True,
    "lines.solid_capstyle": "round",
    "hatch.linewidth": 0.8,
}
_ids = count()
Margins = tuple[float, float, float, float]  # left, right, top and bottom [px]


class Canvas:
    """Axes of a size [px] on a matplotlib figure. is_wide: of a screen or sheet, not a phone."""

    def __init__(self, figure: Figure, axes: Any, width: float, height: float) -> None:
        self.figure, self.axes, self.width, self.height = figure, axes, width, height
        self.is_wide = width > NARROW
        axes.patch.set_visible(False)

    def scale(
        self,
        x: tuple[str, float],
        y: tuple[str, float],
        upright: bool = True,
        across: bool = False,
    ) -> None:
        """Labels both axes and lets them reach from zero to a value. upright: the y axis has
        figures and lines at them; across: the x axis has."""
        from matplotlib.ticker import MaxNLocator

        axes = self.axes
        axes.spines[["top", "right", "left"]].set_visible(False)
        axes.set(xlim=(0, x[1]), ylim=(0, y[1]), xlabel=x[0])
        axes.set_title(y[0], loc="left", fontsize=SMALL, color=tokens.colour("dim"), pad=8)
        axes.xaxis.set_major_locator(MaxNLocator(8 if self.is_wide else 5, steps=_STEPS))
        axes.yaxis.set_major_locator(MaxNLocator(5, steps=_STEPS))
        axes.xaxis.set_major_formatter(lambda value, _: f"{value:,.10g}")
        axes.yaxis.set_major_formatter(lambda value, _: f"{value:,.10g}")
        if upright:
            axes.grid(axis="y")
        if across:
            axes.grid(axis="x")

    def say(self, x: float, y: float, text: str, colour: str = "dim", **options: Any) -> None:
        """Writes a label beside its subject, in a colour or that of a token."""
        shown = tokens.LIGHT.get(colour, colour)
        self.axes.annotate(text, (x, y), **_SAID | {"color": shown} | options)


_STEPS = [1, 2, 2.5, 5, 10]
_SAID: dict[str, Any] = {"xytext": (0, 0), "textcoords": "offset points", "annotation_clip": False}


def drawing(
    draw: Callable[[Canvas], None], height: float, margins: Margins, description: str
) -> str:
    """Returns a drawing as SVG in two widths: wide, and narrow for phones.

    description: the content in words, for readers who can't see it.
    """
    svgs = []
    for name, width in (("wide", WIDE), ("narrow", NARROW)):
        svgs.append(
            f'<div class="{name}">{single(draw, width, height, margins, description)}</div>'
        )
    return "".join(svgs)


def single(
    draw: Callable[[Canvas], None], width: float, height: float, margins: Margins, description: str
) -> str:
    """Returns a drawing as an SVG of a size [px]."""
    with _figure(width, height) as figure:
        canvas = on(figure, (0, 0, width, height), margins)
        draw(canvas)
        return _as_svg(canvas, description)


@contextmanager
def _figure(width: float, height: float, **options: Any) -> Iterator[Figure]:
    """Yields an empty figure of a size [px], with matplotlib set to the pages' look."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    with mpl.rc_context(_look()):
        yield Figure(figsize=(width / 72, height / 72), **options)


def on(figure: Figure, place: Margins, margins: Margins) -> Canvas:
    """Returns a Canvas on a part of a figure: (x, y, width, height) [px] from its top left."""
    whole_w, whole_h = figure.get_size_inches() * 72
    x, y, width, height = place
    left, right, top, bottom = margins
    box = (
        (x + left) / whole_w,
        1 - (y + height - bottom) / whole_h,
        max(width - left - right, 10) / whole_w,
        max(height - top - bottom, 10) / whole_h,
    )
    return Canvas(figure, figure.add_axes(box), width, height)


def write_png(path: Any, draw: Callable[[Figure], None], width: float, height: float) -> None:
    """Writes a picture for slides, light: `draw` fills a figure of that size [px]."""
    with _figure(width, height, dpi=144) as figure:
        draw(figure)
        figure.savefig(path)


def spread(targets: Sequence[float], least: float) -> list[float]:
    """Returns values near the targets that are `least` apart, in their order."""
    order = np.argsort(targets, kind="stable")
    values = np.asarray(targets, float)[order]
    # Neighbours that are too near become one group around their mean.
    groups: list[list[float]] = []  # [sum of the targets, number]
    for value in values:
        groups.append([value, 1])
        while len(groups) > 1 and _top(groups[-2], least) + least > _low(groups[-1], least):
            total, number = groups.pop()
            groups[-1] = [groups[-1][0] + total, groups[-1][1] + number]
    placed = [_low(group, least) + i * least for group in groups for i in range(int(group[1]))]
    out = np.empty(len(placed))
    out[order] = placed
    return out.tolist()


def _low(group: Sequence[float], least: float) -> float:
    return group[0] / group[1] - (group[1] - 1) * least / 2


def _top(group: Sequence[float], least: float) -> float:
    return group[0] / group[1] + (group[1] - 1) * least / 2


def _look() -> dict[str, Any]:
    """Returns matplotlib's settings; its own font where Inter is not installed."""
    from matplotlib import font_manager

    manager = font_manager.fontManager
    if page_font.FONT.exists() and not any(font.name == "Inter" for font in manager.ttflist):
        manager.addfont(str(page_font.FONT))
    has_inter = any(font.name == "Inter" for font in manager.ttflist)
    return _LOOK | {"font.family": ["Inter", "DejaVu Sans"][not has_inter :]}


def _as_svg(canvas: Canvas, description: str) -> str:
    file = io.StringIO()
    metadata = {"Date": None, "Creator": None, "Format": None, "Type": None}
    canvas.figure.savefig(file, format="svg", metadata=metadata, transparent=True)
    text = file.getvalue()
    text = re.sub(r"<metadata>.*?</metadata>|<style.*?</style>", "", text, flags=re.DOTALL)
    # Several drawings in one page must not share names.
    prefix = f"p{next(_ids)}-"
    text = re.sub(r'\bid="', f'id="{prefix}', text[text.index("<svg") :])
    text = re.sub(r'(url\(#|href="#)', rf"\g<1>{prefix}", text)
    return tokens.themed(_head(canvas, description) + text[text.index(">") + 1 :])


def _head(canvas: Canvas, description: str) -> str:
    width, height = canvas.figure.get_size_inches() * 72
    return (
        f'<svg role="img" aria-label="{escape(description)}" viewBox="0 0 {width:g} {height:g}"'
        f' width="{width:g}" height="{height:g}" xmlns="http://www.w3.org/2000/svg"'
        ' xmlns:xlink="http://www.w3.org/1999/xlink">'
    )
