# SPDX-License-Identifier: Apache-2.0
"""What RViz is told, and that it is told only what moved."""

import math
from io import BytesIO

import numpy as np
import pytest
from fake_ros import FakeRos, fleet_state
from geometry_msgs.msg import Point, PointStamped, PoseStamped
from sensor_msgs.msg import LaserScan
from visualization_msgs.msg import Marker, MarkerArray

from warehouse_layout.floor import poses
from warehouse_msgs.msg import (
    Event,
    FleetPaths,
    KivaStatus,
    Look,
    Scenery,
    UnitStates,
    WarehouseObjects,
)
from warehouse_viewer.drawing import markers
from warehouse_viewer.page.activities import Activity
from warehouse_viewer.rviz.picture import Picture


def look(**links):
    """A Look of links, each a list of (kind, x, y, z, size, colour)."""
    out = Look(links=list(links), link_pose=[0, 0, 0, 0, 0, 0, 1] * len(links))
    for i, (kind, *at, size, colour) in (
        (i, shape) for i, shapes in enumerate(links.values()) for shape in shapes
    ):
        out.shape_link.append(i)
        out.shape_kind = bytes(out.shape_kind) + bytes([kind])
        out.shape_pose += [*at, 0, 0, 0, 1]
        out.shape_size += size
        out.shape_colour += (*colour, 1)
    return out


DARK, YELLOW, BROWN = (0.1, 0.1, 0.1), (0.9, 0.8, 0.2), (0.5, 0.3, 0.1)
KIVA = look(
    chassis=[
        (Look.BOX, 0, 0, 0.2, (0.8, 0.6, 0.3), DARK),
        (Look.SPHERE, 0, 0, 0.1, (0.1, 0.1, 0.1), DARK),  # too small to be seen from afar
    ],
    tower=[(Look.CYLINDER, 0, 0, 0.38, (0.5, 0.5, 0.1), YELLOW)],
)
UNIT = look(shelf=[(Look.BOX, 0, 0, z, (0.8, 0.8, 0.04), YELLOW) for z in (0.4, 0.8, 1.2)])
ITEM = look(body=[(Look.BOX, 0, 0, 0.06, (0.2, 0.15, 0.12), BROWN)])
PERSON = look(body=[(Look.CAPSULE, 0, 0, 0.9, (0.4, 0.4, 1.8), BROWN)])


class Scene(FakeRos):
    """Two robots, two units with an item each, and a person."""

    def __init__(self, turned=0.0, robots=2):
        super().__init__()
        self.warnings, self.numbers = [], list(range(1, robots + 1))
        self.picture = Picture(self)
        self.topic = self.publishers["warehouse/markers"]
        self.topic.listeners = 1
        self.tell_scenery()
        self.drive()
        self.callbacks["warehouse/objects"](
            WarehouseObjects(
                storage_units=["storage_unit1", "storage_unit2"],
                items=["item1", "item2"],
                item_unit=[0, 1],
                item_pose=[0.2, 0, 0.46, 0, 0, 0, 1] * 2,
            )
        )
        self.turn_unit(turned)

    def logwarn(self, text):
        self.warnings.append(text)

    def tell_scenery(self, floor=(-2.5, 2.5, -1.5, 1.5)):
        out = Scenery(floor=floor, grid_spacing=1.0, looks=[KIVA, UNIT, ITEM, PERSON])
        out.kiva_look, out.storage_unit_look, out.item_look = 0, 1, 2
        out.models, out.model_look, out.pose = ["person1"], [3], [2, 1, 0, 0, 0, 0, 1]
        self.callbacks["warehouse/scenery"](out)

    def drive(self, x=1.0, status=KivaStatus.STATUS_IDLE, shelf=0, ended=0):
        others = len(self.numbers) - 1
        self.callbacks["warehouse/fleet"](
            fleet_state(
                kiva_id=self.numbers,
                x=[x, *range(2, 2 + others)],
                status=bytes([status, *[0] * others]),
                shelf_id=[shelf, *[0] * others],
                last_end=bytes([ended, *[0] * others]),
            )
        )

    def go(self, number, *corners):
        x, y = zip(*corners) if corners else ((), ())
        ways = FleetPaths(kiva_id=[number][: len(corners)], points=[len(corners)][: len(corners)])
        ways.x, ways.y = x, y
        self.callbacks["warehouse/paths"](ways)

    def turn_unit(self, yaw, carrier=0, z=0.0):
        first = poses.planar(0, 0, 0)
        first[2] = z
        flat = [*first, *poses.planar(1, 1, yaw)]
        self.callbacks["warehouse/unit_states"](UnitStates(pose=flat, carrier=[carrier, 0]))

    def shown(self):
        """{name: marker} of what one more turn sends, as a subscriber reads it."""
        before = len(self.topic.sent)
        self.picture.turn(patience=0)
        assert len(self.topic.sent) <= before + 1
        sent = self.topic.sent[before:]
        return {m.text or m.ns: m for message in sent for m in _read(message)}

    def click(self, x, y):
        self.callbacks["clicked_point"](PointStamped(point=Point(x, y, 0)))

    def sent(self, topic):
        return self.publishers[topic].sent


def _read(message):
    buffer = BytesIO()
    message.serialize(buffer)
    return MarkerArray().deserialize(buffer.getvalue()).markers


def extent(marker):
    points = np.array([(p.x, p.y, p.z) for p in marker.points])
    return points.min(0).tolist(), points.max(0).tolist()


def colour(does):
    return tuple(np.round(markers.COLOURS[does][:3], 2))


def changed_colours(before, after):
    pairs = zip(before.colors, after.colors)
    return {(round(c.r, 2), round(c.g, 2), round(c.b, 2)) for b, c in pairs if b != c}


@pytest.fixture
def scene():
    return Scene()


def test_everything_is_shown(scene):
    shown = scene.shown()
    drawn = {name for name, marker in shown.items() if marker.action == Marker.ADD}
    assert drawn == {"robots", "kiva1", "kiva2", "units 1", "items 1", "scenery 4", "floor", "grid"}
    assert len(shown["units 1"].points) == 2 * 3
    assert shown["units 1"].scale.z == pytest.approx(0.04)
    assert extent(shown["floor"])[0][:2] == [-2.5, -1.5]
    assert extent(shown["scenery 4"])[1][2] == pytest.approx(1.8)


def test_a_robot_has_the_size_that_its_look_tells(scene):
    marker = scene.shown()["robots"]
    low, high = extent(marker)
    assert (low[0], high[0]) == pytest.approx((0.51, 2.49))  # with the frames on the floor
    body = [p for p in marker.points if p.z > 0.03]
    assert min(p.x for p in body) == pytest.approx(0.6)
    assert min(p.z for p in body) == pytest.approx(0.05)  # without the sphere beneath


def test_of_very_many_robots_each_is_a_box():
    marker = Scene(robots=1000).shown()["robots"]
    assert len(marker.points) == 1000 * (36 + 3 + 24)


def test_of_ten_thousand_robots_each_is_a_square():
    marker = Scene(robots=10_000).shown()["robots"]
    assert len(marker.points) == 10_000 * 6 <= markers.MOST_POINTS
    low, high = extent(marker)
    assert low[2] == high[2] > 0.4
    assert (low[1], high[1]) == pytest.approx((-0.3, 0.3))


def test_of_very_many_units_each_is_a_box_without_items(monkeypatch):
    monkeypatch.setattr(markers, "MOST_CUBES", 2 * 3 - 1)
    shown = Scene().shown()
    assert len(shown["units 1"].points) == 2
    assert "items 1" not in shown


def test_the_tower_goes_up_with_the_load(scene):
    before = extent(scene.shown()["robots"])[1][2]
    scene.drive(shelf=1)
    scene.turn_unit(0.0, carrier=1, z=0.1)
    assert extent(scene.shown()["robots"])[1][2] == pytest.approx(before + 0.1, abs=0.002)


def test_only_what_moved_is_sent_again(scene):
    scene.shown()
    assert scene.shown() == {}
    scene.drive(x=1.1)
    assert set(scene.shown()) == {"robots", "kiva1"}
    scene.turn_unit(0.3)
    assert set(scene.shown()) == {"units 1", "items 1", "units turned", "items turned"}


def test_a_newcomer_gets_everything(scene):
    scene.shown()
    scene.topic.connect()
    assert {"robots", "units 1", "floor"} <= {m.ns for m in _read(scene.topic.sent[-1])}


def test_a_robot_that_is_gone_takes_its_name_along(scene):
    scene.shown()
    scene.numbers = [1]
    scene.drive()
    (gone,) = [m for m in scene.shown().values() if m.ns == "names"]
    assert (gone.id, gone.action) == (2, Marker.DELETE)


def test_of_very_many_robots_those_with_trouble_are_named():
    scene = Scene(robots=300)
    assert not [m for m in scene.shown().values() if m.ns == "names"]
    scene.drive(ended=Event.BLOCKED)
    first = f"kiva{scene.numbers[0]}"
    assert [m.text for m in scene.shown().values() if m.ns == "names"] == [first]


def test_what_a_robot_does_has_its_colour(scene):
    idle = scene.shown()["robots"]
    scene.drive(status=KivaStatus.STATUS_BUSY)
    assert changed_colours(idle, scene.shown()["robots"]) == {colour(Activity.MOVING)}


def test_who_was_blocked_shows_it_until_the_next_command(scene):
    idle = scene.shown()["robots"]
    scene.drive(ended=Event.BLOCKED)
    blocked = scene.shown()["robots"]
    assert changed_colours(idle, blocked) == {colour(Activity.NEEDS_HELP)}
    scene.drive()
    assert changed_colours(blocked, scene.shown()["robots"]) == {colour(Activity.RESTING)}


def test_a_turned_unit_is_drawn_turned():
    shown = Scene(turned=math.pi / 4).shown()
    assert len(shown["units 1"].points) == 3
    low, high = extent(shown["units turned"])
    assert high[0] - low[0] == pytest.approx(0.8 * math.sqrt(2), abs=0.01)


def test_items_on_a_unit_put_down_after_a_quarter_turn():
    shown = Scene(turned=math.pi / 2).shown()
    (across,) = shown["items 1 across"].points
    assert (across.x, across.y) == pytest.approx((1, 1.2))
    assert shown["items 1 across"].scale.y == pytest.approx(0.2)


def test_a_floor_of_unknown_size_reaches_beyond_what_stands_on_it(scene):
    scene.tell_scenery(floor=(0, 0, 0, 0))
    assert extent(scene.shown()["floor"])[1][:2] == [4.5, 3.5]


def test_paths_lead_from_the_robot_to_its_goal(scene):
    scene.shown()
    scene.go(1, (3, 0), (3, 2))
    points = [(p.x, p.y) for p in scene.shown()["paths"].points]
    assert points == [(1, 0), (3, 0), (3, 0), (3, 2)]
    scene.go(1)
    assert scene.shown()["paths"].action == Marker.DELETE


def test_a_path_is_told_while_somebody_listens(scene):
    scene.go(1, (3, 0), (3, 2))
    scene.shown()
    assert scene.sent("kiva1/path") == []
    scene.publishers["kiva1/path"].listeners = 1
    scene.drive(x=1.5)
    scene.shown()
    (path,) = scene.sent("kiva1/path")
    at = [(p.pose.position.x, p.pose.position.y) for p in path.poses]
    assert at == [(1.5, 0), (3, 0), (3, 2)] and path.header.frame_id == "world"
    assert path.poses[1].pose.orientation.z == pytest.approx(math.sqrt(0.5))
    scene.shown()
    assert len(scene.sent("kiva1/path")) == 1
    scene.go(1)
    scene.shown()
    assert scene.sent("kiva1/path")[-1].poses == []


def test_a_click_chooses_a_robot_and_a_goal_sends_it(scene):
    scene.shown()
    goal = PoseStamped()
    goal.pose.position = Point(4.4, -1.6, 0)
    scene.callbacks["move_base_simple/goal"](goal)
    assert "Publish Point" in scene.warnings[0] and not scene.sent("mov")
    scene.click(2.3, 0.2)
    scene.drive()
    low, high = extent(scene.shown()["chosen"])
    assert [*low[:2], *high[:2]] == pytest.approx([1.52, -0.48, 2.48, 0.48])
    scene.callbacks["move_base_simple/goal"](goal)
    (sent,) = scene.sent("mov")
    assert (sent.kiva_id, sent.x, sent.y) == (2, 4, -2)


def test_the_laser_of_the_chosen_is_told_again(scene):
    scene.shown()
    scene.click(1.1, 0)
    scan = LaserScan(ranges=[1.0])
    scene.callbacks["kiva1/chassis/laser/scan"](scan)
    assert scene.sent("warehouse/chosen/scan") == [scan]
    scene.click(50, 50)
    scene.drive()
    assert "kiva1/chassis/laser/scan" not in scene.callbacks
