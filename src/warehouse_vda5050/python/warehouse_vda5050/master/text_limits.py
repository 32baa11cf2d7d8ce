# SPDX-License-Identifier: Apache-2.0
"""Whether messages keep to the lengths of strings and arrays of a vehicle's factsheet."""

import zlib
from collections.abc import Iterable, Iterator

from warehouse_vda5050.model import Action, Lengths, VehicleOrder, ZoneSet

MESSAGE_HEAD = 400  # bytes of an order without nodes, with its header
NODE_SHARE = 700  # bytes of a node and the edge to it, at most, without actions
ACTION_SHARE = 1000  # bytes of the actions of an order
ZONE_SHARE = 400  # bytes of a zone of four corners, at most


def nodes_within(lengths: Lengths) -> int | None:
    """Returns how many nodes an order may have within the longest message; None: any number."""
    if not lengths.message:
        return None
    return max(2, (lengths.message - MESSAGE_HEAD - ACTION_SHARE) // NODE_SHARE)


def too_long(order: VehicleOrder, lengths: Lengths) -> str:
    """Returns in a sentence what of an order the vehicle can't take, '' if it can take it all."""
    return next(_faults(order, lengths), "")


def fitting_id(run: str, count: int, lengths: Lengths) -> str:
    """Returns the id of an instant action, which no vehicle may be spared: of digits or shorter
    than it is for others, as the vehicle asks. The last part tells those of one run apart."""
    if lengths.is_numeric:
        return f"{zlib.crc32(run.encode())}{count:05}"[-(lengths.id or 15) :]
    return f"{run}-i{count}"[-lengths.id :]


def zones_too_long(zones: ZoneSet, lengths: Lengths) -> str:
    """Returns in a sentence what of a zone set the vehicle can't take, '' if it can take it all."""
    ids = [("zoneSetId", zones.id), ("mapId", zones.map_id)]
    ids += [("zoneId", zone.id) for zone in zones.zones]
    size = MESSAGE_HEAD + ZONE_SHARE * len(zones.zones)
    if 0 < lengths.message < size:
        return f"{len(zones.zones)} zones need {size} bytes, and its most are {lengths.message}"
    return next(_of_ids(ids, lengths), "")


def _faults(order: VehicleOrder, lengths: Lengths) -> Iterator[str]:
    yield from _of_ids(_ids(order), lengths)
    for node in order.nodes:
        if 0 < lengths.node_actions < len(node.actions):
            yield (
                f"node {node.id} has {len(node.actions)} actions, and node.actions of its"
                f" factsheet is {lengths.node_actions}"
            )
        yield from _of_actions(node.actions, lengths)


def _ids(order: VehicleOrder) -> Iterator[tuple[str, str]]:
    yield "orderId", order.id
    for node in order.nodes:
        yield "nodeId", node.id
        if node.position:
            yield "mapId", node.position.map_id
    for edge in order.edges:
        yield "edgeId", edge.id


def _of_ids(ids: Iterable[tuple[str, str]], lengths: Lengths) -> Iterator[str]:
    for name, text in ids:
        if 0 < lengths.id < len(text):
            yield _sentence(name, text, f"idLen of its factsheet is {lengths.id}")
        if lengths.is_numeric and text and not text.isdecimal():
            yield f"{name} {text[:60]!r} is no number, as idNumericalOnly of its factsheet demands"


def _of_actions(actions: Iterable[Action], lengths: Lengths) -> Iterator[str]:
    for action in actions:
        yield from _of_ids([("actionId", action.id)], lengths)
        count, most = len(action.parameters), lengths.parameters
        if 0 < most < count:
            yield (
                f"{action.type} has {count} parameters, and actions.actionsParameters of its"
                f" factsheet is {most}"
            )
        for word in (action.type, *(key for key, _ in action.parameters)):
            if 0 < lengths.word < len(word):
                yield _sentence("the word", word, f"enumLen of its factsheet is {lengths.word}")
        load = dict(action.parameters).get("loadId")
        if isinstance(load, str) and 0 < lengths.load_id < len(load):
            yield _sentence("loadId", load, f"loadIdLen of its factsheet is {lengths.load_id}")


def _sentence(name: str, text: str, limit: str) -> str:
    return f"{name} {text[:60]!r} has {len(text)} characters, and {limit}"
