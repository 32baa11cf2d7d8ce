# SPDX-License-Identifier: Apache-2.0
"""An emergency stop holds the whole fleet, however it was asked for, until it is released."""

import rospy
from fake_ros import FakeRos, fleet_state

from warehouse_client.heard_commands import Heard
from warehouse_viewer.ros.emergency_stop import HELD, EmergencyStop
from warehouse_viewer.watch import troubles
from warehouse_viewer.watch.alarm_book import Trouble


class Ros(FakeRos):
    def set_param(self, name, value):
        self.parameters[name] = value


def fleet(time, robots=(1, 2), timeline=0):
    return fleet_state(stamp=rospy.Time(time), kiva_id=[*robots], timeline=timeline)


def heard(**fields):
    return Heard("/stop", "/someone", fields)


def sent(ros):
    return [(message.kiva_id, message.stop) for message in ros.publishers["stop"].sent]


def test_it_stops_all_and_releases_all():
    ros = Ros()
    stop = EmergencyStop(ros)
    stop.keep(fleet(7))
    stop.stop("Ann")
    assert stop.hold == ("Ann", 7.0) and sent(ros) == [(0, True)]
    stop.stop("Bob")  # the first has asked for it
    assert stop.hold.by == "Ann"
    assert stop.release() == "the robots go on"
    assert stop.hold is None and sent(ros)[-1] == (0, False)


def test_robots_that_come_and_those_of_another_timeline_stand_too():
    ros = Ros()
    stop = EmergencyStop(ros)
    stop.keep(fleet(7))
    stop.stop("Ann")
    stop.keep(fleet(8))
    assert len(sent(ros)) == 1
    stop.keep(fleet(9, robots=(1, 2, 3)))
    stop.keep(fleet(0, robots=(1, 2, 3), timeline=1))
    assert sent(ros) == [(0, True)] * 3
    stop.release()
    stop.keep(fleet(5, robots=(1, 2, 3), timeline=2))  # a checkpoint of during the stop
    assert sent(ros)[-2:] == [(0, False)] * 2


def test_it_outlasts_the_viewer_and_hears_other_clients():
    ros = Ros()
    EmergencyStop(ros).stop("Ann")
    again = EmergencyStop(ros)
    assert again.hold.by == "Ann"
    again.hear(heard(kiva_id=3, stop=0))
    again.hear(heard(kiva_id=0))
    again.hear(heard(stop=0))
    again.hear(Heard("/rot", "/someone", {"kiva_id": 0, "direction": 1}))
    assert again.hold
    again.hear(heard(kiva_id=0, stop=0))
    assert again.hold is None and not ros.parameters[HELD]
    again.hear(heard(kiva_id=0, stop=1))
    assert again.hold.by == ""


def test_it_is_one_alarm_and_what_follows_from_it_is_none():
    ros = Ros()
    stop = EmergencyStop(ros)
    stop.stop("Ann")
    waits = Trouble("ROBOT_WAITS", "kiva1", "kiva1 waits")
    broken = Trouble("ROBOT_BROKEN", "kiva2", "kiva2 is broken")
    first, *rest = troubles.of_stop(stop, [waits, broken])
    assert (first.kind, first.text) == ("EMERGENCY_STOP", "Ann has stopped all robots")
    assert rest == [broken]
    stop.keep(fleet(100))
    stop.release()
    stop.keep(fleet(110))  # robots have not come far yet
    assert troubles.of_stop(stop, [waits, broken]) == [broken]
    stop.keep(fleet(200))
    assert troubles.of_stop(stop, [waits, broken]) == [waits, broken]
