# SPDX-License-Identifier: Apache-2.0
"""What the page is told: what changed, no more, and in the frame that spares most bytes."""

import math

import numpy as np
import pytest
from sample_messages import World, fleet, objects, rows, scenery, states

from warehouse_msgs.msg import (
    Event,
)
from warehouse_viewer.page import protocol
from warehouse_viewer.page.activities import Activity
from warehouse_viewer.page.table import Table

HEAD = 40  # bytes before the rows of an update


def unit_row(model):
    return model.units.rows[0]


def test_a_newcomer_gets_all_and_then_what_changed():
    world = World()
    assert world.turn()
    assert rows(world.model.encode_update(-1)) == [2, 1, 1, 1]
    tick = world.model.tick
    assert world.turn(fleet=fleet(x=(0.0, 1.5)))
    assert rows(world.model.encode_update(tick)) == [1, 0, 0, 0]
    assert rows(world.model.encode_update(world.model.tick)) == [0, 0, 0, 0]


def test_nothing_new_is_no_update():
    world = World()
    world.turn()
    assert not world.turn(fleet=fleet(stamp=1.1))


def test_time_alone_is_an_update_now_and_then():
    world = World()
    world.turn()
    world.now += 0.6
    assert world.turn(fleet=fleet(stamp=1.1))
    assert not world.turn(fleet=fleet(stamp=1.2))
    world.now += 0.6
    assert world.turn()  # with what came before
    world.now += 0.6
    assert not world.turn()


def test_bytes_are_as_described():
    world = World()
    world.turn(fleet=fleet(x=(2.5, 1.0), shelf=(7, 0), stamp=4.0))
    update = world.model.encode_update(-1)
    assert len(update) == HEAD + 2 * 28 + 3 * 36
    assert np.frombuffer(update, "<u4", 2).tolist() == [protocol.UPDATE, 1]
    assert np.frombuffer(update, "<f8", 1, 8)[0] == 4.0
    first = np.frombuffer(update, protocol.ROBOT, 1, HEAD)[0]
    assert (first["index"], first["x"], first["shelf"]) == (0, 2.5, 7)


def test_the_limit_that_a_robot_keeps_for_its_load():
    world = World()
    world.turn(fleet=fleet(limit=(3.0, math.inf)))
    assert world.model.robots.rows["load_limit"].tolist() == [3, 0]
    world.turn(fleet=fleet())  # loads are ideal
    assert world.model.robots.rows["load_limit"].tolist() == [0, 0]


def test_an_item_that_fell_lies_where_it_is_reported():
    world = World()
    world.turn()
    fallen = objects()
    fallen.item_unit, fallen.fallen_item, fallen.fallen_from = [-1], [0], [0]
    lies = states()
    lies.loose_item, lies.loose_pose = [0], [3, 4, 0, 0, 0, 0, 1]
    assert world.turn(objects=fallen, states=lies)
    assert world.model.loose.rows[0]["pose"][:2].tolist() == [3, 4]
    scene = world.model.scene()
    assert (scene["item_unit"], scene["fallen_item"], scene["fallen_from"]) == ([-1], [0], [0])


def test_a_carried_unit_costs_nothing_while_it_is_driven():
    world = World()
    world.turn()
    world.turn(fleet=fleet(shelf=(1, 0)), states=states(x=0.0, z=0.1, carrier=1))
    assert unit_row(world.model)["pose"][:3] == pytest.approx([0, 0, 0.1])
    tick = world.model.tick
    world.turn(
        fleet=fleet(x=(0.7, 1.0), vx=(1.0, 0.0), shelf=(1, 0)),
        states=states(x=0.55, z=0.1, carrier=1),  # of another moment
    )
    assert rows(world.model.encode_update(tick)) == [1, 0, 0, 0]


def test_a_unit_first_seen_under_way_sits_on_its_robot():
    world = World()
    moving = fleet(x=(3.0, 1.0), vx=(1.5, 0.0), yaw=(math.pi / 2, 0.0), shelf=(1, 0))
    world.turn(fleet=moving, states=states(x=2.9, z=0.1, yaw=0.02, carrier=1))
    pose = unit_row(world.model)["pose"]
    assert pose[:3] == pytest.approx([0, 0, 0.1])
    assert 2 * math.atan2(pose[5], pose[6]) == pytest.approx(-math.pi / 2)


def test_a_dropped_unit_is_where_it_stands():
    world = World()
    world.turn(fleet=fleet(shelf=(1, 0)), states=states(x=0.0, z=0.1, carrier=1))
    world.turn(fleet=fleet(x=(3.0, 1.0)), states=states(x=3.0))
    assert unit_row(world.model)["pose"][0] == 3.0
    assert unit_row(world.model)["carrier"] == 0


def test_blocked_shows_until_the_next_command():
    world = World()
    world.turn(fleet=fleet(ended=(0, Event.BLOCKED)))
    assert world.model.robots.rows["activity"].tolist() == [0, Activity.NEEDS_HELP]
    world.turn(fleet=fleet(ended=(0, 0)))
    assert world.model.robots.rows["activity"].tolist() == [0, 0]


def test_a_new_scene_when_something_comes():
    world = World()
    world.turn()
    before = world.model.revision
    world.turn(objects=objects(items=2))
    assert world.model.revision == before + 1
    assert world.model.scene()["items"] == ["item1", "item2"]
    assert rows(world.model.encode_update(-1)) == [2, 1, 2, 1]


def test_scenery_that_moves_is_no_new_scene():
    world = World()
    world.turn()
    before, tick = world.model.revision, world.model.tick
    world.turn(scenery=scenery(x=8.0))
    assert world.model.revision == before
    assert rows(world.model.encode_update(tick)) == [0, 0, 0, 1]


def test_looks_come_by_link():
    world = World()
    world.turn()
    (look,) = world.model.scene()["looks"]
    assert look[0]["name"] == "body"
    assert look[0]["shapes"][0]["size"] == [1, 1, 1]


def test_a_robot_that_goes_changes_the_scene():
    world = World()
    world.turn()
    world.turn(fleet=fleet(x=(0.0,), vx=(0.0,), yaw=(0.0,), shelf=(0,)))
    assert world.model.scene()["robots"] == [1]


def test_a_table_tells_each_reader_what_is_new_to_it():
    table = Table(protocol.ROBOT)
    table.resize(3, tick=1)
    assert table.set(2, x=[0, 5, 0])
    assert not table.set(3, x=[0, 5, 0])
    table.set(4, x=[1, 5, 0])
    assert table.since(1)["index"].tolist() == [0, 1]
    assert table.since(2)["index"].tolist() == [0]
    assert len(table.since(4)) == 0
