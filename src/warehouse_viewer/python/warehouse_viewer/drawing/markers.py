# SPDX-License-Identifier: Apache-2.0
"""The warehouse as RViz shows it: markers of the shapes in the world's Looks."""

from collections.abc import Collection, Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from warehouse_layout.floor import floor_markings, palette, poses
from warehouse_layout.floor.floor_markings import Mark
from warehouse_layout.floor.outlines import SQUARE, placed
from warehouse_msgs.msg import Look, Scenery
from warehouse_viewer.drawing import looks, shapes
from warehouse_viewer.drawing.looks import Part
from warehouse_viewer.drawing.shapes import Shape, Text
from warehouse_viewer.page.activities import Activity

COLOURS = np.zeros((len(Activity), 4))  # of robots, as design.css has them for the page
COLOURS[Activity.RESTING] = (0.55, 0.59, 0.65, 1)
COLOURS[Activity.MOVING] = (0.31, 0.61, 0.98, 1)
COLOURS[Activity.WORKING] = (0.25, 0.75, 0.50, 1)
COLOURS[Activity.WAITING] = (0.95, 0.69, 0.19, 1)
COLOURS[Activity.NEEDS_HELP] = (0.94, 0.38, 0.35, 1)

FLOOR, GRID = (*palette.rgb("floor"), 1), (*palette.rgb("grid"), 1)
EDGE = (0.36, 0.42, 0.50, 1)  # of storage units seen from above
WHITE = (0.97, 0.97, 0.97, 1)
INK = (0.10, 0.10, 0.12, 1)
PATH = (0.00, 0.62, 0.45, 1)
WAITS = (0.80, 0.47, 0.65, 1)
CHOSEN = (0.80, 0.47, 0.65, 1)

# What RViz draws ten times a second on a machine like those that the tests run on.
MOST_POINTS = 100_000  # of all robots: where they would need more, each is a box, or a square
MOST_CUBES = 200_000  # of all things of a kind: where they would need more, each is one
MOST_NAMES = 200  # robots with their names above them
NAME_HEIGHT, NAME_ABOVE = 0.28, 0.30  # of letters; over a robot [m]
LIFTED = "tower"  # a robot's link that goes up with its load
LINE, THIN = 0.04, 0.02  # widths [m]
ABOVE_FLOOR, ABOVE_ROBOTS = 0.02, 0.40  # of lines [m]
PAINT = 0.005  # of what is painted on the floor [m]
FRAME = (0.40, 0.49)  # inner and outer half edges of the frame around a robot [m]
ARROW = np.array([(0.90, 0), (0.30, 0.6), (0.30, -0.6)])  # of half a robot's length and width


def floor(bounds: Sequence[float], spacing: float = 1.0) -> list[Shape]:
    """Returns a slab and the cells' borders; bounds are min_x, max_x, min_y, max_y [m]."""
    x0, x1, y0, y1 = bounds
    centre = np.array([[(x0 + x1) / 2, (y0 + y1) / 2, 0, 0]])
    slab = shapes.boxes(centre, (0, 0, -0.03), (x1 - x0, y1 - y0, 0.05))
    xs, ys = _borders(x0, x1, spacing), _borders(y0, y1, spacing)
    along_y = [(x, y, 0.0) for x in xs for y in (y0, y1)]
    along_x = [(x, y, 0.0) for y in ys for x in (x0, x1)]
    return [_joined("floor", [(slab, FLOOR)]), shapes.lines("grid", along_y + along_x, 0.02, GRID)]


def _borders(low: float, high: float, spacing: float) -> np.ndarray:
    """Midway between grid points, one of which is at 0."""
    return np.arange(np.ceil(low / spacing - 0.5) + 0.5, high / spacing + 1e-6) * spacing


def _joined(name: str, parts: Sequence[tuple[np.ndarray, ArrayLike]]) -> Shape:
    """One marker from parts: triangles (n, m, 3), and a colour for all or for each of the n."""
    points = [p.reshape(-1, 3) for p, _ in parts] or [np.zeros((0, 3))]
    colours = [np.repeat(np.broadcast_to(c, (len(p), 4)), p.shape[1], axis=0) for p, c in parts]
    return shapes.triangles(
        name, np.concatenate(points), np.concatenate(colours or [np.zeros((0, 4))])
    )


def robots(look: Look | None, at: np.ndarray, does: np.ndarray, lift: np.ndarray) -> list[Shape]:
    """Returns robots at (n, 3) x y [m] yaw [rad], in the colours of (n,) activities, their
    towers up by `lift` (n,) [m]."""
    at = np.insert(at, 2, 0.0, axis=1)
    if look is None:
        return [_joined("robots", [])]
    parts = looks.parts(look)
    body = parts[0]
    if len(at) * sum(len(part.triangles()) for part in parts) > MOST_POINTS:
        parts = [body := looks.hull(look)]
    lifted = at + np.outer(lift, (0, 0, 1, 0))
    solids = [
        (
            shapes.placed(lifted if part.link == LIFTED else at, part.triangles()),
            COLOURS[does] if part is body else part.colour,
        )
        for part in parts
    ]
    if len(at) * (len(body.triangles()) + len(_frame()) + len(ARROW)) > MOST_POINTS:
        return [_joined("robots", [(shapes.placed(lifted, _top(look)), COLOURS[does])])]
    marks = [(shapes.placed(at, _arrow(look)), WHITE)]
    marks.append((shapes.placed(at, _frame()), COLOURS[does]))
    return [_joined("robots", [*solids, *marks])]


def _arrow(look: Look) -> np.ndarray:
    """Triangle on top of a robot's front, where it heads."""
    low, high = looks.extent(look)
    return np.column_stack([ARROW * high[:2], np.full(3, high[2] + 0.001)])


def _top(look: Look) -> np.ndarray:
    """Triangles of the square that a robot is from above."""
    low, high = looks.extent(look)
    top = placed(SQUARE * (high - low)[:2] / 2, (low + high)[:2] / 2)
    return np.insert(top[0, _TRIANGLES], 2, high[2], axis=1)


def _frame() -> np.ndarray:
    """Triangles of a square frame on the floor, in the colour of what a robot does."""
    square = np.array([(1, 1, 0), (-1, 1, 0), (-1, -1, 0), (1, -1, 0)])
    inner, outer = (half * square + (0, 0, ABOVE_FLOOR) for half in FRAME)
    sides = [(outer[i - 1], outer[i], inner[i], inner[i - 1]) for i in range(4)]
    return np.array([(a, b, c, a, c, d) for a, b, c, d in sides]).reshape(-1, 3)


def things(name: str, look: Look | None, at: np.ndarray) -> list[Shape]:
    """Returns things of one look at (n, 4) x y z [m] yaw [rad]; in line with the axes as boxes."""
    if look is None or not len(at):
        return []
    parts = [looks.hull(look)] if are_thinned(look, len(at)) else looks.parts(look)
    turned = np.abs(np.sin(2 * at[:, 3])) > 0.01
    across = ~turned & (np.abs(np.sin(at[:, 3])) > 0.7)
    along = ~turned & ~across
    boxes = [part for part in parts if part.kind == Look.BOX and _is_straight(part)]
    others = [part for part in parts if not any(part is box for box in boxes)]
    out = []
    for i, alike in enumerate(_alike(boxes)):
        colour, size = alike[0].colour.tolist(), alike[0].size
        for suffix, which, edges in (("", along, (0, 1, 2)), (" across", across, (1, 0, 2))):
            middles = shapes.placed(at[which], np.array([part.pose[:3] for part in alike]))
            label = f"{name} {i + 1}{suffix}"
            out.append(shapes.cubes(label, middles.reshape(-1, 3), size[list(edges)], colour))
    round_ones = [(shapes.placed(at[~turned], p.triangles()), p.colour) for p in others]
    slanted = [(shapes.placed(at[turned], p.triangles()), p.colour) for p in parts]
    return [*out, _joined(f"{name} round", round_ones), _joined(f"{name} turned", slanted)]


def are_thinned(look: Look | None, count: int) -> bool:
    """Whether `count` things of a look are drawn as a box each, since they have too many parts."""
    return look is not None and count * len(looks.parts(look)) > MOST_CUBES


def _is_straight(part: Part) -> bool:
    return np.allclose(np.abs(part.pose[6]), 1)


def _alike(parts: Iterable[Part]) -> list[list[Part]]:
    """Parts in groups of one size and colour."""
    groups: dict[tuple[Any, ...], list[Any]] = {}
    for part in parts:
        groups.setdefault((tuple(part.size), tuple(part.colour)), []).append(part)
    return list(groups.values())


def paint(marks: Sequence[Mark]) -> list[Any]:
    """Returns what floor_markings.Marks show, and the names of stations."""
    points = np.insert(floor_markings.outlines(marks)[:, _TRIANGLES], 2, PAINT, axis=2)
    colours = np.reshape([(*palette.rgb(m.kind), 1) for m in marks], (-1, 4))
    return [
        _joined("paint", [(points, colours)]),
        *(
            shapes.Text("stations", i, (m.x, m.y, NAME_ABOVE), m.station, NAME_HEIGHT, INK)
            for i, m in enumerate(floor_markings.served(marks))
        ),
    ]


_TRIANGLES = [0, 1, 2, 0, 2, 3]  # two, of four corners


def scenery(message: Scenery) -> list[Shape]:
    """Returns every other model in a Scenery, one marker per look."""
    at, index = poses.rows(message.pose), np.array(message.model_look, int)
    index[[floor_markings.is_name(name) for name in message.models]] = -1
    return [
        _joined(
            f"scenery {i + 1}",
            [_at_poses(part, at[index == i]) for part in looks.parts(look, 0.01)],
        )
        for i, look in enumerate(message.looks)
        if (index == i).any()
    ]


def _at_poses(part: Part, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(triangles, colour) of a Part on each of the models at poses (n, 7)."""
    own = part.triangles()
    turn = np.repeat(at[:, 3:], len(own), axis=0)
    points = poses.rotate(turn, np.tile(own, (len(at), 1))).reshape(len(at), -1, 3)
    return points + at[:, None, :3], part.colour


def names(
    look: Look | None, numbers: Sequence[int], at: np.ndarray, always: Collection[int]
) -> list[Text]:
    """Returns names over the robots `numbers` at (n, 3); over many only those in `wanted`."""
    height = looks.extent(look)[1][2] + NAME_ABOVE if look else NAME_HEIGHT
    shown = numbers if len(numbers) <= MOST_NAMES else [n for n in numbers if n in always]
    where = dict(zip(numbers, at))
    return [
        shapes.Text("names", n, (*where[n][:2], height), f"kiva{n}", NAME_HEIGHT, INK)
        for n in shown
    ]


def paths(ways: Sequence[Any]) -> list[Shape]:
    """Returns lines along ways, each (n, 2) [m]."""
    ends = [p for way in ways for pair in zip(way, way[1:]) for p in pair]
    points = [(x, y, ABOVE_FLOOR) for x, y in ends]
    return [shapes.lines("paths", np.reshape(points, (-1, 3)), LINE, PATH)]


def fleet_ways(released: np.ndarray, planned: np.ndarray, ties: np.ndarray) -> list[Shape]:
    """Returns lines along segments (n, 2, 2) [m]: see rviz/fleet_ways.py."""
    parts = (
        ("released", released, ABOVE_FLOOR, LINE, PATH),
        ("planned", planned, ABOVE_FLOOR, LINE, PATH),
        ("waits for", ties, ABOVE_ROBOTS, THIN, WAITS),
    )
    return [
        shapes.lines(name, np.insert(segments.reshape(-1, 2), 2, height, axis=1), width, colour)
        for name, segments, height, width, colour in parts
    ]


def chosen(at: Any | None) -> list[Shape]:
    """Returns a square around the cell at (x, y) [m], or an empty marker for None."""
    if at is None:
        return [shapes.lines("chosen", np.zeros((0, 3)), LINE, CHOSEN)]
    corners = [(at[0] + dx, at[1] + dy, ABOVE_FLOOR) for dx, dy in _SQUARE]
    ends = [p for pair in zip(corners, corners[1:] + corners[:1]) for p in pair]
    return [shapes.lines("chosen", ends, LINE, CHOSEN)]


_SQUARE = ((0.48, 0.48), (-0.48, 0.48), (-0.48, -0.48), (0.48, -0.48))
