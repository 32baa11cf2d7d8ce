# SPDX-License-Identifier: Apache-2.0
"""Our vehicle core as a vehicle of whatever map, with refusals on demand, and its connection."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from warehouse_vda5050.codec import Codec
from warehouse_vda5050.conform.master.channel import Channel
from warehouse_vda5050.conform.master.open_floor import OpenFloor
from warehouse_vda5050.conform.names import of_wire, to_wire
from warehouse_vda5050.errors import Error, ErrorType
from warehouse_vda5050.formula_driver import FormulaRobot
from warehouse_vda5050.headers import Headers
from warehouse_vda5050.model import (
    MAP_ID,
    Action,
    ConnectionState,
    Edge,
    InstantActions,
    Node,
    VehicleOrder,
    VehicleState,
    Visualization,
    ZoneSet,
)
from warehouse_vda5050.mqtt.loop import Outgoing
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.mqtt.vehicle_link import VehicleLink
from warehouse_vda5050.topics import Identity, Kind, Topics, heard_by_vehicle
from warehouse_vda5050.vehicle import Vehicle, VehicleSettings
from warehouse_vda5050.vehicle.complaints import references

Json = dict[str, Any]
# What the robot does by itself; the core has the robots of a grid in mind, which do not.
OBEYED = (
    "maxSpeed",
    "maxRotationSpeed",
    "orientation",
    "orientationType",
    "rotationAllowed",
    "reachOrientationBeforeEntering",
    "length",
    "allowedDeviationTheta",
)


class PlayedVehicle(Vehicle):
    """Takes orders of any map and place. map_id: of its map. refusal: (type, whether of updates) of
    the error by which it refuses, None if it does not; deaf: whether it ignores instant actions;
    no_zones: whether it refuses zone sets. accepted: whether it took the last order over."""

    def __init__(
        self, robot: FormulaRobot, floor: OpenFloor, map_id: str, settings: VehicleSettings
    ) -> None:
        super().__init__(robot, floor, settings)
        self.robot, self.floor, self.map_id = robot, floor, map_id
        self.refusal: tuple[str, bool] | None = None
        self.deaf = self.accepted = self.no_zones = False

    def on_order(self, order: VehicleOrder, now: float, unknown: tuple[str, ...] = ()) -> bool:
        """Takes an order or an update, or refuses it on demand."""
        self.accepted = False
        is_update = self.order is not None and order.id == self.order.id
        if self.refusal and self.refusal[1] == is_update:
            text = "refused, to see what the master makes of it"
            self.note(Error(self.refusal[0], description=text, references=references(order)))
            return False
        self.accepted = super().on_order(self._understood(order), now, unknown)
        return self.accepted

    def on_instant_actions(
        self, message: InstantActions, now: float, unknown: tuple[str, ...] = ()
    ) -> None:
        """Begins instant actions, unless it is deaf to them."""
        if not self.deaf:
            super().on_instant_actions(message, now, unknown)

    def on_zone_set(self, zones: ZoneSet, unknown: tuple[str, ...] = ()) -> None:
        """Adds a zone set of its map, or refuses it on demand."""
        if self.no_zones:
            refer = (("topic", Kind.ZONE_SET.value), ("zoneSetId", zones.id))
            text = "refused, to see what the master makes of it"
            self.note(Error(ErrorType.VALIDATION.value, description=text, references=refer))
            return
        here = MAP_ID if zones.map_id == self.map_id else f"{zones.map_id}, not {self.map_id}"
        super().on_zone_set(replace(zones, map_id=here), unknown)

    def _understood(self, order: VehicleOrder) -> VehicleOrder:
        """Returns an order without what the robot does by itself, on the core's map."""
        nodes = tuple(self._place(node) for node in order.nodes)
        pairs = zip(order.edges, nodes, nodes[1:])
        edges = tuple(self._limit(edge, a, b) for edge, a, b in pairs)
        return replace(order, nodes=nodes, edges=(*edges, *order.edges[len(edges) :]))

    def _place(self, node: Node) -> Node:
        demands = tuple(pair for pair in node.demands if pair[0] not in OBEYED)
        node = replace(node, demands=demands, actions=tuple(map(_of_any_load, node.actions)))
        at = node.position
        if at is None:
            return node
        if at.theta is not None:
            point = self.floor.position(self.floor.add(node.id, at.x, at.y))
            self.robot.headings[point] = at.theta
        here = MAP_ID if at.map_id in ("", self.map_id) else f"{at.map_id}, not {self.map_id}"
        return replace(node, position=replace(at, theta=None, map_id=here))

    def _limit(self, edge: Edge, a: Node, b: Node) -> Edge:
        speed = dict(edge.demands).get("maxSpeed")
        if isinstance(speed, (int, float)) and speed > 0 and a.position and b.position:
            ends = [self.floor.add(node.id, node.position.x, node.position.y) for node in (a, b)]  # type: ignore[union-attr]
            start, goal = (self.floor.position(cell) for cell in ends)
            self.robot.limits[start, goal] = speed
        return replace(edge, demands=tuple(p for p in edge.demands if p[0] not in OBEYED))


def _of_any_load(action: Action) -> Action:
    """Returns an action that lifts whatever type of load there is."""
    known = tuple(pair for pair in action.parameters if pair[0] != "loadType")
    return replace(action, parameters=known)


class PlayedLink(VehicleLink):
    """Its connection. edits: what is changed of its messages, by kind; of factsheets with the names
    of 2.1.0. before() is called when a message has come, heard(kind, payload) after its effect;
    sent(message) with each of its own."""

    def __init__(
        self,
        vehicle: PlayedVehicle,
        identity: Identity,
        codec: Codec,
        topics: Topics,
        broker: BrokerSettings,
    ) -> None:
        super().__init__(vehicle, identity, codec, topics, broker)
        self.channel = Channel()
        self.edits: dict[Kind, Callable[[Json], None]] = {}
        self.before: Callable[[], None] = lambda: None
        self.heard: Callable[[Kind, bytes], None] = lambda _kind, _payload: None
        self.sent: Callable[[Outgoing], None] = lambda _message: None

    @property
    def headers(self) -> Headers:
        """What numbers its messages."""
        return self._headers

    def continue_headers(self, headers: Headers) -> None:
        """Numbers messages on from an earlier connection."""
        self._headers = headers

    def send_raw(self, kind: Kind, payload: bytes) -> None:
        """Sends a payload as it is."""
        self._post(Outgoing(self._topics.of(self.identity, kind), payload, kind.qos, kind.retained))

    def state_payload(self) -> bytes:
        """Returns its next state as it would be sent."""
        return self._outgoing(Kind.STATE, self._on_map(self.vehicle.state())).payload

    def send_late(self, now: float) -> None:
        """Sends states whose time has come."""
        for message in self.channel.due(now):
            self._post(message)

    def close(self) -> None:
        """Says OFFLINE and disconnects."""
        farewell = self._connection(ConnectionState.OFFLINE)
        if self.link.connected:
            self.sent(farewell)
        self.link.close(farewell)

    def _post(self, message: Outgoing) -> None:
        if self.link.publish(message):
            self.sent(message)

    def _send(self, kind: Kind, message: Any) -> None:
        outgoing = self._edited(kind, self._outgoing(kind, self._on_map(message)))
        if kind is Kind.STATE:
            for state in self.channel.put(outgoing, self._now):
                self._post(state)
        else:
            self._post(outgoing)

    def _edited(self, kind: Kind, message: Outgoing) -> Outgoing:
        edit = self.edits.get(kind)
        if edit is None:
            return message
        is_sheet = kind is Kind.FACTSHEET
        value = of_wire(self._codec, kind, message.payload) if is_sheet else None
        value = json.loads(message.payload) if value is None else value
        edit(value)
        payload = to_wire(self._codec, kind, value) if is_sheet else json.dumps(value).encode()
        return message._replace(payload=payload)

    def _on_map(self, message: Any) -> Any:
        """Returns a message with the name of the vehicle's map."""
        vehicle: Any = self.vehicle
        if isinstance(message, (VehicleState, Visualization)) and message.position:
            at = replace(message.position, map_id=vehicle.map_id)
            message = replace(message, position=at)
        if isinstance(message, VehicleState):
            states = (
                replace(n, position=n.position and replace(n.position, map_id=vehicle.map_id))
                for n in message.nodes
            )
            sets = tuple(replace(s, map_id=vehicle.map_id) for s in message.zone_sets)
            maps = (vehicle.map_id,)
            message = replace(message, nodes=tuple(states), maps=maps, zone_sets=sets)
        return message

    def _on_connect(self) -> None:
        self.sent(self._online)
        super()._on_connect()

    def _on_message(self, topic: str, payload: bytes, retained: bool) -> None:
        self.before()
        super()._on_message(topic, payload, retained)
        kind = topic.rpartition("/")[2]
        known = {known.value for known in heard_by_vehicle(self._codec.version)}
        if kind in known and not retained:
            self.heard(Kind(kind), payload)
