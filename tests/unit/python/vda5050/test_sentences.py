# SPDX-License-Identifier: Apache-2.0
"""What the specification demands of a vehicle: each test is named by its sentence.

Sections are those of 2.1.0, unless 3.0.0 stands before the number.
"""

from dataclasses import replace

import pytest
from grid_robot import Bench, drop, is_over, order, pick, row

from warehouse_vda5050.model import Action, BlockingType, InstantActions


def statuses(state):
    return {action.id: action.status.value for action in state.actions}


def types(state):
    return [error.type for error in state.errors]


# --- 6.9 Actions


def test_failed_pick_operations_should_correspond_with_an_error():
    """6.8.2. At the last node, too, where nothing is left to be driven."""
    bench = Bench()
    bench.order("o", row(0, 2), actions={2: [pick("8")]})
    state = bench.until(lambda s: statuses(s)["p1"] == "FAILED")
    state = bench.tick(5)
    assert types(state) == ["orderActionError"] and not state.nodes
    assert ("actionId", "p1") in state.errors[0].references
    assert bench.order("next", row(2, 3)) and not bench.vehicle.state().errors


def test_cancelled_actions_are_no_errors():
    """6.6.3: if there are scheduled actions, these actions shall be cancelled and report FAILED."""
    bench = Bench()
    bench.order("o", row(0, 3), actions={3: [pick("8")]})
    bench.instant("cancelOrder", "c")
    assert not bench.until(is_over).errors


def test_the_order_of_multiple_actions_in_a_list_defines_the_sequence_of_their_execution():
    """6.12. One lift at a time, whatever the blocking types say."""
    bench = Bench(units={"7": (1, 0)})
    lifts = [
        replace(pick(), blocking=BlockingType.NONE),
        replace(drop(), blocking=BlockingType.NONE),
    ]
    bench.order("o", row(0, 1), actions={1: [*lifts, replace(pick(), id="p2")]})
    state = bench.until(is_over)
    assert statuses(state) == {"p1": "FINISHED", "d1": "FINISHED", "p2": "FINISHED"}
    assert [what for what, *_ in bench.robot.events if what != "at"] == ["pick", "drop", "pick"]


def test_two_picks_at_one_node_are_done_one_after_the_other():
    bench = Bench(units={"7": (1, 0)})
    lifts = [replace(pick(id=id), blocking=BlockingType.NONE) for id in ("a", "b")]
    bench.order("o", row(0, 1), actions={1: lifts})
    state = bench.until(is_over)
    assert statuses(state) == {"a": "FINISHED", "b": "FAILED"}
    assert "carries 7 already" in state.errors[0].description


# --- 6.10 State


@pytest.mark.parametrize("cells", [row(0, 2), [(0, 0), (1, 1)]])
def test_the_state_is_published_at_receiving_an_order(cells):
    """6.10.1. Each time: also a copy, and also the same order refused again."""
    bench = Bench(moving=30.0)
    for _ in range(3):
        count = len(bench.states)
        bench.vehicle.on_order(order("o", cells), bench.now)
        assert bench.vehicle.take_state(bench.now) and len(bench.states) == count


def test_the_state_is_published_at_receiving_an_instant_action():
    bench = Bench()
    action = Action("startPause", "a", BlockingType.NONE)
    for _ in range(3):
        bench.vehicle.on_instant_actions(InstantActions((action,)), bench.now)
        assert bench.vehicle.take_state(bench.now)


# --- 6.6.3 Order cancellation


def test_after_all_movement_has_stopped_the_cancel_order_action_shall_report_finished():
    """6.6.3. A paused vehicle stands between cells, and moves no more."""
    bench = Bench()
    bench.order("o", [(0, 0), (9, 0)])
    bench.tick(2)
    bench.instant("startPause", "p")
    state = bench.instant("cancelOrder", "c")
    assert statuses(state)["c"] == "FINISHED" and not state.nodes and state.paused
    assert not bench.order("early", [bench.robot.cell, (9, 0)])  # it stands on no grid point yet
    at = bench.robot.cell
    bench.instant("stopPause", "s")
    bench.tick(3)
    assert bench.robot.cell[0] <= at[0] + 1  # not to the end of the cancelled order
    assert bench.order("next", [bench.robot.cell, (9, 0)]), bench.vehicle.errors


def test_the_previous_order_was_cancelled_so_cancel_order_shall_be_reported_as_failed():
    """6.6.3.2."""
    bench = Bench()
    bench.order("o", [(0, 0), (9, 0)])
    bench.tick(2)
    bench.instant("startPause", "p")
    bench.instant("cancelOrder", "c")
    state = bench.instant("cancelOrder", "again")
    assert statuses(state)["again"] == "FAILED" and types(state) == ["noOrderToCancel"]


# --- 6.8 Instant actions


def test_the_name_of_the_log_will_be_reported_in_status(tmp_path):
    """6.8.2."""
    bench = Bench(logs=tmp_path, name="kiva-7")
    bench.order("o", row(0, 2))
    state = bench.instant("logReport", reason="why")
    (report,) = tmp_path.iterdir()
    assert state.actions[0].result == report.name and report.name.startswith("kiva-7-")
    assert "reason: why" in report.read_text() and "order o update 0" in report.read_text()


def test_the_report_can_not_be_stored(tmp_path):
    """6.8.2."""
    (tmp_path / "file").write_text("no folder")
    state = Bench(logs=tmp_path / "file" / "folder").instant("logReport")
    assert statuses(state) == {"i1": "FAILED"} and types(state) == ["instantActionError"]


def test_more_instant_actions_than_the_factsheet_says_are_refused_as_a_whole():
    """7.2, protocolLimits: the greatest length of arrays."""
    bench = Bench()
    actions = tuple(Action("stateRequest", f"a{k}", BlockingType.NONE) for k in range(60))
    bench.vehicle.on_instant_actions(InstantActions(actions), bench.now)
    state = bench.tick()
    assert types(state) == ["validationError"] and not state.actions
    assert "60 actions; at most 20" in state.errors[0].description


def test_all_instant_actions_that_the_vehicle_received_are_in_the_state():
    """6.8: three full messages before the next state."""
    bench = Bench()
    for begin in (0, 20, 40):
        actions = tuple(
            Action("stateRequest", f"a{begin + k}", BlockingType.NONE) for k in range(20)
        )
        bench.vehicle.on_instant_actions(InstantActions(actions), bench.now)
    assert len(bench.tick().actions) == 60
    bench.tick(60)
    bench.instant("stateRequest", "late")
    assert len(bench.tick().actions) <= 51


def test_an_unknown_field_is_warned_of_until_the_next_order():
    """6.6.4.1: the warning shall be reported until the vehicle has accepted a new order."""
    bench = Bench()
    bench.vehicle.on_order(order("o", row(0, 1)), bench.now, ("surprise",))
    assert "surprise" in bench.until(is_over).errors[0].description
    bench.order("p", row(1, 2))
    assert not bench.vehicle.state().errors


# --- The vehicle's program begins again


def test_a_vehicle_whose_program_ended_in_an_order_takes_orders_again():
    bench = Bench(linger=3.0)
    bench.order("o", row(0, 4))
    bench.tick(2)
    again = Bench.of(bench.robot, linger=3.0)
    assert again.vehicle.is_taken
    again.until(lambda state: not bench.robot.busy)
    assert bench.robot.taken  # as long as it drives
    assert again.order("p", row(4, 6)), again.vehicle.errors
    again.until(is_over)
    again.tick(5)
    assert not bench.robot.taken
