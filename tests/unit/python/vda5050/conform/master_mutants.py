# SPDX-License-Identifier: Apache-2.0
"""Masters that break one rule of the specification each: messages damaged on their way to the
vehicles, or our master's code with one thing wrong."""

from __future__ import annotations

import contextlib
from dataclasses import dataclass, field, replace
from unittest import mock

from damage import Additions
from paper_master import runner_for

from warehouse_vda5050.conform.master.cases import cases_of
from warehouse_vda5050.conform.verdict import Verdict
from warehouse_vda5050.master import remote_vehicle
from warehouse_vda5050.master.instant import InstantRequests
from warehouse_vda5050.master.journey import Journey
from warehouse_vda5050.master.remote_vehicle import Phase, RemoteVehicle
from warehouse_vda5050.master.vehicle_view import TAKES_ORDERS, VehicleView
from warehouse_vda5050.model import Action, BlockingType, InstantActions, OperatingMode
from warehouse_vda5050.mqtt import master_link


@dataclass
class Mutant:
    """rule: what is broken. damage(message, memory) changes a message of the master, None: it is
    lost. patches: (object, name, replacement)."""

    name: str
    rule: str
    damage: object = None
    patches: list = field(default_factory=list)

    def runner(self, stack, version="2.1.0"):
        """Returns a runner with this master; `stack` undoes its patches."""
        for target, name, replacement in self.patches:
            stack.enter_context(mock.patch.object(target, name, replacement))
        memory = {}
        damage = self.damage or (lambda message, _memory: message)
        return runner_for(version, lambda message: damage(message, memory), strict=True)


MUTANTS: dict[str, Mutant] = {}
additions = Additions(MUTANTS, Mutant, "/order")
patched, message, json_of = additions.patched, additions.message, additions.json_of


def found_by(mutant, version="2.1.0", chapters=()):
    """Returns the first case that a mutant fails, with the reason; None if it fails none. What
    judges all messages of a run is tried after each accident, too: it costs nothing. chapters: the
    only ones whose accidents are tried."""
    with contextlib.ExitStack() as stack:
        runner = mutant.runner(stack, version)
        cases = cases_of(version, strict=True)
        cases = [c for c in cases if c.audit or not chapters or c.chapter in chapters]
        audits = [case for case in cases if case.audit and case.id != "messages.retained"]
        for case in [c for c in cases if not c.audit]:
            for tried in (case, *audits):
                result = runner.try_case(tried)
                if result.verdict is Verdict.DIFFERS:
                    return result.case.id, result.reason
        retained = next(c for c in cases if c.id == "messages.retained")
        result = runner.try_case(retained)
        return (retained.id, result.reason) if result.verdict is Verdict.DIFFERS else None


# --- how messages are sent


@message("qos_1", "order has QoS 0")
def _(sent, memory):
    return sent._replace(qos=1)


@message("retained", "orders are not retained", "/order")
def _(sent, memory):
    return sent._replace(retain=True)


@message("latin_1", "text is UTF-8", "/order")
def _(sent, memory):
    return sent._replace(payload=sent.payload.replace(b"paper", b"p\xe4per"))


@json_of("header_id_still", "headerId of orders counts up")
def _(value, memory):
    value["headerId"] = 7


@json_of("header_id_of_all", "headerId counts by one a topic", "")
def _(value, memory):
    memory["id"] = memory.get("id", 0) + 1
    value["headerId"] = memory["id"]


@json_of("instant_header_id", "headerId of instant actions counts up", "/instantActions")
def _(value, memory):
    value["headerId"] *= 2


@json_of("stamp_zone", "timestamp is in UTC")
def _(value, memory):
    value["timestamp"] = value["timestamp"].replace("Z", "+01:00")


@json_of("stamp_back", "timestamp never goes back")
def _(value, memory):
    memory["n"] = memory.get("n", 0) + 1
    if memory["n"] % 4 == 0:
        value["timestamp"] = "2001" + value["timestamp"][4:]


@json_of("stamp_stands", "timestamp advances")
def _(value, memory):
    value["timestamp"] = memory.setdefault("t", value["timestamp"])


@json_of("version_missing", "a header has a version")
def _(value, memory):
    value.pop("version")


@json_of("version_other", "version is the protocol's")
def _(value, memory):
    value["version"] = "2.0.0"


@json_of("serial_other", "serialNumber is the vehicle's", "/instantActions")
def _(value, memory):
    value["serialNumber"] = "other"


@json_of("number_as_text", "numbers are numbers")
def _(value, memory):
    value["orderUpdateId"] = str(value["orderUpdateId"])


@json_of("not_a_number", "NaN is no number")
def _(value, memory):
    value["nodes"][0]["nodePosition"]["theta"] = float("nan")


@json_of("edges_without_actions", "edges have actions")
def _(value, memory):
    for edge in value["edges"]:
        edge.pop("actions")


@json_of("released_missing", "nodes say whether they are released")
def _(value, memory):
    value["nodes"][-1].pop("released")


# --- orders


@json_of("edge_too_many", "one edge less than nodes")
def _(value, memory):
    if value["edges"]:
        last = value["edges"][-1]
        value["edges"].append({**last, "sequenceId": last["sequenceId"] + 2, "released": False})


@json_of("edge_ends", "edges join their nodes")
def _(value, memory):
    for edge in value["edges"]:
        edge["startNodeId"], edge["endNodeId"] = edge["endNodeId"], edge["startNodeId"]


@json_of("sequence_by_one", "sequenceId runs over nodes and edges")
def _(value, memory):
    for k, node in enumerate(value["nodes"]):
        node["sequenceId"] = k


@json_of("sequence_begins_at_two", "an order begins with sequenceId 0")
def _(value, memory):
    for part in (*value["nodes"], *value["edges"]):
        part["sequenceId"] += 2


@json_of("gap", "nothing released follows something unreleased")
def _(value, memory):
    if not value["nodes"][-1]["released"] and len(value["nodes"]) > 3:
        value["nodes"][-1]["released"] = value["edges"][-1]["released"] = True


@json_of("edge_released_alone", "an edge is released with its nodes")
def _(value, memory):
    for edge, node in zip(value["edges"], value["nodes"][1:]):
        edge["released"] = edge["released"] or not node["released"]


@json_of("first_not_released", "the first node is released")
def _(value, memory):
    value["nodes"][0]["released"] = False


@json_of("other_map", "mapId is the vehicle's")
def _(value, memory):
    for node in value["nodes"]:
        node["nodePosition"]["mapId"] = "elsewhere"


@json_of("degrees", "angles are radians")
def _(value, memory):
    value["nodes"][-1]["nodePosition"]["theta"] = 90.0


@json_of("wandering_node", "a nodeId is one place")
def _(value, memory):
    value["nodes"][-1]["nodePosition"]["x"] += 0.002 * (value["orderUpdateId"] % 7)


@json_of("trajectory", "optional fields are those of the factsheet")
def _(value, memory):
    for edge in value["edges"]:
        edge["trajectory"] = {"degree": 1, "knotVector": [0, 0, 1, 1], "controlPoints": []}


@json_of("speed_zero", "maxSpeed is above 0")
def _(value, memory):
    for edge in value["edges"]:
        edge["maxSpeed"] = 0.0


def _shifted_path(self, place, former=Journey.next_order):
    if self.update < 0 and len(self.points) > 2:
        del self.points[0]
        self.released = max(1, self.released - 1)
    return former(self, place)


patched(
    "begins_ahead",
    "the first node is where the vehicle stands",
    (Journey, "next_order", _shifted_path),
)


def _next_id_again(self):
    self._count += 1
    return f"{self._run}-{self.robot.number}-{self._count % 3}"


patched("ids_again", "an orderId is used once", (RemoteVehicle, "_next_id", _next_id_again))


# --- updates


def _counting(step):
    def next_order(self, place, former=Journey.next_order):
        before, awaited = self.update, self.sent
        order = former(self, place)
        if order is not None and order is not awaited and before >= 0:
            self.update = max(0, before + step)
            self.sent = order = replace(order, update=self.update)
        return order

    return next_order


patched("update_by_two", "orderUpdateId counts by one", (Journey, "next_order", _counting(2)))
patched("update_still", "an update has another number", (Journey, "next_order", _counting(0)))
patched("update_back", "orderUpdateId never goes back", (Journey, "next_order", _counting(-1)))


def _stitched(change):
    def next_order(self, place, former=Journey.next_order):
        had = self.had
        self.had = max(0, change(self)) if had else 0
        order = former(self, place)
        self.had = had
        return order

    return next_order


patched(
    "whole_base_again",
    "an update begins at the end of the base",
    (Journey, "next_order", _stitched(lambda journey: 1)),
)
patched(
    "stitched_before",
    "an update is stitched at the last node of the base",
    (Journey, "next_order", _stitched(lambda journey: journey.had - 1)),
)
patched(
    "gap_in_the_way",
    "an update leaves no gap",
    (Journey, "next_order", _stitched(lambda journey: min(journey.had + 1, len(journey.points)))),
)


@json_of("stitch_changed", "the stitching node is sent as it was")
def _(value, memory):
    if value["orderUpdateId"]:
        value["nodes"][0]["nodeDescription"] = f"update {value['orderUpdateId']}"


@json_of("base_renamed", "a base is never changed")
def _(value, memory):
    if value["orderUpdateId"]:
        value["nodes"][0]["nodeId"] = value["nodes"][-1]["nodeId"]


@json_of("base_taken_back", "what is released stays so")
def _(value, memory):
    if value["orderUpdateId"] % 2:
        for part in (*value["nodes"], *value["edges"]):
            part["released"] = False


def _goes_on_after_cancel(self, now, former=RemoteVehicle._due_order):
    if self._phase is Phase.CANCELLING and self._journey and not self._journey.awaits_answer:
        self._journey.is_changed = True
        return self._journey.next_order(self._place)
    return former(self, now)


patched(
    "updates_what_it_cancels",
    "a cancelled order is not updated",
    (RemoteVehicle, "_due_order", _goes_on_after_cancel),
)


# --- when orders are sent


def _modes(*modes):
    return property(lambda self: self.state is not None and self.state.mode in modes)


patched(
    "orders_in_manual",
    "no orders in MANUAL",
    (VehicleView, "takes_orders", _modes(*TAKES_ORDERS, OperatingMode.MANUAL)),
)
patched(
    "orders_in_service",
    "no orders in SERVICE",
    (VehicleView, "takes_orders", _modes(*TAKES_ORDERS, OperatingMode.SERVICE)),
)
patched(
    "orders_in_teach_in",
    "no orders in TEACHIN",
    (VehicleView, "takes_orders", _modes(*TAKES_ORDERS, OperatingMode.TEACHIN)),
)
patched("orders_when_lost", "no orders to a lost vehicle", (VehicleView, "is_localized", True))
patched(
    "orders_when_broken",
    "no orders to a vehicle with a FATAL error",
    (VehicleView, "fatal", property(lambda self: [])),
    (VehicleView, "fatal_types", property(lambda self: [])),
)
patched(
    "orders_when_offline",
    "no orders to a vehicle that is not connected",
    (VehicleView, "hears", True),
)


def _finishes_early(self, way, state, now, former=RemoteVehicle._advance):
    if self._phase is Phase.UNDER_WAY and way.is_whole and state.last_node_sequence and state.nodes:
        self._end(remote_vehicle.EventKind.DONE, "done")
        return
    former(self, way, state, now)


patched(
    "next_before_the_end",
    "one order at a time",
    (RemoteVehicle, "_advance", _finishes_early),
    (RemoteVehicle, "_end_foreign", lambda self, state: None),
)


def _lifts_unseen(self, way, state, former=RemoteVehicle._settle):
    if way.lift and way.is_whole and self._phase is Phase.UNDER_WAY:
        self._finish(way)
        return
    former(self, way, state)


patched(
    "actions_not_awaited",
    "an order is under way as long as an action of it runs",
    (RemoteVehicle, "_settle", _lifts_unseen),
)


def _believes_lifts(self, way, state, former=RemoteVehicle._settle):
    over = state.actions and all(act.status.is_over for act in state.actions)
    if way.lift and way.is_whole and over and self._phase is Phase.UNDER_WAY:
        load = way.lift.shelf_id if way.lift.up else 0
        self._finish(way)
        self.load = load
        self._take_load = lambda state: None
        return
    former(self, way, state)


patched(
    "failed_is_finished",
    "a pick that FAILED has lifted nothing",
    (RemoteVehicle, "_settle", _believes_lifts),
)


def _stale_states(self, state, now, former=VehicleView.take_state):
    self._stamp = ("", 0)
    return former(self, state, now)


patched(
    "old_states_count",
    "a state that is older is not acted upon",
    (VehicleView, "take_state", _stale_states),
)


def _refused_as_it_was(self, way, state, now):
    for error in state.errors:
        if way.awaits_answer and dict(error.references).get("orderId") == way.order_id:
            self._sent_at = min(self._sent_at, now - 1.6)  # sent again soon
            self._times = 0
            return


patched(
    "refused_sent_again",
    "what was refused is not sent again as it was",
    (RemoteVehicle, "_note_refusal", _refused_as_it_was),
)
patched(
    "no_back_off",
    "a vehicle that refuses is not hammered",
    (remote_vehicle, "BACK_OFF", (0.0, 0.0)),
)
patched(
    "steady_hammering",
    "the times between orders that are refused grow",
    (remote_vehicle, "BACK_OFF", (0.6, 0.6)),
)


def _deaf_to_requests(self, place, former=Journey.next_order):
    if self.had and self.had < len(self.points):
        return None
    return former(self, place)


patched(
    "base_not_extended",
    "a newBaseRequest is answered",
    (Journey, "next_order", _deaf_to_requests),
)


# --- the factsheet

patched(
    "factsheet_not_read",
    "the factsheet's limits hold",
    (RemoteVehicle, "take_factsheet", lambda self, sheet: None),
)


def _ignores(name, value):
    def take_factsheet(self, sheet, former=RemoteVehicle.take_factsheet):
        former(self, replace(sheet, **{name: value}))

    return take_factsheet


patched(
    "interval_ignored",
    "minOrderInterval is kept",
    (RemoteVehicle, "take_factsheet", _ignores("order_interval", 0.0)),
)
patched(
    "nodes_ignored",
    "an order has no more nodes than the factsheet allows",
    (RemoteVehicle, "take_factsheet", _ignores("max_nodes", 1000)),
)
patched(
    "actions_ignored",
    "actions are those of the factsheet",
    (RemoteVehicle, "take_factsheet", _ignores("actions", ())),
)


# --- actions


@json_of("parameter_unknown", "parameters are those of the factsheet")
def _(value, memory):
    for node in value["nodes"]:
        for action in node["actions"]:
            action["actionParameters"].append({"key": "colour", "value": "green"})


@json_of("parameter_twice", "a parameter stands once")
def _(value, memory):
    for node in value["nodes"]:
        for action in node["actions"]:
            action["actionParameters"] *= 2


@json_of("action_unknown", "actions are those of the factsheet, at nodes")
def _(value, memory):
    for node in value["nodes"]:
        for action in node["actions"]:
            action["actionType"] = "lift"


@json_of("blocking_word", "blockingType is one of three")
def _(value, memory):
    for node in value["nodes"]:
        for action in node["actions"]:
            action["blockingType"] = "FULL"


@json_of("action_ids_again", "actionId is that of one action")
def _(value, memory):
    for node in value["nodes"]:
        for action in node["actions"]:
            action["actionId"] = "action"


@json_of("action_at_edge", "edges have only actions that the factsheet has for them")
def _(value, memory):
    for edge in value["edges"]:
        edge["actions"] = [
            {"actionType": "pick", "actionId": edge["edgeId"], "blockingType": "NONE"}
        ]


@json_of("pick_for_drop", "a pick is for an empty vehicle")
def _(value, memory):
    for node in value["nodes"]:
        for action in node["actions"]:
            action["actionType"] = "pick"


# --- instant actions

patched(
    "repeats_for_ever",
    "an instant action is not sent again once it is reported",
    (InstantRequests, "take", lambda self, state: None),
)


def _renewed(self, now, former=InstantRequests.due):
    message = former(self, now)
    if message is None:
        return None
    self._count += 1
    new = tuple(replace(a, id=f"{a.id}-{self._count}") for a in message.actions)
    return InstantActions(new)


patched(
    "unanswered_renewed",
    "an action that is sent again keeps its actionId",
    (InstantRequests, "due", _renewed),
)


def _chatty(self, now, former=InstantRequests.due):
    self.ask("stateRequest")
    return former(self, now)


patched(
    "state_requests_all_the_time",
    "instant actions come no more often than they can be answered",
    (InstantRequests, "due", _chatty),
)


def _cancels_first(self, way, text, former=RemoteVehicle._begin):
    former(self, way, text)
    self._instants.ask("cancelOrder")


patched(
    "cancels_nothing",
    "cancelOrder is for an order that is under way",
    (RemoteVehicle, "_begin", _cancels_first),
)


def _another_type(self, now, former=InstantRequests.due):
    message = former(self, now)
    if message is None:
        return None
    kind = {True: "stateRequest", False: "factsheetRequest"}
    self._count += 1
    extra = Action(kind[self._count % 2 == 0], "question", BlockingType.NONE)
    return InstantActions((*message.actions, extra))


patched(
    "one_id_for_two_actions",
    "an actionId is that of one action, of instant actions too",
    (InstantRequests, "due", _another_type),
)


def _pauses_for_good(self, command, former=RemoteVehicle._obey):
    if isinstance(command, remote_vehicle.Stop) and not command.stop:
        return
    former(self, command)


patched(
    "never_resumes",
    "what the master has paused it lets go on",
    (RemoteVehicle, "_obey", _pauses_for_good),
)


def _cancels_at_warnings(self, former=RemoteVehicle._take_errors):
    former(self)
    if self.view.state.errors and self._phase is Phase.UNDER_WAY:
        self._cancel()


patched(
    "cancels_for_warnings",
    "a WARNING resolves itself",
    (RemoteVehicle, "_take_errors", _cancels_at_warnings),
)


def _asks_offline(self, now):
    self._insist()
    order, instants = self._due_order(now) if self.view.hears else None, self._instants.due(now)
    if instants is None and not self.view.hears:
        self._instants.ask("stateRequest")
    return [message for message in (instants, order) if message is not None]


patched(
    "instant_actions_offline",
    "no instant actions to a vehicle that is not connected",
    (RemoteVehicle, "messages", _asks_offline),
)
patched(
    "connection_qos",
    "the master hears connections",
    (master_link, "HEARD", tuple(kind for kind in master_link.HEARD if kind != "connection")),
)
