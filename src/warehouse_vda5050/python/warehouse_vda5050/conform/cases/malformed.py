# SPDX-License-Identifier: Apache-2.0
"""Messages that are no valid orders (6.6.4.1): not taken over, a warning, and nothing breaks."""

from collections.abc import Callable

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.probe import Json, Probe
from warehouse_vda5050.conform.verdict import demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("malformed")
case = chapter.case
Damage = Callable[[Json], None]


def _refused(probe: Probe, send: Callable[[], None], types: tuple[str, ...] = ()) -> None:
    """Demands a warning, that the order is the one before, and that the vehicle answers."""
    before = probe.state.get("orderId"), probe.state.get("orderUpdateId")
    probe.refused(send, types)
    after = probe.state.get("orderId"), probe.state.get("orderUpdateId")
    demand(before == after, f"the message was taken over: {after}")
    probe.finished(probe.instant("stateRequest"))
    demand(probe.state.get("driving") is False, "it drives")


def _bytes(name: str, sentence: str, payload: bytes) -> None:
    def trial(probe: Probe) -> None:
        _refused(probe, lambda: probe.send_bytes(Kind.ORDER, payload), ("validationError",))

    trial.__doc__ = sentence
    case(name, "6.6.4.1")(trial)


def _damaged(name: str, sentence: str, damage: Damage) -> None:
    def trial(probe: Probe) -> None:
        order = probe.new_order(probe.way(1))
        damage(order)
        types = ("validationError", "orderError")
        _refused(probe, lambda: probe.order(order), types)

    trial.__doc__ = sentence
    case(name, "6.6.4.1", edges=1)(trial)


_bytes("text", "What is no JSON is refused: validationError.", b"conform")
_bytes(
    "truncated", "JSON that breaks off is refused: validationError.", b'{"orderId": "x", "nodes": ['
)
_bytes("array", "A message that is no object is refused: validationError.", b"[1, 2, 3]")
_bytes("object", "An order without any field is refused: validationError.", b"{}")
_bytes("binary", "What is no UTF-8 is refused: validationError.", b"\xff\xfe\x00\x80")
_bytes(
    "deep", "JSON of a thousand levels is refused.", b'{"nodes":' + b"[" * 1000 + b"]" * 1000 + b"}"
)

_damaged("without_id", "An order without orderId is refused.", lambda o: o.pop("orderId"))
_damaged(
    "without_update", "An order without orderUpdateId is refused.", lambda o: o.pop("orderUpdateId")
)
_damaged("without_nodes", "An order without nodes is refused.", lambda o: o.pop("nodes"))
_damaged(
    "no_nodes",
    "An order whose list of nodes is empty is refused.",
    lambda o: o.update(nodes=[], edges=[]),
)
_damaged(
    "nodes_text", "An order whose nodes are a text is refused.", lambda o: o.update(nodes="none")
)
_damaged(
    "without_edge",
    "Two nodes without the edge between them are refused.",
    lambda o: o.update(edges=[]),
)
_damaged(
    "without_sequence",
    "A node without sequenceId is refused.",
    lambda o: o["nodes"][1].pop("sequenceId"),
)
_damaged(
    "without_released",
    "A node without released is refused.",
    lambda o: o["nodes"][1].pop("released"),
)
_damaged(
    "without_node_id", "A node without nodeId is refused.", lambda o: o["nodes"][1].pop("nodeId")
)
_damaged(
    "released_text",
    "released as a text is refused.",
    lambda o: o["nodes"][1].update(released="true"),
)
_damaged(
    "sequence_text",
    "A sequenceId that is a text is refused.",
    lambda o: o["nodes"][1].update(sequenceId="two"),
)
_damaged(
    "sequence_negative",
    "A negative sequenceId is refused.",
    lambda o: o["nodes"][1].update(sequenceId=-2),
)
_damaged(
    "sequence_fraction",
    "A sequenceId that is no whole number is refused.",
    lambda o: o["nodes"][1].update(sequenceId=2.5),
)
_damaged(
    "update_flag",
    "An orderUpdateId that is true is refused.",
    lambda o: o.update(orderUpdateId=True),
)
_damaged(
    "update_negative",
    "A negative orderUpdateId is refused.",
    lambda o: o.update(orderUpdateId=-1),
)
_damaged(
    "sequence_twice",
    "Two nodes of one sequenceId are refused.",
    lambda o: o["nodes"][1].update(sequenceId=0),
)
_damaged(
    "sequence_gap",
    "A gap between sequenceIds is refused.",
    lambda o: o["nodes"][1].update(sequenceId=6),
)
_damaged(
    "position_text",
    "A position that is a text is refused.",
    lambda o: o["nodes"][1].update(nodePosition="here"),
)
_damaged(
    "edge_elsewhere",
    "An edge that leads elsewhere is refused.",
    lambda o: o["edges"][0].update(sequenceId=7),
)
_damaged(
    "first_unreleased",
    "An order whose first node is not released is refused.",
    lambda o: o["nodes"][0].update(released=False),
)


@case("base_gap", "6.6.2", edges=2)
def base_gap(probe: Probe) -> None:
    """A released node after one that is not is refused."""
    order = probe.new_order(probe.way(2))
    order["nodes"][1]["released"] = order["edges"][0]["released"] = False
    _refused(probe, lambda: probe.order(order))


@case("version", "6.4", edges=1)
def version(probe: Probe) -> None:
    """A message of another major version is not taken over."""
    order = probe.new_order(probe.way(1))
    probe.send(Kind.ORDER, order, version="9.0.0")
    probe.wait(1.0)
    demand(not view.has(probe.state, order), "the order was taken over")


@case("addressee", "6.4", edges=1, strict=True)
def addressee(probe: Probe) -> None:
    """A message for another vehicle is not taken over."""
    order = probe.new_order(probe.way(1))
    probe.send(Kind.ORDER, order, serialNumber="conform-another")
    probe.wait(1.0)
    demand(not view.has(probe.state, order), "the order was taken over")


@case("unknown_field", "6.1.1", edges=1)
def unknown_field(probe: Probe) -> None:
    """A field that no version has breaks nothing."""
    order = {**probe.new_order(probe.way(0)), "conformUnknown": 1}
    probe.order(order)
    probe.answer("an order with an unknown field")
    probe.finished(probe.instant("stateRequest"))


@case("instant_text", "6.9")
def instant_text(probe: Probe) -> None:
    """Instant actions that are no JSON break nothing, and are reported."""
    _refused(probe, lambda: probe.send_bytes(Kind.INSTANT_ACTIONS, b"conform"))


@case("instant_without_id", "6.9")
def instant_without_id(probe: Probe) -> None:
    """An instant action without actionId is reported as an error."""
    action = {"actionType": "startPause", "blockingType": "NONE", "actionParameters": []}
    _refused(probe, lambda: probe.send(Kind.INSTANT_ACTIONS, {"actions": [action]}))
    demand(not probe.state.get("paused"), "it is paused")


@case("order_goes_on", "6.6.4.1", edges=2)
def order_goes_on(probe: Probe) -> None:
    """A malformed message changes nothing of the order under way."""
    order = probe.new_order(probe.way(2))
    probe.accept(order)
    probe.driving()
    probe.send_bytes(Kind.ORDER, b"{}")
    demand(probe.finish(order).get("lastNodeSequenceId") == 4, "it did not come to its end")
