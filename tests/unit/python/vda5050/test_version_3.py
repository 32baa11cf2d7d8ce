# SPDX-License-Identifier: Apache-2.0
"""What 3.0.0 demands beyond new names; sections are its own."""

import json
import math
from dataclasses import replace

import pytest
from grid_robot import Bench, is_over, order, pick, row
from test_fields import sent

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.errors import Predefined, former_type, precise_type
from warehouse_vda5050.model import Action, ActionStatus, OperatingMode
from warehouse_vda5050.topics import Kind

CODEC = codec_for("3.0.0")


def errors(bench):
    """Returns (type, level) of each error as 3.0.0 tells it."""
    entries = CODEC.to_json(bench.tick())["errors"]
    return [(error["errorType"], error["errorLevel"]) for error in entries]


def malformed(bench):
    bench.vehicle.on_order(order("", row(0, 1)), bench.now)


def too_long(bench):
    bench.vehicle.on_order(order("o", [(k % 2, 0) for k in range(1001)]), bench.now)


def unknown_action(bench):
    bench.order("o", row(0, 1), actions={1: [Action("dance", "a")]})


def lifts_too_high(bench):
    bench.order("o", row(0, 1), actions={1: [Action("pick", "a", parameters=(("height", 3),))]})


def outdated_update(bench):
    bench.order("o", row(0, 4), released=2, update=1)
    bench.order("o", row(0, 4), released=2, update=0)


def same_update(bench):
    bench.order("o", row(0, 4), released=2)
    bench.order("o", row(0, 5), released=3)


def update_after_cancel(bench):
    bench.order("o", row(0, 9), released=9)
    bench.instant("cancelOrder")
    bench.until(is_over)
    bench.order("o", [bench.robot.cell, (9, 0)], update=1, first=bench.robot.cell[0])


def another_order(bench):
    bench.order("o", row(0, 4), released=2)
    bench.order("p", row(0, 1))


def manual(bench):
    bench.robot.extra = {"mode": OperatingMode.MANUAL}
    bench.tick()
    bench.order("o", row(0, 1))


@pytest.mark.parametrize(
    "does,expected",
    [
        (malformed, ("VALIDATION_FAILURE", "WARNING")),
        (too_long, ("INSUFFICIENT_MEMORY", "URGENT")),
        (unknown_action, ("INVALID_ORDER_ACTION", "WARNING")),
        (lifts_too_high, ("INVALID_ORDER_ACTION", "WARNING")),
        (outdated_update, ("OUTDATED_ORDER_UPDATE", "WARNING")),
        (same_update, ("SAME_ORDER_UPDATE_ID", "WARNING")),
        (update_after_cancel, ("ORDER_UPDATE_FOLLOWING_CANCEL", "WARNING")),
        (another_order, ("OTHER_ORDER_ACTIVE", "WARNING")),
        (manual, ("MOBILE_ROBOT_NOT_AVAILABLE", "WARNING")),
        (lambda b: b.order("o", row(2, 3)), ("START_NODE_OUT_OF_RANGE", "WARNING")),
        (lambda b: b.order("o", [(0, 0), (1, 1)]), ("NO_ROUTE_TO_TARGET", "WARNING")),
        (lambda b: b.order("o", [(0, 0), (0, 5), (9, 5)]), ("NO_ROUTE_TO_TARGET", "WARNING")),
        (lambda b: b.instant("dance"), ("INVALID_INSTANT_ACTION", "WARNING")),
        (lambda b: b.instant("cancelOrder"), ("NO_ORDER_TO_CANCEL", "WARNING")),
        (lambda b: sent(b, place={"mapId": "attic"}), ("UNKNOWN_MAP_ID", "WARNING")),
        (lambda b: sent(b, edge={"maxSpeed": 0.1}), ("UNSUPPORTED_PARAMETER", "CRITICAL")),
    ],
    ids=lambda value: value[0] if isinstance(value, tuple) else "",
)
def test_the_mobile_robot_shall_use_predefined_error_types_to_report_specific_issues(
    does, expected
):
    """6.6.5.4."""
    bench = Bench()
    does(bench)
    assert expected in errors(bench)


def test_a_vehicle_that_is_pushed_aside_cannot_reach_a_node_in_its_order():
    """6.6.5.4: NODE_UNREACHABLE."""
    bench = Bench()
    bench.order("o", row(0, 6), released=3)
    bench.tick(6)
    bench.robot.cell = (2, 3)
    bench.order("o", row(2, 6), update=1, first=2)
    bench.tick(3)
    assert ("NODE_UNREACHABLE", "CRITICAL") in errors(bench)


@pytest.mark.parametrize("name", [*Predefined, "batteryEmpty"])
def test_each_predefined_type_comes_back_as_it_was_sent(name):
    value = CODEC.to_json(Bench().tick())
    value["errors"] = [{"errorType": name, "errorLevel": "URGENT", "errorReferences": []}]
    (error,) = CODEC.decode(Kind.STATE, json.dumps(value).encode()).message.errors
    assert precise_type(error) == name and former_type(name)[0] == error.type


def test_fields_are_named_as_they_were_sent():
    """6.1.4.2: the erroneous fields as errorReferences."""
    bench = Bench()
    sent(bench, "3.0.0", edge={"maximumSpeed": 0.1})
    (error,) = CODEC.to_json(bench.tick())["errors"]
    assert error["errorDescription"].startswith("edge 'e3': maximumSpeed is 0.1")
    named = [r["referenceValue"] for r in error["errorReferences"] if r["referenceKey"] == "field"]
    assert named == ["maximumSpeed"]


@pytest.mark.parametrize(
    "edge,place,is_taken",
    [
        ({"maximumRotationSpeed": 0.1}, {}, True),
        ({"maximumMobileRobotHeight": 0.1}, {}, False),
        ({"minimumLoadHandlingDeviceHeight": 0.1}, {}, False),
        ({}, {"allowedDeviationXY": {"a": 0.5, "b": 0.2, "theta": 0.0}}, True),
        ({}, {"allowedDeviationXY": {"a": 0.5, "b": 0.001, "theta": 0.0}}, False),
        ({}, {"allowedDeviationXY": {"a": 0.0, "b": 0.0, "theta": 0.0}}, True),
        ({}, {"allowedDeviationXY": {"a": 0.5}}, False),
        ({}, {"theta": math.pi}, False),
    ],
)
def test_the_mobile_robot_shall_not_ignore_the_field(edge, place, is_taken):
    """7.1."""
    assert (sent(Bench(), "3.0.0", edge, place).order_id == "o") is is_taken


def with_retriable_pick(bench, cells):
    """Sends an order whose pick, of a unit that is not there, may be retried."""
    action = replace(pick(), retriable=True)
    assert bench.order("o", cells, actions={1: [action]})
    return bench.until(lambda s: [a for a in s.actions if a.status is ActionStatus.RETRIABLE])


def status_of(state, id):
    return next(a.status.value for a in state.actions if a.id == id)


def test_an_action_that_failed_and_is_retriable_is_done_by_a_retry_and_the_order_goes_on():
    """6.2.3.1, retry; 6.6.9."""
    bench = Bench()
    state = with_retriable_pick(bench, row(0, 2))
    assert state.nodes and not state.driving
    assert "may be retried" in state.errors[-1].description
    bench.robot.units["7"] = bench.robot.cell
    state = bench.instant("retry", actionId="p1")
    assert status_of(state, "i1") == "FINISHED"
    state = bench.until(is_over)
    assert status_of(state, "p1") == "FINISHED" and state.last_node == "c2_0" and not state.errors


def test_an_action_that_failed_and_is_skipped_has_failed():
    """6.2.3.1, skipRetry."""
    bench = Bench()
    with_retriable_pick(bench, row(0, 1))
    state = bench.instant("skipRetry", actionId="p1")
    assert status_of(state, "p1") == "FAILED" and is_over(bench.tick())
    assert status_of(bench.instant("retry", "i2", actionId="p1"), "i2") == "FAILED"


def test_a_cancelled_order_leaves_nothing_to_be_retried():
    """6.6.9, Table 12."""
    bench = Bench()
    with_retriable_pick(bench, row(0, 2))
    state = bench.instant("cancelOrder")
    assert status_of(state, "p1") == "FAILED"
    assert is_over(bench.until(is_over))


def test_versions_without_retriable_call_it_running():
    bench = Bench()
    state = with_retriable_pick(bench, row(0, 1))
    words = {
        version: codec_for(version).to_json(state)["actionStates"][0]["actionStatus"]
        for version in ("2.1.0", "3.0.0")
    }
    assert words == {"2.1.0": "RUNNING", "3.0.0": "RETRIABLE"}


def test_order_update_id_shall_start_at_0_for_a_new_order():
    """6.1.2, step 4, and 7.3."""
    bench = Bench(begins_at_zero=True)
    assert not bench.order("o", row(0, 2), update=1)
    assert "begins with 0" in bench.vehicle.state().errors[0].description
    assert bench.order("o", row(0, 2), released=2)
    assert bench.order("o", row(1, 3), update=4, first=1)


def test_the_order_id_in_the_action_does_not_match_so_the_cancel_order_action_fails():
    """6.1.3.2. The order goes on."""
    bench = Bench()
    bench.order("o", row(0, 5))
    state = bench.instant("cancelOrder", "c", orderId="another")
    assert state.actions[0].status.value == "FAILED" and state.nodes
    (error,) = state.errors
    assert error.type == "noOrderToCancel" and ("actionId", "c") in error.references
    assert bench.until(is_over).last_node == "c5_0"


def test_fleet_control_can_pass_an_order_id_to_reference_which_order_shall_be_cancelled():
    """6.1.3."""
    bench = Bench()
    bench.order("o", row(0, 5))
    bench.instant("cancelOrder", "c", orderId="o")
    state = bench.until(is_over)
    assert state.last_node != "c5_0" and state.actions[0].status.value == "FINISHED"


def test_the_factsheet_names_blocking_types_and_what_can_be_paused():
    """7.9: pauseAllowed and cancelAllowed are booleans."""
    sheet = CODEC.to_json(Bench().vehicle.take_factsheet())
    actions = {
        entry["actionType"]: entry for entry in sheet["protocolFeatures"]["mobileRobotActions"]
    }
    pick_up = actions["pick"]
    assert pick_up["blockingTypes"] == ["NONE", "SINGLE", "SOFT", "HARD"]
    assert (pick_up["pauseAllowed"], pick_up["cancelAllowed"]) == (True, False)
    assert actions["waitForTrigger"]["cancelAllowed"] is True
    assert actions["startPause"]["blockingTypes"] == ["NONE"]
