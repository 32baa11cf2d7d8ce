# SPDX-License-Identifier: Apache-2.0
"""What is added must not stand in what stands there."""

import numpy as np
import pytest

from warehouse_layout.file import files
from warehouse_layout.floor import poses
from warehouse_layout.models import overlaps, sdf_world, world_file
from warehouse_layout.models.overlaps import Boxes
from warehouse_layout.models.sdf_world import Solid


def boxes(name, x, y, z=0.5, size=(1, 1, 1), yaw=0.0):
    pose = poses.planar(x, y, yaw)
    pose[2] = z
    return Boxes.of_solids([(name, Solid(pose, np.array(size, float)))])


@pytest.mark.parametrize(
    "other, is_hit",
    [
        (boxes("b", 0.9, 0), True),
        (boxes("b", 1.0, 0), False),  # they touch
        (boxes("b", 0.9995, 0), False),  # less than a millimetre
        (boxes("b", 0.9, 0.9), True),
        (boxes("b", 1.1, 0, yaw=np.pi / 4), True),  # its corner reaches in
        (boxes("b", 1.1, 1.1, yaw=np.pi / 4), False),  # its side does not
        (boxes("b", 0, 0, z=1.6), False),  # above
        (boxes("b", 0, 0, z=1.4), True),
        (boxes("b", 0, 0, size=(0.1, 0.1, 0.1)), True),  # within
    ],
)
def test_boxes_that_reach_into_each_other(other, is_hit):
    assert overlaps.first(boxes("a", 0, 0), other) == (("a", "b") if is_hit else None)


def inserted(world, standing=(), **place):
    path = files.worlds() / f"{world}.sdf"
    loaded = world_file.insertable(path, standing, **place)
    models = sdf_world.parse(loaded.xml, path, points=("item",)).models
    return Boxes.of_solids((model.name, solid) for model in models for solid in model.solids)


def test_the_same_world_again_stands_in_itself():
    assert overlaps.first(inserted("paper"), inserted("paper"))
    assert overlaps.first(inserted("paper", at=(50.0, 0.0)), inserted("paper")) is None
    # A robot beneath a storage unit is not in its way: the shapes are looked at one by one.
    assert overlaps.first(inserted("paper", at=(0.0, 300.0), yaw=1.0), inserted("paper")) is None


def test_models_are_turned_about_the_origin_and_moved():
    before = inserted("paper")
    after = inserted("paper", at=(10.0, 20.0), yaw=np.pi / 2)
    x, y = before.centre.T
    np.testing.assert_allclose(after.centre, np.column_stack([10 - y, 20 + x]), atol=1e-9)
