# SPDX-License-Identifier: Apache-2.0
"""Updates of orders (6.6.2): stitched at the end of the base, which is never changed."""

from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.master.orders import Ordered, content, orders_of, updates_of
from warehouse_vda5050.conform.master.stage import Stage
from warehouse_vda5050.conform.verdict import demand

chapter = Chapter("update")
case = chapter.case
FREE = ("actions",)  # what a node that is sent again may leave out


@case("number", "6.6.2", audit=True)
def number(stage: Stage) -> None:
    """orderUpdateId is one more than that of the message before."""
    for order in updates_of(stage):
        assert order.before
        expected = {order.before.newest + 1, order.before.accepted + 1}
        demand(order.update in expected, f"{order.name} follows {order.before.newest}")


@case("never_lower", "6.6.4.3", audit=True)
def never_lower(stage: Stage) -> None:
    """An update that is older than that of the vehicle is not sent."""
    for order in orders_of(stage):
        had = order.before.accepted if order.before else -1
        demand(order.update >= had, f"{order.name} comes after {had}")


@case("copy", "6.6.4.3", audit=True)
def copy(stage: Stage) -> None:
    """The same orderUpdateId has the same content, if it is sent once more."""
    for order in orders_of(stage):
        if order.is_copy:
            assert order.before
            same = order.before.sent[order.update] == content(order.value)
            demand(same, f"{order.name} has another content than before")


def _end(order: Ordered) -> int:
    """Returns the sequenceId of the last node of the base."""
    assert order.before
    return max(order.before.nodes)


@case("stitch", "6.6.2", audit=True)
def stitch(stage: Stage) -> None:
    """The first node of an update is the last released node that the vehicle has."""
    for order in updates_of(stage):
        assert order.before
        first, last = order.nodes[0], order.before.nodes[_end(order)]
        ours = first["nodeId"], first["sequenceId"]
        theirs = last["nodeId"], last["sequenceId"]
        demand(ours == theirs, f"{order.name} begins with {ours}; the base ends with {theirs}")


@case("stitch_unchanged", "6.6.2", audit=True)
def stitch_unchanged(stage: Stage) -> None:
    """The node at which an update is stitched on is sent as it was."""
    for order in updates_of(stage):
        assert order.before
        first = order.nodes[0]
        known = order.before.nodes.get(first["sequenceId"], first)
        for name in first.keys() | known.keys():
            left_out = name in FREE and not first.get(name)
            same = first.get(name) == known.get(name) or left_out
            demand(same, f"{order.name}: {name} of {first['nodeId']} has changed")


@case("base_kept", "6.6.2", audit=True)
def base_kept(stage: Stage) -> None:
    """A base is never changed: no node or edge of it becomes another."""
    for order in updates_of(stage):
        assert order.before
        for part in order.nodes:
            known = order.before.nodes.get(part["sequenceId"], part)
            same = part["nodeId"] == known["nodeId"]
            demand(same, f"{order.name}: {part['nodeId']} stands for {known['nodeId']}")
        for part in order.edges:
            known = order.before.edges.get(part["sequenceId"], part)
            same = part["edgeId"] == known["edgeId"]
            demand(same, f"{order.name}: {part['edgeId']} stands for {known['edgeId']}")


@case("base_not_taken_back", "6.6.2", audit=True)
def base_not_taken_back(stage: Stage) -> None:
    """What is released stays so."""
    for order in updates_of(stage):
        released = [n["sequenceId"] for n in order.nodes if n["released"]]
        last = max(released, default=-1)
        demand(last >= _end(order), f"{order.name} releases up to {last} of {_end(order)}")


@case("after_refusal", "6.6.4", audit=True)
def after_refusal(stage: Stage) -> None:
    """What a vehicle has refused is not sent again as it was."""
    reaction = stage.settings.reaction
    for order in orders_of(stage):
        refused = order.before.refused.get(order.update) if order.before else None
        again = refused is not None and order.entry.time > refused + reaction
        demand(not again, f"{order.name} was refused, and is sent again")


@case("after_cancel", "6.6.3", audit=True)
def after_cancel(stage: Stage) -> None:
    """A cancelled order is not updated."""
    for order in updates_of(stage):
        assert order.before
        cancelled = order.before.cancelled_at
        demand(
            cancelled is None, f"{order.name} comes after a cancelOrder at {cancelled or 0:.1f} s"
        )
