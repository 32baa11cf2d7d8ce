# SPDX-License-Identifier: Apache-2.0
"""The warehouse from above, drawn by matplotlib without a screen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from warehouse_client import tracking
from warehouse_layout.floor import floor_markings, palette, poses
from warehouse_layout.floor.floor_markings import Mark
from warehouse_layout.floor.outlines import SQUARE, placed
from warehouse_msgs.msg import FleetState, UnitStates, WarehouseObjects
from warehouse_viewer.drawing import looks, markers
from warehouse_viewer.drawing.looks import Part
from warehouse_viewer.page.activities import Activity, activity

if TYPE_CHECKING:
    from warehouse_msgs.msg import Scenery

UNKNOWN = ((0.8, 0.8), (0.75, 0.75, 0.75))  # footprint [m] and colour where there is no look
LONGEST, SHORTEST = 12.0, 5.0  # edges of a picture [inches]
HEAD = 0.4  # room for the title [inches]
FLAT, ROOM = 0.03, 9.0  # [m] above zero and [m2]: what is flatter and larger is floor
MOST_NAMES = 60  # robots with their number beside them


@dataclass
class Moment:
    """The messages that describe the warehouse at one time; `scenery` may be None."""

    objects: WarehouseObjects = None
    states: UnitStates = None  # of the same revision
    fleet: FleetState = None
    scenery: Scenery | None = None

    @property
    def complete(self) -> bool:
        """Whether there are objects, states of the same revision, and robots."""
        parts = (self.objects, self.states, self.fleet)
        return all(parts) and self.objects.revision == self.states.revision


class Drawing:
    """A figure of one size, for one picture or the frames of a film."""

    def __init__(self, moment: Moment, dpi: int = 110, title: str = "") -> None:
        self.bounds, self._title = bounds(moment), title
        x0, x1, y0, y1 = self.bounds
        scale = LONGEST / max(x1 - x0, y1 - y0)
        size = np.maximum(np.array([x1 - x0, y1 - y0]) * scale, SHORTEST) + (0.2, HEAD)
        # Films want even numbers of pixels.
        self.figure = Figure(np.round(size * dpi / 2) * 2 / dpi, dpi=dpi, facecolor="white")
        self._canvas = FigureCanvasAgg(self.figure)
        top = 1 - HEAD / self.figure.get_size_inches()[1]
        self._axes = self.figure.add_axes((0.01, 0.01, 0.98, top - 0.01))

    def draw(self, moment: Moment) -> None:
        """Draws a Moment in place of the last one."""
        axes = self._axes
        axes.clear()
        axes.set_axis_off()
        axes.set_aspect("equal")
        axes.set_xlim(self.bounds[:2])
        axes.set_ylim(self.bounds[2:])
        self._floor()
        if moment.scenery:
            _paint(axes, floor_markings.readable(moment.scenery))
            _scenery(axes, moment.scenery)
        _robots(axes, moment)
        _loads(axes, moment)
        self._heading(moment)

    def pixels(self) -> np.ndarray:
        """Returns the picture, (height, width, 3) uint8."""
        self._canvas.draw()
        return np.asarray(self._canvas.buffer_rgba())[..., :3].copy()

    def save(self, path: str) -> None:
        """Writes the picture in the format of the path's suffix."""
        self.figure.savefig(path, facecolor="white")

    def _floor(self) -> None:
        x0, x1, y0, y1 = self.bounds
        self._axes.fill((x0, x1, x1, x0), (y0, y0, y1, y1), color=markers.FLOOR, zorder=0)
        xs, ys = np.arange(np.ceil(x0 - 0.5) + 0.5, x1), np.arange(np.ceil(y0 - 0.5) + 0.5, y1)
        lines = [[(x, y0), (x, y1)] for x in xs] + [[(x0, y), (x1, y)] for y in ys]
        self._axes.add_collection(LineCollection(lines, colors=[markers.GRID], linewidths=0.5))

    def _heading(self, moment: Moment) -> None:
        counts = np.bincount(activity(moment.fleet), minlength=len(Activity))
        keys = [
            Patch(color=markers.COLOURS[does], label=f"{_word(does)} {counts[does]}")
            for does in Activity
        ]
        self.figure.legends.clear()
        self.figure.legend(handles=keys, loc="upper right", ncol=len(Activity), frameon=False)
        text = f"{self._title}  {moment.fleet.stamp.to_sec():.1f} s".strip()
        self._axes.set_title(text, loc="left", fontsize=12)


def _word(does: Activity) -> str:
    return does.name.replace("_", " ").lower()


def bounds(moment: Moment) -> tuple[float, ...]:
    """Returns min_x, max_x, min_y, max_y [m] of the floor, or around the models if unknown."""
    return looks.floor(moment.scenery, moment.fleet, moment.states)


def _look(moment: Moment, kind: str) -> tuple[np.ndarray, np.ndarray]:
    """(length, width) [m] and colour of the robots, storage units or items of a Moment."""
    look = looks.named(moment.scenery, kind)
    if look is None:
        return UNKNOWN
    low, high = looks.extent(look)
    return 2 * np.maximum(-low, high)[:2], looks.parts(look)[0].colour[:3]


def _robots(axes: Axes, moment: Moment) -> None:
    fleet = moment.fleet
    at, yaw = np.column_stack([fleet.x, fleet.y]).reshape(-1, 2), np.asarray(fleet.yaw)
    colours = markers.COLOURS[activity(moment.fleet)]
    size, _ = _look(moment, "kiva")
    body, tips = (
        placed(shape * np.asarray(size) / 2, at, yaw=yaw) for shape in (SQUARE, markers.ARROW)
    )
    _add(axes, body, facecolors=colours, edgecolors="black", linewidths=0.6)
    _add(axes, tips, facecolors="white", zorder=4)
    if len(at) <= MOST_NAMES:
        for (x, y), number in zip(at, fleet.kiva_id):
            axes.text(x, y + 0.44, str(number), ha="center", va="bottom", fontsize=7, zorder=6)


def _loads(axes: Axes, moment: Moment) -> None:
    """Units, above their carriers yet letting them show; and items on them."""
    units = tracking.storage_units(moment.objects, moment.states)
    items = tracking.items(moment.objects, moment.states)
    for tracked, kind, opacity, layer in ((units, "storage_unit", 0.55, 3), (items, "item", 1, 5)):
        size, colour = _look(moment, kind)
        outlines = placed(
            SQUARE * np.asarray(size) / 2, tracked.pose[:, :2], yaw=poses.yaw(tracked.pose)
        )
        edges = np.where(tracked.carrier[:, None] > 0, (0, 0, 0, 1), markers.EDGE)
        look = {"edgecolors": edges, "linewidths": 0.8} if tracked is units else {}
        _add(axes, outlines, facecolors=[(*colour, opacity)], zorder=layer, **look)


def _paint(axes: Axes, marks: Sequence[Mark]) -> None:
    """What is painted on the floor, beneath its grid; the names of stations beside their places."""
    colours = [palette.rgb(m.kind) for m in marks]
    _add(axes, floor_markings.outlines(marks), facecolors=colours, zorder=0.5)
    served = floor_markings.served(marks)
    if len(served) <= MOST_NAMES:
        for m in served:
            axes.text(m.x, m.y, m.station, ha="center", va="center", fontsize=6, zorder=6)


def _scenery(axes: Axes, scenery: Scenery) -> None:
    """The footprint of every shape of what else stands there, the lower ones first."""
    described = [looks.parts(look, 0) for look in scenery.looks]
    things = zip(scenery.models, scenery.model_look, poses.rows(scenery.pose))
    for name, look, pose in things:
        if not floor_markings.is_name(name):
            _stand(axes, described[look], pose)


def _stand(axes: Axes, parts: Sequence[Part], pose: np.ndarray) -> None:
    """The footprints of the parts of one model, but for its floor, which is drawn already."""
    own = np.reshape([part.pose for part in parts], (-1, 7))
    at = poses.compose(np.broadcast_to(pose, own.shape), own)
    extents = np.reshape([np.abs(p.size @ _axes_of(row)) for p, row in zip(parts, at)], (-1, 3))
    is_flat = at[:, 2] + extents[:, 2] / 2 <= FLAT
    is_floor = is_flat & (extents[:, 0] * extents[:, 1] >= ROOM)
    chosen = [i for i in np.argsort(at[:, 2]) if not is_floor[i]]
    yaw = poses.yaw(pose[None])[0]
    outlines = [placed(SQUARE * extents[i, :2] / 2, at[i, :2], yaw=yaw)[0] for i in chosen]
    _add(axes, outlines, facecolors=[parts[i].colour for i in chosen], zorder=2)


def _axes_of(pose: np.ndarray) -> np.ndarray:
    """Rows: which of a model's axes a shape's own lie along, for shapes in line with them."""
    turned = poses.rotate(np.repeat(pose[None, 3:], 3, axis=0), np.eye(3))
    heading = poses.yaw(pose[None])[0]
    c, s = np.cos(heading), np.sin(heading)
    return turned @ np.array([(c, -s, 0), (s, c, 0), (0, 0, 1)])


def _add(axes: Axes, outlines: np.ndarray, **look: Any) -> None:
    axes.add_collection(PolyCollection(outlines, **look))
