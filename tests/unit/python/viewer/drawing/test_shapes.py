# SPDX-License-Identifier: Apache-2.0
"""Markers of many points, as RViz reads them."""

from io import BytesIO

import numpy as np
import pytest
from visualization_msgs.msg import Marker, MarkerArray

from warehouse_viewer.drawing import shapes


def received(*sent):
    """What a subscriber gets."""
    buffer, out = BytesIO(), MarkerArray()
    shapes.ShapeArray(list(sent)).serialize(buffer)
    return out.deserialize(buffer.getvalue()).markers


def normals(triangles):
    a, b, c = triangles.reshape(-1, 3, 3).transpose(1, 0, 2)
    return np.cross(b - a, c - a), (a + b + c) / 3


def test_points_and_colours_arrive():
    points = np.arange(12.0).reshape(4, 3)
    cubes, triangles = received(
        shapes.cubes("c", points, (1, 2, 3), (0.5, 0.25, 0, 1)),
        shapes.triangles("t", points[:3], np.eye(3, 4)),
    )
    assert (cubes.ns, cubes.type, cubes.header.frame_id) == ("c", Marker.CUBE_LIST, "world")
    assert [(p.x, p.y, p.z) for p in cubes.points] == [tuple(p) for p in points]
    assert (cubes.scale.x, cubes.scale.z, cubes.color.r, cubes.color.g) == (1, 3, 0.5, 0.25)
    assert cubes.colors == []
    assert [(c.r, c.g, c.b) for c in triangles.colors] == [(1, 0, 0), (0, 1, 0), (0, 0, 1)]


def test_it_is_what_genpy_would_have_written():
    sent = shapes.lines("l", [(0, 0, 0), (1, 2, 3)], 0.1, (1, 0, 0, 1))
    by_hand, by_genpy = BytesIO(), BytesIO()
    shapes.ShapeArray([sent]).serialize(by_hand)
    MarkerArray(received(sent)).serialize(by_genpy)
    assert by_hand.getvalue() == by_genpy.getvalue()


def test_without_points_the_marker_goes():
    (marker,) = received(shapes.cubes("c", np.zeros((0, 3)), (1, 1, 1), (1, 1, 1, 1)))
    assert marker.action == Marker.DELETE


def test_a_box_has_its_size_and_place():
    (box,) = shapes.boxes(np.array([[10, 20, 1, 0]]), (0, 0, 0.5), (4, 2, 1))
    assert box.min(0) == pytest.approx([8, 19, 1])
    assert box.max(0) == pytest.approx([12, 21, 2])


def test_a_box_turns_with_the_thing_it_is_fixed_to():
    (box,) = shapes.boxes(np.array([[10, 20, 0, np.pi / 2]]), (3, 0, 0), (4, 2, 1))
    assert box.min(0) == pytest.approx([9, 21, -0.5])
    assert box.max(0) == pytest.approx([11, 25, 0.5])


def test_a_box_is_closed_and_seen_from_outside():
    (box,) = shapes.boxes(np.zeros((1, 4)), (0, 0, 0), (2, 2, 2))
    normal, centre = normals(box)
    assert np.all(np.einsum("ij,ij->i", normal, centre) > 0)
    assert np.linalg.norm(normal, axis=1).sum() / 2 == pytest.approx(6 * 4)


@pytest.mark.parametrize("change", ["points", "colours", "scale", "none"])
def test_same_as(change):
    def shape(**changes):
        values = {"points": np.zeros((2, 3)), "colours": (1, 0, 0, 1), "scale": (1, 1, 1)}
        return shapes.Shape(Marker.CUBE_LIST, "c", **(values | changes))

    other = {"points": np.ones((2, 3)), "colours": (0, 1, 0, 1), "scale": (2, 1, 1), "none": None}
    changed = shape(**{change: other[change]}) if other[change] is not None else shape()
    assert changed.same_as(shape()) == (change == "none")
    assert not changed.same_as(None)
