# SPDX-License-Identifier: Apache-2.0
"""A world without ROS, as the page sees it."""

import math

import pytest
from paths import ROOT

from kiva_plugin_cpp import World
from warehouse_viewer.page.world_source import WorldFeed

KIVA = (ROOT / "worlds" / "models" / "kiva" / "model.sdf").read_text()


def robot(laser):
    """SDF of a robot with that laser plugin; its parameters that are not told have defaults."""
    begin = KIVA.index('<plugin name="laser"')
    end = KIVA.index("</plugin>", begin) + len("</plugin>")
    return KIVA[:begin] + laser + KIVA[end:]


@pytest.fixture
def feed():
    world = World()
    own = '<plugin name="laser" filename="libkiva_laser.so"><rays>31</rays><x>0.1</x>'
    own += "<min_angle>-0.5</min_angle><max_angle>1</max_angle></plugin>"
    world.spawn(KIVA, "kiva1", [0, 0, 0, 0])
    world.spawn(robot(own), "kiva2", [3, 0, 0, 0])
    world.spawn(robot(""), "kiva3", [6, 0, 0, 0])
    return WorldFeed(world, None)


def test_each_scan_is_that_of_its_robots_own_laser(feed):
    feed.subscribe_extras(False, False, [1, 2, 3, 4])
    feed.update()
    assert len(feed["scan1"].ranges) == 121
    assert feed["scan1"].angle_min == pytest.approx(-math.pi / 3)
    assert len(feed["scan2"].ranges) == 31
    assert (feed["scan2"].angle_min, feed["scan2"].angle_increment) == (-0.5, 0.05)
    assert not any(math.isnan(r) for r in feed["scan2"].ranges)
    assert feed["scan3"] is None and feed["scan4"] is None


def test_lasers_are_where_their_robots_have_them(feed):
    places = {at.child_frame_id: at.transform.translation for at in feed["frames"].transforms}
    assert places.keys() == {"kiva1/laser", "kiva2/laser"}
    assert (places["kiva1/laser"].x, places["kiva2/laser"].x) == (0.38, 0.1)
