# SPDX-License-Identifier: Apache-2.0
"""Messages that are not sound are dropped where they come in, with a warning that says why."""

import math
import re
from pathlib import Path
from types import SimpleNamespace

import pytest
from fake_ros import FakeRos, fleet_state
from geometry_msgs.msg import PointStamped
from paths import ROOT
from roslib.message import get_message_class
from rospy.numpy_msg import numpy_msg
from sensor_msgs.msg import LaserScan

from warehouse_client import message_check
from warehouse_client.message_contracts import CONTRACTS
from warehouse_msgs.msg import (
    CoordinatorPaths,
    CoordinatorState,
    Event,
    FleetPaths,
    FleetState,
    HeatMap,
    Look,
    Scenery,
    Station,
    StationState,
    StationStates,
    TransportEvent,
    UnitStates,
    WarehouseObjects,
)

POSE = [0.0, 0, 0, 0, 0, 0, 1]


def objects(**changes):
    fields = {
        "storage_units": ["storage_unit1", "storage_unit7"],
        "items": ["item1"],
        "item_unit": [1],
        "item_pose": POSE,
        "belts": ["conveyor_belt1"],
        "kiva_id": [1, 2],
    }
    return WarehouseObjects(**(fields | changes))


def look(**changes):
    fields = {"links": ["link"], "link_pose": POSE, "shape_link": [0], "shape_kind": [0]}
    fields |= {"shape_pose": POSE, "shape_size": [1.0] * 3, "shape_colour": [1.0] * 4}
    return Look(**(fields | changes))


def scenery(**changes):
    fields = {"grid_spacing": 1.0, "looks": [look()], "models": ["wall"], "model_look": [0]}
    return Scenery(**(fields | {"pose": POSE, "floor": [-1, 1, -2, 2]} | changes))


FAULTS = {
    "x is nan; a finite number": fleet_state(kiva_id=[1, 2], x=[0.0, math.nan]),
    "x is inf; a finite number": fleet_state(kiva_id=[1], x=[math.inf]),
    "y is -1e+300; a finite number up to 1e+12": fleet_state(kiva_id=[1], y=[-1e300]),
    "x has 1 entries; 2 for the 2 in kiva_id": fleet_state(kiva_id=[1, 2], x=[0.0]),
    "load_limit has 1 entries; 2": fleet_state(kiva_id=[1, 2], load_limit=[0.0]),
    "state is 255; one of 0 (IDLE)": fleet_state(kiva_id=[1], state=bytes([255])),
    "last_end is 7; one of 0 (none yet), 2 (DONE)": fleet_state(kiva_id=[1], last_end=[7]),
    "kiva_id is 0; a number above 0": fleet_state(kiva_id=[0]),
    "kiva_id holds a number twice": fleet_state(kiva_id=[3, 3]),
    "kind is 255; one of 0 (ACCEPTED)": Event(kind=255),
    "kind is 8; one of 0 (RECEIVED)": TransportEvent(kind=8),
    "pose has 7 entries; 14 for the 2 in carrier": UnitStates(pose=POSE, carrier=[0, 0]),
    "loose_pose has 0 entries; 7 for the 1 in": UnitStates(loose_item=[0]),
    "item_unit is 2; -1 to 1, an index into storage_units,": objects(item_unit=[2]),
    "fallen_item is -1; 0 to 0": objects(fallen_item=[-1], fallen_from=[0]),
    "items is 'box'; item and a number": objects(items=["box"]),
    "storage_units is 'storage_unit٣'": objects(storage_units=["storage_unit٣"]),
    "storage_units holds a name twice": objects(storage_units=["storage_unit1"] * 2),
    "grid_spacing is 0.0; a number above 0": scenery(grid_spacing=0.0),
    "kiva_look is 1; -1 to 0, an index into looks,": scenery(kiva_look=1),
    "looks[0].shape_kind is 9; one of 0 (BOX)": scenery(looks=[look(shape_kind=[9])]),
    "looks[0].shape_size has 2 entries; 3": scenery(looks=[look(shape_size=[1.0] * 2)]),
    "x has 3 entries; 2, the sum of points, were": FleetPaths([], [1], [2], [0.0] * 3, [0.0] * 3),
    "service is 0; 0 to -1": Station(kind="PICK"),
    "stations[1].kind is 'pick'; one of PICK, REPLENISH": StationStates(
        stations=[StationState(kind="PICK"), StationState(kind="pick")]
    ),
    "doing is 'sings'; one of fetching": CoordinatorState(doing_kiva=[1], doing=["sings"]),
    "waiting has 0 entries; 1": HeatMap(spacing=1.0, width=1, traffic=[0.0]),
    "point.x is nan": PointStamped(point=SimpleNamespace(_type="geometry_msgs/Point", x=math.nan)),
}


@pytest.mark.parametrize(("text", "message"), FAULTS.items(), ids=FAULTS)
def test_a_fault_names_field_value_and_what_was_expected(text, message):
    sentence = message_check.fault(message)
    assert sentence.startswith(text), sentence
    assert re.search("expected$", sentence)


SOUND = [
    fleet_state(kiva_id=[1, 2], load_limit=[math.inf, 1.0]),
    fleet_state(kiva_id=[1], load_limit=[]),
    fleet_state(kiva_id=[]),
    objects(),
    objects(item_unit=[-1]),
    scenery(),
    CoordinatorPaths(
        kiva_id=[1], released=[0], planned=[0], waits_for=[0], goal_x=[math.nan], goal_y=[math.nan]
    ),
    LaserScan(ranges=[math.inf, math.nan, 1.0]),
    UnitStates(carrier=[0], pose=POSE),
]


@pytest.mark.parametrize("message", SOUND, ids=lambda message: message._type)
def test_what_means_something_is_sound(message):
    assert message_check.fault(message) == ""


def test_arrays_of_numpy_are_looked_at_too():
    message = numpy_msg(FleetState)()
    state = fleet_state(kiva_id=[1, 2], y=[0.0, math.nan], state=bytes(2))
    buffer = __import__("io").BytesIO()
    state.serialize(buffer)
    message.deserialize(buffer.getvalue())
    assert message_check.fault(message).startswith("y is nan")


@pytest.fixture
def ros():
    return FakeRos()


def test_what_is_dropped_is_warned_of_once(ros):
    taken = []
    message_check.subscribe(ros, "/warehouse/events", Event, taken.append, queue_size=1)
    for kind in (255, Event.DONE, 254):
        ros.callbacks["/warehouse/events"](Event(kind=kind))
    assert [event.kind for event in taken] == [Event.DONE]
    (warning,) = ros.warnings
    assert warning.startswith("/warehouse/events: a message is dropped: kind is 255; one of 0")


def test_another_program_is_not_heard_while_the_world_tells(ros):
    taken, tellers = [], ["/gazebo", "/stranger"]
    connections = [SimpleNamespace(callerid_pub=name) for name in tellers]
    subscriber = message_check.subscribe(ros, "/warehouse/events", Event, taken.append)
    subscriber.impl = SimpleNamespace(connections=connections)

    def tell(name):
        event = Event(text=name)
        event._connection_header = {"callerid": name}
        ros.callbacks["/warehouse/events"](event)

    tell("/stranger")
    tell("/gazebo")
    assert [event.text for event in taken] == ["/gazebo"]
    assert "it is from /stranger; /gazebo publishes this topic" in ros.warnings[0]
    del connections[0]  # as where a recording is played
    tell("/stranger")
    assert [event.text for event in taken] == ["/gazebo", "/stranger"]


def test_nodes_of_robots_at_a_broker_are_heard_beside_the_world(ros):
    taken, names = [], ["/gazebo", "/vda5050_master", "/vda5050_vehicles", "/stranger"]
    subscriber = message_check.subscribe(ros, "/warehouse/events", Event, taken.append)
    connections = [SimpleNamespace(callerid_pub=name) for name in names]
    subscriber.impl = SimpleNamespace(connections=connections)
    for name in names:
        event = Event(text=name)
        event._connection_header = {"callerid": name}
        ros.callbacks["/warehouse/events"](event)
    assert [event.text for event in taken] == names[:3]


def test_objects_and_states_of_one_revision_fit_if_they_tell_of_as_many():
    assert message_check.fit(objects(), UnitStates(carrier=[0, 0], loose_item=[0]))
    assert not message_check.fit(objects(), UnitStates(carrier=[0]))
    assert not message_check.fit(objects(), UnitStates(carrier=[0, 0], loose_item=[1]))
    assert not message_check.fit(objects(), UnitStates(carrier=[0, 0], revision=1))
    assert not message_check.fit(None, None)


def test_contracts_name_fields_that_messages_have():
    for message_type, contract in CONTRACTS.items():
        fields = set(get_message_class(message_type).__slots__)
        columns = {c.partition(":")[0] for table in contract.tables for c in table.split()}
        indices = {field for _, field in contract.indices.values()} | contract.indices.keys()
        totals = {part for parts in contract.totals.values() for part in parts}
        named = contract.optional | contract.ids | contract.positive | contract.any_number
        named |= contract.kinds.keys() | contract.names.keys() | contract.totals.keys()
        assert columns | indices | totals | named <= fields, message_type


def test_nodes_subscribe_by_nothing_else():
    sources = [*ROOT.glob("src/*/python/**/*.py"), *ROOT.glob("src/*/nodes/*")]
    assert len(sources) > 200
    direct = re.compile(r"\.(Subscriber|wait_for_message)\(")
    paths = {s.name for s in sources if direct.search(Path(s).read_text("utf-8"))}
    assert paths == {"message_check.py"}
