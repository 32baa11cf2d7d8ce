# SPDX-License-Identifier: Apache-2.0
"""The warehouse at a glance, once a second and whenever something comes or goes."""

import io

import pytest
import rospy
from fake_ros import FakeRos, fleet_state

from warehouse_layout.floor import poses
from warehouse_msgs.msg import KivaStatus, UnitStates, WarehouseObjects
from warehouse_sim.state import StatePublisher


class World(FakeRos):
    """Two robots and a unit carried by the second."""

    def __init__(self):
        super().__init__()
        self.publisher = StatePublisher(self)
        self.topic = self.publishers["warehouse/state"]
        self.topic.connect()

    def tell(self, revision=1):
        self.callbacks["warehouse/objects"](
            WarehouseObjects(
                revision=revision,
                storage_units=["storage_unit3"],
                items=["item1", "item2"],
                item_unit=[0, 0],
                item_pose=[*poses.planar(0, 0, 0)] * 2,
                belts=["conveyor_belt1"],
                kiva_id=[1, 4],
            )
        )
        self.callbacks["warehouse/unit_states"](
            UnitStates(revision=revision, pose=[*poses.planar(5, 6, 0)], carrier=[4])
        )

    def drive(self, seconds):
        self.callbacks["warehouse/fleet"](
            fleet_state(
                stamp=rospy.Time(seconds),
                kiva_id=[1, 4],
                x=[1, 5],
                y=[2, 6],
                yaw=[0, 1.5],
                status=[KivaStatus.STATUS_IDLE, KivaStatus.STATUS_BUSY],
                state=[KivaStatus.STATE_IDLE, KivaStatus.STATE_MOVING_X],
                shelf_id=[0, 3],
            )
        )

    def turn(self):
        """How many messages one turn publishes."""
        before = len(self.topic.sent)
        self.publisher.turn(patience=0)
        return len(self.topic.sent) - before


@pytest.fixture
def world():
    return World()


def test_everything_is_in_it(world):
    world.parameters |= {"warehouse/name": "small", "warehouse/id": 9}
    world.tell()
    world.drive(seconds=12)
    assert world.turn() == 1
    state = world.topic.sent[-1]
    assert (state.warehouse_name, state.warehouse_id) == ("small", 9)
    assert (state.robots, state.items, state.shelves, state.belts) == (2, 2, 1, 1)
    assert (state.header.stamp, state.header.frame_id) == (rospy.Time(12), "world")
    second = state.kivas[1]
    assert (second.kiva_id, second.shelf_id, second.pose.y) == (4, 3, 6)
    assert (second.status, second.state) == (KivaStatus.STATUS_BUSY, KivaStatus.STATE_MOVING_X)
    unit = state.storage_units[0]
    assert (unit.name, unit.carrier, unit.pose.position.x) == ("storage_unit3", "kiva4", 5)


def test_once_a_second_of_simulated_time(world):
    world.tell()
    published = []
    for tenth in range(100, 130):
        world.drive(seconds=tenth / 10)
        published.append(world.turn())
    assert published == ([1] + 9 * [0]) * 3


def test_at_once_when_something_comes_or_goes(world):
    world.tell(revision=1)
    assert (world.turn(), world.turn()) == (1, 0)
    world.tell(revision=2)
    assert (world.turn(), world.turn()) == (1, 0)


def test_a_new_name_is_seen_while_time_stands_still(world):
    world.tell()
    assert (world.turn(), world.turn()) == (1, 0)
    world.parameters["warehouse/name"] = "new"
    assert (world.turn(), world.turn()) == (1, 0)
    assert world.topic.sent[-1].warehouse_name == "new"


def test_goes_on_after_time_was_reset(world):
    world.tell()
    world.drive(seconds=100)
    world.turn()
    world.drive(seconds=0)
    assert world.turn() == 1


def test_nothing_before_the_world_has_told(world):
    world.drive(seconds=3)
    assert world.turn() == 0
    assert world.topic.sent == []


def test_a_newcomer_gets_the_newest_at_once(world):
    world.tell(revision=1)
    world.turn()
    world.drive(seconds=10.3)
    world.topic.connect()
    assert world.topic.sent[-1].kivas[0].pose.x == 1


@pytest.mark.parametrize("wrong", ["seven", 1.5, 2**40, True, [7]])
def test_an_id_of_another_type_is_told_and_ends_nothing(world, wrong):
    world.parameters["warehouse/id"] = wrong
    world.tell()
    assert world.turn() == 1
    world.topic.sent[-1].serialize(io.BytesIO())
    assert world.topic.sent[-1].warehouse_id == 0
    assert "warehouse/id is" in world.warnings[0]
