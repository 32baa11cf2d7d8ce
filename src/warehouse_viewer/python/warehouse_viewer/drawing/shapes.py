# SPDX-License-Identifier: Apache-2.0
"""RViz markers from numpy arrays, a few large ones instead of thousands of small ones.

Lists of points pass as bytes: making a Python object of each would cost a hundred times as much.
"""

from collections.abc import Sequence
from io import BytesIO
from typing import Self

import numpy as np
from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from numpy.typing import ArrayLike
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

# Corners of a unit cube by their bits (x y z), and its faces as two triangles each, seen
# counterclockwise from outside.
CORNERS = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)]) - 0.5
_QUADS = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
_FACES = np.array([(a, b, c, a, c, d) for a, b, c, d in _QUADS]).ravel()

ROUND = 8  # sides of what is round

# What follows points and colours in a serialised marker without texts: their counts, those of
# text and mesh, and a flag.
_COUNTS, _TAIL = 8, 17


class Shape:
    """A marker of many points: `points` (n, 3) [m], `colours` (n, 4) in 0…1 or one for all."""

    def __init__(
        self,
        kind: int,
        name: str,
        points: ArrayLike,
        colours: ArrayLike,
        scale: Sequence[float] = (1, 1, 1),
    ) -> None:
        self.points = np.ascontiguousarray(points, "<f8")
        self.colours = np.ascontiguousarray(colours, "<f4")
        self._marker = Marker(header=Header(frame_id="world"), ns=name, type=kind)
        self._marker.action = Marker.ADD if len(points) else Marker.DELETE
        self._marker.pose = Pose(orientation=Quaternion(w=1))
        self._marker.scale = Vector3(*scale)
        if self.colours.ndim == 1:
            self._marker.color = ColorRGBA(*self.colours.tolist())

    @property
    def name(self) -> str:
        """The marker's namespace."""
        return self._marker.ns

    def same_as(self, other: Self | None) -> bool:
        """Whether another Shape of this name, or None, would look the same."""
        return (
            other is not None
            and np.array_equal(self.points, other.points)
            and np.array_equal(self.colours, other.colours)
            and self._marker.scale == other._marker.scale
        )

    def gone(self) -> Marker:
        """Returns the marker that removes it."""
        return Shape(self._marker.type, self.name, np.zeros((0, 3)), (0, 0, 0, 0))

    def serialize(self, buffer: BytesIO) -> None:
        """Writes what genpy would write for a marker with these points and colours."""
        frame = BytesIO()
        self._marker.serialize(frame)
        head, tail = frame.getvalue()[:-_TAIL], frame.getvalue()[-_TAIL + _COUNTS :]
        colours = self.colours if self.colours.ndim == 2 else self.colours[:0]
        buffer.write(head)
        for array in (self.points, colours):
            buffer.write(np.uint32(len(array)).tobytes() + array.tobytes())
        buffer.write(tail)


class Text:
    """A marker of words; those of one namespace `ns` differ in their numbers."""

    def __init__(
        self,
        ns: str,
        number: int,
        at: Sequence[float],
        words: str,
        height: float,
        colour: Sequence[float],
    ) -> None:
        self.name = f"{ns} {number}"
        self._marker = Marker(header=Header(frame_id="world"), ns=ns, id=number)
        self._marker.type = Marker.TEXT_VIEW_FACING
        self._marker.action = Marker.ADD if words else Marker.DELETE
        self._marker.text = words
        self._marker.pose = Pose(Point(*at), Quaternion(w=1))
        self._marker.scale.z = height
        self._marker.color = ColorRGBA(*colour)

    def same_as(self, other: Self | None) -> bool:
        """Whether another Text of this name, or None, would look the same."""
        return other is not None and self._marker == other._marker

    def gone(self) -> Marker:
        """Returns the marker that removes it."""
        return Text(self._marker.ns, self._marker.id, (0, 0, 0), "", 1, (0, 0, 0, 0))

    def serialize(self, buffer: BytesIO) -> None:
        """Writes the marker as genpy does."""
        self._marker.serialize(buffer)


class ShapeArray(MarkerArray):
    """A MarkerArray of Shapes and Texts."""

    __slots__ = MarkerArray.__slots__

    def serialize(self, buff: BytesIO) -> None:
        """Writes all markers into a message's buffer (genpy's hook)."""
        buff.write(np.uint32(len(self.markers)).tobytes())
        for shape in self.markers:
            shape.serialize(buff)


def cubes(name: str, centres: ArrayLike, size: Sequence[float], colour: ArrayLike) -> Shape:
    """Returns boxes of one size [m] along the axes, at centres (n, 3) [m]."""
    return Shape(Marker.CUBE_LIST, name, centres, colour, size)


def triangles(name: str, points: ArrayLike, colours: ArrayLike) -> Shape:
    """Returns triangles of three points each, (3 n, 3) [m]."""
    return Shape(Marker.TRIANGLE_LIST, name, points, colours)


def lines(name: str, points: ArrayLike, width: float, colour: ArrayLike) -> Shape:
    """Returns lines of two points each, (2 n, 3) [m]."""
    return Shape(Marker.LINE_LIST, name, points, colour, (width, 0, 0))


def box() -> np.ndarray:
    """Returns the corners of a cube's triangles, (36, 3); its edges are one metre long."""
    return CORNERS[_FACES]


def cylinder() -> np.ndarray:
    """Returns the same for a prism that stands for a cylinder along z."""
    return _turned([(0, -0.5), (0.5, -0.5), (0.5, 0.5), (0, 0.5)])


def ball() -> np.ndarray:
    """Returns the same for a body that stands for a sphere."""
    angles = np.linspace(-np.pi / 2, np.pi / 2, 5)
    return _turned(np.column_stack([np.cos(angles), np.sin(angles)]) / 2)


def _turned(profile: Sequence[tuple[float, float]]) -> np.ndarray:
    """Triangles of an outline (n, 2) of distance from and height along z, turned about it."""
    angles = np.linspace(0, 2 * np.pi, ROUND + 1)
    ring = np.array([[(r * np.cos(a), r * np.sin(a), z) for a in angles] for r, z in profile])
    low, high = ring[:-1], ring[1:]
    a, b, c, d = low[:, :-1], low[:, 1:], high[:, 1:], high[:, :-1]
    out = np.stack([a, b, c, a, c, d], axis=2).reshape(-1, 3, 3)
    flat = np.linalg.norm(np.cross(out[:, 1] - out[:, 0], out[:, 2] - out[:, 0]), axis=1) < 1e-12
    return out[~flat].reshape(-1, 3)


def boxes(poses: np.ndarray, centre: ArrayLike, size: ArrayLike) -> np.ndarray:
    """Triangles of boxes fixed to things that turn about z: (n, 36, 3).

    `poses` is (n, 4): x y z yaw of the things; `centre` and `size` [m] of the box in their frame.
    """
    return placed(poses, (CORNERS * size + centre)[_FACES])


def placed(poses: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Returns points (m, 3) on each of the things at `poses` (n, 4): (n, m, 3) [m]."""
    c, s = np.cos(poses[:, 3])[:, None], np.sin(poses[:, 3])[:, None]
    x, y, z = points.T
    turned = np.stack([c * x - s * y, s * x + c * y, np.broadcast_to(z, (len(poses), len(z)))], 2)
    return turned + poses[:, None, :3]
