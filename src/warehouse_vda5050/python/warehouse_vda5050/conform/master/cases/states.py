# SPDX-License-Identifier: Apache-2.0
"""States as a radio brings them (6.2: best effort), and with what no version has (6.1)."""

import json
from collections.abc import Callable

from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.log import Entry
from warehouse_vda5050.conform.master.actor import Actor
from warehouse_vda5050.conform.master.channel import Travel
from warehouse_vda5050.conform.master.facts import value_of
from warehouse_vda5050.conform.master.stage import Stage
from warehouse_vda5050.conform.verdict import demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("states")
case = chapter.case


def _drive(stage: Stage, travel: Travel) -> None:
    """Has states travel so for a time, and demands that each order fits the vehicle all the
    same."""
    stage.idle()
    for actor in stage.actors:
        actor.channel.travel = travel
    mark = stage.mark
    stage.an_order(mark)
    stage.wait(2 * stage.settings.watch)
    demand_sound(stage, mark)


def demand_sound(stage: Stage, mark: int) -> None:
    """Demands that each order since some message fits what its vehicle had."""
    for entry in stage.received(Kind.ORDER, mark):
        value = entry.value or {}
        had, busy = value_of(entry.scene, "order"), value_of(entry.scene, "busy")
        order = value.get("orderId")
        demand(order == had or not busy, f"order {order} came while {had} was under way")
        refused = not value_of(entry.scene, "accepted") and not _is_copy(entry)
        demand(not refused, f"order {order} update {value.get('orderUpdateId')} does not fit")


def _is_copy(entry: Entry) -> bool:
    value = entry.value or {}
    had = value_of(entry.scene, "order"), value_of(entry.scene, "update")
    return had == (value.get("orderId"), value.get("orderUpdateId"))


@case("doubled", "6.2")
def doubled(stage: Stage) -> None:
    """States that come twice change nothing."""
    _drive(stage, Travel.DOUBLED)


@case("late", "6.2")
def late(stage: Stage) -> None:
    """States that come a second late are waited for."""
    _drive(stage, Travel.LATE)


@case("swapped", "6.4")
def swapped(stage: Stage) -> None:
    """A state that a newer one overtook is not acted upon: headerId and timestamp say so."""
    _drive(stage, Travel.SWAPPED)


@case("stale", "6.4")
def stale(stage: Stage) -> None:
    """A copy of a state that comes seconds later is not acted upon."""
    _drive(stage, Travel.STALE)


@case("lossy", "6.2")
def lossy(stage: Stage) -> None:
    """States of which two of three are lost are enough: orders are updated all the same."""
    _drive(stage, Travel.LOSSY)


def _goes_on(stage: Stage, accident: Callable[[Actor], None]) -> None:
    """Demands that the master goes on after something that it can't read."""
    actor = stage.idle()
    accident(actor)
    actor.vehicle.request_state()
    stage.an_order(stage.mark, actor)


@case("unknown_field", "6.1")
def unknown_field(stage: Stage) -> None:
    """A state with a field of a later version is read all the same."""

    def edit(value: dict) -> None:
        value["conformField"] = {"of": "a later version"}

    def accident(actor: Actor) -> None:
        actor.link.edits[Kind.STATE] = edit

    _goes_on(stage, accident)


@case("no_json", "6.1")
def no_json(stage: Stage) -> None:
    """A state that is no JSON, is empty, or lacks its fields, does not stop the master."""

    def accident(actor: Actor) -> None:
        for payload in (b"{", b"", b"[]", b"\xff", json.dumps({"headerId": 1}).encode()):
            actor.link.send_raw(Kind.STATE, payload)

    _goes_on(stage, accident)


@case("information", "6.10.4")
def information(stage: Stage) -> None:
    """Information is for people: it changes nothing."""

    def edit(value: dict) -> None:
        value["information"] = [{"infoType": "conform", "infoLevel": "INFO"}]

    def accident(actor: Actor) -> None:
        actor.link.edits[Kind.STATE] = edit

    _goes_on(stage, accident)
