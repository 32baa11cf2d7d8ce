# SPDX-License-Identifier: Apache-2.0
"""A vehicle that was seen at the broker becomes a robot of the warehouse, or it is said why not."""

import math
from dataclasses import replace

import pytest

from warehouse_vda5050.grid import Grid
from warehouse_vda5050.master import introduction
from warehouse_vda5050.master.commands import Follow, RefusedError
from warehouse_vda5050.master.fleet import RemoteFleet
from warehouse_vda5050.master.onboarded_file import OnboardedFile
from warehouse_vda5050.master.onboarding import Floor, Request, make_robot
from warehouse_vda5050.master.robots_file import RemoteRobot, RobotsFileError
from warehouse_vda5050.master.seen import MOST, SeenVehicle, SeenVehicles
from warehouse_vda5050.model import (
    AgvPosition,
    Connection,
    ConnectionState,
    Factsheet,
    Header,
    NodeState,
    SupportedAction,
    VehicleOrder,
    VehicleState,
)
from warehouse_vda5050.topics import Identity

WHO = Identity("acme", "7")
GRID = Grid(-5, -5, 1.0, 20, 20, frozenset({(0, 0)}))
FLOOR = Floor(GRID, {1: (2.0, 2.0), 3: (0.0, 0.0)})
AT = AgvPosition(1.0, 2.0, 0.5, "hall")
STANDS = Request(0, True, (4.0, 3.0, 0.5 + math.pi / 2))


def seen(position=AT, **changes):
    state = VehicleState(position=position, header=Header(timestamp="t1"))
    vehicle = SeenVehicle(WHO, ConnectionState.ONLINE, state, Factsheet())
    return replace(vehicle, **changes)


def near(values, expected):
    assert list(values) == pytest.approx(list(expected), abs=1e-9)


# --- where it stands


def test_the_cell_where_it_stands_gives_the_origin_of_its_map():
    robot = make_robot(
        replace(STANDS, pose=(4.0, 3.0, math.pi / 2)), seen(replace(AT, theta=0)), FLOOR
    )
    near(robot.frame.to_world(1.0, 2.0, 0.0), (4.0, 3.0, math.pi / 2))
    assert (robot.number, robot.identity) == (2, WHO)


def test_a_map_that_is_turned_by_nearly_a_quarter_turn_is_taken_as_that():
    pose = (4.0, 3.0, math.pi / 2)
    robot = make_robot(replace(STANDS, pose=pose), seen(replace(AT, theta=0.03)), FLOOR)
    assert robot.frame.theta == pytest.approx(math.pi / 2)
    near(robot.frame.to_world(1.0, 2.0)[:2], (4.0, 3.0))


def test_a_map_that_is_askew_stays_so():
    pose = (4.0, 3.0, math.pi / 2)
    robot = make_robot(replace(STANDS, pose=pose), seen(AT), FLOOR)
    assert robot.frame.theta == pytest.approx(math.pi / 2 - 0.5)
    near(robot.frame.to_world(1.0, 2.0, 0.5), pose)


def test_the_origin_can_be_given():
    request = Request(9, False, (3.0, 1.0, 0.0), "m1", "N{row}-{column}", '{"loadType": "EPAL"}')
    robot = make_robot(request, seen(replace(AT, theta=0.0)), FLOOR)
    near((robot.frame.x, robot.frame.y, robot.frame.theta), (3.0, 1.0, 0.0))
    assert (robot.number, robot.map_id) == (9, "m1")
    assert robot.node_id((4, 7)) == "N7-4" and robot.action_parameters == {"loadType": "EPAL"}


STRAIGHT = replace(AT, theta=0.0)


@pytest.mark.parametrize(
    ("request_", "vehicle", "why"),
    [
        ({"number": 3}, {}, "number 3 is taken: kiva3 is there already"),
        ({"number": -1}, {}, "a robot's number is 1 to 1000000, not -1"),
        ({"pose": (90.0, 3.0, 0.0)}, {}, "it would stand at 90.00, 3.00 m: that is off the floor"),
        ({"pose": (-5.0, -5.0, 0.0)}, {}, "a wall or something else that is fixed stands there"),
        ({"pose": (2.2, 2.1, 0.0)}, {}, "it would stand at 2.00, 2.00 m: kiva1 stands there"),
        ({"pose": (4.0, 3.0, 0.8)}, {}, "it has to be along an axis"),
        ({"pose": (math.nan, 3.0, 0.0)}, {}, "x, y and theta have to be numbers"),
        ({"pose": (2.6, 1.0, 0.0), "stands": False}, {}, "that is not the middle of a cell"),
        ({"node_ids": "N7"}, {}, "a pattern such as c{column}_{row} was expected"),
        ({"action_parameters": "[1"}, {}, "action_parameters: "),
        ({"action_parameters": "[1]"}, {}, "a short object, names with values, was expected"),
        ({}, {"sheet": None}, "acme/7 has no factsheet (none has come): confirm what is assumed"),
        ({}, {"state": None}, "acme/7 has not reported where it is: localize it first"),
        ({}, {"connection": ConnectionState.OFFLINE}, "acme/7 is not connected to the broker"),
        ({}, {"sheet": Factsheet(length=1.4)}, "acme/7 does not fit: it is 1.4 m long, and a cell"),
    ],
)
def test_what_can_not_be_is_refused(request_, vehicle, why):
    request = replace(Request(0, True, (4.0, 3.0, 0.0)), **request_)
    with pytest.raises(RefusedError) as refusal:
        make_robot(request, seen(STRAIGHT, **vehicle), FLOOR)
    assert why in str(refusal.value)


def test_a_vehicle_that_does_not_know_where_it_is_can_not_be_placed():
    lost = replace(STRAIGHT, initialized=False)
    with pytest.raises(RefusedError, match="localize it first"):
        make_robot(STANDS, seen(lost), FLOOR)


def test_without_a_factsheet_it_is_taken_if_a_person_says_so():
    request = replace(STANDS, pose=(4.0, 3.0, 0.0), assume=True)
    assert make_robot(request, seen(STRAIGHT, sheet=None), FLOOR).number == 2


# --- what is said of it


def test_the_factsheet_is_said_in_sentences():
    sheet = Factsheet("Mule", kinematics="DIFF", max_load_mass=80.0, max_speed=0.9, length=0.9)
    rows = [*introduction.abilities(sheet)]
    assert rows[0] == "Mule, CARRIER, DIFF" and "it carries up to 80 kg" in rows
    said = [*introduction.misfits(seen(sheet=sheet), {}, 1.0)]
    assert said == [
        "it needs 1.08 m to turn, more than a cell: it reaches into those beside",
        "plans reckon with 1.5 m/s: robots behind it wait",
    ]


def test_what_its_actions_lack_is_said():
    rows = (("height", "NUMBER", False, ""),)
    pick = SupportedAction("pick", ("NODE",), parameters=rows)
    sheet = Factsheet(actions=(pick,), parameters=(("order.edges.corridor", "REQUIRED", ""),))
    said = [*introduction.misfits(seen(sheet=sheet), {}, 1.0)]
    assert said[0].startswith("no unit is given to it: its factsheet requires height of each pick")
    assert said[1] == "no unit is given to it: its factsheet has no drop at nodes"
    assert said[2].startswith("its factsheet requires corridor in orders")
    assert said[3] == "its factsheet has no cancelOrder: it may not obey that"


def test_what_is_assumed_and_what_is_invalid_is_said():
    (said,) = introduction.misfits(seen(sheet=None), {}, 1.0)
    assert said.startswith("it has sent no factsheet: that it fits into a cell")
    sheet = Factsheet(faults=("x is 1; 2 was expected",))
    assert [*introduction.misfits(seen(sheet=sheet), {}, 1.0)] == [
        "its factsheet is invalid: x is 1; 2 was expected"
    ]


# --- in the fleet


def fleet_with(robots=()):
    fleet = RemoteFleet(robots, GRID, "run")
    fleet.take(WHO, Connection(ConnectionState.ONLINE), 0.0)
    fleet.take(WHO, Factsheet(max_nodes=2), 0.0)
    fleet.take(WHO, VehicleState(position=STRAIGHT, header=Header(timestamp="t1")), 0.0)
    return fleet


def test_a_vehicle_that_is_added_has_what_was_heard_of_it_and_is_driven():
    fleet = fleet_with()
    assert fleet.shadows(0.0) == [] and [*fleet.messages(0.0)] == []
    robot = make_robot(replace(STANDS, pose=(4.0, 3.0, 0.0)), fleet.roster.get(WHO), FLOOR)
    fleet.add(robot, 0.0)
    (shadow,) = fleet.shadows(0.0)
    near((shadow.kiva_id, shadow.x, shadow.y), (2, 4.0, 3.0))
    fleet.command(2, Follow(1, 0, ((4.0, 3.0), (5.0, 3.0), (6.0, 3.0)), 3))
    orders = [m for _, m in fleet.messages(0.0) if isinstance(m, VehicleOrder)]
    assert len(orders[0].nodes) == 2  # by its factsheet
    assert orders[0].nodes[0].position.map_id == "hall"
    near((orders[0].nodes[1].position.x, orders[0].nodes[1].position.y), (2.0, 2.0))


def test_the_same_vehicle_is_no_second_robot():
    fleet = fleet_with([RemoteRobot(5, WHO)])
    with pytest.raises(RefusedError, match="acme/7 is kiva5 already"):
        fleet.add(RemoteRobot(6, WHO), 0.0)


def test_a_vehicle_is_removed_if_it_does_and_carries_nothing():
    fleet = fleet_with([RemoteRobot(5, WHO)])
    (vehicle,) = fleet.vehicles
    with pytest.raises(RefusedError, match="kiva6 is no vehicle of this master"):
        fleet.remove(6)
    vehicle.load = 4
    with pytest.raises(RefusedError, match="kiva5 carries storage_unit4"):
        fleet.remove(5)
    vehicle.load = 0
    nodes = (NodeState("n", 2, True),)
    fleet.take(WHO, VehicleState(nodes=nodes, position=AT, header=Header(timestamp="t2")), 0.0)
    with pytest.raises(RefusedError, match="kiva5 carries out a command"):
        fleet.remove(5)
    fleet = fleet_with([RemoteRobot(5, WHO)])
    fleet.remove(5)
    assert fleet.vehicles == [] and fleet.of(WHO) is None and fleet.roster.get(WHO) is not None
    fleet.command(5, Follow(1, 0, ((4.0, 3.0),), 1))
    assert [*fleet.messages(100.0)] == []


def test_a_broker_full_of_strangers_is_forgotten_in_part():
    vehicles = SeenVehicles()
    for number in range(MOST + 5):
        vehicles.take(Identity("acme", str(number)), Connection(ConnectionState.ONLINE))
    assert len(vehicles.all()) == MOST


# --- the file


def test_what_was_added_and_removed_is_known_after_a_restart(tmp_path):
    path = tmp_path / "robots.yaml"
    path.write_text("21: {manufacturer: acme, serial: '1'}  # by hand\n")
    file = OnboardedFile(path)
    request = Request(9, False, (3.0, 1.0, 0.0), "m1", "N{row}-{column}", '{"loadType": "EPAL"}')
    robot = make_robot(request, seen(STRAIGHT), FLOOR)
    file.add(robot)
    again = OnboardedFile(path)
    assert [r.number for r in again.robots()] == [9, 21] and again.robots()[0] == robot
    again.remove(21)
    again.remove(9)
    assert OnboardedFile(path).robots() == []
    assert path.read_text().endswith("# by hand\n")  # a person's file is left as it is


def test_without_a_file_of_robots_there_is_one_to_add_to(tmp_path):
    path = tmp_path / "folder" / "robots.yaml"
    file = OnboardedFile(path, optional=True)
    assert file.robots() == []
    file.add(RemoteRobot(4, WHO))
    assert OnboardedFile(path, optional=True).robots() == [RemoteRobot(4, WHO)]
    with pytest.raises(RobotsFileError):
        OnboardedFile(path)


@pytest.mark.parametrize("text", ["- 1\n", "4: {manufacturer: 3}\n", "4: ["])
def test_a_damaged_file_is_named(tmp_path, text):
    path = tmp_path / "robots.yaml"
    path.with_name("robots.onboarded.yaml").write_text(text)
    with pytest.raises(RobotsFileError, match=r"robots\.onboarded\.yaml"):
        OnboardedFile(path, optional=True).robots()
