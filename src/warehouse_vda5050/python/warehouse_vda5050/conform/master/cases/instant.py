# SPDX-License-Identifier: Apache-2.0
"""Instant actions (6.9), cancelOrder among them (6.6.3)."""

from collections.abc import Iterator
from typing import Any

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.log import Entry
from warehouse_vda5050.conform.master.cases.actions import instant_actions
from warehouse_vda5050.conform.master.facts import held_for, value_of
from warehouse_vda5050.conform.master.orders import orders_of
from warehouse_vda5050.conform.master.row import Row
from warehouse_vda5050.conform.master.stage import Stage
from warehouse_vda5050.conform.verdict import Untestable, demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("instant")
case = chapter.case
Json = dict[str, Any]
MOST, WINDOW = 20, 10.0  # instant actions to one vehicle, and in which time [s]


class Asked(Row):
    """An instant action as it was sent."""

    id_field = "actionId"

    @property
    def name(self) -> str:
        """The vehicle and the action, for people."""
        return f"{self.entry.vehicle}: {self.row.get('actionType')} {self.key[1]}"


def _asked(stage: Stage, *types: str) -> list[Asked]:
    """Returns instant actions, of some types. Raises Untestable without any."""
    rows = [*_all(stage)]
    rows = [row for row in rows if not types or row.row.get("actionType") in types]
    if not rows:
        raise Untestable(f"the master sent no {' or '.join(types) or 'instant actions'}")
    return rows


def _all(stage: Stage) -> Iterator[Asked]:
    for entry in stage.received(Kind.INSTANT_ACTIONS):
        yield from (Asked(entry, action) for action in instant_actions(entry))


@case("copies", "6.9", audit=True)
def copies(stage: Stage) -> None:
    """An instant action that is sent again is the same action."""
    known: dict[tuple[str, str], Json] = {}
    for asked in _asked(stage):
        before = known.setdefault(asked.key, asked.row)
        demand(before == asked.row, f"{asked.name} was another before")


@case("repeats", "6.9", audit=True)
def repeats(stage: Stage) -> None:
    """An instant action is sent again only as long as the vehicle does not report it."""
    reported = _reported(stage)
    for asked in _asked(stage):
        since = reported.get(asked.key)
        again = since is not None and asked.entry.time > since + stage.settings.reaction
        demand(not again, f"{asked.name} was reported at {since or 0:.1f} s, and is sent again")


def _reported(stage: Stage) -> dict[tuple[str, str], float]:
    """Returns when actions were first reported by their vehicles."""
    times: dict[tuple[str, str], float] = {}
    for entry in stage.log.entries:
        if entry.sent and entry.kind is Kind.STATE:
            for row in view.rows(entry.value, "actionStates"):
                times.setdefault((entry.vehicle, str(row.get("actionId"))), entry.time)
    return times


@case("few", "6.9", audit=True)
def few(stage: Stage) -> None:
    """Instant actions come no more often than a vehicle can answer them."""
    times: dict[str, list[float]] = {}
    for asked in _asked(stage):
        recent = times.setdefault(asked.entry.vehicle, [])
        recent.append(asked.entry.time)
        lately = [t for t in recent if t > recent[-1] - WINDOW]
        demand(len(lately) <= MOST, f"{len(lately)} came within {WINDOW:.0f} s")


@case("unanswered", "6.9")
def unanswered(stage: Stage) -> None:
    """An instant action that a vehicle does not report is no reason to send ever new ones."""
    actor = stage.idle()
    actor.leave()
    stage.wait(1.0)
    actor.vehicle.deaf = True
    mark = stage.mark
    actor.enter()
    stage.wait(stage.settings.watch)
    rows = [r for r in _all(stage) if r.entry in stage.received(Kind.INSTANT_ACTIONS, mark, actor)]
    if not rows:
        raise Untestable("the master sent no instant actions to a vehicle that came back")
    kinds = [row.row.get("actionType") for row in {row.key: row for row in rows}.values()]
    most = max(kinds.count(kind) for kind in kinds)
    demand(most <= 3, f"{most} of one type within {stage.settings.watch:.0f} s, with new actionIds")


@case("cancel_with_order", "6.6.3.2", audit=True)
def cancel_with_order(stage: Stage) -> None:
    """cancelOrder is sent to a vehicle that has an order under way, not to others."""
    for asked in _asked(stage, "cancelOrder"):
        scene, now = asked.entry.scene, asked.entry.time
        lately = held_for(scene, "busy", now) < stage.settings.reaction
        running = value_of(scene, "busy") or value_of(scene, "cancel") == "RUNNING"
        demand(
            running or lately or asked.entry.missed, f"{asked.name}: there is no order to cancel"
        )


@case("cancel_then_new", "6.6.3.1", audit=True)
def cancel_then_new(stage: Stage) -> None:
    """After a cancelOrder the next order is another, and comes when the former has ended."""
    _asked(stage, "cancelOrder")
    for order in orders_of(stage):
        running = value_of(order.scene, "cancel") == "RUNNING"
        demand(not running, f"{order.name} came while a cancelOrder was RUNNING")


@case("pause_ends", "6.8.1", audit=True)
def pause_ends(stage: Stage) -> None:
    """A vehicle that the master has paused is let go on by it."""
    last: dict[str, Asked] = {}
    for asked in _asked(stage, "startPause", "stopPause"):
        last[asked.entry.vehicle] = asked
    end = stage.now()
    for asked in last.values():
        held = asked.row.get("actionType") == "startPause" and asked.entry.time < end - 60.0
        demand(not held, f"{asked.name} was the last of them")


@case("paused_elsewhere", "6.9")
def paused_elsewhere(stage: Stage) -> None:
    """A vehicle that is paused at the vehicle itself keeps its order, and is sent no other."""
    actor = stage.under_way(1)
    order = actor.vehicle.state().order_id
    actor.vehicle.set_paused(True)
    actor.vehicle.request_state()
    mark = stage.mark
    stage.wait(stage.settings.watch)
    others = [
        entry
        for entry in stage.received(Kind.ORDER, mark, actor)
        if value_of(entry.scene, "busy") and _is_another(entry)
    ]
    demand(not others, f"another order came while {order} was paused")


def _is_another(entry: Entry) -> bool:
    return bool((entry.value or {}).get("orderId") != value_of(entry.scene, "order"))
