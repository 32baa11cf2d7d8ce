# SPDX-License-Identifier: Apache-2.0
"""Actions of orders (6.6.6, 6.8, 6.12, 6.15): known, complete, at the right place and time."""

from collections.abc import Iterator
from typing import Any, NamedTuple

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.log import Entry
from warehouse_vda5050.conform.master.actor import Actor
from warehouse_vda5050.conform.master.facts import held_for, value_of
from warehouse_vda5050.conform.master.orders import orders_of
from warehouse_vda5050.conform.master.stage import Stage
from warehouse_vda5050.conform.verdict import Untestable, demand
from warehouse_vda5050.model import ActionState, ActionStatus
from warehouse_vda5050.topics import Kind

chapter = Chapter("actions")
case = chapter.case
Json = dict[str, Any]
NUMERIC = ("NUMBER", "FLOAT", "INTEGER")


class Sent(NamedTuple):
    """An action as it was sent. where: NODE, EDGE or INSTANT."""

    entry: Entry
    where: str
    action: Json

    @property
    def name(self) -> str:
        """The vehicle and the action, for people."""
        return (
            f"{self.entry.vehicle}: {self.action.get('actionType')} {self.action.get('actionId')}"
        )


def instant_actions(entry: Entry) -> list[Json]:
    """Returns the actions of a message of instant actions, by either name."""
    return view.rows(entry.value, "actions") or view.rows(entry.value, "instantActions")


def _all(stage: Stage) -> Iterator[Sent]:
    for entry in stage.log.entries:
        if entry.sent or entry.missed:
            continue
        if entry.kind is Kind.INSTANT_ACTIONS:
            yield from (Sent(entry, "INSTANT", action) for action in instant_actions(entry))
        elif entry.kind is Kind.ORDER:
            for where, key in (("NODE", "nodes"), ("EDGE", "edges")):
                for part in view.rows(entry.value, key):
                    yield from (Sent(entry, where, a) for a in view.rows(part, "actions"))


def _sent(stage: Stage) -> list[Sent]:
    """Returns all actions. Raises Untestable without any."""
    actions = [*_all(stage)]
    if not actions:
        raise Untestable("the master sent no action")
    return actions


def _sheet_row(sent: Sent) -> Json | None:
    sheet = value_of(sent.entry.scene, "sheet") or {}
    known = view.rows(sheet.get("protocolFeatures"), "agvActions")
    return next((r for r in known if r.get("actionType") == sent.action.get("actionType")), None)


def _knows_sheet(stage: Stage, sent: Sent) -> bool:
    """Returns whether the master had time to read the factsheet."""
    return held_for(sent.entry.scene, "sheet", sent.entry.time) >= stage.settings.reaction


@case("ids", "6.6.6", audit=True)
def ids(stage: Stage) -> None:
    """actionId is that of one action alone."""
    known: dict[tuple[str, str], tuple[str, Any]] = {}
    for sent in _sent(stage):
        kind, id = sent.action.get("actionType"), str(sent.action.get("actionId"))
        what = sent.where, kind
        before = known.setdefault((sent.entry.vehicle, id), what)
        demand(before == what, f"{sent.name} was {before[1]} before")


@case("ids_of_orders", "6.6.6", audit=True)
def ids_of_orders(stage: Stage) -> None:
    """The actions of two orders have no actionId in common."""
    known: dict[tuple[str, str], str] = {}
    for order in orders_of(stage):
        for part in (*order.nodes, *order.edges):
            for action in view.rows(part, "actions"):
                key = order.entry.vehicle, str(action["actionId"])
                before = known.setdefault(key, order.id)
                demand(before == order.id, f"{order.name}: {key[1]} is of order {before}")


@case("known", "6.15", audit=True)
def known(stage: Stage) -> None:
    """Actions are those of the factsheet, where it has them: at nodes, edges, or at once."""
    for sent in _sent(stage):
        if _knows_sheet(stage, sent):
            row = _sheet_row(sent)
            demand(row is not None, f"{sent.name}: the factsheet has no such action")
            scopes = (row or {}).get("actionScopes") or ()
            demand(sent.where in scopes, f"{sent.name}: the factsheet has it for {scopes}")


@case("blocking", "6.12", audit=True)
def blocking(stage: Stage) -> None:
    """blockingType is one that the factsheet has for the action."""
    for sent in _sent(stage):
        row = _sheet_row(sent) or {}
        types = row.get("blockingTypes") or row.get("blockingType")
        type = sent.action.get("blockingType")
        fits = not isinstance(types, list) or type in types
        demand(fits, f"{sent.name}: blockingType is {type}; the factsheet has {types}")


@case("parameters", "6.15", audit=True)
def parameters(stage: Stage) -> None:
    """Parameters of actions are those of the factsheet."""
    for sent in _sent(stage):
        row = _sheet_row(sent)
        if row is None:
            continue
        names = [p.get("key") for p in view.rows(row, "actionParameters")]
        for parameter in view.rows(sent.action, "actionParameters"):
            key = parameter.get("key")
            demand(key in names, f"{sent.name}: the factsheet has no parameter {key}")


@case("required", "6.15", audit=True)
def required(stage: Stage) -> None:
    """Parameters that the factsheet does not call optional are there."""
    for sent in _sent(stage):
        names = [p.get("key") for p in view.rows(sent.action, "actionParameters")]
        for parameter in view.rows(_sheet_row(sent), "actionParameters"):
            there = parameter.get("isOptional") or parameter.get("key") in names
            demand(there, f"{sent.name}: parameter {parameter.get('key')} is missing")


@case("parameters_once", "6.6.6", audit=True)
def parameters_once(stage: Stage) -> None:
    """A parameter stands once in an action."""
    for sent in _sent(stage):
        names = [p.get("key") for p in view.rows(sent.action, "actionParameters")]
        demand(len(set(names)) == len(names), f"{sent.name} has the parameters {names}")


@case("types", "6.15", audit=True)
def types(stage: Stage) -> None:
    """Numbers are sent where the factsheet says numbers."""
    for sent in _sent(stage):
        rows = view.rows(_sheet_row(sent), "actionParameters")
        numeric = [row.get("key") for row in rows if row.get("valueDataType") in NUMERIC]
        for parameter in view.rows(sent.action, "actionParameters"):
            value = parameter.get("value")
            fits = parameter.get("key") not in numeric or _is_number(value)
            demand(fits, f"{sent.name}: {parameter.get('key')} is {value!r:.60}")


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


@case("pick_empty", "6.8.1", audit=True)
def pick_empty(stage: Stage) -> None:
    """A pick is for a vehicle that carries nothing, of those that carry one load."""
    _demand_loads(stage, "pick", loaded=False)


@case("drop_loaded", "6.8.1", audit=True)
def drop_loaded(stage: Stage) -> None:
    """A drop is for a vehicle that carries a load."""
    _demand_loads(stage, "drop", loaded=True)


def _demand_loads(stage: Stage, type: str, loaded: bool) -> None:
    """Demands that the first lift of an order fits what the vehicle carries."""
    tried = 0
    for order in orders_of(stage):
        lifts = [
            action["actionType"]
            for node in order.nodes
            for action in view.rows(node, "actions")
            if action["actionType"] in ("pick", "drop")
        ]
        if lifts and lifts[0] == type and order.is_new and not order.entry.missed:
            tried += 1
            carries = bool(value_of(order.scene, "loaded"))
            text = f"{order.name}: {type}, and it carries {'a load' if carries else 'nothing'}"
            demand(carries == loaded, text)
    if not tried:
        raise Untestable(f"the master sent no {type}")


@case("failed_pick", "6.11")
def failed_pick(stage: Stage) -> None:
    """After a pick that FAILED the master does not take the load as carried."""
    for actor in stage.actors:
        actor.robot.lift_fault = "the lift is refused, to see what the master makes of it"
    actor = stage.until(lambda: _failed(stage, "pick"), stage.settings.patience)
    if not isinstance(actor, Actor):
        raise Untestable(f"the master sent no pick within {stage.settings.patience:.0f} s")
    stage.wait(stage.settings.reaction)
    mark = stage.mark
    stage.wait(stage.settings.watch)
    after = [
        a["actionType"]
        for entry in stage.received(Kind.ORDER, mark, actor)
        for node in view.rows(entry.value, "nodes")
        for a in view.rows(node, "actions")
    ]
    demand(after[:1] != ["drop"], "the next action is a drop of what it does not carry")


def _failed(stage: Stage, type: str) -> Actor | None:
    """Returns a vehicle that reports an action of a type as FAILED."""
    for actor in stage.actors:
        actions = actor.vehicle.state().actions
        if any(a.type == type and a.status is ActionStatus.FAILED for a in actions):
            return actor
    return None


@case("slow", "6.6.2")
def slow(stage: Stage) -> None:
    """An order is under way as long as an action of it runs, and no other is sent."""
    for actor in stage.actors:
        actor.robot.lift_time = 3 * stage.settings.watch

    def lifting() -> Any:
        rows = ((actor, actor.vehicle.state()) for actor in stage.actors)
        return next((a for a, s in rows if any(_runs(x) for x in s.actions)), None)

    actor = stage.until(lifting, stage.settings.patience)
    if not actor:
        raise Untestable(f"the master sent no action within {stage.settings.patience:.0f} s")
    mark = stage.mark
    stage.wait(stage.settings.watch)
    others = [e for e in stage.received(Kind.ORDER, mark, actor) if _comes_too_soon(e)]
    demand(not others, f"order {others and _id(others[0])} came while an action was RUNNING")


def _comes_too_soon(entry: Entry) -> bool:
    return bool(value_of(entry.scene, "busy")) and _id(entry) != value_of(entry.scene, "order")


def _runs(action: ActionState) -> bool:
    return action.status is ActionStatus.RUNNING and not action.instant


def _id(entry: Entry) -> Any:
    return (entry.value or {}).get("orderId")
