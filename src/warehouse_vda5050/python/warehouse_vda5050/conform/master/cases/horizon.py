# SPDX-License-Identifier: Apache-2.0
"""What is released, and when (6.6.2, 6.10.3)."""

from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.master.actor import Actor
from warehouse_vda5050.conform.master.facts import value_of
from warehouse_vda5050.conform.master.orders import Ordered, updates_of
from warehouse_vda5050.conform.master.stage import Stage
from warehouse_vda5050.conform.verdict import Untestable, demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("horizon")
case = chapter.case
PATIENCE = 30.0  # until a base is extended that a vehicle asks for [s]
ATTEMPTS = 3


def _with_horizon(stage: Stage) -> Actor:
    """Returns a vehicle that asks for a base. Raises Untestable if no order has a horizon."""

    def asks() -> Actor | None:
        asking = (a for a in stage.actors if a.vehicle.state().new_base_request)
        return next((a for a in asking if not _is_cancelled(a)), None)

    actor = stage.until(asks, stage.settings.patience)
    if not isinstance(actor, Actor):
        seconds = stage.settings.patience
        raise Untestable(f"the master sent no order with a horizon within {seconds:.0f} s")
    return actor


def _is_cancelled(actor: Actor) -> bool:
    return bool(value_of(actor.facts.scene(), "cancel") == "RUNNING")


@case("base_request", "6.10.3")
def base_request(stage: Stage) -> None:
    """A newBaseRequest is answered by an update that releases more."""
    for _ in range(ATTEMPTS):
        if _base_is_extended(stage):
            return
    raise Untestable(f"{ATTEMPTS} orders that a base was asked for were cancelled")


def _base_is_extended(stage: Stage) -> bool:
    """Returns whether a base was extended that a vehicle asked for; False: the order was cancelled.
    Raises Differs."""
    actor = _with_horizon(stage)
    order = actor.vehicle.state().order_id
    mark = stage.mark

    def answered() -> bool:
        entries = stage.received(Kind.ORDER, mark, actor)
        return any((e.value or {}).get("orderId") == order for e in entries)

    stage.until(lambda: answered() or _is_cancelled(actor), PATIENCE)
    demand(answered() or _is_cancelled(actor), f"no update within {PATIENCE:.0f} s")
    return answered()


@case("fluent", "6.6.2", strict=True, audit=True)
def fluent(stage: Stage) -> None:
    """A base is extended before the vehicle has to stop at its end, if traffic allows that."""
    updates = updates_of(stage)
    in_time = [o for o in updates if _left(o)]
    demand(
        in_time, f"all {len(updates)} updates came when the vehicle stood at the end of its base"
    )


def _left(order: Ordered) -> bool:
    """Returns whether a part of the base was still to be driven."""
    assert order.before
    return bool(value_of(order.scene, "sequence") < max(order.before.nodes, default=0))


@case("no_horizon_left", "6.6.2")
def no_horizon_left(stage: Stage) -> None:
    """An order with a horizon comes to its end: it is released, cut off or cancelled."""
    actor = _with_horizon(stage)
    order = actor.vehicle.state().order_id

    def ended() -> bool:
        state = actor.vehicle.state()
        return state.order_id != order or not state.nodes

    demand(stage.until(ended, stage.settings.trip), f"order {order} has nodes left still")
