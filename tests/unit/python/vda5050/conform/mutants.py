# SPDX-License-Identifier: Apache-2.0
"""Vehicles that break one rule of the specification each: messages damaged on their way to the
broker, or our vehicle's code with one thing wrong."""

from __future__ import annotations

import contextlib
import json
import math
from dataclasses import dataclass, field, replace
from unittest import mock

from damage import Additions
from paper_vehicle import PaperWire, runner_for

from warehouse_vda5050.conform.cases import cases_of
from warehouse_vda5050.conform.verdict import Verdict
from warehouse_vda5050.errors import Error, ErrorLevel
from warehouse_vda5050.model import ActionStatus
from warehouse_vda5050.topics import Kind
from warehouse_vda5050.validation import actions as action_checks
from warehouse_vda5050.validation import demands
from warehouse_vda5050.validation.fields import Fields
from warehouse_vda5050.vehicle import instant, reception, wheels
from warehouse_vda5050.vehicle.actions import ActionQueue
from warehouse_vda5050.vehicle.complaints import Complaints
from warehouse_vda5050.vehicle.hands import Hands
from warehouse_vda5050.vehicle.instant import InstantDesk
from warehouse_vda5050.vehicle.phase import Phase
from warehouse_vda5050.vehicle.progress import OrderProgress
from warehouse_vda5050.vehicle.state_report import StateReporter
from warehouse_vda5050.vehicle.vehicle import Vehicle
from warehouse_vda5050.vehicle.wheels import Wheels
from warehouse_vda5050.vehicle.wheels import _speeds_of as speeds_of

from warehouse_vda5050.mqtt.vehicle_link import VehicleLink  # isort: skip


@dataclass
class Mutant:
    """rule: what is broken. damage(message, memory) changes a message of the vehicle, None: it is
    lost. deafen(topic, payload) one to the vehicle. patches: (object, name, replacement)."""

    name: str
    rule: str
    damage: object = None
    deafen: object = None
    patches: list = field(default_factory=list)

    def runner(self, stack, version="2.1.0"):
        """Returns a runner with this vehicle; `stack` undoes its patches."""
        for target, name, replacement in self.patches:
            stack.enter_context(mock.patch.object(target, name, replacement))
        memory = {}
        damage = self.damage
        hear = {} if damage is None else {"damage": lambda message: damage(message, memory)}
        if self.deafen:
            hear["deafen"] = self.deafen
        return runner_for(version, PaperWire(version, **hear))


MUTANTS: dict[str, Mutant] = {}
additions = Additions(MUTANTS, Mutant)
patched, message, json_of = additions.patched, additions.message, additions.json_of


def found_by(mutant, cases=None, version="2.1.0"):
    """Returns the first case that a mutant fails, with the reason; None if it fails none."""
    with contextlib.ExitStack() as stack:
        try:
            runner = mutant.runner(stack, version)
        except RuntimeError as silent:
            return "begin", str(silent)
        for result in runner.run(cases or cases_of(version)):
            if result.verdict is Verdict.DIFFERS:
                return result.case.id, result.reason
    return None


def state(name, rule):
    """Returns a decorator for damage of states."""
    return json_of(name, rule, Kind.STATE)


ALL = (Kind.STATE, Kind.CONNECTION, Kind.FACTSHEET, Kind.VISUALIZATION)

# --- connection


@message("connection_not_retained", "connection is retained", Kind.CONNECTION)
def _(sent, memory):
    return sent._replace(retain=False)


@message("connection_qos_0", "connection has QoS 1", Kind.CONNECTION)
def _(sent, memory):
    return sent._replace(qos=0)


@message("state_qos_1", "state has QoS 0", Kind.STATE)
def _(sent, memory):
    return sent._replace(qos=1)


@message("never_online", "says ONLINE", Kind.CONNECTION)
def _(sent, memory):
    return None if b"ONLINE" in sent.payload else sent


@message("no_will", "has a last will", Kind.CONNECTION)
def _(sent, memory):
    return None if b"CONNECTIONBROKEN" in sent.payload else sent


@message("will_offline", "the will says CONNECTIONBROKEN", Kind.CONNECTION)
def _(sent, memory):
    return sent._replace(payload=sent.payload.replace(b"CONNECTIONBROKEN", b"OFFLINE"))


@message("will_not_retained", "the will is retained", Kind.CONNECTION)
def _(sent, memory):
    return sent._replace(retain=b"CONNECTIONBROKEN" not in sent.payload)


@message("online_once", "says ONLINE after each connection", Kind.CONNECTION)
def _(sent, memory):
    if b"ONLINE" in sent.payload:
        memory["count"] = memory.get("count", 0) + 1
    return None if b"ONLINE" in sent.payload and memory["count"] > 1 else sent


@message("factsheet_not_retained", "factsheet is retained", Kind.FACTSHEET)
def _(sent, memory):
    return sent._replace(retain=False)


@json_of("connection_without_header", "connection has a header", Kind.CONNECTION)
def _(value, memory):
    value.pop("headerId")


@json_of("connection_word", "connectionState is one of three", Kind.CONNECTION)
def _(value, memory):
    value["connectionState"] = value["connectionState"].lower()


def _silent_reconnection(self):
    self._called = True
    self.link.publish(self._online)
    if not hasattr(self, "was_there"):
        self.was_there = True
        self.vehicle.request_state()
        self.vehicle.request_factsheet()


patched(
    "no_state_after_reconnection",
    "a state comes after a new connection",
    (VehicleLink, "_on_connect", _silent_reconnection),
)


def _forgetful_connection(self):
    if self.vehicle.order and hasattr(self, "was_there"):
        self.vehicle.order = None
        self.vehicle.phase = Phase.HELD
    self.was_there = True
    self._called = True
    self.link.publish(self._online)
    self.vehicle.request_state()
    self.vehicle.request_factsheet()


patched(
    "order_lost_with_connection",
    "without a connection the order is kept",
    (VehicleLink, "_on_connect", _forgetful_connection),
)


def _stops_alone(self, now, former=VehicleLink.tick):
    former(self, now)
    if not self.link.connected and hasattr(self, "was_there"):
        self.vehicle.begin_cancel(now)
    self.was_there = self.link.connected or hasattr(self, "was_there")


patched(
    "stops_without_connection",
    "without a connection the base is driven",
    (VehicleLink, "tick", _stops_alone),
)

# --- headers


@json_of("header_id_still", "headerId counts up", *ALL)
def _(value, memory):
    value["headerId"] = 1


@json_of("header_id_by_two", "headerId counts by one", *ALL)
def _(value, memory):
    value["headerId"] *= 2


@json_of("header_id_of_all", "headerId is of a topic", *ALL)
def _(value, memory):
    memory["id"] = memory.get("id", 0) + 1
    value["headerId"] = memory["id"]


@json_of("header_id_text", "headerId is a number", *ALL)
def _(value, memory):
    value["headerId"] = str(value["headerId"])


@json_of("stamp_without_zone", "timestamp is in UTC", *ALL)
def _(value, memory):
    value["timestamp"] = value["timestamp"].removesuffix("Z")


@json_of("stamp_number", "timestamp is ISO 8601", *ALL)
def _(value, memory):
    value["timestamp"] = 1700000000.0


@json_of("stamp_goes_back", "timestamp never goes back", *ALL)
def _(value, memory):
    memory["n"] = memory.get("n", 0) + 1
    if memory["n"] % 20 == 0:
        value["timestamp"] = "2001" + value["timestamp"][4:]


@json_of("stamp_stands", "timestamp advances", *ALL)
def _(value, memory):
    value["timestamp"] = memory.setdefault("t", value["timestamp"])


@json_of("version_other", "version is the protocol's", *ALL)
def _(value, memory):
    value["version"] = "1.1.0"


@json_of("serial_other", "serialNumber is the vehicle's", *ALL)
def _(value, memory):
    value["serialNumber"] = "another"


@json_of("no_manufacturer", "a header has manufacturer", *ALL)
def _(value, memory):
    value.pop("manufacturer")


# --- form of states

for _name in ("operatingMode", "batteryState", "safetyState", "errors", "driving", "lastNodeId"):

    @state(f"without_{_name}", f"a state has {_name}")
    def _(value, memory, name=_name):
        value.pop(name)


@state("nodes_null", "nodeStates is a list, also if it is empty")
def _(value, memory):
    value["nodeStates"] = value["nodeStates"] or None


@state("driving_text", "a boolean is no text")
def _(value, memory):
    value["driving"] = str(value["driving"]).lower()


@state("theta_degrees", "theta is in radians")
def _(value, memory):
    value["agvPosition"]["theta"] = 270.0


@state("mode_small", "enumerations are in upper case")
def _(value, memory):
    value["operatingMode"] = value["operatingMode"].lower()


@state("status_word", "actionStatus is one of six")
def _(value, memory):
    for row in value["actionStates"]:
        row["actionStatus"] = row["actionStatus"].replace("FINISHED", "DONE")


@state("level_word", "errorLevel is WARNING or FATAL")
def _(value, memory):
    for row in value["errors"]:
        row["errorLevel"] = "ERROR"


@state("charge_beyond", "batteryCharge is up to 100")
def _(value, memory):
    value["batteryState"]["batteryCharge"] = 4200.0


@state("charge_text", "batteryCharge is a number")
def _(value, memory):
    value["batteryState"]["batteryCharge"] = "80"


@state("map_missing", "the map of the position is among maps")
def _(value, memory):
    value["maps"] = []


@state("not_initialized", "positionInitialized is true of a vehicle that knows where it is")
def _(value, memory):
    value["agvPosition"]["positionInitialized"] = False


@json_of("visualization_form", "visualization has the form of the position", Kind.VISUALIZATION)
def _(value, memory):
    value["agvPosition"].pop("x")


@json_of("visualization_elsewhere", "visualization agrees with the state", Kind.VISUALIZATION)
def _(value, memory):
    value["agvPosition"]["x"] += 3.0


@json_of("visualization_stale", "visualization is of the present", Kind.VISUALIZATION)
def _(value, memory):
    now = value["agvPosition"]
    value["agvPosition"], memory["before"] = memory.get("before", now), now


# --- when states come


def _long_interval(self, situation, now, former=StateReporter.take):
    state = former(self, situation, now)
    if state:
        self.due = now + 90.0
    return state


patched("idle_silence", "a state comes each 30 s", (StateReporter, "take", _long_interval))


@state("nodes_unreported", "driving over a node triggers a state")
def _(value, memory):
    return value["lastNodeSequenceId"] != 2


@state("driving_unreported", "a change of driving triggers a state")
def _(value, memory):
    return not value["driving"]


def _no_request(self):
    pass


patched("unanswered", "an instant action is answered", (Vehicle, "request_state", _no_request))
patched(
    "state_request_ignored",
    "stateRequest is answered by a state",
    (
        InstantDesk,
        "begin",
        lambda self, action, now, former=InstantDesk.begin: (
            None if action.type == "stateRequest" else former(self, action, now)
        ),
    ),
)

# --- progress in states


@state("traversed_node_stays", "a traversed node leaves nodeStates")
def _(value, memory):
    if value["nodeStates"] and value["lastNodeSequenceId"]:
        first = {"nodeId": value["lastNodeId"], "sequenceId": value["lastNodeSequenceId"]}
        value["nodeStates"].insert(0, {**first, "released": True})


@state("driven_edge_stays", "a driven edge leaves edgeStates")
def _(value, memory):
    if value["edgeStates"]:
        memory.setdefault(value["orderId"], value["edgeStates"])
        value["edgeStates"] = memory[value["orderId"]]


@state("last_number_stays", "lastNodeSequenceId is the traversed node's")
def _(value, memory):
    value["lastNodeSequenceId"] = 0


@state("last_number_halved", "sequenceIds of nodes are those of the order")
def _(value, memory):
    value["lastNodeSequenceId"] //= 2


@state("last_name_stays", "lastNodeId is the traversed node's")
def _(value, memory):
    value["lastNodeId"] = memory.setdefault(value["orderId"], value["lastNodeId"])


@state("traversed_early", "a node is traversed when the vehicle is there")
def _(value, memory):
    if value["nodeStates"] and value["driving"]:
        node = value["nodeStates"].pop(0)
        value["edgeStates"].pop(0)
        value["lastNodeId"], value["lastNodeSequenceId"] = node["nodeId"], node["sequenceId"]


@state("nodes_reversed", "nodeStates are in the order's sequence")
def _(value, memory):
    value["nodeStates"].reverse()


@state("edges_missing", "edgeStates has the edges to be driven")
def _(value, memory):
    value["edgeStates"] = []


@state("horizon_missing", "the horizon is in nodeStates and edgeStates")
def _(value, memory):
    for name in ("nodeStates", "edgeStates"):
        value[name] = [row for row in value[name] if row["released"]]


@state("all_released", "the horizon is reported as not released")
def _(value, memory):
    for row in [*value["nodeStates"], *value["edgeStates"]]:
        row["released"] = True


@state("none_released", "the base is reported as released")
def _(value, memory):
    for row in [*value["nodeStates"], *value["edgeStates"]]:
        row["released"] = False


@state("order_forgotten", "orderId is kept after the end")
def _(value, memory):
    if not value["nodeStates"]:
        value["orderId"] = ""


@state("update_zero", "orderUpdateId is the newest")
def _(value, memory):
    value["orderUpdateId"] = 0


@state("never_driving", "driving is true while the vehicle drives")
def _(value, memory):
    value["driving"] = False


@state("always_driving", "driving is false while the vehicle stands")
def _(value, memory):
    value["driving"] = True


@state("position_stays", "agvPosition follows the vehicle")
def _(value, memory):
    value["agvPosition"] = memory.setdefault("at", value["agvPosition"])


@state("node_names", "nodeStates has the order's nodeIds")
def _(value, memory):
    for row in value["nodeStates"]:
        row["nodeId"] = f"n{row['sequenceId']}"


@state("edge_names", "edgeStates has the order's edgeIds")
def _(value, memory):
    for row in value["edgeStates"]:
        row["edgeId"] = f"e{row['sequenceId']}"


@state("base_request_idle", "without an order no base is asked for")
def _(value, memory):
    value["newBaseRequest"] = True


@state("errors_hidden", "errors are reported")
def _(value, memory):
    value["errors"] = []


@state("errors_once", "an error stays until the next order")
def _(value, memory):
    known = memory.setdefault("known", [])
    fresh = [row for row in value["errors"] if row not in known]
    known += fresh
    value["errors"] = fresh


@state("errors_forever", "an error goes with the next order")
def _(value, memory):
    kept = memory.setdefault("kept", [])
    kept += [row for row in value["errors"] if row not in kept]
    value["errors"] = list(kept)


@state("errors_fatal", "a refusal is a warning")
def _(value, memory):
    for row in value["errors"]:
        row["errorLevel"] = "FATAL"


@state("errors_without_references", "an error has references")
def _(value, memory):
    for row in value["errors"]:
        row["errorReferences"] = []


@state("errors_without_order", "an error refers to its order")
def _(value, memory):
    for row in value["errors"]:
        pairs = row["errorReferences"]
        row["errorReferences"] = [p for p in pairs if p["referenceKey"] != "orderId"]


@state("errors_without_action", "an error refers to its action")
def _(value, memory):
    for row in value["errors"]:
        pairs = row["errorReferences"]
        row["errorReferences"] = [p for p in pairs if p["referenceKey"] != "actionId"]


@state("errors_of_one_type", "errorType is the specification's")
def _(value, memory):
    for row in value["errors"]:
        row["errorType"] = "error"


@state("errors_well", "a vehicle that is well has no errors")
def _(value, memory):
    ours = {"errorType": "ok", "errorLevel": "WARNING", "errorReferences": []}
    value["errors"].append(ours)


@state("actions_without_type", "actionType is the action's")
def _(value, memory):
    for row in value["actionStates"]:
        row["actionType"] = "action"


@state("actions_over_vanish", "actionStates are kept after the end")
def _(value, memory):
    over = ("FINISHED", "FAILED")
    value["actionStates"] = [a for a in value["actionStates"] if a["actionStatus"] not in over]


@state("actions_twice", "an action is in actionStates once")
def _(value, memory):
    value["actionStates"] *= 2


@state("actions_return", "what is over stays over")
def _(value, memory):
    memory["n"] = memory.get("n", 0) + 1
    if memory["n"] % 9 == 0:
        for row in value["actionStates"]:
            row["actionStatus"] = "RUNNING"


@state("waiting_hidden", "actions that wait are in actionStates")
def _(value, memory):
    value["actionStates"] = [a for a in value["actionStates"] if a["actionStatus"] != "WAITING"]


@state("waiting_runs", "before its node an action is WAITING")
def _(value, memory):
    for row in value["actionStates"]:
        row["actionStatus"] = row["actionStatus"].replace("WAITING", "INITIALIZING")


@state("never_paused", "paused is true while the vehicle is paused")
def _(value, memory):
    value["paused"] = False


@state("result_missing", "logReport names the log")
def _(value, memory):
    for row in value["actionStates"]:
        row.pop("resultDescription", None)


# --- orders: our code with one thing wrong

NOTHING = lambda *args, **kwargs: None  # noqa: E731
patched(
    "takes_second_order",
    "another order while one is active is refused",
    (reception.Reception, "_check_free", NOTHING),
    (
        Vehicle,
        "start",
        lambda self, progress, order, former=Vehicle.start: (
            setattr(self, "phase", Phase.HELD) or former(self, progress, order)
        ),
    ),
    (
        reception.Reception,
        "_begin",
        lambda self, order, cells, now, report: self._start(OrderProgress(order, cells), order),
    ),
)
patched(
    "starts_anywhere", "an order begins where the vehicle is", (reception, "_check_start", NOTHING)
)


def _stitch_anything(self, order, cells, former=OrderProgress.stitch):
    self.update = min(self.update, order.update)
    return former(self, order, cells)


patched(
    "lower_update_taken", "a lower update is refused", (OrderProgress, "stitch", _stitch_anything)
)


def _quiet(kinds):
    def note(self, error, former=Complaints.note):
        if error.type not in kinds:
            former(self, error)

    return note


for _kind in (
    "orderUpdateError",
    "orderError",
    "validationError",
    "noRouteError",
    "noOrderToCancel",
):
    patched(f"no_{_kind}", f"{_kind} is reported", (Complaints, "note", _quiet([_kind])))
patched(
    "no_instant_error",
    "an unknown instant action is an error",
    (Complaints, "note", _quiet(["instantActionError"])),
)


def _copy_is_error(self, order):
    if (order.id, order.update) == (self.id, self.update):
        self._refuse(order, "it is known")
    return False


patched("copy_refused", "a copy is ignored", (OrderProgress, "is_repeated", _copy_is_error))


def _copy_restarts(self, order):
    return False


patched(
    "copy_driven_again",
    "a copy is not driven again",
    (OrderProgress, "is_repeated", _copy_restarts),
    (
        reception.Reception,
        "_update",
        lambda self, current, order, cells, now, report: self._start(
            OrderProgress(order, cells), order
        ),
    ),
    (
        Vehicle,
        "start",
        lambda self, progress, order, former=Vehicle.start: (
            setattr(self, "phase", Phase.HELD) or former(self, progress, order)
        ),
    ),
)
patched(
    "horizon_driven",
    "the horizon is not driven",
    (OrderProgress, "base_end", property(lambda self: len(self.nodes) - 1)),
)
patched(
    "stops_early",
    "the base is driven to its end",
    (Wheels, "_goal", lambda self, order, former=Wheels._goal: max(0, former(self, order) - 1)),
)


def _shared_anywhere(self, order, cells):
    return range(self.base_end, self.base_end + 1)


patched(
    "gap_taken",
    "an update begins at the last released node",
    (OrderProgress, "_shared", _shared_anywhere),
)
patched(
    "other_node_taken",
    "the first node of an update is the last released",
    (OrderProgress, "_same", lambda *args: True),
)


def _refuse_after_end(self, current, order, cells, now, report, former=reception.Reception._update):
    if now.phase.is_free:
        reception._refuse(order, "the order is over")
    former(self, current, order, cells, now, report)


patched(
    "update_after_end_refused",
    "an order that is over is continued",
    (reception.Reception, "_update", _refuse_after_end),
)


def _refuse_while_driving(
    self, current, order, cells, now, report, former=reception.Reception._update
):
    if report.moving:
        reception._refuse(order, "it drives")
    former(self, current, order, cells, now, report)


patched(
    "update_while_driving_refused",
    "the base is extended while driving",
    (reception.Reception, "_update", _refuse_while_driving),
)


def _stitch_keeping(self, order, cells, former=OrderProgress.stitch):
    tail = self.nodes[self.base_end + 1 :], self.cells[self.base_end + 1 :]
    edges = self.edges[self.base_end :]
    new = former(self, order, cells)
    if len(order.nodes) == 1:
        self.nodes += tail[0]
        self.cells += tail[1]
        self.edges += edges
    return new


patched(
    "horizon_kept", "an update replaces the horizon", (OrderProgress, "stitch", _stitch_keeping)
)


def _stitch_lost(self, order, cells, former=OrderProgress.stitch):
    former(self, order, cells)
    self.update, self._content = order.update - 1, None
    return ()


patched(
    "update_number_stays", "orderUpdateId is the update's", (OrderProgress, "stitch", _stitch_lost)
)


def _number_before_check(self, order, cells, former=OrderProgress.stitch):
    if order.update > self.update:
        self.update = order.update
    return former(self, order, cells)


patched(
    "refused_number_taken",
    "a refused update leaves the number",
    (OrderProgress, "stitch", _number_before_check),
)


def _refused_forgets(self, order, now, former=reception.Reception.accept):
    try:
        return former(self, order, now)
    except reception.MessageError:
        if now.order and now.order.id != order.id:
            now.order.id, now.order.update = order.id, order.update
        raise


patched(
    "refused_order_taken",
    "a refused order is not taken over",
    (reception.Reception, "accept", _refused_forgets),
)


def _cancels_on_refusal(self, error, former=Vehicle.note):
    former(self, error)
    self.begin_cancel(0.0)


patched(
    "malformed_cancels",
    "a malformed message changes nothing",
    (Vehicle, "note", _cancels_on_refusal),
)
patched(
    "one_node_refused",
    "an order of one node is taken",
    (
        reception,
        "check_form",
        lambda order, former=reception.check_form: (
            former(order) if len(order.nodes) > 1 else reception._refuse(order, "too short")
        ),
    ),
)
patched(
    "no_loops",
    "an order may come to a node twice",
    (
        reception,
        "check_form",
        lambda order, former=reception.check_form: (
            former(order)
            if len({n.id for n in order.nodes}) == len(order.nodes)
            else reception._refuse(order, "a loop")
        ),
    ),
)


def _stuck_after_refusal(self, order, now, unknown=(), former=Vehicle.on_order):
    if getattr(self, "stuck", False):
        return False
    accepted = former(self, order, now, unknown)
    if not accepted and self.complaints._noted:
        self.stuck = True
    return accepted


patched(
    "stuck_after_refusal",
    "after a refusal the next order is taken",
    (Vehicle, "on_order", _stuck_after_refusal),
)

# --- cancel and pause


def _cancel_ignored(self, now):
    return self.phase is Phase.WORKING


patched(
    "cancel_ignored", "cancelOrder stops the vehicle", (Vehicle, "begin_cancel", _cancel_ignored)
)


def _cancel_over(vehicle, action, now):
    vehicle.begin_cancel(now)
    return ""


patched(
    "cancel_finished_early",
    "cancelOrder is RUNNING until the vehicle stands",
    (
        instant,
        "ACTIONS",
        {**instant.ACTIONS, "cancelOrder": lambda v, a, n: (instant._cancel(v, a, n), "")[1]},
    ),
)
patched(
    "cancel_idle_finished",
    "cancelOrder without an order is FAILED",
    (
        instant,
        "ACTIONS",
        {
            **instant.ACTIONS,
            "cancelOrder": lambda v, a, n: instant.RUNS if v.begin_cancel(n) else "",
        },
    ),
)
patched("cancel_drives_to_end", "cancelOrder stops at the next node", (Wheels, "cancel", NOTHING))


def _cancel_keeping(self):
    self.cancelled = True


patched(
    "cancel_keeps_nodes",
    "a cancelled order leaves no nodes",
    (OrderProgress, "cancel", _cancel_keeping),
)


def _cancel_forgetting(self, former=OrderProgress.cancel):
    former(self)
    self.id = ""


patched(
    "cancel_forgets_id",
    "orderId is kept after a cancellation",
    (OrderProgress, "cancel", _cancel_forgetting),
)
patched(
    "cancel_leaves_waiting",
    "scheduled actions are FAILED",
    (ActionQueue, "fail_waiting", lambda self, reason: self._due.clear()),
)
patched(
    "cancel_drops_waiting",
    "scheduled actions are reported FAILED",
    (
        ActionQueue,
        "fail_waiting",
        lambda self, reason: (
            self._due.clear(),
            setattr(
                self,
                "_states",
                {k: s for k, s in self._states.items() if s.status is not ActionStatus.WAITING},
            ),
        ),
    ),
)
patched("cancel_leaves_running", "running actions end with the order", (Hands, "give_up", NOTHING))
patched(
    "cancel_finishes_running",
    "waitForTrigger is FAILED if the order is cancelled",
    (Hands, "give_up", lambda self: self.trigger()),
)
patched(
    "cancel_waits_for_resume",
    "a paused order is cancelled",
    (Vehicle, "_has_halted", lambda self, report: not self.paused and self.wheels.rest),
)


def _update_of_cancelled(self, order, cells, former=OrderProgress.stitch):
    self.cancelled = False
    return former(self, order, cells)


patched(
    "update_after_cancel",
    "an update of a cancelled order is refused",
    (OrderProgress, "stitch", _update_of_cancelled),
)


def _error_of_cancel(self, former=Vehicle.errors):
    errors = former(self)
    if self.order and self.order.cancelled:
        errors = (*errors, Error("cancelled", ErrorLevel.WARNING))
    return errors


patched(
    "cancel_is_error", "a cancelled order leaves no error", (Vehicle, "errors", _error_of_cancel)
)


def _no_order_after_cancel(self, order, now, former=reception.Reception._check_free):
    former(self, order, now)
    if now.order and now.order.cancelled:
        reception._refuse(order, "cancelled")


patched(
    "no_order_after_cancel",
    "after a cancellation a new order is taken",
    (reception.Reception, "_check_free", _no_order_after_cancel),
)


def _pause_in_words(self, paused):
    self.paused = paused


patched("pause_in_words", "a paused vehicle stands", (Vehicle, "set_paused", _pause_in_words))
patched(
    "pause_finished_early",
    "startPause is FINISHED once the vehicle stands",
    (instant, "ACTIONS", {**instant.ACTIONS, "startPause": lambda v, a, n: ""}),
)


def _pause_soft(self, paused):
    self.paused = paused


def _brake_later(self, now, former=Vehicle.update):
    former(self, now)
    held = getattr(self, "held_since", None)
    if self.paused and held is None:
        self.held_since = now
    if self.paused and held is not None and now - held > 1.0:
        self.driver.stop(True)
    if not self.paused:
        self.held_since = None
        self.driver.stop(False)


patched(
    "pause_brakes_late",
    "startPause is FINISHED once the vehicle stands, late",
    (Vehicle, "set_paused", _pause_soft),
    (Vehicle, "update", _brake_later),
    (
        instant,
        "ACTIONS",
        {**instant.ACTIONS, "startPause": lambda v, a, n: (v.set_paused(True), "")[1]},
    ),
)


def _never_resumes(self, paused):
    self.paused = paused
    if paused:
        self.driver.stop(True)


patched("never_resumes", "stopPause resumes the order", (Vehicle, "set_paused", _never_resumes))


def _pause_cancels(self, paused, former=Vehicle.set_paused):
    former(self, paused)
    if paused:
        self.begin_cancel(0.0)


patched("pause_cancels", "a paused order is kept", (Vehicle, "set_paused", _pause_cancels))


def _pause_once(vehicle, action, now):
    if vehicle.paused:
        raise instant.ActionError("paused already")
    return instant._pause(vehicle, action, now)


patched(
    "pause_once",
    "startPause is idempotent",
    (instant, "ACTIONS", {**instant.ACTIONS, "startPause": _pause_once}),
)


def _resume_once(vehicle, action, now):
    if not vehicle.paused:
        raise instant.ActionError("not paused")
    return instant._go_on(vehicle, action, now)


patched(
    "resume_once",
    "stopPause is idempotent",
    (instant, "ACTIONS", {**instant.ACTIONS, "stopPause": _resume_once}),
)


def _start_resumes(self, progress, order, former=Vehicle.start):
    self.set_paused(False)
    former(self, progress, order)


patched("order_resumes", "a new order does not end a pause", (Vehicle, "start", _start_resumes))


def _extend_resumes(self, nodes, former=Vehicle.extend):
    if self.paused:
        self.begin_cancel(0.0)
    former(self, nodes)


patched(
    "update_lost_in_pause",
    "an update while paused is driven later",
    (Vehicle, "extend", _extend_resumes),
)

# --- actions


def _known(order, sheet):
    pass


patched("any_action_taken", "an unknown action is refused", (reception, "check_actions", _known))


def _parameters_ignored(name, value, names, sheet):
    return ""


patched(
    "parameters_ignored",
    "an unusable parameter is refused",
    (action_checks, "_fault", _parameters_ignored),
)
patched(
    "height_ignored", "a height that can't be reached is refused", (action_checks, "CHECKS", {})
)


def _edge_actions_ignored(order, sheet, former=action_checks.check_actions):
    former(replace(order, edges=tuple(replace(e, actions=()) for e in order.edges)), sheet)


patched(
    "edge_actions_ignored",
    "an action of an edge is not ignored",
    (reception, "check_actions", _edge_actions_ignored),
)


def _due_early(self, nodes, former=ActionQueue.add):
    nodes = list(nodes)
    former(self, nodes)
    self._due += [action for node in nodes[1:] for action in node.actions]


patched(
    "action_early",
    "an action begins at its node",
    (ActionQueue, "add", _due_early),
    (
        ActionQueue,
        "make_due",
        lambda self, nodes: self._due.extend(
            a
            for n in nodes
            for a in n.actions
            if a not in self._due
            and a not in self.running
            and self._states[a.id].status is ActionStatus.WAITING
        ),
    ),
)
patched(
    "actions_never",
    "an action begins when its node is traversed",
    (ActionQueue, "make_due", NOTHING),
)


def _never_holds(self):
    return False


patched(
    "hard_drives",
    "HARD holds the vehicle",
    (ActionQueue, "holds_driving", property(_never_holds)),
    (Wheels, "_goal", lambda self, order: order.base_end),
)


def _soft_drives(self):
    from warehouse_vda5050.model import BlockingType

    return any(a.blocking is BlockingType.HARD for a in [*self.running, *self._due])


patched(
    "soft_drives", "SOFT holds the vehicle", (ActionQueue, "holds_driving", property(_soft_drives))
)
patched(
    "none_holds",
    "NONE does not hold the vehicle",
    (ActionQueue, "holds_driving", property(lambda self: not self.is_over)),
)


def _next_at_once(self, standing):
    if not self._due:
        return None
    action = self._due.pop(0)
    self.running.append(action)
    self._set(action.id, ActionStatus.RUNNING)
    return action


patched(
    "hard_beside_others", "HARD runs beside no other action", (ActionQueue, "next", _next_at_once)
)


def _next_reversed(self, standing, former=ActionQueue.next):
    self._due.reverse()
    action = former(self, standing)
    self._due.reverse()
    return action


patched(
    "actions_reversed", "actions are begun in their sequence", (ActionQueue, "next", _next_reversed)
)


def _hard_waits_for_none(self, standing, former=ActionQueue.next):
    from warehouse_vda5050.model import BlockingType

    running = self.running
    self.running = [a for a in running if a.blocking is not BlockingType.NONE]
    action = former(self, standing)
    self.running = running + [a for a in self.running if a not in running]
    return action


patched("hard_beside_none", "HARD waits for NONE", (ActionQueue, "next", _hard_waits_for_none))


def _start_keeping_actions(self, progress, order, former=Vehicle.start):
    before = dict(self.actions._states)
    former(self, progress, order)
    self.actions._states = {**before, **self.actions._states}


patched(
    "actions_never_cleared",
    "a new order clears actionStates",
    (Vehicle, "start", _start_keeping_actions),
)


def _settle_early(self):
    if self.phase in (Phase.WORKING, Phase.HALTED) and self.order and self.order.is_driven:
        self._go_to(Phase.HELD)


patched(
    "over_before_actions",
    "an order is under way until its actions are over",
    (Vehicle, "_settle", _settle_early),
)
patched(
    "failed_action_unsaid",
    "a failed action is an error",
    (ActionQueue, "failed", property(lambda self: [])),
)
patched(
    "drop_of_nothing_finished",
    "a drop without a load is FAILED",
    (Hands, "_begin_lift", lambda self, action, report, now: self.actions.finish(action.id)),
)

# --- instant actions

patched(
    "instant_unreported",
    "instant actions are in actionStates",
    (InstantDesk, "states", lambda self: ()),
)


def _unknown_finished(self, action, now, former=InstantDesk.begin):
    if action.type in instant.ACTIONS:
        former(self, action, now)
    else:
        self._begun[action.id] = now
        self._set(action, ActionStatus.FINISHED)


patched(
    "unknown_instant_finished",
    "an unknown instant action is FAILED",
    (InstantDesk, "begin", _unknown_finished),
)


def _first_alone(self, sent, now, unknown=(), former=Vehicle.on_instant_actions):
    former(self, replace(sent, actions=sent.actions[:1]), now, unknown)


patched(
    "first_instant_alone",
    "all actions of a message are carried out",
    (Vehicle, "on_instant_actions", _first_alone),
)


def _some_vanish(self, sent, now, unknown=(), former=Vehicle.on_instant_actions):
    former(self, replace(sent, actions=sent.actions[:10]), now, unknown)


patched(
    "many_instants_vanish",
    "too many instant actions are refused, or done",
    (Vehicle, "on_instant_actions", _some_vanish),
)
patched(
    "init_anything",
    "initPosition without a pose is FAILED",
    (instant, "ACTIONS", {**instant.ACTIONS, "initPosition": lambda v, a, n: ""}),
)
patched(
    "charging_in_words",
    "startCharging FINISHED means charging",
    (instant, "ACTIONS", {**instant.ACTIONS, "startCharging": lambda v, a, n: ""}),
)


def _instant_cancels(self, sent, now, unknown=(), former=Vehicle.on_instant_actions):
    if any(action.type == "stateRequest" for action in sent.actions):
        self.begin_cancel(now)
    former(self, sent, now, unknown)


patched(
    "instant_cancels",
    "an instant action changes nothing of the order",
    (Vehicle, "on_instant_actions", _instant_cancels),
)

# --- fields

for _name in (
    "maxHeight",
    "minHeight",
    "orientation",
    "direction",
    "trajectory",
    "corridor",
):
    patched(
        f"{_name}_ignored",
        f"{_name} is honoured or refused",
        (demands, "EDGE_CHECKS", {k: v for k, v in demands.EDGE_CHECKS.items() if k != _name}),
    )
patched(
    "speed_ignored",
    "maxSpeed is honoured or refused",
    (OrderProgress, "speeds", lambda self: [math.inf] * self.base_end),
)


def _first_speed_alone(self, former=OrderProgress.speeds):
    return [*former(self)[:1], *[math.inf] * (self.base_end - 1)]


def _speed_of_next(self, former=OrderProgress.speeds):
    return [*former(self)[1:], math.inf]


def _half_heard(leg, speeds):
    return [2 * speed for speed in speeds_of(leg, speeds)]


patched(
    "speed_ahead_late",
    "maxSpeed holds from the node where the edge begins",
    (Wheels, "_lengthen", lambda *arguments: None),
    (OrderProgress, "speeds", _first_speed_alone),
)
patched(
    "speed_off_by_one",
    "maxSpeed holds on its own edge",
    (OrderProgress, "speeds", _speed_of_next),
)
patched("speed_doubled", "maxSpeed is in m/s", (wheels, "_speeds_of", _half_heard))
patched("theta_ignored", "theta is honoured or refused", (demands, "_theta", lambda *args: ""))
patched(
    "deviation_ignored",
    "allowedDeviationXY is kept or refused",
    (demands, "_deviation", lambda *a: ""),
)
patched("map_ignored", "a node of another map is refused", (reception, "check_maps", NOTHING))


def _zones_ignored(order, cells, robot, former=demands.check_demands):
    former(replace(order, zone_set=""), cells, robot)


patched(
    "zones_ignored", "an unknown zone set is refused", (reception, "check_demands", _zones_ignored)
)


def _unnamed(order, field, text, part=None, precise=None):
    raise reception.MessageError("an unusable field", "orderError", (("orderId", order.id),))


patched("fields_unnamed", "the error names the field", (demands, "_refuse", _unnamed))


def _all_fields_refused(order, cells, robot):
    for edge in order.edges:
        if edge.demands:
            demands._refuse(order, edge.demands[0][0], "never", edge)


patched(
    "harmless_fields_refused",
    "a generous maxSpeed is taken",
    (reception, "check_demands", _all_fields_refused),
)

# --- malformed messages


def _lenient(**defaults):
    def get(self, key, default, kind, expected, former=Fields._get):
        return former(self, key, defaults.get(key, default), kind, expected)

    return get


patched("released_assumed", "released is required", (Fields, "_get", _lenient(released=True)))
patched("update_assumed", "orderUpdateId is required", (Fields, "_get", _lenient(orderUpdateId=0)))


def _form_unchecked(order):
    if not order.nodes:
        reception._refuse(order, "no nodes")


patched(
    "form_unchecked",
    "sequenceIds have no gap, edges no hole",
    (reception, "check_form", _form_unchecked),
)
patched(
    "version_unchecked",
    "another major version is not taken over",
    (
        Fields,
        "text",
        lambda self, key, default=None, former=Fields.text: (
            "2.1.0" if key == "version" else former(self, key, default)
        ),
    ),
)


def _deaf_to_damage(topic, payload):
    try:
        return payload if isinstance(json.loads(payload), dict) else None
    except (ValueError, RecursionError):
        return None


MUTANTS["not_json_unsaid"] = Mutant(
    "not_json_unsaid", "what is no JSON is reported", deafen=_deaf_to_damage
)


def _nan_as_zero(topic, payload):
    return payload.replace(b"NaN", b"2.0")


MUTANTS["nan_taken"] = Mutant("nan_taken", "NaN is refused", deafen=_nan_as_zero)


def _texts_as_numbers(topic, payload):
    return payload.replace(b'"true"', b"true").replace(b'"two"', b"2")


MUTANTS["texts_taken"] = Mutant("texts_taken", "a text is no number", deafen=_texts_as_numbers)

# --- factsheet

patched(
    "factsheet_request_ignored",
    "factsheetRequest is answered",
    (Vehicle, "request_factsheet", lambda self: None),
)


@json_of("factsheet_without_actions", "agvActions has the vehicle's actions", Kind.FACTSHEET)
def _(value, memory):
    value["protocolFeatures"]["agvActions"] = []


@json_of("factsheet_without_body", "a factsheet has physicalParameters", Kind.FACTSHEET)
def _(value, memory):
    value.pop("physicalParameters")


@json_of("factsheet_measures", "measures are above 0", Kind.FACTSHEET)
def _(value, memory):
    value["physicalParameters"]["length"] = 0.0


@json_of("factsheet_limits", "lengths are not negative", Kind.FACTSHEET)
def _(value, memory):
    value["protocolLimits"]["maxArrayLens"]["order.nodes"] = -1


@json_of("factsheet_scopes", "actions have scopes", Kind.FACTSHEET)
def _(value, memory):
    for action in value["protocolFeatures"]["agvActions"]:
        action["actionScopes"] = []


# --- what a random mutation of the code showed to be untried


def _stitch_older(self, order, cells, former=OrderProgress.stitch):
    number = order.update
    new = former(self, replace(order, update=max(number, self.update)), cells)
    self.update = number
    return new


patched(
    "older_update_stitched",
    "a lower update is refused, also if it fits",
    (OrderProgress, "stitch", _stitch_older),
)


def _rounded(self, key, default=None, former=Fields.number):
    return int(former(self, key, default))


patched("fractions_taken", "a sequenceId is a whole number", (Fields, "natural", _rounded))


def _true_is_one(topic, payload):
    return payload.replace(b'"orderUpdateId":true', b'"orderUpdateId":0')


MUTANTS["true_taken"] = Mutant("true_taken", "true is no number", deafen=_true_is_one)


def _absolute(topic, payload):
    return payload.replace(b'"orderUpdateId":-1', b'"orderUpdateId":1')


MUTANTS["negative_taken"] = Mutant("negative_taken", "numbers are not negative", deafen=_absolute)
patched(
    "horizon_actions_wait",
    "actions of a deleted horizon go with it",
    (ActionQueue, "keep_only", NOTHING),
)
patched(
    "device_ignored",
    "a pick by an unknown device is refused",
    (
        action_checks,
        "CHECKS",
        {k: v for k, v in action_checks.CHECKS.items() if k != "lhd"},
    ),
)


def _no_start_heading(order, cells, robot, former=demands.check_demands):
    former(order, cells, replace(robot, yaw=None))


patched(
    "start_heading_ignored",
    "theta of the first node is taken or refused",
    (reception, "check_demands", _no_start_heading),
)
