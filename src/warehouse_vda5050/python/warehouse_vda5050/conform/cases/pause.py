# SPDX-License-Identifier: Apache-2.0
"""startPause and stopPause (6.8.1, 6.8.2)."""

import math

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.probe import Json, Probe
from warehouse_vda5050.conform.verdict import demand

chapter = Chapter("pause")
case = chapter.case


def _pause(probe: Probe) -> Json:
    return probe.finished(probe.instant("startPause"), probe.settings.edge)


def _go_on(probe: Probe) -> Json:
    return probe.finished(probe.instant("stopPause"), probe.settings.edge)


def _under_way(probe: Probe, edges: int = 3) -> Json:
    order = probe.new_order(probe.way(edges))
    probe.accept(order)
    probe.driving()
    return order


@case("idle", "6.8.2")
def idle(probe: Probe) -> None:
    """startPause of an idle vehicle is FINISHED, paused true."""
    demand(_pause(probe).get("paused") is True, "paused is not true")


@case("idle_ends", "6.8.2")
def idle_ends(probe: Probe) -> None:
    """stopPause is FINISHED, paused false."""
    _pause(probe)
    demand(_go_on(probe).get("paused") is False, "paused is not false")


@case("twice", "6.8.1")
def twice(probe: Probe) -> None:
    """startPause is idempotent: once more it is FINISHED."""
    _pause(probe)
    demand(_pause(probe).get("paused") is True, "paused is not true")


@case("not_paused", "6.8.1")
def not_paused(probe: Probe) -> None:
    """stopPause is idempotent: of a vehicle that is not paused, FINISHED."""
    demand(_go_on(probe).get("paused") is False, "paused is not false")


@case("driving", "6.8.2", edges=3)
def driving(probe: Probe) -> None:
    """While driving: FINISHED means that the vehicle stands."""
    _under_way(probe)
    state = _pause(probe)
    demand(state.get("driving") is False, "driving is true when it is FINISHED")
    demand(state.get("paused") is True, "paused is not true")


@case("stays", "6.8.1", edges=3)
def stays(probe: Probe) -> None:
    """A paused vehicle does not drive."""
    _under_way(probe)
    before = view.at(_pause(probe))
    probe.wait(2.0)
    probe.instant("stateRequest")
    state = probe.answer()
    after = view.at(state)
    far = math.dist(before, after) if before and after else 0.0
    demand(far < 0.1 and not state.get("driving"), f"it moved by {far:.2f} m")


@case("resumes", "6.8.2", edges=3)
def resumes(probe: Probe) -> None:
    """After stopPause the order is driven to its end."""
    order = _under_way(probe)
    _pause(probe)
    _go_on(probe)
    demand(probe.finish(order).get("lastNodeSequenceId") == 6, "it did not come to its end")


@case("order_kept", "6.8.1", edges=3)
def order_kept(probe: Probe) -> None:
    """A paused order keeps its nodes and edges."""
    order = _under_way(probe)
    state = _pause(probe)
    demand(view.has(state, order), "the order is another one")
    demand(state.get("nodeStates") and state.get("edgeStates"), "nodeStates or edgeStates is empty")


@case("order_taken", "6.8.1", edges=1)
def order_taken(probe: Probe) -> None:
    """A paused vehicle does not drive a new order before stopPause."""
    _pause(probe)
    order = probe.new_order(probe.way(1))
    probe.order(order)
    probe.answer("an order")
    probe.never(lambda s: s.get("driving"), "it drives although paused", 2.0)
    taken = view.has(probe.state, order)
    _go_on(probe)
    if taken:
        probe.finish(order)


@case("update_taken", "6.8.1", edges=2)
def update_taken(probe: Probe) -> None:
    """An update while paused is taken, and driven after stopPause."""
    way = probe.way(2)
    order = probe.new_order(way, released=2)
    probe.accept(order)
    probe.driving()
    _pause(probe)
    update = probe.update(order, way, 1)
    probe.accept(update)
    _go_on(probe)
    probe.finish(update)


@case("no_errors", "6.8.1", edges=2)
def no_errors(probe: Probe) -> None:
    """A pause is no error."""
    _under_way(probe, 2)
    before = len(view.rows(probe.state, "errors"))
    state = _pause(probe)
    demand(len(view.rows(state, "errors")) <= before, f"errors: {state.get('errors')!r:.200}")
