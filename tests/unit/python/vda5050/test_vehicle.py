# SPDX-License-Identifier: Apache-2.0
"""The vehicle core: orders, updates, actions and instant actions, on a robot on paper."""

from dataclasses import replace

import pytest
from grid_robot import Bench, drop, is_over, order, pick, row

from warehouse_vda5050.errors import Error
from warehouse_vda5050.model import Action, ActionStatus, BlockingType, OperatingMode


def statuses(state):
    return {action.id: action.status.value for action in state.actions}


def error_types(state):
    return [error.type for error in state.errors]


def test_drives_an_order_and_tells_each_node():
    bench = Bench()
    assert bench.order("o", row(0, 4))
    state = bench.until(is_over)
    assert (state.last_node, state.last_node_sequence, state.order_id) == ("c4_0", 8, "o")
    passed = [s.last_node_sequence for s in bench.states]
    assert sorted(set(passed)) == [0, 2, 4, 6, 8] and passed == sorted(passed)
    assert bench.robot.path_id == 1  # one path, without a stop


def test_tells_its_cell_before_any_order():
    assert Bench(cell=(3, 2)).vehicle.state().last_node == "c3_2"


def test_fetches_carries_and_drops_in_one_order():
    bench = Bench(units={"7": (2, 0)})
    cells = [*row(0, 4), (4, 1), (4, 2)]
    assert bench.order("o", cells, actions={2: [pick()], 6: [drop()]})
    state = bench.until(is_over)
    assert statuses(state) == {"p1": "FINISHED", "d1": "FINISHED"}
    assert bench.robot.units == {"7": (4, 2)}
    acts = [e for e in bench.robot.events if e[0] != "at"]
    assert acts == [("pick", "7", (2, 0)), ("drop", "7", (4, 2))]


def test_stops_at_the_end_of_the_base_and_goes_on_with_an_update():
    bench = Bench()
    bench.order("o", row(0, 5), released=3)
    state = bench.tick(20)
    assert state.last_node == "c2_0" and not state.driving and state.new_base_request
    assert [node.released for node in state.nodes] == [False] * 3
    assert bench.order("o", row(2, 5), update=1, first=2)
    assert bench.until(is_over).last_node == "c5_0"


def test_lengthens_the_path_under_way():
    bench = Bench()
    bench.order("o", row(0, 7), released=4)
    bench.tick(1)
    assert bench.order("o", row(3, 7), update=1, first=3)
    bench.until(is_over)
    assert bench.robot.path_id == 1 and len(bench.robot.path) == 8


def test_update_replaces_the_horizon():
    bench = Bench()
    bench.order("o", row(0, 5), released=3)
    bench.order("o", [(2, 0), (2, 1), (2, 2)], update=1, first=2)
    assert bench.until(is_over).last_node == "c2_2"


def test_update_may_repeat_the_base_but_not_change_it():
    bench = Bench()
    bench.order("o", row(0, 3), released=3)
    assert bench.order("o", row(0, 5), update=1, released=6)  # all of it once more
    assert not bench.order("o", [(5, 0), (5, 1)], update=2, first=4)
    assert error_types(bench.vehicle.state()) == ["orderUpdateError"]
    assert bench.until(is_over).last_node == "c5_0"


@pytest.mark.parametrize(
    "cells,update,first",
    [
        (row(2, 4), 0, 2),  # another message under the number of one that was accepted
        (row(3, 5), 1, 3),  # begins beyond the base
        (row(0, 1), 1, 0),  # takes back
        ([(0, 0), (0, 1), (0, 2)], 1, 0),  # changes the base
    ],
)
def test_refuses_updates_that_do_not_fit(cells, update, first):
    bench = Bench()
    bench.order("o", row(0, 4), released=3)
    assert not bench.order("o", cells, update=update, first=first)
    assert error_types(bench.vehicle.state()) == ["orderUpdateError"]
    assert bench.vehicle.order.base_end + bench.vehicle.order.last.sequence // 2 == 2


def test_ignores_the_same_update_and_refuses_a_lower_one():
    bench = Bench()
    bench.order("o", row(0, 2), released=2)
    bench.order("o", row(1, 3), update=1, first=1)
    assert not bench.order("o", row(1, 3), update=1, first=1)
    assert not bench.vehicle.state().errors
    assert not bench.order("o", row(0, 2), released=2)
    assert error_types(bench.vehicle.state()) == ["orderUpdateError"]


def test_late_copy_of_an_order_that_is_over_is_not_done_again():
    bench = Bench(cell=(0, 0))
    bench.order("a", row(0, 2))
    bench.until(is_over)
    bench.order("b", row(2, 0))
    bench.until(is_over)
    assert not bench.order("a", row(0, 2))
    assert "carried out already" in bench.vehicle.state().errors[0].description
    assert not bench.order("b", row(2, 0)) and bench.tick(5).last_node == "c0_0"


@pytest.mark.parametrize(
    "cells,kind,text",
    [
        ([(0, 0), (1, 1)], "orderError", "not in a line"),
        ([(0, 0), (0, 10)], "orderError", "off the floor"),
        ([(1, 0), (2, 0)], "noRouteError", "not where the robot stands"),
        ([(0, 0), (0, 5), (9, 5)], "noRouteError", "nothing can stand at c5_5"),
        ([(0, 0), (0, 0)], "orderError", "where the node before it is"),
    ],
)
def test_refuses_what_cannot_be_driven(cells, kind, text):
    bench = Bench()
    assert not bench.order("o", cells)
    (error,) = bench.vehicle.state().errors
    assert error.type == kind and text in error.description
    assert ("orderId", "o") in error.references


def test_refuses_a_node_that_is_unknown_and_one_off_the_grid():
    bench = Bench()
    good = order("o", row(0, 1), positions=False)
    unknown = replace(good, nodes=(good.nodes[0], replace(good.nodes[1], id="dock")))
    unknown = replace(unknown, edges=(replace(good.edges[0], end="dock"),))
    assert not bench.vehicle.on_order(unknown, 0.0)
    assert "'dock' is unknown" in bench.vehicle.state().errors[0].description
    between = order("p", row(0, 1))
    beside = replace(between.nodes[1].position, x=1.4)
    nodes = (between.nodes[0], replace(between.nodes[1], id="x", position=beside))
    edges = (replace(between.edges[0], end="x"),)
    assert not bench.vehicle.on_order(replace(between, nodes=nodes, edges=edges), 0.0)
    assert "middle of no cell" in bench.vehicle.state().errors[1].description


def test_refuses_another_order_while_one_is_under_way():
    bench = Bench()
    bench.order("a", row(0, 5), released=2)
    bench.tick(10)
    assert not bench.order("b", row(1, 2))
    assert error_types(bench.vehicle.state()) == ["orderError"]


def test_takes_the_next_order_as_soon_as_the_last_node_is_passed():
    bench = Bench()
    bench.order("o", row(0, 3))
    bench.until(lambda state: not state.nodes)
    assert bench.order("p", row(3, 5)), bench.vehicle.errors


def test_refuses_unknown_actions_trajectories_and_actions_at_edges():
    bench = Bench()
    assert not bench.order("o", row(0, 1), actions={1: [Action("dance", "a")]})
    plain = order("p", row(0, 1))
    curved = replace(plain.edges[0], demands=(("trajectory", {}),))
    assert not bench.vehicle.on_order(replace(plain, edges=(curved,)), 0.0)
    busy = replace(plain.edges[0], actions=(Action("pick", "a"),))
    assert not bench.vehicle.on_order(replace(plain, id="q", edges=(busy,)), 0.0)
    assert error_types(bench.vehicle.state()) == ["orderError"] * 3


def test_refuses_orders_in_manual_mode_and_where_it_is_lost():
    bench = Bench()
    bench.robot.extra = {"mode": OperatingMode.MANUAL}
    bench.tick()
    assert not bench.order("o", row(0, 1))
    bench.robot.extra = {"localized": False}
    bench.tick()
    assert not bench.order("o", row(0, 1))
    texts = [error.description for error in bench.vehicle.state().errors]
    assert "operating mode" in texts[0] and "does not know where" in texts[1]


def test_an_accepted_order_ends_the_errors_of_messages():
    bench = Bench()
    bench.order("o", [(0, 0), (1, 1)])
    bench.order("o", row(0, 1))
    assert not bench.vehicle.state().errors


def test_cancel_ends_at_the_next_grid_point():
    bench = Bench(units={"7": (9, 0)})
    bench.order("o", [(0, 0), (9, 0)], actions={1: [pick()]})
    bench.tick(3)
    state = bench.instant("cancelOrder")
    assert statuses(state)["i1"] in ("RUNNING", "FINISHED")
    state = bench.until(is_over)
    assert statuses(state) == {"p1": "FAILED", "i1": "FINISHED"}
    assert state.last_node != "c9_0" and not state.errors and not state.edges
    at = bench.robot.cell
    assert bench.order("next", [at, (at[0], 1)])


def test_cancel_lets_a_lift_come_to_its_end():
    bench = Bench(units={"7": (0, 0)})
    bench.order("o", row(0, 1), actions={0: [pick()], 1: [drop()]})
    bench.instant("cancelOrder")
    state = bench.until(is_over)
    assert statuses(state) == {"p1": "FINISHED", "d1": "FAILED", "i1": "FINISHED"}
    assert state.loads[0].id == "7" and bench.robot.cell == (0, 0)


def test_nothing_to_cancel():
    state = Bench().instant("cancelOrder")
    assert error_types(state) == ["noOrderToCancel"] and statuses(state) == {"i1": "FAILED"}


def test_an_instant_action_that_is_repeated_is_done_once():
    bench = Bench()
    bench.order("o", row(0, 9))
    bench.instant("startPause", "a")
    bench.instant("stopPause", "b")
    bench.instant("startPause", "a")
    assert not bench.robot.stopped and bench.until(is_over).last_node == "c9_0"


def test_masters_that_give_all_pauses_one_id():
    bench = Bench()
    bench.order("o", row(0, 9))
    bench.instant("startPause", "pause")
    bench.instant("stopPause", "resume")
    bench.tick(6)
    assert bench.instant("startPause", "pause").paused


def test_pause_and_go_on():
    bench = Bench()
    bench.order("o", row(0, 9))
    state = bench.until(lambda s: s.last_node_sequence == 4)
    bench.instant("startPause")
    state = bench.tick(5)
    assert state.paused and not state.driving and statuses(state) == {"i1": "FINISHED"}
    held = state.last_node_sequence
    assert bench.tick(5).last_node_sequence == held
    assert not bench.instant("stopPause", "i2").paused
    assert bench.until(is_over).last_node == "c9_0"


def test_a_failed_pick_keeps_the_robot_where_it_is():
    bench = Bench()
    bench.order("o", row(0, 3), actions={1: [pick("8")]})
    bench.until(lambda s: statuses(s).get("p1") == "FAILED")
    state = bench.tick(5)
    assert state.last_node == "c1_0" and len(state.nodes) == 2
    assert "stays where it is" in state.errors[0].description
    bench.instant("cancelOrder")
    assert bench.until(is_over).last_node == "c1_0"


def test_blocking_types():
    bench = Bench()
    waits = [
        Action("waitForTrigger", "none", BlockingType.NONE),
        Action("waitForTrigger", "soft", BlockingType.SOFT),
        Action("waitForTrigger", "hard", BlockingType.HARD),
    ]
    bench.order("o", row(0, 2), actions={1: waits})
    state = bench.tick(10)
    assert statuses(state) == {"none": "RUNNING", "soft": "RUNNING", "hard": "WAITING"}
    assert state.last_node == "c1_0"
    assert statuses(bench.instant("trigger", "t"))["hard"] == "RUNNING"
    bench.instant("trigger", "u")
    assert bench.until(is_over).last_node == "c2_0"


def test_none_lets_the_robot_drive_on():
    bench = Bench()
    wait = Action("waitForTrigger", "w", BlockingType.NONE)
    bench.order("o", row(0, 3), actions={1: [wait]})
    state = bench.tick(15)
    assert state.last_node == "c3_0" and statuses(state) == {"w": "RUNNING"}
    assert bench.robot.path_id == 1


def test_unknown_instant_action_fails():
    state = Bench().instant("dance")
    assert statuses(state) == {"i1": "FAILED"} and error_types(state) == ["instantActionError"]


@pytest.mark.parametrize("type", ["stateRequest", "factsheetRequest", "logReport"])
def test_requests(type, tmp_path):
    bench = Bench(logs=tmp_path)
    bench.vehicle.take_factsheet()
    count = len(bench.states)
    state = bench.instant(type, reason="why")
    assert statuses(state) == {"i1": "FINISHED"} and len(bench.states) == count + 1
    assert bool(bench.vehicle.take_factsheet()) == (type == "factsheetRequest")
    assert len([*tmp_path.iterdir()]) == (type == "logReport")


def test_state_at_the_latest_after_the_interval():
    bench = Bench(interval=30.0)
    count = len(bench.states)
    bench.tick(59)
    assert len(bench.states) == count + 1
    bench.tick(3)
    assert len(bench.states) == count + 2


def test_what_is_not_heard_is_sent_again():
    bench = Bench()
    bench.robot.deaf = True
    bench.order("o", row(0, 2))
    bench.tick(5)
    bench.robot.deaf = False
    assert bench.until(is_over).last_node == "c2_0"


def test_robot_is_taken_and_given_back():
    bench = Bench(linger=3.0, units={"7": (2, 0)})
    bench.order("o", row(0, 2), actions={2: [pick()]})
    assert bench.robot.taken
    bench.until(is_over)
    bench.tick(10)
    assert bench.robot.taken  # it carries a unit of the master's
    bench.order("p", [(2, 0)], actions={0: [drop()]})
    bench.until(is_over)
    bench.tick(5)
    assert not bench.robot.taken


def test_refused_path_is_told_and_tried_again():
    bench = Bench()
    bench.robot.busy = True  # with something that began at the same time
    bench.robot.stopped = True
    bench.vehicle.report = replace(bench.vehicle.report, busy=False)
    bench.vehicle.on_order(order("o", row(0, 2)), bench.now)
    bench.tick(10)
    bench.robot.busy = bench.robot.stopped = False
    assert bench.until(is_over).last_node == "c2_0"


def test_a_late_report_of_a_path_is_counted_although_another_command_was_refused():
    bench = Bench()
    bench.order("o", row(0, 2))
    now = replace(bench.robot.report(), path_id=0, busy=False, refusal="it is not idle")
    bench.robot.report = lambda: now
    bench.tick(2)  # the robot drives; its reports are late, and a refusal of before came
    del bench.robot.report
    assert bench.until(is_over).last_node == "c2_0"


def test_mode_that_changes_ends_the_order():
    bench = Bench()
    bench.order("o", row(0, 9))
    bench.tick(2)
    bench.robot.extra = {"mode": OperatingMode.SERVICE}
    state = bench.until(is_over)
    assert state.mode is OperatingMode.SERVICE and state.last_node != "c9_0"


def test_errors_of_the_robot_are_reported():
    bench = Bench()
    bench.robot.extra = {"errors": (Error("motorError"),), "blocked": True}
    state = bench.tick()
    assert error_types(state) == ["motorError"] and state.field_violation


def test_a_robot_on_one_node_carries_out_an_action():
    bench = Bench(units={"7": (0, 0)})
    assert bench.order("o", [(0, 0)], actions={0: [pick()]})
    state = bench.until(is_over)
    assert state.actions[0].status is ActionStatus.FINISHED and state.loads[0].id == "7"


def test_positions_are_told_while_it_moves():
    bench = Bench(visualization=2.0)
    assert bench.vehicle.take_visualization(bench.now).position.x == 0
    bench.tick(5)
    assert bench.vehicle.take_visualization(bench.now) is None  # it stands where it stood
    bench.order("o", row(0, 9))
    positions = []
    for _ in range(12):
        bench.tick()
        positions.append(bench.vehicle.take_visualization(bench.now))
    xs = [entry.position.x for entry in positions if entry]
    assert len(xs) == 5 and xs == sorted(set(xs))


def test_without_an_interval_no_positions_are_reported():
    assert Bench(visualization=0.0).vehicle.take_visualization(0.0) is None
