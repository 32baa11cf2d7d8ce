# SPDX-License-Identifier: Apache-2.0
"""Vehicles that are not there (6.2, 6.14)."""

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.log import Entry
from warehouse_vda5050.conform.master.actor import Actor
from warehouse_vda5050.conform.master.facts import value_of
from warehouse_vda5050.conform.master.stage import Stage
from warehouse_vda5050.conform.verdict import demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("connection")
case = chapter.case


@case("offline", "6.14")
def offline(stage: Stage) -> None:
    """A vehicle that has said OFFLINE is sent no order."""
    actor = stage.idle()
    actor.leave()
    stage.no_orders(actor, "came after OFFLINE")
    stage.goes_on(actor)


@case("broken", "6.14")
def broken(stage: Stage) -> None:
    """Once the broker has published CONNECTIONBROKEN for a vehicle, it is sent no new order."""
    actor = stage.idle()
    actor.cut()
    stage.no_orders(actor, "came after CONNECTIONBROKEN")
    stage.goes_on(actor)


@case("broken_under_way", "6.2")
def broken_under_way(stage: Stage) -> None:
    """A vehicle that loses its connection under way keeps its order, and is not sent another when
    it comes back before the end."""
    actor = stage.under_way(2)
    order = actor.vehicle.state().order_id
    actor.cut()
    stage.wait(1.0)
    actor.restore()
    stage.until(lambda: actor.link.link.connected, stage.settings.patience)
    mark = stage.mark
    stage.until(lambda: not actor.is_busy, stage.settings.watch)
    others = [e for e in stage.received(Kind.ORDER, mark, actor) if _comes_too_soon(e)]
    demand(not others, f"another order came while {order} was under way")


def _comes_too_soon(entry: Entry) -> bool:
    had = value_of(entry.scene, "order")
    return bool(value_of(entry.scene, "busy")) and (entry.value or {}).get("orderId") != had


@case("restarted", "6.14")
def restarted(stage: Stage) -> None:
    """A vehicle whose program began again, without an order, is sent a new order, no update."""
    actor = stage.idle()
    former = actor.vehicle.state().order_id
    actor.restart()
    began = stage.now()
    entry = stage.an_order(stage.mark, actor)
    value = entry.value or {}
    goes_on = value.get("orderId") == former
    is_late = entry.time > began + stage.settings.reaction
    demand(not (goes_on and is_late), f"order {former} goes on, and the vehicle forgot it")
    first = view.rows(value, "nodes")[0].get("sequenceId")
    demand(goes_on or first == 0, f"it begins with sequenceId {first}")


@case("actions_offline", "6.14")
def actions_offline(stage: Stage) -> None:
    """A vehicle that has said OFFLINE is sent no instant actions."""
    actor = stage.idle()
    actor.leave()
    stage.wait(stage.settings.reaction)
    mark = stage.mark
    stage.wait(stage.settings.watch)
    _demand_none(stage, mark, actor)
    stage.goes_on(actor)


def _demand_none(stage: Stage, mark: int, actor: Actor) -> None:
    sent = stage.received(Kind.INSTANT_ACTIONS, mark, actor)
    demand(not sent, f"{len(sent)} messages of instant actions came after OFFLINE")
