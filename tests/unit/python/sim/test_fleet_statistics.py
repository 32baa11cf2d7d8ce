# SPDX-License-Identifier: Apache-2.0
"""What each robot did, as a table."""

import math

import pytest
from fake_ros import FakeRos, fleet_state

from warehouse_msgs.msg import Event
from warehouse_sim.fleet_statistics import FleetStatistics


@pytest.fixture
def ros():
    return FakeRos()


def drive(ros, *poses):
    for x, y, yaw in poses:
        ros.callbacks["warehouse/fleet"](fleet_state(kiva_id=[4], x=[x], y=[y], yaw=[yaw]))


def row(statistics, events=()):
    return statistics.table([4], events).splitlines()[-1].split()


def test_the_way_is_summed_up(ros):
    statistics = FleetStatistics(ros)
    drive(ros, (0, 0, 0), (2, 0, 0), (2, 0, math.pi / 2), (2, 1, math.pi / 2), (2, 0, math.pi / 2))
    assert row(statistics)[:3] == ["kiva4", "4.0", "1"]


def test_turning_over_half_a_turn_is_no_whole_turn(ros):
    statistics = FleetStatistics(ros)
    drive(ros, (0, 0, 3 * math.pi / 4), (0, 0, -3 * math.pi / 4))
    assert row(statistics)[2] == "1"


def test_events_are_counted(ros):
    kinds = [Event.ACCEPTED] * 5 + [Event.LIFTED, Event.DROPPED, Event.BLOCKED, Event.REFUSED]
    events = [Event(kind=kind, model="kiva4") for kind in kinds]
    events += [Event(kind=Event.DONE, model="kiva4"), Event(kind=Event.BLOCKED, model="kiva5")]
    events += [Event(kind=Event.COLLISION, model="kiva5", other="kiva4")]
    assert row(FleetStatistics(ros), events)[3:] == ["5", "2", "1", "1", "1"]


def test_columns_have_titles_of_their_width(ros):
    lines = FleetStatistics(ros).table([4, 12], []).splitlines()
    assert len(lines) == 4
    assert len({len(line) for line in lines}) == 1
