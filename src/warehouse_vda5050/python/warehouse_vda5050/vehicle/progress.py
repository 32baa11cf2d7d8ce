# SPDX-License-Identifier: Apache-2.0
"""An accepted order: what of it is passed, released and planned, and how updates are stitched on.

A base is never changed nor taken back: an update has to repeat the released nodes from its first
one on, and replaces the horizon alone.
"""

import math

from warehouse_vda5050.errors import ErrorType, Predefined
from warehouse_vda5050.grid import Cell
from warehouse_vda5050.model import Edge, EdgeState, Node, NodeState, VehicleOrder
from warehouse_vda5050.validation import MessageError


class OrderProgress:
    """The order under way, or the last one. Nodes before the last passed one are forgotten.

    nodes[0] is the last passed node; edges[k] leads from nodes[k] to nodes[k + 1].
    """

    def __init__(self, order: VehicleOrder, cells: list[Cell]) -> None:
        self.id, self.update = order.id, order.update
        self.nodes, self.edges, self.cells = list(order.nodes), list(order.edges), list(cells)
        self.cancelled = False
        self._content = _content(order)

    @property
    def last(self) -> Node:
        """The last passed node."""
        return self.nodes[0]

    @property
    def base_end(self) -> int:
        """Index of the last released node."""
        return sum(node.released for node in self.nodes) - 1

    def speeds(self) -> list[float]:
        """Returns the highest speed on each edge of the base [m/s]; inf where it has no limit."""
        edges = self.edges[: self.base_end]
        return [dict(edge.demands).get("maxSpeed", math.inf) for edge in edges]

    @property
    def has_horizon(self) -> bool:
        """Whether there are nodes that are not released."""
        return not self.nodes[-1].released

    @property
    def is_driven(self) -> bool:
        """Whether all nodes are passed, or the order was cancelled."""
        return self.cancelled or len(self.nodes) == 1

    def is_repeated(self, order: VehicleOrder) -> bool:
        """Returns whether an order is the last accepted message once more. Raises MessageError if
        it is another one under the same number."""
        if (order.id, order.update) != (self.id, self.update):
            return False
        if _content(order) != self._content:
            text = f"update {self.update} was accepted with other nodes"
            self._refuse(order, text, Predefined.SAME_ORDER_UPDATE_ID)
        return True

    def stitch(self, order: VehicleOrder, cells: list[Cell]) -> tuple[Node, ...]:
        """Takes over an update of this order. Returns the nodes it brings. Raises MessageError."""
        if order.update < self.update:
            text = f"update {order.update} is older than {self.update}"
            self._refuse(order, text, Predefined.OUTDATED_ORDER_UPDATE)
        if self.cancelled:
            cancelled = Predefined.ORDER_UPDATE_FOLLOWING_CANCEL
            self._refuse(order, "the order was cancelled", cancelled)
        shared = self._shared(order, cells)
        begin = shared[0]
        overlap = len(shared)
        self.nodes[begin + overlap :] = order.nodes[overlap:]
        self.cells[begin + overlap :] = cells[overlap:]
        self.edges[begin + overlap - 1 :] = order.edges[overlap - 1 :]
        self.update, self._content = order.update, _content(order)
        return order.nodes[overlap:]

    def _shared(self, order: VehicleOrder, cells: list[Cell]) -> range:
        """Returns the indices of the released nodes that an update repeats. Raises MessageError."""
        first = order.nodes[0]
        begin = (first.sequence - self.last.sequence) // 2
        if not 0 <= begin <= self.base_end:
            end = self.nodes[self.base_end]
            self._refuse(
                order,
                f"the update begins at {first.id} ({first.sequence}), not at the last released"
                f" node {end.id} ({end.sequence})",
            )
        shared = range(begin, self.base_end + 1)
        if len(order.nodes) < len(shared):
            self._refuse(order, "the update takes back a part of the base")
        for theirs, ours in enumerate(shared):
            if not self._same(order, cells, theirs, ours):
                self._refuse(order, f"the update changes {self.nodes[ours].id}, which is released")
        return shared

    def _same(self, order: VehicleOrder, cells: list[Cell], theirs: int, ours: int) -> bool:
        a, b = order.nodes[theirs], self.nodes[ours]
        actions = {action.id for action in a.actions}
        same = a.released and a.id == b.id and cells[theirs] == self.cells[ours]
        # Masters may leave out the actions of a node that they repeat.
        return same and (not actions or actions == {action.id for action in b.actions})

    def _refuse(
        self, order: VehicleOrder, text: str, precise: Predefined = Predefined.VALIDATION_FAILURE
    ) -> None:
        refer = (("orderId", order.id[:100]), ("orderUpdateId", str(order.update)))
        raise MessageError(text, ErrorType.ORDER_UPDATE.value, refer, precise)

    def pass_nodes(self, count: int) -> list[Node]:
        """Takes the next `count` nodes as passed; returns them."""
        count = min(count, self.base_end)
        passed = self.nodes[1 : count + 1]
        del self.nodes[:count], self.edges[:count], self.cells[:count]
        return passed

    def cancel(self) -> None:
        """Forgets what was not passed."""
        self.cancelled = True
        del self.nodes[1:], self.edges[:], self.cells[1:]

    def node_states(self) -> tuple[NodeState, ...]:
        """Returns the nodes that are yet to be passed."""
        return tuple(NodeState(n.id, n.sequence, n.released, n.position) for n in self.nodes[1:])

    def edge_states(self) -> tuple[EdgeState, ...]:
        """Returns the edges that are yet to be driven."""
        return tuple(EdgeState(e.id, e.sequence, e.released) for e in self.edges)


def _content(order: VehicleOrder) -> tuple[tuple[Node, ...], tuple[Edge, ...]]:
    return order.nodes, order.edges
