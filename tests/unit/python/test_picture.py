# SPDX-License-Identifier: Apache-2.0
"""What RViz is told, and that it is told only what moved."""

import math
from io import BytesIO

import numpy as np
import pytest
from fake_world import FakeWorld
from visualization_msgs.msg import Marker, MarkerArray

from warehouse_msgs.msg import Event, FleetState, KivaStatus, UnitStates, WarehouseObjects
from warehouse_sim import markers, poses
from warehouse_sim.picture import Picture


class Scene(FakeWorld):
    """Two robots, two units with an item each, a belt and a person."""

    def __init__(self, turned=0.0):
        super().__init__(standing=["conveyor_belt1", "person1", "ground_plane"])
        self.parameters["/warehouse/floor"] = [-2.5, 2.5, -1.5, 1.5]
        self.picture = Picture(self)
        self.topic = self.publishers["/warehouse/markers"]
        self.topic.listeners = 1
        self.drive()
        self.callbacks["/warehouse/objects"](
            WarehouseObjects(
                storage_units=["storage_unit1", "storage_unit2"],
                items=["item1", "item2"],
                item_unit=[0, 1],
                item_pose=[0.2, 0, 0.46, 0, 0, 0, 1] * 2,
            )
        )
        self.turn_unit(turned)

    def drive(self, x=1.0, status=KivaStatus.STATUS_IDLE):
        self.callbacks["/warehouse/fleet"](
            FleetState(
                kiva_id=[1, 2],
                x=[x, 2],
                y=[0, 0],
                yaw=[0, 0],
                status=bytes([status, 0]),
                shelf_id=[0, 0],
            )
        )

    def turn_unit(self, yaw):
        flat = [*poses.planar(0, 0, 0), *poses.planar(1, 1, yaw)]
        self.callbacks["/warehouse/unit_states"](UnitStates(pose=flat, carrier=[0, 0]))

    def shown(self):
        """{name: marker} of what one more turn sends, as a subscriber reads it."""
        before = len(self.topic.sent)
        self.picture.turn(patience=0)
        assert len(self.topic.sent) <= before + 1
        sent = self.topic.sent[before:]
        return {m.ns: m for message in sent for m in _read(message)}


def _read(message):
    buffer = BytesIO()
    message.serialize(buffer)
    return MarkerArray().deserialize(buffer.getvalue()).markers


def extent(marker):
    points = np.array([(p.x, p.y, p.z) for p in marker.points])
    return points.min(0).tolist(), points.max(0).tolist()


def colour(status):
    return tuple(markers.STATUS_COLOURS[status][:3])


def changed_colours(before, after):
    pairs = zip(before.colors, after.colors)
    return {(round(c.r, 2), round(c.g, 2), round(c.b, 2)) for b, c in pairs if b != c}


@pytest.fixture
def scene():
    return Scene()


def test_everything_is_shown(scene):
    shown = scene.shown()
    drawn = {name for name, marker in shown.items() if marker.action == Marker.ADD}
    assert drawn == {
        "robots", "boards", "posts", "items", "belts", "person", "floor", "grid",
    }  # fmt: skip
    assert len(shown["boards"].points) == 2 * 4
    assert extent(shown["floor"])[0][:2] == [-2.5, -1.5]
    assert extent(shown["person"])[1][2] == 1.75


def test_only_what_moved_is_sent_again(scene):
    scene.shown()
    assert scene.shown() == {}
    scene.drive(x=1.1)
    assert set(scene.shown()) == {"robots"}
    scene.turn_unit(0.3)
    assert set(scene.shown()) == {"boards", "posts", "items", "turned units", "turned items"}


def test_a_newcomer_gets_everything(scene):
    scene.shown()
    scene.topic.connect()
    assert {"robots", "boards", "floor"} <= {m.ns for m in _read(scene.topic.sent[-1])}


def test_status_has_its_colour(scene):
    idle = scene.shown()["robots"]
    scene.drive(status=KivaStatus.STATUS_BUSY)
    assert changed_colours(idle, scene.shown()["robots"]) == {colour(KivaStatus.STATUS_BUSY)}


def test_who_was_blocked_shows_it_until_the_next_command(scene):
    idle = scene.shown()["robots"]
    scene.callbacks["/warehouse/events"](Event(kind=Event.BLOCKED, model="kiva2"))
    scene.drive()
    blocked = scene.shown()["robots"]
    assert changed_colours(idle, blocked) == {colour(KivaStatus.STATUS_BLOCKED)}
    scene.callbacks["/warehouse/events"](Event(kind=Event.ACCEPTED, model="kiva2"))
    scene.drive()
    assert changed_colours(blocked, scene.shown()["robots"]) == {colour(KivaStatus.STATUS_IDLE)}


def test_a_turned_unit_is_drawn_turned():
    shown = Scene(turned=math.pi / 4).shown()
    assert len(shown["boards"].points) == 4
    low, high = extent(shown["turned units"])
    assert high[0] - low[0] == pytest.approx(0.8 * math.sqrt(2), abs=0.01)


def test_items_on_a_unit_put_down_after_a_quarter_turn():
    shown = Scene(turned=math.pi / 2).shown()
    (across,) = shown["items across"].points
    assert (across.x, across.y) == pytest.approx((1, 1.2))
    assert shown["items across"].scale.y == 0.2


def test_a_floor_of_unknown_size_reaches_beyond_what_stands_on_it(scene):
    del scene.parameters["/warehouse/floor"]
    assert extent(scene.shown()["floor"])[1][:2] == [2.5, 2.5]


def test_nothing_is_known_of_other_models_while_the_world_is_silent(scene):
    def silent(*_):
        raise scene.ROSException

    scene.wait_for_service = silent
    assert "belts" not in scene.shown()
