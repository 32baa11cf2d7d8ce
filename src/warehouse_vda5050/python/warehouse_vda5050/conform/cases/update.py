# SPDX-License-Identifier: Apache-2.0
"""Updates of orders (6.6.2): stitched at the last released node; the base never changes."""

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.probe import Json, Probe
from warehouse_vda5050.conform.verdict import demand

chapter = Chapter("update")
case = chapter.case
WRONG = ("orderUpdateError", "orderError", "validationError")


def _half(probe: Probe) -> tuple[list, Json]:
    """A way of two edges, and an order under way that has released the first alone."""
    way = probe.way(2)
    order = probe.new_order(way, released=2)
    probe.accept(order)
    return way, order


def _stand(probe: Probe) -> Json:
    """Waits until the vehicle stands at the end of its base."""
    seconds = probe.settings.edge + probe.settings.answer
    return probe.until(
        lambda s: view.reached(s) == 2 and s.get("driving") is False,
        "standing at the end of the base",
        seconds,
    )


@case("while_driving", "6.6.2", edges=2)
def while_driving(probe: Probe) -> None:
    """An update with a higher number extends the base while driving."""
    way, order = _half(probe)
    probe.driving()
    update = probe.update(order, way, 1)
    probe.accept(update)
    state = probe.finish(update)
    demand(state.get("lastNodeSequenceId") == 4, "it did not come to the new end")


@case("standing", "6.6.2", edges=2)
def standing(probe: Probe) -> None:
    """An update is taken while the vehicle waits at the end of its base."""
    way, order = _half(probe)
    _stand(probe)
    update = probe.update(order, way, 1)
    probe.accept(update)
    demand(probe.finish(update).get("lastNodeSequenceId") == 4, "it did not come to the new end")


@case("after_end", "6.6.2", edges=2)
def after_end(probe: Probe) -> None:
    """An update continues an order that was over, from its last node."""
    way = probe.way(2)
    order = probe.new_order(way[:2])
    probe.drive(order)
    update = probe.update(order, way, 1)
    probe.accept(update)
    demand(probe.finish(update).get("lastNodeSequenceId") == 4, "it did not come to the new end")


@case("twice", "6.6.2", edges=3)
def twice(probe: Probe) -> None:
    """One update after another is stitched on."""
    way = probe.way(3)
    order = probe.new_order(way, released=2)
    probe.accept(order)
    first = probe.update(order, way, 1, released=3)
    probe.accept(first)
    second = probe.update(first, way, 2)
    probe.accept(second)
    demand(probe.finish(second, 3).get("lastNodeSequenceId") == 6, "it did not come to its end")


@case("states", "6.6.2", edges=2)
def states(probe: Probe) -> None:
    """After an update the states have the rest of the base and the new nodes."""
    way, order = _half(probe)
    _stand(probe)
    update = probe.update(order, way, 1)
    state = probe.accept(update)
    reported = view.sequences(state, "nodeStates")
    demand(reported in ([4], [2, 4], []), f"nodeStates has {reported}; [4] was expected")
    probe.finish(update)


@case("horizon_replaced", "6.6.2", edges=2)
def horizon_replaced(probe: Probe) -> None:
    """An update replaces the horizon: what it leaves out is gone."""
    way, order = _half(probe)
    update = probe.update(order, way[:2], 1)
    state = probe.accept(update)
    left = view.sequences(state, "nodeStates")
    demand(4 not in left, f"nodeStates has {left} although the horizon was deleted")
    demand(probe.finish(update).get("lastNodeSequenceId") == 2, "it is not at the end of the base")


@case("horizon_actions", "6.6.2", edges=2)
def horizon_actions(probe: Probe) -> None:
    """Actions of a horizon that an update deletes wait no longer."""
    action = probe.harmless()
    way = probe.way(2)
    order = probe.new_order(way, released=2, actions={2: [action]})
    probe.accept(order)
    update = probe.update(order, way[:2], 1)
    probe.accept(update)
    status = view.status(probe.finish(update), action["actionId"])
    demand(status in ("", "FAILED"), f"the action is {status}")


@case("horizon_changed", "6.6.2", edges=2)
def horizon_changed(probe: Probe) -> None:
    """An update may bring another horizon."""
    way, order = _half(probe)
    update = probe.update(order, [way[0], way[1], way[0]], 1)
    probe.accept(update)
    state = probe.finish(update)
    demand(state.get("lastNodeId") == way[0].id, "it is not at the end of the new horizon")


@case("copy", "6.6.4.3", edges=2)
def copy(probe: Probe) -> None:
    """The same update once more is ignored."""
    way, order = _half(probe)
    update = probe.update(order, way, 1)
    probe.accept(update)
    probe.order(update)
    probe.answer("a copy")
    state = probe.finish(update)
    errors = [e for e in view.rows(state, "errors") if order["orderId"] in str(e)]
    demand(not errors, f"an error for it: {errors[:1]}")


@case("lower", "6.6.4.3", edges=2)
def lower(probe: Probe) -> None:
    """A lower orderUpdateId is refused: orderUpdateError."""
    way = probe.way(2)
    order = probe.new_order(way, released=2)
    probe.accept(order)
    update = probe.update(order, way, 1)
    probe.accept(update)
    probe.refused(lambda: probe.order(order), ("orderUpdateError",), order["orderId"])
    demand(view.has(probe.state, update), "the state has gone back to the former update")
    probe.finish(update)


@case("lower_stitched", "6.6.4.3", edges=2)
def lower_stitched(probe: Probe) -> None:
    """A lower orderUpdateId is refused, also if it would fit the base."""
    way = probe.way(2)
    order = {**probe.new_order(way, released=2), "orderUpdateId": 0}
    probe.accept(order)
    newer = {**probe.update(order, way, 1, released=2), "orderUpdateId": 5}
    probe.accept(newer)
    older = {**probe.update(order, way, 1), "orderUpdateId": 3}
    probe.refused(lambda: probe.order(older), ("orderUpdateError",), order["orderId"])
    probe.never(lambda s: view.reached(s) > 2, "it left its base", 2.0)


@case("lower_goes_on", "6.6.4.3", edges=2)
def lower_goes_on(probe: Probe) -> None:
    """After a lower orderUpdateId the order goes on."""
    way = probe.way(2)
    order = probe.new_order(way, released=2)
    probe.accept(order)
    update = probe.update(order, way, 1)
    probe.accept(update)
    probe.order({**order, "orderUpdateId": 0})
    demand(probe.finish(update).get("lastNodeSequenceId") == 4, "it did not come to its end")


@case("gap", "6.6.2", edges=3)
def gap(probe: Probe) -> None:
    """An update that does not begin at the last released node is refused."""
    way = probe.way(3)
    order = probe.new_order(way, released=2)
    probe.accept(order)
    update = probe.update(order, way, 2)
    probe.refused(lambda: probe.order(update), WRONG, order["orderId"])
    demand(not view.has(probe.state, update), "the update was taken over")
    probe.never(lambda s: view.reached(s) > 2, "it left its base", 2.0)


@case("other_node", "6.6.2", edges=2)
def other_node(probe: Probe) -> None:
    """An update whose first node is another one is refused."""
    way, order = _half(probe)
    update = probe.update(order, [way[0], way[2], way[1]], 1)
    probe.refused(lambda: probe.order(update), WRONG, order["orderId"])
    demand(not view.has(probe.state, update), "the update was taken over")


@case("other_number", "6.6.2", edges=2)
def other_number(probe: Probe) -> None:
    """An update whose first node has another sequenceId is refused."""
    way, order = _half(probe)
    _stand(probe)
    update = probe.update(order, [way[0], way[0], way[1], way[2]], 2)
    probe.refused(lambda: probe.order(update), WRONG, order["orderId"])
    demand(not view.has(probe.state, update), "the update was taken over")


@case("other_number_after_end", "6.6.2", edges=2)
def other_number_after_end(probe: Probe) -> None:
    """An order that is over is continued from its last number alone."""
    way = probe.way(2)
    order = probe.new_order(way[:2])
    probe.drive(order)
    update = probe.update(order, [way[0], way[0], way[1], way[2]], 2)
    probe.refused(lambda: probe.order(update), WRONG, order["orderId"])
    probe.never(lambda s: s.get("driving"), "the vehicle drives", 1.0)


@case("number_kept", "6.6.4.3", edges=2)
def number_kept(probe: Probe) -> None:
    """A refused update leaves orderUpdateId as it was."""
    way, order = _half(probe)
    wrong = probe.update(order, [way[0], way[2], way[1]], 1)
    probe.order(wrong)
    probe.answer("a wrong update")
    demand(view.has(probe.state, order), "orderUpdateId has changed")
    right = probe.update(order, way, 1)
    probe.accept(right)
    probe.finish(right)
