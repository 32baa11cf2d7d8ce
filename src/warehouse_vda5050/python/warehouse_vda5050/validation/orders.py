# SPDX-License-Identifier: Apache-2.0
"""Whether an order can be driven: its form, and its places on the floor."""

from collections.abc import Iterator

from warehouse_vda5050.errors import ErrorType, Predefined
from warehouse_vda5050.grid import Cell, Grid, GridError
from warehouse_vda5050.model import VehicleOrder
from warehouse_vda5050.validation import MessageError

MAX_NODES = 1000


def check_form(order: VehicleOrder) -> None:
    """Raises MessageError if nodes and edges don't take turns, or the base has a gap."""
    refer = (("orderId", order.id[:100]),)
    if not order.id:
        raise MessageError("orderId is empty", references=refer)
    count = len(order.nodes)
    if not 0 < count <= MAX_NODES:
        raise MessageError(
            f"{count} nodes; 1 to {MAX_NODES} were expected",
            references=refer,
            precise=Predefined.INSUFFICIENT_MEMORY if count else None,
        )
    if len(order.edges) != len(order.nodes) - 1:
        text = f"{len(order.edges)} edges between {len(order.nodes)} nodes; one less was expected"
        raise MessageError(text, references=refer)
    fault = next(_form_faults(order), None)
    if fault:
        raise MessageError(fault, references=refer)


def _form_faults(order: VehicleOrder) -> Iterator[str]:
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


def cells_of(order: VehicleOrder, grid: Grid) -> list[Cell]:
    """Returns the cell of each node. Raises MessageError, of type orderError or noRouteError."""
    cells: list[Cell] = []
    for node in order.nodes:
        refer = (("orderId", order.id[:100]), ("nodeId", node.id[:100]))
        try:
            cell = grid.cell_of(node)
            way = grid.between(cells[-1], cell)[1:] if cells else []
        except GridError as error:
            unreachable = Predefined.NO_ROUTE_TO_TARGET
            raise MessageError(str(error), ErrorType.ORDER.value, refer, unreachable) from None
        if cells and not way:
            text = f"node {node.id!r} is where the node before it is"
            unreachable = Predefined.NO_ROUTE_TO_TARGET
            raise MessageError(text, ErrorType.ORDER.value, refer, unreachable)
        taken = grid.blocked_among(way)
        if taken:
            text = f"nothing can stand at {grid.node_id(taken)}, on the way to node {node.id!r}"
            raise MessageError(text, ErrorType.NO_ROUTE.value, refer)
        cells.append(cell)
    return cells
