# SPDX-License-Identifier: Apache-2.0
"""A vehicle behind a broker takes the commands of this project."""

import math
from dataclasses import replace

import pytest

from warehouse_layout.message_enums import FailureKind, Status
from warehouse_layout.message_enums import State as Does
from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.errors import Error, ErrorLevel
from warehouse_vda5050.grid import Grid
from warehouse_vda5050.master.commands import Cancel, Follow, Lift, Other, Stop
from warehouse_vda5050.master.frame import Frame
from warehouse_vda5050.master.remote_vehicle import EventKind, RemoteVehicle
from warehouse_vda5050.master.robots_file import RemoteRobot
from warehouse_vda5050.master.shadow import shadow_of
from warehouse_vda5050.model import (
    ActionState,
    ActionStatus,
    AgvPosition,
    ConnectionState,
    Factsheet,
    Header,
    InstantActions,
    Load,
    NodeState,
    OperatingMode,
    SupportedAction,
    VehicleOrder,
    VehicleState,
    Velocity,
)
from warehouse_vda5050.topics import Identity, Kind

GRID = Grid(-5, -5, 1.0, 20, 20)
ROBOT = RemoteRobot(21, Identity("acme", "7"), action_parameters={"stationType": "floor-1"})
WAY = ((0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0))


class Bench:
    """A RemoteVehicle, and what its vehicle tells."""

    def __init__(self, robot=ROBOT):
        self.vehicle = RemoteVehicle(robot, GRID, "run")
        self.now = 0.0
        self.state = VehicleState(position=AgvPosition(0, 0, 0), header=Header(timestamp="t0"))
        self.stamps = 0
        self.vehicle.take_connection(ConnectionState.ONLINE, self.now)
        (asked,) = self.instants()
        assert asked.type == "stateRequest"
        self.tell(actions=(ActionState(asked.id, asked.type, ActionStatus.FINISHED),))

    def tell(self, **changes):
        """What the vehicle tells, with those changes; it goes on being so."""
        self.stamps += 1
        self.state = replace(self.state, header=Header(timestamp=f"t{self.stamps:03}"), **changes)
        self.vehicle.take_state(self.state, self.now)

    def sent(self, wait=0.0):
        self.now += wait
        return self.vehicle.messages(self.now)

    def order(self, wait=0.0):
        (order,) = [message for message in self.sent(wait) if isinstance(message, VehicleOrder)]
        return order

    def instants(self, wait=0.0):
        messages = [instant for instant in self.sent(wait) if isinstance(instant, InstantActions)]
        return [action for message in messages for action in message.actions]

    def events(self):
        return [(event.kind.value, event.text) for event in self.vehicle.take_events()]

    def take(self, order, at=0):
        """The vehicle has an order, and is at the node of that sequence number."""
        left = [node for node in order.nodes if node.sequence > at]
        nodes = tuple(NodeState(n.id, n.sequence, n.released) for n in left)
        self.tell(order_id=order.id, order_update=order.update, nodes=nodes, last_node_sequence=at)

    def follow(self, released=2):
        self.vehicle.command(Follow(9, 0, WAY, released))
        order = self.order()
        self.take(order)
        return order

    @property
    def shadow(self):
        return shadow_of(self.vehicle, self.now)


@pytest.fixture
def bench():
    return Bench()


def test_a_path_becomes_an_order(bench):
    bench.vehicle.command(Follow(9, 0, WAY, 2))
    order = bench.order()
    assert [(n.id, n.sequence, n.released) for n in order.nodes] == [
        ("c5_5", 0, True),
        ("c6_5", 2, True),
        ("c7_5", 4, False),
        ("c7_6", 6, False),
    ]
    assert [(e.sequence, e.start, e.end, e.released) for e in order.edges] == [
        (1, "c5_5", "c6_5", True),
        (3, "c6_5", "c7_5", False),
        (5, "c7_5", "c7_6", False),
    ]
    assert bench.events() == [("ACCEPTED", "follow path 9")]
    assert (bench.shadow.status, bench.shadow.path_id) == (Status.BUSY, 9)


def test_more_released_is_stitched_at_the_last_released_node(bench):
    first = bench.follow()
    bench.vehicle.command(Follow(9, 0, (), 3))
    bench.vehicle.command(Follow(9, 0, (), 4))  # both go together
    order = bench.order()
    assert (order.id, order.update) == (first.id, 1)
    assert [(n.id, n.sequence, n.released) for n in order.nodes] == [
        ("c6_5", 2, True),
        ("c7_5", 4, True),
        ("c7_6", 6, True),
    ]


def test_changes_wait_until_the_vehicle_has_the_last_order(bench):
    bench.vehicle.command(Follow(9, 0, WAY, 2))
    order = bench.order()
    bench.vehicle.command(Follow(9, 0, (), 3))
    assert bench.sent() == []
    bench.take(order)
    assert bench.order().update == 1


def test_an_order_is_resent_as_it_was(bench):
    bench.vehicle.command(Follow(9, 0, WAY, 2))
    order = bench.order()
    bench.vehicle.command(Follow(9, 0, (), 3))
    assert bench.sent(1.0) == []
    assert bench.order(1.5) == order


def test_an_order_that_is_never_taken_is_refused(bench):
    bench.vehicle.command(Follow(9, 0, WAY, 2))
    asked = []
    for _ in range(15):
        asked = bench.instants(2.5) or asked
    assert bench.events()[-1] == ("REFUSED", "the vehicle does not confirm the order")
    cancel = asked[-1]
    assert cancel.type == "cancelOrder"  # it may have the order all the same
    bench.tell(actions=(ActionState(cancel.id, "cancelOrder", ActionStatus.FAILED),))
    assert bench.shadow.status == Status.IDLE


def test_how_far_it_has_come(bench):
    order = bench.follow(4)
    bench.take(order, at=4)
    assert (bench.shadow.reached, bench.shadow.left) == (3, 2)
    bench.take(order, at=6)
    assert bench.events()[-1] == ("DONE", "done: follow path 9")
    assert (bench.shadow.reached, bench.shadow.status) == (4, Status.IDLE)


def test_it_waits_at_the_end_of_what_is_released(bench):
    order = bench.follow(2)
    bench.take(order, at=2)
    assert (bench.shadow.state, bench.shadow.reached) == (Does.WAITING, 2)
    assert bench.events() == [("ACCEPTED", "follow path 9")]


@pytest.mark.parametrize(
    ("command", "why"),
    [
        (Follow(9, 0, (), 1), "none can be taken back"),
        (Follow(9, 1, ((1.0, 1.0),), 2), "2 of 4 are released"),
        (Follow(9, 0, (), 5), "5 of 4 points"),
        (Follow(8, 0, WAY, 2), "not idle"),
        (Lift(True, 3), "not idle"),
        (Other("turns"), "no turns"),
    ],
)
def test_what_can_not_be_said_is_refused(bench, command, why):
    bench.follow()
    bench.events()
    bench.vehicle.command(command)
    kind, text = bench.events()[-1]
    assert kind == "REFUSED"
    assert why in text
    assert bench.sent() == []


def test_a_refused_update_leaves_what_the_vehicle_has(bench):
    bench.follow(2)
    bench.vehicle.command(Follow(9, 0, (), 4))
    order = bench.order()
    error = Error("orderUpdateError", description="no", references=(("orderId", order.id),))
    bench.tell(errors=(error,))
    assert bench.events()[-1] == ("REFUSED", "orderUpdateError: no")
    bench.tell(errors=())
    bench.vehicle.command(Follow(9, 0, (), 3))
    again = bench.order(wait=1.0)
    assert (again.update, again.nodes[0].id, len(again.base)) == (2, "c6_5", 2)


def test_a_standing_vehicle_whose_path_can_not_go_on_as_asked_is_let_go(bench):
    """The coordinator may go back farther after a refused update than the vehicle did."""
    order = bench.follow(3)
    other = Follow(9, 2, ((1.0, 0.0), (1.0, 1.0)), 3)
    for _ in range(20):
        bench.vehicle.command(other)
    assert {kind for kind, _ in bench.events()} == {"ACCEPTED", "REFUSED"}  # it drives
    bench.take(order, at=4)
    bench.vehicle.command(other)
    ((kind, text),) = bench.events()
    assert kind == "BLOCKED" and "can't be replaced: 3 of 4 are released" in text
    assert [action.type for action in bench.instants()] == ["cancelOrder"]
    bench.tell(nodes=())
    assert not bench.vehicle.waits


def test_a_vehicle_that_refuses_is_asked_less_and_less_often(bench):
    bench.follow(2)
    times = []
    for _ in range(1200):
        bench.vehicle.command(Follow(9, 0, (), 4))  # as the coordinator does
        for order in [message for message in bench.sent(0.1) if isinstance(message, VehicleOrder)]:
            times.append(bench.now)
            refer = (("orderId", order.id), ("orderUpdateId", str(order.update)))
            bench.tell(errors=(Error("orderUpdateError", description="no", references=refer),))
            bench.tell(errors=())
    gaps = [b - a for a, b in zip(times, times[1:])]
    assert len(times) <= 9 and gaps == sorted(gaps) and gaps[-1] <= 31
    assert all(kind != "BLOCKED" for kind, _ in bench.events())
    bench.vehicle.command(Follow(9, 0, (), 4))
    bench.take(bench.order(wait=31.0))
    bench.vehicle.command(Follow(9, 4, ((2.0, 2.0),), 5))
    assert bench.order()  # it accepted one, and is not waited for any more


def refuse(bench, order):
    refer = (("orderId", order.id), ("orderUpdateId", str(order.update)))
    bench.tell(errors=(Error("orderUpdateError", description="no", references=refer),))
    bench.tell(errors=())


def test_after_a_refused_update_a_path_may_end_where_the_vehicle_stands(bench):
    """The coordinator sends the last point that is to stay once more, which cuts off the others."""
    bench.take(bench.follow(2), at=2)
    bench.vehicle.command(Follow(9, 0, (), 4))
    refuse(bench, bench.order())
    bench.events()
    bench.vehicle.command(Follow(9, 1, (WAY[1],), 2))
    assert bench.events() == []
    order = bench.order(wait=1.0)
    assert [(n.id, n.released) for n in order.nodes] == [("c6_5", True)]
    bench.take(order, at=2)
    assert bench.events()[-1] == ("DONE", "done: follow path 9")


def test_a_vehicle_that_was_put_elsewhere_is_asked_again_at_once(bench):
    for wait in (0.0, 1.0, 2.0):
        bench.vehicle.command(Follow(9, 0, WAY, 2))
        refuse(bench, bench.order(wait))
    bench.vehicle.command(Follow(9, 0, WAY, 2))
    assert bench.sent(1.0) == []
    bench.tell(position=AgvPosition(0.0, 0.1, 0.0))
    assert bench.order()


def test_an_order_whose_end_the_vehicle_refuses_is_cancelled(bench):
    bench.take(bench.follow(2), at=2)
    bench.tell(driving=True)
    bench.vehicle.command(Follow(9, 1, (WAY[1],), 2))
    refuse(bench, bench.order())
    assert not bench.instants()  # it still drives there
    bench.vehicle.command(Follow(9, 1, (WAY[1],), 2))
    order = bench.order(wait=1.0)
    bench.tell(driving=False)
    refuse(bench, order)
    assert bench.events()[-1] == ("BLOCKED", "it refuses that its path ends where it stands")
    assert [action.type for action in bench.instants()] == ["cancelOrder"]


@pytest.mark.parametrize("is_loaded", [False, True])
def test_a_vehicle_that_jumps_off_its_path_is_stopped_and_told_of(bench, is_loaded):
    if is_loaded:
        bench.tell(loads=(Load("storage_unit12"),))
    bench.follow(4)
    bench.events()
    bench.tell(position=AgvPosition(1.0, 2.0, 0.0), driving=True)
    assert bench.instants()[0].type == "cancelOrder"
    ((kind, text),) = bench.events()
    assert kind == "BLOCKED" and text == ("the vehicle jumped 2.2 m, from 0.00, 0.00 to 1.00, 2.00")
    assert bench.shadow.status == Status.BUSY  # until it has stopped
    assert (bench.shadow.x, bench.shadow.y) == (1.0, 2.0)


def test_a_vehicle_that_was_pushed_off_its_path_is_stopped(bench):
    bench.follow(4)
    bench.tell(position=AgvPosition(0.4, 0.3, 0.2))
    assert not bench.instants()
    bench.now += 1
    bench.tell(position=AgvPosition(0.4, 0.6, 0.2))
    assert bench.instants()[0].type == "cancelOrder"
    assert "0.6 m off its path" in bench.events()[-1][1]


def test_an_idle_vehicle_that_jumps_is_told_of(bench):
    bench.tell(position=AgvPosition(30.0, 0.0, 0.0))
    assert bench.events() == [
        ("BLOCKED", "the vehicle jumped 30.0 m, from 0.00, 0.00 to 30.00, 0.00")
    ]
    bench.now += 20
    bench.tell(position=AgvPosition(10.0, 0.0, 0.0))
    assert bench.events() == []  # that it may have driven


@pytest.mark.parametrize("seconds, is_told", [(8, False), (2, True)])
def test_states_that_a_network_brings_all_at_once_tell_of_no_jump(bench, seconds, is_told):
    stamp = "2026-11-29T08:00:{:02}.000Z"
    state = replace(bench.state, header=Header(1, stamp.format(0)))
    bench.vehicle.take_state(state, bench.now)
    later = replace(
        state, header=Header(2, stamp.format(seconds)), position=AgvPosition(16.0, 0.0, 0.0)
    )
    bench.vehicle.take_state(later, bench.now)
    assert bool(bench.events()) == is_told


def test_a_path_of_one_point_puts_the_vehicle_straight():
    """A vehicle that gets neither heading nor deviations takes the node as reached, and stands."""
    bench = Bench(replace(ROBOT, frame=Frame(0.0, 0.0, math.pi / 2)))
    bench.tell(position=AgvPosition(0.0, 0.2, 0.3))
    bench.events()
    here = (-0.0, 0.0)
    bench.vehicle.command(Follow(9, 0, (here,), 1))
    order = bench.order()
    (node,) = order.nodes
    assert abs(node.position.theta) < 1e-9  # in its own frame
    assert dict(node.demands) == {"allowedDeviationXY": 0.05, "allowedDeviationTheta": 0.05}
    bench.take(order)  # it says to be there
    assert bench.events()[-1] == (
        "BLOCKED",
        "the vehicle ended its order 0.20 m off the node and 0.30 rad askew",
    )
    bench.vehicle.command(Follow(10, 0, (here,), 1))
    bench.take(bench.order(), at=-1)
    bench.tell(nodes=(), last_node_sequence=0, position=AgvPosition(0.0, 0.01, 0.01))
    assert bench.events()[-1] == ("DONE", "done: follow path 10")


def test_longer_paths_leave_the_heading_to_the_vehicle(bench):
    assert all(n.position.theta is None and not n.demands for n in bench.follow(4).nodes)


@pytest.mark.parametrize(
    "type,bit",
    [("motorError", 1), ("batteryEmpty", 0), ("laserScanner", 3), ("eStopPressed", 6)],
)
def test_what_breaks_is_told_in_the_vehicles_own_words(bench, type, bit):
    error = Error(type, ErrorLevel.FATAL, "line 7: it is stuck")
    for _ in range(2):
        bench.tell(errors=(error,))
    assert bench.shadow.failures == 1 << bit
    assert bench.events() == [("FAILED", f"{type}: line 7: it is stuck")]
    bench.tell(errors=())
    assert bench.shadow.failures == 0 and bench.events()[0][0] == "REPAIRED"


def test_a_refused_order_is_over(bench):
    bench.vehicle.command(Follow(9, 0, WAY, 2))
    order = bench.order()
    references = (("orderId", order.id), ("orderUpdateId", "0"))
    bench.tell(errors=(Error("noRouteError", description="far", references=references),))
    assert bench.events()[-1] == ("REFUSED", "noRouteError: far")
    assert bench.shadow.status == Status.IDLE


def lift(bench, up=True):
    bench.vehicle.command(Lift(up, 12))
    order = bench.order()
    (action,) = order.nodes[0].actions
    bench.take(order)
    return action


def test_it_takes_up_and_puts_down(bench):
    action = lift(bench)
    assert (action.type, action.blocking.value) == ("pick", "HARD")
    assert action.parameter("loadId") == "storage_unit12"
    assert action.parameter("stationType") == "floor-1"
    bench.tell(actions=(ActionState(action.id, "pick", ActionStatus.RUNNING),))
    assert (bench.shadow.state, bench.shadow.shelf_id) == (Does.LIFTING, 0)
    bench.tell(actions=(ActionState(action.id, "pick", ActionStatus.FINISHED),))
    assert bench.shadow.shelf_id == 12
    assert [kind for kind, _ in bench.events()] == ["ACCEPTED", "LIFTED", "DONE"]
    drop = lift(bench, up=False)
    bench.tell(actions=(ActionState(drop.id, "drop", ActionStatus.FINISHED),))
    assert bench.shadow.shelf_id == 0


def test_a_lift_that_fails_is_blocked(bench):
    action = lift(bench)
    bench.tell(actions=(ActionState(action.id, "pick", ActionStatus.FAILED, "stuck"),))
    assert bench.events()[-1] == ("BLOCKED", "stuck")
    assert bench.shadow.shelf_id == 0


def test_a_cancelled_path_is_done(bench):
    bench.follow(4)
    bench.vehicle.command(Cancel())
    (action,) = bench.instants()
    assert action.type == "cancelOrder"
    assert bench.instants(2.5) == [action]  # until it is answered
    bench.tell(nodes=(), actions=(ActionState(action.id, "cancelOrder", ActionStatus.FINISHED),))
    assert bench.events()[-1] == ("DONE", "cancelled")
    assert bench.instants(2.5) == []


def test_a_lift_that_was_cancelled_may_be_done_all_the_same(bench):
    action = lift(bench)
    bench.vehicle.command(Cancel())
    (cancel,) = bench.instants()
    ended = (ActionState(action.id, "pick", ActionStatus.FINISHED),)
    ended += (ActionState(cancel.id, "cancelOrder", ActionStatus.FINISHED),)
    bench.tell(actions=ended, loads=(Load("storage_unit12"),))
    assert bench.shadow.shelf_id == 12


def test_a_cancel_that_was_never_answered_is_asked_for_again(bench):
    order = bench.follow(4)
    bench.vehicle.command(Cancel())
    asked = {action.id for _ in range(30) for action in bench.instants(2.5)}
    bench.take(order, at=2)  # it still drives
    (again,) = bench.instants(2.5)
    assert again.type == "cancelOrder" and again.id not in asked


def test_an_order_that_others_cancelled_is_blocked(bench):
    bench.follow(4)
    bench.tell(nodes=(), last_node="c6_5", last_node_sequence=2)
    assert bench.events()[-1] == ("BLOCKED", "others ended its order at c6_5")
    assert bench.shadow.reached == 2


def test_an_order_that_the_vehicle_lost_is_blocked(bench):
    bench.follow(2)
    bench.tell(order_id="", order_update=0, nodes=())
    assert bench.events()[-1] == ("BLOCKED", "the vehicle does not know its order any more")


def test_an_error_of_an_order_that_it_has_is_no_refusal(bench):
    bench.vehicle.command(Follow(9, 0, WAY, 2))
    order = bench.order()
    references = (("orderId", order.id), ("orderUpdateId", "0"))
    bench.state = replace(bench.state, errors=(Error("orderError", references=references),))
    bench.take(order)
    assert bench.events() == [("ACCEPTED", "follow path 9")]


def test_a_state_from_before_ends_no_cancelled_path(bench):
    bench.vehicle.command(Follow(9, 0, WAY, 2))
    bench.sent()
    bench.vehicle.command(Cancel())
    bench.tell()
    assert bench.events() == [("ACCEPTED", "follow path 9")]


def test_stop_and_go_on(bench):
    bench.vehicle.command(Stop(True))
    assert [a.type for a in bench.instants()] == ["startPause"]
    bench.vehicle.command(Stop(False))
    assert [a.type for a in bench.instants()] == ["stopPause"]
    assert [a.type for a in bench.instants(2.5)] == ["stopPause"]  # the stop is not sent again


def test_an_order_of_an_earlier_run_is_cancelled(bench):
    bench.tell(order_id="old", nodes=(NodeState("c9_9", 2, True),))
    (action,) = bench.instants()
    assert action.type == "cancelOrder"
    bench.vehicle.command(Follow(9, 0, WAY, 2))
    assert bench.events() == [("REFUSED", "it is not idle")]
    bench.tell(nodes=(), actions=(ActionState(action.id, "cancelOrder", ActionStatus.FINISHED),))
    bench.vehicle.command(Follow(9, 0, WAY, 2))
    assert bench.events() == [("ACCEPTED", "follow path 9")]


@pytest.mark.parametrize(
    ("state", "why"),
    [
        ({"mode": OperatingMode.MANUAL}, "operating mode is MANUAL"),
        ({"position": AgvPosition(0, 0, 0, initialized=False)}, "does not know where it is"),
        ({"position": AgvPosition(3, 0, 0)}, "it stands at 3.00, 0.00"),
    ],
)
def test_a_vehicle_that_can_not_is_given_no_order(bench, state, why):
    bench.tell(**state)
    bench.vehicle.command(Follow(9, 0, WAY, 2))
    kind, text = bench.events()[-1]
    assert kind == "REFUSED"
    assert why in text


def test_a_silent_vehicle_is_not_heard(bench):
    radio = 1 << FailureKind.RADIO_LOST
    assert bench.shadow.failures == 0
    bench.now = 60
    assert bench.shadow.failures == radio
    bench.tell()
    assert bench.shadow.failures == 0
    bench.vehicle.take_connection(ConnectionState.CONNECTIONBROKEN, bench.now)
    assert bench.shadow.failures == radio
    assert bench.sent() == []


def test_a_fatal_error_is_a_broken_drive(bench):
    bench.tell(errors=(Error("motorError", ErrorLevel.FATAL),))
    assert bench.shadow.failures == 1 << FailureKind.MOTOR


def test_an_older_state_is_dropped(bench):
    bench.tell(position=AgvPosition(1, 0, 0))
    bench.vehicle.take_state(
        VehicleState(position=AgvPosition(0, 0, 0), header=Header(timestamp="t0")), 0
    )
    assert bench.shadow.x == 1


@pytest.mark.parametrize(("time", "number"), [("t0", 7), ("t9", 0)])
def test_a_clock_set_back_or_numbers_that_begin_again_are_no_old_states(bench, time, number):
    header = Header(timestamp="t5", header_id=6)
    bench.vehicle.take_state(replace(bench.state, header=header), 0)
    moved = replace(bench.state, position=AgvPosition(1, 0, 0))
    bench.vehicle.take_state(replace(moved, header=Header(number, time)), 0)
    assert bench.shadow.x == 1


def test_a_vehicle_that_begins_again_unseen_is_heard(bench):
    bench.vehicle.take_connection(ConnectionState.ONLINE, 0)  # no will came before
    bench.vehicle.take_state(VehicleState(position=AgvPosition(1, 0, 0), header=Header(0, "s")), 0)
    assert bench.shadow.x == 1


def test_a_vehicle_that_comes_back_is_asked_for_its_state(bench):
    bench.vehicle.take_connection(ConnectionState.CONNECTIONBROKEN, 0)
    bench.vehicle.take_connection(ConnectionState.ONLINE, 0)
    assert [a.type for a in bench.instants()] == ["stateRequest"]


def test_a_load_that_it_tells_is_believed(bench):
    bench.tell(loads=(Load("storage_unit5"),))
    assert bench.shadow.shelf_id == 5
    bench.tell(loads=())
    assert bench.shadow.shelf_id == 0


@pytest.mark.parametrize("name", ["RFID_7c4", "0815"])
def test_a_vehicle_may_have_names_of_its_own_for_loads(bench, name):
    action = lift(bench)
    done = (ActionState(action.id, "pick", ActionStatus.FINISHED),)
    bench.tell(actions=done, loads=(Load(name),))
    bench.tell()
    assert bench.shadow.shelf_id == 12


@pytest.mark.parametrize("name", ["", "pallet", "7²", "9" * 5000, "unit99999999999"])
def test_a_load_without_a_units_number_is_none(bench, name):
    bench.tell(loads=(Load(name),))
    assert bench.shadow.shelf_id == 0


def test_a_person_ahead_blocks_it(bench):
    bench.follow(4)
    bench.tell(field_violation=True)
    assert (bench.shadow.status, bench.shadow.state) == (Status.BLOCKED, Does.BLOCKED)


def test_its_map_may_lie_anywhere():
    bench = Bench(replace(ROBOT, frame=Frame(4.0, 2.0, 1.5707963267948966)))
    shadow = bench.shadow
    assert (shadow.x, shadow.y) == (4.0, 2.0)
    assert shadow.yaw == pytest.approx(1.5708, abs=1e-4)
    bench.vehicle.command(Follow(9, 0, ((4.0, 2.0), (4.0, 3.0)), 2))
    node = bench.order().nodes[1]
    assert node.id == "c9_8"
    assert (node.position.x, node.position.y) == pytest.approx((1.0, 0.0))


def test_kinds_of_events_are_those_of_the_messages():
    assert {kind.value for kind in EventKind} <= {kind.name for kind in _event_kinds()}


def _event_kinds():
    from warehouse_layout.message_enums import EventKind as Kinds  # noqa: PLC0415

    return Kinds


# --- factsheets


def test_an_order_has_no_more_nodes_than_the_factsheet_allows_and_the_rest_comes_next():
    bench = Bench()
    bench.vehicle.take_factsheet(Factsheet(max_nodes=3))
    bench.vehicle.command(Follow(1, 0, WAY, 4))
    first = bench.order()
    assert [node.sequence for node in first.nodes] == [0, 2, 4]
    bench.take(first)
    second = bench.order()
    assert [node.sequence for node in second.nodes] == [4, 6]
    assert all(node.released for node in (*first.nodes, *second.nodes))
    bench.take(second, at=6)
    assert bench.vehicle.is_idle and bench.events()[-1][0] == "DONE"


def test_a_factsheet_that_comes_under_way_holds_for_the_updates():
    bench = Bench()
    bench.vehicle.command(Follow(1, 0, WAY, 2))
    first = bench.order()
    assert len(first.nodes) == 4
    bench.take(first)
    bench.vehicle.take_factsheet(Factsheet(max_nodes=2))
    bench.vehicle.command(Follow(1, 0, (), 3))
    assert [node.sequence for node in bench.order().nodes] == [2, 4]


def test_orders_keep_the_interval_of_the_factsheet():
    bench = Bench()
    bench.now = 100.0
    bench.vehicle.take_factsheet(Factsheet(order_interval=5.0))
    bench.vehicle.command(Follow(1, 0, WAY, 2))
    bench.take(bench.order())
    bench.vehicle.command(Follow(1, 0, (), 3))
    assert not bench.sent(4.9)
    assert bench.order(0.2).update == 1


def test_a_lift_that_the_factsheet_lacks_is_refused_and_unknown_parameters_are_left_out():
    bench = Bench(RemoteRobot(21, Identity("acme", "7")))
    drop = SupportedAction("drop", ("NODE",))
    bench.vehicle.take_factsheet(Factsheet(actions=(drop,)))
    bench.vehicle.command(Lift(True, 7))
    assert bench.events()[-1] == ("REFUSED", "its factsheet has no pick at nodes")
    parameters = (("loadId", "STRING", True, ""),)
    picks = SupportedAction("pick", ("NODE",), parameters=parameters)
    bench.vehicle.take_factsheet(Factsheet(actions=(picks, drop)))
    bench.vehicle.command(Lift(True, 7))
    (action,) = bench.order().nodes[0].actions
    assert action.parameters == (("loadId", "storage_unit7"),)


def test_a_factsheet_without_limits_limits_nothing():
    bench = Bench()
    sheet = codec_for().decode(Kind.FACTSHEET, b"{}").message
    bench.vehicle.take_factsheet(sheet)
    bench.vehicle.command(Follow(1, 0, WAY, 2))
    assert len(bench.order().nodes) == 4


# --- what it was never sent


def test_a_path_that_the_vehicle_was_never_sent_is_cancelled_without_a_cancel_order():
    bench = Bench()
    bench.vehicle.command(Follow(1, 0, WAY, 2))
    bench.vehicle.command(Cancel())
    assert bench.vehicle.is_idle and bench.events()[-1] == ("DONE", "cancelled")
    assert not bench.sent(10.0)


def test_a_path_for_a_vehicle_that_went_manual_before_ends_with_the_reason():
    bench = Bench()
    bench.vehicle.command(Follow(1, 0, WAY, 2))
    bench.tell(mode=OperatingMode.MANUAL)
    assert not bench.sent()
    assert bench.events()[-1] == ("BLOCKED", "its operating mode is MANUAL")


def test_a_vehicle_with_a_fatal_error_is_sent_nothing():
    bench = Bench()
    bench.tell(errors=(Error("motorError", ErrorLevel.FATAL, "no torque"),))
    bench.vehicle.command(Follow(1, 0, WAY, 2))
    assert bench.events()[-1] == ("REFUSED", "it reports motorError: no torque")


def twist(bench):
    shadow = bench.shadow
    return pytest.approx((shadow.vx, shadow.vy, shadow.yaw_rate))


def test_the_shadow_has_the_reported_velocity():
    frame = Frame(0, 0, math.pi / 2)
    bench = Bench(replace(ROBOT, frame=frame))
    moving = AgvPosition(0, 0, math.pi / 2)
    bench.tell(driving=True, position=moving, velocity=Velocity(1.5, 0.1, 0.2))
    assert twist(bench) == (-1.5, -0.1, 0.2)
    bench.now += 5.0  # nothing has come since long
    assert twist(bench) == (0, 0, 0)


def test_the_shadow_has_the_velocity_of_successive_positions():
    bench = Bench()
    for x in (0.0, 0.75, 1.5, 2.25):
        bench.now += 0.5
        bench.tell(driving=True, position=AgvPosition(x, 0, 0))
    assert twist(bench) == (1.5, 0, 0)
    bench.tell(order_update=1)  # at once: the time between says nothing
    assert twist(bench) == (1.5, 0, 0)
    bench.now += 0.5
    bench.tell(position=AgvPosition(15.0, 0, 0))
    assert twist(bench) == (0, 0, 0), "it was carried"
    bench.tell(driving=False)
    assert twist(bench) == (0, 0, 0)


def test_a_vehicle_that_comes_back_stands():
    bench = Bench()
    bench.tell(driving=True, velocity=Velocity(1.5))
    bench.vehicle.take_connection(ConnectionState.ONLINE, bench.now)
    assert twist(bench) == (0, 0, 0)


def test_a_vehicle_that_sets_off_moves_though_it_has_no_speed_yet():
    bench = Bench()
    bench.tell(driving=True, velocity=Velocity(0.0))
    assert twist(bench) == (0.02, 0, 0)
    bench.now += 1.0
    bench.tell(velocity=Velocity(0.0))
    assert twist(bench) == (0.02, 0, 0)
    bench.now += 1.0  # it says that it drives, and does not
    bench.tell(velocity=Velocity(0.0))
    assert twist(bench) == (0, 0, 0)
