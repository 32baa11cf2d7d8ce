# SPDX-License-Identifier: Apache-2.0
"""Errors (6.10.5, 6.6.4): what is refused is reported, with references, until it is over."""

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.orders import action_of
from warehouse_vda5050.conform.probe import Json, Probe
from warehouse_vda5050.conform.verdict import demand

chapter = Chapter("errors")
case = chapter.case


def _refusal(probe: Probe) -> tuple[Json, Json]:
    """An order that is refused, and the error for it."""
    action = action_of("conformUnknown", probe.new_id("unknown"))
    order = probe.new_order(probe.way(0), actions={0: [action]})
    return order, probe.refuses(order)


@case("none", "6.10.5")
def none(probe: Probe) -> None:
    """A vehicle that is well, and was sent nothing wrong, has no errors."""
    probe.instant("stateRequest")
    errors = view.rows(probe.answer(), "errors")
    demand(not errors, f"errors: {errors!r:.200}")


@case("form", "6.10.6", edges=1)
def form(probe: Probe) -> None:
    """An error has errorType and errorLevel."""
    error = _refusal(probe)[1]
    demand(error.get("errorType"), "errorType is empty")
    demand(error.get("errorLevel") in ("WARNING", "FATAL"), f"errorLevel {error.get('errorLevel')}")


@case("level", "6.6.4.2", edges=1)
def level(probe: Probe) -> None:
    """A refused order is a warning: no person has to come."""
    value = _refusal(probe)[1].get("errorLevel")
    demand(value == "WARNING", f"errorLevel is {value}")


@case("order_reference", "7.1", edges=1)
def order_reference(probe: Probe) -> None:
    """The error of an order refers to its orderId."""
    order, error = _refusal(probe)
    pairs = view.references(error)
    demand(pairs.get("orderId") == order["orderId"], f"references are {pairs}")


@case("update_reference", "7.1", edges=2)
def update_reference(probe: Probe) -> None:
    """The error of an update refers to its orderUpdateId."""
    way = probe.way(2)
    order = probe.new_order(way, released=2)
    probe.accept(order)
    update = probe.update(order, [way[0], way[2], way[1]], 1)
    error = probe.refused(lambda: probe.order(update), refer=order["orderId"])
    pairs = view.references(error)
    demand(pairs.get("orderUpdateId") == "1", f"references are {pairs}")


@case("stays", "6.6.4.2", edges=1)
def stays(probe: Probe) -> None:
    """The warning is reported until a new order is accepted."""
    order, _ = _refusal(probe)
    probe.wait(2.0)
    probe.instant("stateRequest")
    demand(order["orderId"] in str(probe.answer().get("errors")), "it is gone")


@case("goes", "6.6.4.2", edges=1)
def goes(probe: Probe) -> None:
    """The warning goes when a new order is accepted."""
    refused, _ = _refusal(probe)
    probe.drive(probe.new_order(probe.way(0)))
    probe.instant("stateRequest")
    demand(refused["orderId"] not in str(probe.answer().get("errors")), "it is there still")


@case("described", "6.10.6", edges=1, strict=True)
def described(probe: Probe) -> None:
    """An error has a description for people."""
    demand(_refusal(probe)[1].get("errorDescription"), "errorDescription is empty")


@case("topic_reference", "7.1", edges=1, strict=True)
def topic_reference(probe: Probe) -> None:
    """The error of a message refers to its topic."""
    pairs = view.references(_refusal(probe)[1])
    demand("order" in pairs.values(), f"references are {pairs}")


@case("next_taken", "6.6.4.2", edges=1)
def next_taken(probe: Probe) -> None:
    """After a refusal the next order is taken."""
    _refusal(probe)
    probe.drive(probe.new_order(probe.way(1)))


@case("same_again", "6.10", edges=1)
def same_again(probe: Probe) -> None:
    """The same wrong order once more is answered, too."""
    order, _ = _refusal(probe)
    probe.order(order)
    demand(order["orderId"] in str(probe.answer("a wrong order").get("errors")), "no error")
