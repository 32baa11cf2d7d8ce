# SPDX-License-Identifier: Apache-2.0
"""Where tracked objects are, from what the world publishes."""

import math

import numpy as np
import pytest

from warehouse_client import tracking
from warehouse_layout.floor import poses
from warehouse_msgs.msg import UnitStates, WarehouseObjects


def scene(angle=0.0, carrier=0):
    """Two units; one item on the second, turned by `angle`, and one loose."""
    objects = WarehouseObjects(
        storage_units=["storage_unit1", "storage_unit2"],
        items=["item1", "item2"],
        item_unit=[1, -1],
        item_pose=[0.2, 0.1, 0.81, 0, 0, 0, 1] + [9, 9, 0, 0, 0, 0, 1],
    )
    units = [*poses.planar(0, 0, 0), *poses.planar(3, 4, angle)]
    return objects, UnitStates(
        pose=units, carrier=[0, carrier], loose_item=[1], loose_pose=[8, 7, 0, 0, 0, 0, 1]
    )


def matrix(q):
    """Rotation matrix of a unit quaternion x y z w, written out as in the textbooks."""
    x, y, z, w = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def random_poses(count, seed):
    out = np.random.default_rng(seed).normal(size=(count, 7))
    out[:, 3:] /= np.linalg.norm(out[:, 3:], axis=1, keepdims=True)
    return out


def test_composed_poses_agree_with_matrices():
    frames, inner = random_poses(50, 1), random_poses(50, 2)
    for frame, pose, out in zip(frames, inner, poses.compose(frames, inner)):
        turn = matrix(frame[3:])
        assert out[:3] == pytest.approx(frame[:3] + turn @ pose[:3])
        assert matrix(out[3:]) == pytest.approx(turn @ matrix(pose[3:]), abs=1e-12)


def test_inverse_undoes():
    frames = random_poses(20, 3)
    for rows in (
        poses.compose(frames, poses.inverse(frames)),
        poses.compose(poses.inverse(frames), frames),
    ):
        assert rows[:, :6] == pytest.approx(np.zeros((20, 6)), abs=1e-12)
        assert rows[:, 6] == pytest.approx(np.ones(20))


@pytest.mark.parametrize("angle", [-3.0, -math.pi / 2, 0, 0.1, math.pi / 2, 3.1])
def test_yaw(angle):
    assert poses.yaw(poses.planar(1, 2, angle)[None]) == pytest.approx([angle])


def test_item_stands_on_its_unit():
    items = tracking.items(*scene())
    assert items.pose[0] == pytest.approx([3.2, 4.1, 0.81, 0, 0, 0, 1])
    assert items.message(0).storage_unit == "storage_unit2"


def test_item_turns_with_its_unit():
    items = tracking.items(*scene(angle=math.pi / 2))
    assert items.pose[0, :3] == pytest.approx([2.9, 4.2, 0.81])
    assert poses.yaw(items.pose)[0] == pytest.approx(math.pi / 2)


def test_loose_item_has_its_own_pose():
    items = tracking.items(*scene())
    assert items.pose[1, :3] == pytest.approx([8, 7, 0])
    assert items.message(1).storage_unit == ""


def test_carrier_is_named():
    for kind, index in ((tracking.items, 0), (tracking.storage_units, 1)):
        assert kind(*scene(carrier=12)).message(index).carrier == "kiva12"
        assert kind(*scene(carrier=0)).message(index).carrier == ""


def test_units_as_messages():
    message = tracking.storage_units(*scene()).message(1)
    assert message.name == "storage_unit2"
    assert (message.pose.position.x, message.pose.position.y) == (3, 4)


def test_no_objects_at_all():
    nothing = WarehouseObjects(), UnitStates()
    assert tracking.items(*nothing).names == []
    assert tracking.storage_units(*nothing).pose.shape == (0, 7)


def test_only_what_stands_elsewhere_has_moved():
    old, new = (tracking.storage_units(*scene(angle)) for angle in (0.0, 0.5))
    assert tracking.moved(old, new).tolist() == [False, True]
    assert tracking.moved(new, new).tolist() == [False, False]


def test_moved_finds_objects_by_name():
    old, new = (tracking.storage_units(*scene(angle)) for angle in (0.0, 0.5))
    new.names = ["storage_unit1", "storage_unit7"]
    assert tracking.moved(old, new).tolist() == [False, True]
    new = tracking.Tracked(["storage_unit2"], old.pose[1:], old.carrier[1:], [""])
    assert tracking.moved(old, new).tolist() == [False]


def test_a_new_carrier_is_a_change_but_no_move():
    old, new = (tracking.storage_units(*scene(carrier=c)) for c in (0, 3))
    assert tracking.moved(old, new).tolist() == [False, False]
    assert tracking.changed(old, new).tolist() == [False, True]


def test_asked_again_they_are_where_they_would_be_at_first():
    random = np.random.default_rng(5)
    objects = WarehouseObjects(
        storage_units=[f"storage_unit{i}" for i in range(20)],
        items=[f"item{i}" for i in range(50)],
        item_unit=random.integers(-1, 20, 50).tolist(),
        item_pose=random_poses(50, 6).ravel().tolist(),
    )
    followed, stand = tracking.Items(objects), random_poses(20, 7)
    for _ in range(10):
        driven, fallen = random.integers(0, 20, 3), random.integers(0, 50, 2)
        stand[driven] = random_poses(3, random.integers(1000))
        states = UnitStates(
            pose=stand.ravel().tolist(),
            carrier=random.integers(0, 3, 20).tolist(),
            loose_item=fallen.tolist(),
            loose_pose=random_poses(2, 8).ravel().tolist(),
        )
        now, again = followed.at(states), tracking.items(objects, states)
        assert (now.pose == again.pose).all()
        assert (now.carrier == again.carrier).all()
