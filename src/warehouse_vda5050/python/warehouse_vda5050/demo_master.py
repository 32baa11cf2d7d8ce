# SPDX-License-Identifier: Apache-2.0
"""A small master: fetches a unit with one vehicle, carries it to a station, puts it down.

It knows the warehouse from a map, and robots from their MQTT messages.
"""

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any

from warehouse_vda5050.codec import Codec
from warehouse_vda5050.grid import Cell, Grid
from warehouse_vda5050.headers import Headers
from warehouse_vda5050.model import (
    MAP_ID,
    Action,
    ActionStatus,
    BlockingType,
    Connection,
    ConnectionState,
    Edge,
    InstantActions,
    Node,
    Position,
    VehicleOrder,
    VehicleState,
)
from warehouse_vda5050.mqtt.loop import Link, MqttLoop, Outgoing
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.topics import Identity, Kind, TopicError, Topics
from warehouse_vda5050.validation import MessageError


class TripError(RuntimeError):
    """The trip did not come to its end; the message says where and why."""


def order_of(
    id: str, cells: Sequence[Cell], grid: Grid, actions: dict[int, Action] | None = None
) -> VehicleOrder:
    """Returns an order through cells, all released; `actions` maps a node's index to its action."""
    actions = actions or {}
    nodes = tuple(
        Node(
            grid.node_id(cell),
            2 * k,
            True,
            Position(*grid.position(cell), map_id=MAP_ID),
            (actions[k],) if k in actions else (),
        )
        for k, cell in enumerate(cells)
    )
    edges = tuple(
        Edge(f"{a.id}-{b.id}", a.sequence + 1, True, a.id, b.id) for a, b in zip(nodes, nodes[1:])
    )
    return VehicleOrder(id, 0, nodes, edges)


class DemoMaster:
    """Drives vehicles at a broker. `write` takes what happens, a line each."""

    def __init__(
        self,
        broker: BrokerSettings,
        codec: Codec,
        topics: Topics,
        write: Callable[[str], None] = print,
    ) -> None:
        self.states: dict[Identity, VehicleState] = {}
        self.online: dict[Identity, bool] = {}
        self._codec, self._topics, self._write = codec, topics, write
        self._headers: dict[Identity, Headers] = {}
        self._loop = MqttLoop()
        filters = [(topics.everyone(kind), kind.qos) for kind in (Kind.STATE, Kind.CONNECTION)]
        self._link = self._loop.add(Link(f"demo-{time.time_ns()}", broker, filters, self._hear))

    def close(self) -> None:
        """Disconnects."""
        self._link.close()
        self._loop.close()

    def _hear(self, topic: str, payload: bytes, _retained: bool) -> None:
        try:
            who, kind = self._topics.parse(topic)
            message: Any = self._codec.decode(kind, payload).message
        except (MessageError, TopicError) as error:
            self._write(f"{topic}: {error}")
            return
        if isinstance(message, Connection):
            self.online[who] = message.state is ConnectionState.ONLINE
        else:
            self.states[who] = message

    def until(self, condition: Callable[[], Any], seconds: float, what: str) -> Any:
        """Waits for condition() to be true; returns what it returned. Raises TripError."""
        end = time.monotonic() + seconds
        while not (result := condition()):
            self._loop.poll(0.05)
            if time.monotonic() > end:
                raise TripError(f"{what} did not come in time")
        return result

    def ask_for_state(self, who: Identity) -> None:
        """Asks a vehicle for its state."""
        action = Action("stateRequest", f"state-{time.time_ns()}", BlockingType.NONE)
        self._send(who, Kind.INSTANT_ACTIONS, InstantActions((action,)))

    def known(self) -> list[Identity]:
        """Returns the vehicles that are online and have reported a position."""
        return [
            who for who, state in self.states.items() if self.online.get(who) and state.position
        ]

    def wait_for_vehicles(self, count: int = 1, seconds: float = 60.0) -> list[Identity]:
        """Returns the vehicles that are there, `count` at least. Raises TripError if there are
        fewer."""
        self.until(lambda: sum(self.online.values()) >= count, seconds, f"{count} vehicles")
        for who in [who for who, online in self.online.items() if online]:
            self.ask_for_state(who)
        return self.until(
            lambda: len(known := self.known()) >= count and known,
            seconds,
            f"the states of {count} vehicles",
        )

    def _send(self, who: Identity, kind: Kind, message: Any) -> None:
        headers = self._headers.setdefault(who, Headers(who, self._codec.version))
        payload = self._codec.encode(replace(message, header=headers.next(kind)))
        self._link.publish(Outgoing(self._topics.of(who, kind), payload, kind.qos))

    def carry_out(self, who: Identity, order: VehicleOrder, seconds: float = 300.0) -> VehicleState:
        """Sends an order and waits until it is carried out. Raises TripError."""
        self._write(f"{who.serial}: order {order.id}, {len(order.nodes)} nodes")
        self._send(who, Kind.ORDER, order)
        lines: list[str] = []
        return self.until(lambda: self._follow(who, order, lines), seconds, f"order {order.id}")

    def _follow(self, who: Identity, order: VehicleOrder, states: list[str]) -> VehicleState | None:
        """Writes how far an order is; returns the state once it is over."""
        state = self.states[who]
        if state.order_id != order.id:
            if state.errors and any(("orderId", order.id) in e.references for e in state.errors):
                raise TripError(f"{who.serial} refuses: {state.errors[-1].description}")
            return None
        for line in _progress(state):
            if line not in states:
                states.append(line)
                self._write(f"{who.serial}: {line}")
        failed = [a for a in state.actions if a.status is ActionStatus.FAILED and not a.instant]
        if failed:
            raise TripError(f"{who.serial}: {failed[0].type} failed: {failed[0].result}")
        if state.nodes or state.driving or not all(a.status.is_over for a in state.actions):
            return None
        if state.last_node_sequence != order.nodes[-1].sequence:
            raise TripError(f"{who.serial}: order {order.id} was ended at {state.last_node}")
        return state


def _progress(state: VehicleState) -> Iterable[str]:
    yield f"at {state.last_node}"
    yield from (f"{action.type} is {action.status.value}" for action in state.actions)
    yield from (f"{error.level.value}: {error.description}" for error in state.errors)
