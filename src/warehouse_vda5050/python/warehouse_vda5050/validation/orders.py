# SPDX-License-Identifier: Apache-2.0
"""Whether an order can be driven: its form, its places on the floor, its actions."""

from collections.abc import Iterator

from warehouse_vda5050.grid import Cell, Grid, GridError
from warehouse_vda5050.model import Action, Edge, ErrorType, Node, Order
from warehouse_vda5050.validation import MessageError

MAX_NODES = 1000
MAX_ACTIONS = 20  # of one node


def check_form(order: Order) -> None:
    """Raises MessageError if nodes and edges don't take turns, or the base has a gap."""
    refer = (("orderId", order.id[:100]),)
    if not order.id:
        raise MessageError("orderId is empty", references=refer)
    if not order.nodes or len(order.nodes) > MAX_NODES:
        raise MessageError(
            f"{len(order.nodes)} nodes; 1 to {MAX_NODES} were expected", references=refer
        )
    if len(order.edges) != len(order.nodes) - 1:
        text = f"{len(order.edges)} edges between {len(order.nodes)} nodes; one less was expected"
        raise MessageError(text, references=refer)
    fault = next(_form_faults(order), None)
    if fault:
        raise MessageError(fault, references=refer)


def _form_faults(order: Order) -> Iterator[str]:
    first = order.nodes[0]
    if first.sequence % 2:
        yield f"nodes[0].sequenceId is {first.sequence}; an even number was expected"
    if not first.released:
        yield "nodes[0] is not released"
    for k, (edge, node) in enumerate(zip(order.edges, order.nodes[1:])):
        before = order.nodes[k]
        number = first.sequence + 2 * k + 1
        if edge.sequence != number:
            yield f"edges[{k}].sequenceId is {edge.sequence}; {number} was expected"
        if node.sequence != number + 1:
            yield f"nodes[{k + 1}].sequenceId is {node.sequence}; {number + 1} was expected"
        if edge.released != node.released:
            yield f"edges[{k}] and nodes[{k + 1}] are not released together"
        if node.released and not before.released:
            yield f"nodes[{k + 1}] is released, and what leads there is not"
        if edge.start not in ("", before.id) or edge.end not in ("", node.id):
            yield f"edges[{k}] leads from {edge.start} to {edge.end}, not {before.id} to {node.id}"
    ids = [action.id for node in order.nodes for action in node.actions]
    if len(set(ids)) != len(ids):
        yield "two actions have one actionId"


def cells_of(order: Order, grid: Grid) -> list[Cell]:
    """Returns the cell of each node. Raises MessageError, of type orderError or noRouteError."""
    cells: list[Cell] = []
    for node in order.nodes:
        refer = (("orderId", order.id[:100]), ("nodeId", node.id[:100]))
        try:
            cell = grid.cell_of(node)
            way = grid.between(cells[-1], cell)[1:] if cells else []
        except GridError as error:
            raise MessageError(str(error), ErrorType.ORDER.value, refer) from None
        if cells and not way:
            text = f"node {node.id!r} is where the node before it is"
            raise MessageError(text, ErrorType.ORDER.value, refer)
        taken = grid.blocked_among(way)
        if taken:
            text = f"nothing can stand at {grid.node_id(taken)}, on the way to node {node.id!r}"
            raise MessageError(text, ErrorType.NO_ROUTE.value, refer)
        cells.append(cell)
    return cells


def check_abilities(order: Order, actions: frozenset[str]) -> None:
    """Raises MessageError, of type orderError, for what no robot here can do.

    `actions` are the types that may stand at a node.
    """
    for node in order.nodes:
        _check_node(order, node, actions)
    for edge in order.edges:
        _check_edge(order, edge)


def _check_node(order: Order, node: Node, known: frozenset[str]) -> None:
    refer = (("orderId", order.id[:100]), ("nodeId", node.id[:100]))
    if len(node.actions) > MAX_ACTIONS:
        text = f"{len(node.actions)} actions at node {node.id!r}; at most {MAX_ACTIONS} expected"
        raise MessageError(text, ErrorType.ORDER.value, refer)
    for action in node.actions:
        if action.type not in known:
            text = f"action {action.type!r} is unknown; one of {', '.join(sorted(known))} expected"
            raise MessageError(text, ErrorType.ORDER.value, (*refer, _reference(action)))


def _check_edge(order: Order, edge: Edge) -> None:
    refer = (("orderId", order.id[:100]), ("edgeId", edge.id[:100]))
    if edge.unsupported:
        text = f"edge {edge.id!r} has {', '.join(edge.unsupported)}; edges here are straight"
        raise MessageError(text, ErrorType.ORDER.value, refer)
    if edge.actions:
        text = f"edge {edge.id!r} has actions; they belong to nodes here"
        raise MessageError(text, ErrorType.ORDER.value, (*refer, _reference(edge.actions[0])))


def _reference(action: Action) -> tuple[str, str]:
    return "actionId", action.id[:100]
