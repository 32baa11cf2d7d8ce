# SPDX-License-Identifier: Apache-2.0
"""The master keeps to a vehicle's factsheet: loads, actions, optional fields, speeds."""

import pytest
from test_master_vehicle import WAY, Bench

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.master.commands import Follow, Lift
from warehouse_vda5050.master.load_fit import UnitMeasures
from warehouse_vda5050.master.remote_vehicle import RemoteVehicle
from warehouse_vda5050.master.robots_file import RemoteRobot
from warehouse_vda5050.model import (
    AgvPosition,
    BlockingType,
    Factsheet,
    LoadSet,
    SupportedAction,
)
from warehouse_vda5050.topics import Identity, Kind

UNIT = UnitMeasures(mass=120.0, length=0.8, width=0.8, height=1.8)
PLAIN = RemoteRobot(21, Identity("acme", "7"))


def bench_of(sheet, robot=PLAIN, measures=UNIT):
    """Returns a Bench whose vehicle has that factsheet, and whose units are all alike."""
    bench = Bench(robot)
    bench.vehicle._measure = lambda _unit: measures
    bench.vehicle.take_factsheet(sheet)
    return bench


def lift(bench, up=True):
    bench.vehicle.command(Lift(up, 7 if up else 0))
    (action,) = bench.order().nodes[0].actions
    return action


def refusal(bench):
    """Returns the refusal of lifting unit 7, and the unit that the event names."""
    bench.vehicle.take_events()
    bench.vehicle.command(Lift(True, 7))
    (event,) = bench.vehicle.take_events()
    assert event.kind.value == "REFUSED" and bench.vehicle.is_idle
    return event.text, event.unit


# --- loads

EPAL = LoadSet("pallet", "EPAL", 1.2, 0.8, 2.0, 900.0)
SMALL = LoadSet("box", "BOX", 0.6, 0.4, 0.4, 30.0)


@pytest.mark.parametrize(
    ("sheet", "why"),
    [
        (Factsheet(max_load_mass=100.0), "the unit weighs 120.0 kg, and it carries 100 kg"),
        (
            Factsheet(load_sets=(LoadSet("s", "unit", max_mass=50.0),)),
            "the unit weighs 120.0 kg, and its load set 's' carries 50 kg",
        ),
        (
            Factsheet(load_sets=(LoadSet("s", "unit", 0.9, 0.7),)),
            "the unit is 0.8 x 0.8 m, and its load set 's' takes 0.9 x 0.7 m",
        ),
        (
            Factsheet(load_sets=(LoadSet("s", "unit", 0.9, 0.9, 1.5),)),
            "the unit is 1.8 m high, and its load set 's' takes 1.5 m",
        ),
    ],
)
def test_a_unit_that_is_too_heavy_or_too_large_is_refused(sheet, why):
    text = f"it can't carry storage_unit7: {why}"
    assert refusal(bench_of(sheet)) == (text, 7)


def test_a_unit_that_it_can_not_carry_is_refused_before_it_drives_there():
    bench = bench_of(Factsheet(max_load_mass=100.0))
    bench.vehicle.expect_unit(7)
    (event,) = bench.vehicle.take_events()
    assert (event.kind.value, event.unit) == ("REFUSED", 7)
    bench = bench_of(Factsheet())
    bench.vehicle.expect_unit(7)
    assert bench.vehicle.take_events() == []


@pytest.mark.parametrize(
    "sheet", [Factsheet(), Factsheet(max_load_mass=0.0), Factsheet(load_sets=(LoadSet("", "x"),))]
)
def test_what_a_factsheet_does_not_say_limits_nothing(sheet):
    assert lift(bench_of(sheet)).type == "pick"


def test_what_the_world_does_not_say_limits_nothing():
    bench = bench_of(Factsheet(load_sets=(SMALL,)), measures=UnitMeasures())
    assert lift(bench).parameter("loadType") == "BOX"


def test_the_first_load_set_that_fits_gives_the_load_type():
    assert lift(bench_of(Factsheet(load_sets=(SMALL, EPAL)))).parameter("loadType") == "EPAL"
    ours = LoadSet("ours", "unit")
    assert lift(bench_of(Factsheet(load_sets=(EPAL, ours)))).parameter("loadType") == "unit"


def test_a_drop_has_the_load_type_of_its_pick():
    bench = bench_of(Factsheet(load_sets=(SMALL, EPAL)))
    bench.vehicle.command(Lift(True, 7))
    bench.order()
    bench.vehicle.load = 7
    loads = bench.vehicle.abilities.loads
    assert bench.vehicle.abilities.action("drop", "a", 7, loads).parameter("loadType") == "EPAL"


def test_a_load_type_that_the_vehicle_lacks_is_refused():
    robot = RemoteRobot(21, Identity("acme", "7"), action_parameters={"loadType": "HALF"})
    text, unit = refusal(bench_of(Factsheet(load_sets=(EPAL,)), robot))
    assert unit == 7 and text.endswith(
        "its factsheet has no loadType 'HALF', which the file of robots gives; it has EPAL"
    )


def test_a_load_type_of_the_file_of_robots_is_held_to_its_own_load_set():
    robot = RemoteRobot(21, Identity("acme", "7"), action_parameters={"loadType": "BOX"})
    text, _ = refusal(bench_of(Factsheet(load_sets=(EPAL, SMALL)), robot))
    assert "its load set 'box' carries 30 kg" in text


# --- actions


def picking(**options):
    return Factsheet(actions=(SupportedAction("pick", ("NODE",), **options),))


@pytest.mark.parametrize(
    ("allowed", "sent"),
    [
        ((), BlockingType.HARD),
        ((BlockingType.NONE, BlockingType.HARD), BlockingType.HARD),
        ((BlockingType.NONE, BlockingType.SOFT), BlockingType.SOFT),
        ((BlockingType.SINGLE, BlockingType.NONE), BlockingType.SINGLE),
        ((BlockingType.NONE,), BlockingType.NONE),
    ],
)
def test_a_lift_has_a_blocking_type_that_the_vehicle_allows(allowed, sent):
    assert lift(bench_of(picking(blocking=allowed))).blocking is sent


def test_a_parameter_that_the_vehicle_requires_has_to_be_given():
    rows = (("loadId", "STRING", True, ""), ("height", "NUMBER", False, ""))
    text, unit = refusal(bench_of(picking(parameters=rows)))
    assert (text, unit) == (
        "its factsheet requires height of each pick: add it to action_parameters in the file of"
        " robots",
        0,
    )
    robot = RemoteRobot(21, Identity("acme", "7"), action_parameters={"height": 0.1})
    assert lift(bench_of(picking(parameters=rows), robot)).parameter("height") == 0.1


# --- optional fields and speeds


def requiring(*names, **options):
    return Factsheet(parameters=tuple((name, "REQUIRED", "") for name in names), **options)


def follow(bench):
    bench.vehicle.take_events()
    bench.vehicle.command(Follow(9, 0, WAY, 4))
    return bench.vehicle.take_events()[0]


def test_edges_have_no_speed_that_the_vehicle_does_not_ask_for():
    bench = bench_of(Factsheet(parameters=(("order.edges.maxSpeed", "SUPPORTED", ""),)))
    follow(bench)
    assert [edge.demands for edge in bench.order().edges] == [()] * 3


@pytest.mark.parametrize("name", ["order.edges.maxSpeed", "edge.maximumSpeed"])
def test_a_required_speed_is_the_vehicles_own_and_below_with_a_load(name):
    sets = (LoadSet("slow", "unit", max_speed=0.4),)
    bench = bench_of(requiring(name, max_speed=0.7, load_sets=sets))
    follow(bench)
    assert {edge.demands for edge in bench.order().edges} == {(("maxSpeed", 0.7),)}
    bench = bench_of(requiring(name, max_speed=0.7, load_sets=sets))
    bench.vehicle.abilities.loads = sets[0]
    follow(bench)
    assert {edge.demands for edge in bench.order().edges} == {(("maxSpeed", 0.4),)}


def test_a_required_length_is_that_of_the_edge():
    bench = bench_of(requiring("order.edges.length"))
    follow(bench)
    assert {edge.demands for edge in bench.order().edges} == {(("length", 1.0),)}


def test_a_path_is_refused_if_the_vehicle_requires_what_no_order_has():
    event = follow(bench_of(requiring("order.edges.trajectory", "order.nodes.nodePosition")))
    assert (event.kind.value, event.text) == (
        "REFUSED",
        "its factsheet requires trajectory in orders, which this master does not send",
    )


def test_a_fast_vehicle_does_not_count_as_jumping():
    for speed, kinds in ((1.5, ["BLOCKED"]), (6.0, [])):
        bench = bench_of(Factsheet(max_speed=speed))
        bench.vehicle.take_events()
        bench.now += 1.0
        bench.tell(position=AgvPosition(5.5, 0, 0))
        assert [kind for kind, _ in bench.events()] == kinds


# --- over the wire


@pytest.mark.parametrize("version", ["2.1.0", "3.0.0"])
def test_a_factsheet_comes_over_the_wire_as_it_is(version):
    codec = codec_for(version)
    sets = (LoadSet("pallet", "EPAL", 1.2, 0.8, 1.5, 900.0, 0.8), LoadSet("box", "BOX"))
    rows = (("loadId", "STRING", False, "which"),)
    action = SupportedAction("pick", ("NODE",), parameters=rows, blocking=(BlockingType.SOFT,))
    required = (("order.edges.maxSpeed", "REQUIRED", "m/s"),)
    sheet = Factsheet(max_speed=2.0, load_sets=sets, actions=(action,), parameters=required)
    read = codec.decode(Kind.FACTSHEET, codec.encode(sheet)).message
    assert (read.load_sets, read.max_speed, read.parameters) == (sets, 2.0, required)
    assert read.actions[0].parameters == rows and read.silent == ()
    # 2.1.0 has no field for blocking types that fits its schema.
    said = (BlockingType.SOFT,) if version == "3.0.0" else ()
    assert read.actions[0].blocking == said


def test_a_vehicle_without_a_factsheet_is_driven_as_before():
    bench = Bench(PLAIN)
    assert isinstance(bench.vehicle, RemoteVehicle) and lift(bench).type == "pick"


# --- size


def test_a_vehicle_larger_than_a_cell_is_refused_from_its_factsheet_on():
    bench = bench_of(Factsheet(length=1.4))
    bench.vehicle.command(Follow(9, 0, WAY, 2))
    why = "it does not fit: it is 1.4 m long, and a cell 1 m: it would reach into the cell beside"
    events = [(event.kind.value, event.text) for event in bench.vehicle.take_events()]
    assert events == [("REFUSED", why), ("REFUSED", why)]  # of the factsheet, of the path
    assert not bench.vehicle.view.takes_orders, "the coordinator leaves it alone"
    bench.vehicle.take_factsheet(Factsheet(length=1.4))
    assert bench.vehicle.take_events() == [], "said once"
    bench.vehicle.take_factsheet(Factsheet())
    assert bench.vehicle.view.takes_orders
