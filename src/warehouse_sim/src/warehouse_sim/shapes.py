# SPDX-License-Identifier: Apache-2.0
"""RViz markers from numpy arrays, a few large ones instead of thousands of small ones.

Lists of points pass as bytes: making a Python object of each would cost a hundred times as much.
"""

from io import BytesIO

import numpy as np
from geometry_msgs.msg import Pose, Quaternion, Vector3
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

# Corners of a unit cube by their bits (x y z), and its faces as two triangles each, seen
# counterclockwise from outside.
_CORNERS = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)]) - 0.5
_QUADS = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
_FACES = np.array([(a, b, c, a, c, d) for a, b, c, d in _QUADS]).ravel()

# What follows points and colours in a serialised marker without texts: their counts, those of
# text and mesh, and a flag.
_COUNTS, _TAIL = 8, 17


class Shape:
    """A marker of many points: `points` (n, 3) [m], `colours` (n, 4) in 0…1 or one for all."""

    def __init__(self, kind, name, points, colours, scale=(1, 1, 1)):
        self.points = np.ascontiguousarray(points, "<f8")
        self.colours = np.ascontiguousarray(colours, "<f4")
        self._marker = Marker(header=Header(frame_id="world"), ns=name, type=kind)
        self._marker.action = Marker.ADD if len(points) else Marker.DELETE
        self._marker.pose = Pose(orientation=Quaternion(w=1))
        self._marker.scale = Vector3(*scale)
        if self.colours.ndim == 1:
            self._marker.color = ColorRGBA(*self.colours.tolist())

    @property
    def name(self):
        return self._marker.ns

    def same_as(self, other):
        """Whether another Shape of this name, or None, would look the same."""
        return (
            other is not None
            and np.array_equal(self.points, other.points)
            and np.array_equal(self.colours, other.colours)
            and self._marker.scale == other._marker.scale
        )

    def serialize(self, buffer):
        """As genpy would serialise a marker with these points and colours."""
        frame = BytesIO()
        self._marker.serialize(frame)
        head, tail = frame.getvalue()[:-_TAIL], frame.getvalue()[-_TAIL + _COUNTS :]
        colours = self.colours if self.colours.ndim == 2 else self.colours[:0]
        buffer.write(head)
        for array in (self.points, colours):
            buffer.write(np.uint32(len(array)).tobytes() + array.tobytes())
        buffer.write(tail)


class ShapeArray(MarkerArray):
    """A MarkerArray of Shapes."""

    __slots__ = MarkerArray.__slots__

    def serialize(self, buff):
        buff.write(np.uint32(len(self.markers)).tobytes())
        for shape in self.markers:
            shape.serialize(buff)


def cubes(name, centres, size, colour):
    """Boxes of one size [m] along the axes."""
    return Shape(Marker.CUBE_LIST, name, centres, colour, size)


def triangles(name, points, colours):
    """Triangles of three points each."""
    return Shape(Marker.TRIANGLE_LIST, name, points, colours)


def lines(name, points, width, colour):
    """Lines of two points each."""
    return Shape(Marker.LINE_LIST, name, points, colour, (width, 0, 0))


def boxes(poses, centre, size):
    """Triangles of boxes fixed to things that turn about z: (n, 36, 3).

    `poses` is (n, 4): x y z yaw of the things; `centre` and `size` [m] of the box in their frame.
    """
    return placed(poses, (_CORNERS * size + centre)[_FACES])


def placed(poses, points):
    """The same points (m, 3) on each of the things at `poses` (n, 4): (n, m, 3)."""
    c, s = np.cos(poses[:, 3])[:, None], np.sin(poses[:, 3])[:, None]
    x, y, z = points.T
    turned = np.stack([c * x - s * y, s * x + c * y, np.broadcast_to(z, (len(poses), len(z)))], 2)
    return turned + poses[:, None, :3]
