# SPDX-License-Identifier: Apache-2.0
"""What the HTTP API tells of robots at a broker."""

from fake_ros import FakeRos

from warehouse_msgs.msg import Vda5050
from warehouse_viewer.api import catalogue
from warehouse_viewer.ros.vda5050_feed import Vda5050Feed


def told(direction=Vda5050.VEHICLE):
    return Vda5050(
        broker="host:1883",
        direction=direction,
        kiva_id=[7],
        manufacturer=["kiva"],
        serial=["7"],
        connection=bytes([Vda5050.CONNECTIONBROKEN]),
        order=["o"],
        errors=["orderError: off the floor\nmotorError: no torque"],
        driven=[True],
    )


def test_the_api_names_whose_robot_it_is():
    (robot,) = catalogue.at_broker(told())
    assert (robot.driven_by, robot.connection, robot.order) == (
        "OUTSIDE_MASTER",
        "CONNECTIONBROKEN",
        "o",
    )
    assert robot.errors == ["orderError: off the floor", "motorError: no torque"]
    (robot,) = catalogue.at_broker(told(Vda5050.MASTER))
    assert robot.driven_by == "COORDINATOR"


def test_the_feed_keeps_one_message_a_direction():
    ros = FakeRos()
    feed = Vda5050Feed(ros)
    feed._subscriber.get_num_connections = lambda: 1
    for message in (told(), told(), told(Vda5050.MASTER)):
        feed._keep(message)
    assert len(feed.messages) == 2
    feed._subscriber.get_num_connections = lambda: 0
    assert feed.messages == []
