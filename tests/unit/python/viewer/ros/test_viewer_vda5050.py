# SPDX-License-Identifier: Apache-2.0
"""What the HTTP API tells of robots at a broker."""

import pytest
from fake_ros import FakeRos

from warehouse_msgs.msg import Vda5050
from warehouse_msgs.srv import (
    Vda5050FaultResponse,
    Vda5050OnboardResponse,
    Vda5050RemoveResponse,
    Vda5050SeenResponse,
)
from warehouse_viewer.api import catalogue
from warehouse_viewer.page.source import RefusedError
from warehouse_viewer.ros import vda5050_feed
from warehouse_viewer.ros.vda5050_feed import Vda5050Feed


def listing(direction=Vda5050.VEHICLE):
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
        planned_points=[0],
        waypoints=[0],
    )


def test_the_api_names_whose_robot_it_is():
    (robot,) = catalogue.at_broker(listing())
    assert (robot.driven_by, robot.connection, robot.order) == (
        "OUTSIDE_MASTER",
        "CONNECTIONBROKEN",
        "o",
    )
    assert robot.errors == ["orderError: off the floor", "motorError: no torque"]
    assert robot.faults == ["lost", "error:WARNING"]
    (robot,) = catalogue.at_broker(listing(Vda5050.MASTER))
    assert robot.driven_by == "COORDINATOR"


def test_the_feed_keeps_one_message_a_direction():
    ros = FakeRos()
    feed = Vda5050Feed(ros)
    feed._subscriber.get_num_connections = lambda: 1
    for message in (listing(), listing(), listing(Vda5050.MASTER)):
        feed._keep(message)
    assert len(feed.messages) == 2
    feed._subscriber.get_num_connections = lambda: 0
    assert feed.messages == []


def test_a_message_that_comes_before_its_connection_counts_is_kept(monkeypatch):
    feed, now = Vda5050Feed(FakeRos()), [100.0]
    monkeypatch.setattr(vda5050_feed.time, "monotonic", lambda: now[0])
    feed._keep(listing())
    feed._subscriber.get_num_connections = lambda: 0
    assert feed.messages == []
    feed._subscriber.get_num_connections = lambda: 1
    assert len(feed.messages) == 1
    now[0] += 2 * vda5050_feed.SETTLES
    feed._subscriber.get_num_connections = lambda: 0
    assert feed.messages == []
    feed._subscriber.get_num_connections = lambda: 1
    assert feed.messages == []  # of a node that has ended


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


def test_the_api_has_where_vehicles_say_that_they_will_drive():
    message = listing(Vda5050.MASTER)
    message.planned_points, message.waypoints = [2], [1]
    message.planned_x, message.planned_y = [0.0, 3.0], [1.0, 1.0]
    message.waypoint_x, message.waypoint_y, message.waypoint_time = [2.0], [1.0], [1e9]
    (robot,) = catalogue.at_broker(message)
    assert robot.planned_path == [[0.0, 1.0], [3.0, 1.0]]
    (point,) = robot.intermediate_path
    assert (point.x, point.y, point.time) == (2.0, 1.0, 1e9)


def test_vehicles_at_the_broker_come_from_the_master_and_refusals_go_back(monkeypatch):
    ros = FakeRos()
    feed, asked = Vda5050Feed(ros), []
    monkeypatch.setattr(vda5050_feed, "is_offered", lambda _ros, _name: True)
    answers = {
        vda5050_feed.SEEN: Vda5050SeenResponse(
            broker="host:1883",
            manufacturer=["acme"],
            serial=["7"],
            kiva_id=[0],
            connection=bytes([Vda5050.ONLINE]),
            mode=["AUTOMATIC"],
            placed=[True],
            x=[1.0],
            y=[2.0],
            theta=[0.5],
            map_id=["hall"],
            last_node=["n"],
            factsheet=[True],
            abilities=["it is small\nit is slow"],
            misfits=[""],
        ),
        vda5050_feed.ONBOARD: Vda5050OnboardResponse(True, "acme/7 is kiva4", 4),
        vda5050_feed.REMOVE: Vda5050RemoveResponse(False, "kiva4 carries storage_unit1"),
    }

    def request(_ros, name, _kind, fields):
        asked.append((name, fields))
        return answers[name]

    monkeypatch.setattr(vda5050_feed, "request", request)
    (vehicle,) = catalogue.seen_at_broker(feed.seen())
    assert (vehicle.id, vehicle.position) == (None, [1.0, 2.0, 0.5])
    assert (vehicle.abilities, vehicle.misfits) == (["it is small", "it is slow"], [])
    assert feed.onboard({"serial": "7"}) == (4, "acme/7 is kiva4")
    with pytest.raises(RefusedError, match="carries storage_unit1"):
        feed.remove(4)
    assert asked[1:] == [
        (vda5050_feed.ONBOARD, {"serial": "7"}),
        (vda5050_feed.REMOVE, {"kiva_id": 4}),
    ]
    answers[vda5050_feed.ONBOARD] = Vda5050OnboardResponse(False, "number 4 is taken", 0)
    with pytest.raises(RefusedError, match="number 4 is taken"):
        feed.onboard({})
    monkeypatch.setattr(vda5050_feed, "is_offered", lambda _ros, _name: False)
    with pytest.raises(RefusedError, match=r"start master\.launch"):
        feed.seen()


def test_a_vehicle_of_the_master_is_known_by_its_number():
    feed = Vda5050Feed(FakeRos())
    feed._subscriber.get_num_connections = lambda: 1
    feed._keep(listing())
    assert not feed.is_driven(7)  # an outside master may drive it: it is a robot of ours
    feed._keep(listing(Vda5050.MASTER))
    assert feed.is_driven(7) and not feed.is_driven(8)
