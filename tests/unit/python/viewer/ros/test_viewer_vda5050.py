# SPDX-License-Identifier: Apache-2.0
"""What the HTTP API tells of robots at a broker."""

import pytest
from fake_ros import FakeRos

from warehouse_msgs.msg import Vda5050
from warehouse_msgs.srv import Vda5050FaultResponse
from warehouse_viewer.api import catalogue
from warehouse_viewer.page.source import RefusedError
from warehouse_viewer.ros import vda5050_feed
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
        faults=["lost, error:WARNING"],
    )


def test_the_api_names_whose_robot_it_is():
    (robot,) = catalogue.at_broker(told())
    assert (robot.driven_by, robot.connection, robot.order) == (
        "OUTSIDE_MASTER",
        "CONNECTIONBROKEN",
        "o",
    )
    assert robot.errors == ["orderError: off the floor", "motorError: no torque"]
    assert robot.faults == ["lost", "error:WARNING"]
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


def test_a_fault_goes_to_the_vehicles_and_their_refusal_comes_back(monkeypatch):
    ros = FakeRos()
    feed, asked = Vda5050Feed(ros), []
    monkeypatch.setattr(vda5050_feed, "is_offered", lambda _ros, name: name == vda5050_feed.FAULT)

    def request(_ros, name, _kind, fields):
        asked.append((name, fields))
        return Vda5050FaultResponse(fields["kiva_id"] == 1, "kiva2 is no vehicle")

    monkeypatch.setattr(vda5050_feed, "request", request)
    feed.begin_fault(1, "lost", 2.0)
    fields = {"kiva_id": 1, "fault": "lost", "seconds": 2.0}
    assert asked == [("warehouse/vda5050_fault", fields)]
    with pytest.raises(RefusedError, match="kiva2 is no vehicle"):
        feed.begin_fault(2, "lost", 0.0)
    monkeypatch.setattr(vda5050_feed, "is_offered", lambda _ros, name: False)
    with pytest.raises(RefusedError, match=r"start vehicles\.launch"):
        feed.begin_fault(1, "lost", 0.0)
