# SPDX-License-Identifier: Apache-2.0
"""What the factsheet allows (6.15): lengths, intervals, optional fields, and that it may change."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.log import Entry
from warehouse_vda5050.conform.master.cases.actions import instant_actions
from warehouse_vda5050.conform.master.facts import held_for, value_of
from warehouse_vda5050.conform.master.orders import Ordered, orders_of
from warehouse_vda5050.conform.master.stage import Stage
from warehouse_vda5050.conform.verdict import Untestable, demand
from warehouse_vda5050.field_rules import EDGE, POSITION, Use
from warehouse_vda5050.topics import Kind

chapter = Chapter("limits")
case = chapter.case
Json = dict[str, Any]
FEWER_NODES = 4
INTERVAL = 2.5  # between two orders [s]
JITTER = 0.2  # by which messages come sooner one after another than they were sent [s]
IDS = ("orderId", "zoneSetId", "nodeId", "edgeId", "startNodeId", "endNodeId", "mapId", "actionId")
ENUMS = ("actionType", "blockingType", "direction", "key")
# Optional fields that every vehicle knows: they are in the specification's own examples.
USUAL = ("theta",)


def _limit(stage: Stage, entry: Entry, part: str, name: str) -> int:
    """Returns a limit of the factsheet; 0: it has none, or the master can't know it yet."""
    sheet = value_of(entry.scene, "sheet") or {}
    if held_for(entry.scene, "sheet", entry.time) < stage.settings.reaction:
        return 0
    values = (sheet.get("protocolLimits") or {}).get(part) or {}
    value = values.get(name)
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return int(value or 0) if is_number else 0


def _demand_count(stage: Stage, name: str, count_of: Any) -> None:
    for order in orders_of(stage):
        most = _limit(stage, order.entry, "maxArrayLens", name)
        count = count_of(order)
        demand(not most or count <= most, f"{order.name} has {count} of {name}; {most} at most")


@case("nodes", "6.15.1", audit=True)
def nodes(stage: Stage) -> None:
    """An order has no more nodes than the factsheet allows."""
    _demand_count(stage, "order.nodes", lambda order: len(order.nodes))


@case("edges", "6.15.1", audit=True)
def edges(stage: Stage) -> None:
    """An order has no more edges than the factsheet allows."""
    _demand_count(stage, "order.edges", lambda order: len(order.edges))


def _most_actions(parts: list[Json]) -> int:
    return max((len(view.rows(part, "actions")) for part in parts), default=0)


@case("node_actions", "6.15.1", audit=True)
def node_actions(stage: Stage) -> None:
    """A node has no more actions than the factsheet allows."""
    _demand_count(stage, "node.actions", lambda order: _most_actions(order.nodes))


@case("edge_actions", "6.15.1", audit=True)
def edge_actions(stage: Stage) -> None:
    """An edge has no more actions than the factsheet allows."""
    _demand_count(stage, "edge.actions", lambda order: _most_actions(order.edges))


@case("instant_actions", "6.15.1", audit=True)
def instants(stage: Stage) -> None:
    """A message has no more instant actions than the factsheet allows."""
    entries = stage.received(Kind.INSTANT_ACTIONS)
    if not entries:
        raise Untestable("the master sent no instant actions")
    for entry in entries:
        most = _limit(stage, entry, "maxArrayLens", "instantActions")
        count = len(instant_actions(entry))
        demand(not most or count <= most, f"{entry.topic} has {count}; {most} at most")


def _strings(value: Any, names: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    """Yields the fields of these names, wherever they stand."""
    if isinstance(value, list):
        for item in value:
            yield from _strings(item, names)
    elif isinstance(value, dict):
        for name, item in value.items():
            if name in names and isinstance(item, str):
                yield name, item
            yield from _strings(item, names)


def _all(stage: Stage) -> list[Entry]:
    entries = [e for kind in stage.to_vehicle for e in stage.received(kind)]
    if not entries:
        raise Untestable("the master sent nothing")
    return entries


def _demand_lengths(stage: Stage, limit: str, names: tuple[str, ...]) -> None:
    for entry in _all(stage):
        most = _limit(stage, entry, "maxStringLens", limit)
        for name, text in _strings(entry.value, names) if most else ():
            demand(len(text) <= most, f"{name} {text[:60]!r} is longer than {most}, its {limit}")


@case("id_length", "6.15.1", audit=True)
def id_length(stage: Stage) -> None:
    """Ids are no longer than the factsheet allows."""
    _demand_lengths(stage, "idLen", IDS)


@case("enum_length", "6.15.1", audit=True)
def enum_length(stage: Stage) -> None:
    """Words and keys are no longer than the factsheet allows."""
    _demand_lengths(stage, "enumLen", ENUMS)


@case("numeric_ids", "6.15.1", audit=True)
def numeric_ids(stage: Stage) -> None:
    """Ids are numbers if the factsheet wants that."""
    for entry in _all(stage):
        limits = (value_of(entry.scene, "sheet") or {}).get("protocolLimits") or {}
        if (limits.get("maxStringLens") or {}).get("idNumericalOnly") is True:
            for name, text in _strings(entry.value, IDS):
                demand(text.isdecimal(), f"{name} is {text[:60]!r}; a number was expected")


@case("id_characters", "6.1.2", audit=True, strict=True)
def id_characters(stage: Stage) -> None:
    """Ids have letters, digits and _-.: alone."""
    for entry in _all(stage):
        for name, text in _strings(entry.value, IDS):
            plain = text.replace("_", "").replace("-", "").replace(".", "").replace(":", "")
            fits = plain.isascii() and (plain.isalnum() or not plain)
            demand(fits, f"{name} is {text[:60]!r}")


@case("message_length", "6.15.1", audit=True)
def message_length(stage: Stage) -> None:
    """A message is no longer than the factsheet allows."""
    for entry in _all(stage):
        most = _limit(stage, entry, "maxStringLens", "msgLen")
        size = len(entry.payload)
        demand(not most or size <= most, f"{entry.topic} has {size} bytes; {most} at most")


@case("interval", "6.15.1", audit=True)
def interval(stage: Stage) -> None:
    """Between two orders passes the time that the factsheet calls for."""
    last: dict[str, Entry] = {}
    for order in orders_of(stage):
        entry = order.entry
        sheet = value_of(entry.scene, "sheet") or {}
        timing = (sheet.get("protocolLimits") or {}).get("timing") or {}
        least = timing.get("minOrderInterval") or 0.0
        before = last.get(entry.vehicle)
        passed = _passed(before, entry) if before else math.inf
        last[entry.vehicle] = entry
        is_known = held_for(entry.scene, "sheet", entry.time) >= stage.settings.reaction
        text = f"{order.name} came {passed:.2f} s after the one before; {least:g} at least"
        demand(not is_known or passed >= least - JITTER, text)


def _passed(before: Entry, after: Entry) -> float:
    """Returns the time between two messages, by their arrival or by their headers [s]: a network
    may hold the former back."""
    try:
        sent = (after.stamp - before.stamp).total_seconds()
    except (ValueError, TypeError):
        sent = 0.0
    return max(after.time - before.time, sent)


@case("optional", "6.1.1", audit=True)
def optional(stage: Stage) -> None:
    """Optional fields are sent only if the factsheet has them."""
    for order in orders_of(stage):
        supported = _parameters(order)
        for name in _optional_fields(order):
            demand(name in supported, f"{order.name} has {name}, which the factsheet lacks")


@case("optional_required", "6.15.1", audit=True)
def optional_required(stage: Stage) -> None:
    """Optional fields that the factsheet calls REQUIRED are there."""
    for order in orders_of(stage):
        needed = {name for name, support in _parameters(order).items() if support == "REQUIRED"}
        for name in needed:
            key = name.rpartition(".")[2]
            parts = order.edges if ".edges." in name else order.nodes
            places = [p.get("nodePosition") or {} if "nodePosition." in name else p for p in parts]
            demand(all(key in place for place in places), f"{order.name} lacks {name}")


def _parameters(order: Ordered) -> dict[str, str]:
    sheet = value_of(order.scene, "sheet") or {}
    known = view.rows(sheet.get("protocolFeatures"), "optionalParameters")
    return {str(row.get("parameter")): str(row.get("support")) for row in known}


def _optional_fields(order: Ordered) -> Iterator[str]:
    """Yields the full names of optional fields that demand something of the vehicle."""
    shown = {rule.name for rule in (*POSITION, *EDGE) if rule.use is Use.SHOWN}
    if order.value.get("zoneSetId"):
        yield "order.zoneSetId"
    for where, rules, parts in (
        ("order.nodes.nodePosition", POSITION, [n.get("nodePosition") or {} for n in order.nodes]),
        ("order.edges", EDGE, order.edges),
    ):
        names = {rule.name for rule in rules if rule.is_optional} - shown - {*USUAL}
        for part in parts:
            yield from (f"{where}.{name}" for name in names if name in part)


@case("speed", "6.15.1", audit=True)
def speed(stage: Stage) -> None:
    """maxSpeed of an edge is a speed that the vehicle can drive: above 0, and above its least."""
    for order in orders_of(stage):
        body = (value_of(order.scene, "sheet") or {}).get("physicalParameters") or {}
        for edge in order.edges:
            top = edge.get("maxSpeed")
            fits = top is None or (top > 0 and top >= body.get("speedMin", 0.0))
            demand(fits, f"{order.name}: maxSpeed is {top} on {edge['edgeId']}")


# --- a factsheet that changes


@case("changed_nodes", "6.15")
def changed_nodes(stage: Stage) -> None:
    """When a vehicle says in a new factsheet that it takes fewer nodes, orders have fewer."""

    def edit(sheet: Json) -> None:
        lengths = sheet["protocolLimits"]["maxArrayLens"]
        lengths["order.nodes"], lengths["order.edges"] = FEWER_NODES, FEWER_NODES - 1

    for entry in _after_change(stage, edit):
        count = len(view.rows(entry.value, "nodes"))
        demand(count <= FEWER_NODES, f"{entry.topic} has {count} nodes; {FEWER_NODES} at most")


@case("changed_interval", "6.15")
def changed_interval(stage: Stage) -> None:
    """When a vehicle says in a new factsheet that it takes orders less often, they come so."""

    def edit(sheet: Json) -> None:
        sheet["protocolLimits"]["timing"]["minOrderInterval"] = INTERVAL

    entries = _after_change(stage, edit)
    for before, after in zip(entries, entries[1:]):
        passed = _passed(before, after)
        text = f"{after.topic} came {passed:.2f} s after the one before; {INTERVAL:g} at least"
        demand(after.vehicle != before.vehicle or passed >= INTERVAL - JITTER, text)


@case("changed_actions", "6.15")
def changed_actions(stage: Stage) -> None:
    """When a vehicle says in a new factsheet that it can no longer lift, it is sent no lifts."""

    def edit(sheet: Json) -> None:
        features = sheet["protocolFeatures"]
        rows = features["agvActions"]
        features["agvActions"] = [r for r in rows if r["actionType"] not in ("pick", "drop")]

    for entry in _after_change(stage, edit):
        for node in view.rows(entry.value, "nodes"):
            for action in view.rows(node, "actions"):
                kind = action.get("actionType")
                demand(kind not in ("pick", "drop"), f"{entry.topic} has a {kind}")


def _after_change(stage: Stage, edit: Any) -> list[Entry]:
    """Returns new orders after another factsheet. Raises Untestable without any."""
    for actor in stage.actors:
        actor.change_sheet(edit)
    stage.wait(stage.settings.reaction)
    mark = stage.mark
    stage.an_order(mark)
    stage.wait(2 * stage.settings.watch)
    return stage.received(Kind.ORDER, mark)
