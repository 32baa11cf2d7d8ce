# SPDX-License-Identifier: Apache-2.0
"""What a case has in its hands: messages to the vehicle, and demands on what comes back."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from warehouse_vda5050.codec import Codec
from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.ground import Ground, Place
from warehouse_vda5050.conform.log import Entry, Log
from warehouse_vda5050.conform.names import of_wire, to_wire
from warehouse_vda5050.conform.orders import action_of, order_of
from warehouse_vda5050.conform.settings import Settings
from warehouse_vda5050.conform.verdict import (
    Differs,
    Interrupted,
    Unsupported,
    Untestable,
    demand,
)
from warehouse_vda5050.conform.wire import Arrived, Wire
from warehouse_vda5050.headers import Headers
from warehouse_vda5050.topics import FROM_VEHICLE, Identity, Kind, TopicError, Topics

Json = dict[str, Any]
Condition = Callable[[Json], object]
Actions = dict[int, list[Json]]  # by the index of their node


class Probe:
    """One vehicle, as a master sees it. `ground` is known once begin() has seen a state."""

    def __init__(
        self,
        wire: Wire,
        vehicle: Identity,
        codec: Codec,
        topics: Topics,
        settings: Settings,
        run: str,
    ) -> None:
        self.wire, self.vehicle, self.codec, self.topics = wire, vehicle, codec, topics
        self.settings, self.log = settings, Log()
        self.ground: Ground | None = None
        self.interrupted = False  # whether a person ends the run
        self.settling = False  # whether what a case left is being ended, in any case
        self._headers = Headers(vehicle, codec.version)
        self._began = wire.now()
        self._end = float("inf")
        self._run, self._numbers = run, itertools.count(1)
        wire.take = self._arrived
        for kind in FROM_VEHICLE:
            wire.subscribe(topics.of(vehicle, kind))

    # --- messages

    def _arrived(self, message: Arrived) -> None:
        try:
            who, kind = self.topics.parse(message.topic)
        except TopicError:
            return
        if who == self.vehicle:
            value = of_wire(self.codec, kind, message.payload)
            self._add(kind, message.payload, value, qos=message.qos, retained=message.retained)

    def _add(self, kind: Kind, payload: bytes, value: Json | None, **how: Any) -> None:
        self.log.add(Entry(self.now(), kind, payload, value, **how))

    def send(self, kind: Kind, value: Json, **header: Any) -> None:
        """Sends a message, with a header; `header` replaces fields of it, None leaves one out."""
        names = ("headerId", "timestamp", "version", "manufacturer", "serialNumber")
        ours = self._headers.next(kind)
        values = (ours.header_id, ours.timestamp, ours.version, ours.manufacturer, ours.serial)
        whole = {**dict(zip(names, values)), **header}
        whole = {key: item for key, item in whole.items() if item is not None}
        self.send_bytes(kind, to_wire(self.codec, kind, {**whole, **value}), {**whole, **value})

    def send_bytes(self, kind: Kind, payload: bytes, value: Json | None = None) -> None:
        """Sends a payload as it is."""
        self._add(kind, payload, value, sent=True)
        self.wire.publish(self.topics.of(self.vehicle, kind), payload)

    def order(self, order: Json) -> None:
        """Sends an order or an update."""
        self.send(Kind.ORDER, order)

    def instant(
        self, type: str, parameters: Iterable[tuple[str, Any]] = (), id: str = "", **more: str
    ) -> str:
        """Sends an instant action; returns its id."""
        action = action_of(type, id or self.new_id(type), more.get("blocking", "NONE"), parameters)
        self.send(Kind.INSTANT_ACTIONS, {"actions": [action]})
        return str(action["actionId"])

    def new_id(self, what: str = "order") -> str:
        """Returns an id that nothing had before."""
        return f"{what}-{self._run}-{next(self._numbers)}"

    # --- time

    def now(self) -> float:
        """Returns the time since the run began [s]."""
        return self.wire.now() - self._began

    def limit(self, seconds: float) -> None:
        """Ends all waiting after a number of seconds."""
        self._end = self.now() + seconds

    def poll(self) -> None:
        """Waits for a moment. Raises Differs at the limit, and Interrupted."""
        if self.interrupted and not self.settling:
            raise Interrupted
        demand(self.now() < self._end, "no verdict within the time of a case")
        self.wire.poll(0.05)

    def wait(self, seconds: float) -> None:
        """Waits."""
        end = self.now() + seconds
        while self.now() < end:
            self.poll()

    def until(self, condition: Condition, what: str, seconds: float | None = None) -> Json:
        """Returns the first state from now on, or the newest, that a condition holds for. Raises
        Differs after `seconds`, by default those of an answer."""
        mark = self.log.newest(lambda e: e.kind is Kind.STATE and not e.sent)
        limit = self.settings.answer if seconds is None else seconds
        end = self.now() + limit
        while True:
            count = len(self.log.entries)
            for state in self.log.values(Kind.STATE, mark):
                if condition(state):
                    return state
            mark = count
            if self.now() > end:
                raise Differs(f"{what}: not within {limit:.0f} s")
            self.poll()

    def never(self, condition: Condition, what: str, seconds: float) -> None:
        """Raises Differs if a state within `seconds` fulfils a condition."""
        mark = len(self.log.entries)
        self.wait(seconds)
        demand(not any(map(condition, self.log.values(Kind.STATE, mark))), what)

    # --- what is known of the vehicle

    @property
    def state(self) -> Json:
        """The newest state. Raises Untestable before the first."""
        state = self.log.last(Kind.STATE)
        if state is None:
            raise Untestable("the vehicle has sent no state that can be read")
        return state

    @property
    def sheet(self) -> Json:
        """The factsheet, {} before it came."""
        return self.log.last(Kind.FACTSHEET) or {}

    def supports(self, action: str, scope: str = "") -> bool:
        """Returns whether the factsheet has an action."""
        for row in view.rows(self.sheet.get("protocolFeatures"), "agvActions"):
            if row.get("actionType") == action:
                return not scope or scope in (row.get("actionScopes") or ())
        return False

    def need(self, action: str, scope: str = "") -> None:
        """Raises Unsupported unless the factsheet has an action."""
        if not self.supports(action, scope):
            raise Unsupported(f"the factsheet has no {action}{f' for {scope}' if scope else ''}")

    @property
    def is_new(self) -> bool:
        """Whether the version is 3.0."""
        return self.codec.version.startswith("3")

    # --- orders

    def here(self) -> int:
        """Returns the number of the place where the vehicle stands. Raises Untestable."""
        position = view.at(self.state)
        if self.ground is None or position is None:
            raise Untestable("where the vehicle stands is not known: no agvPosition")
        here = self.ground.at(*position)
        if here is None:
            x, y = position
            raise Untestable(
                f"the vehicle stands at {x:.2f}, {y:.2f}, which is no place it was given"
            )
        return here

    def way(self, edges: int) -> list[Place]:
        """Returns a way with a number of edges; drives to an end of the ground if there is too
        little room. Raises Untestable."""
        here = self.here()
        assert self.ground
        if edges > self.ground.edges:
            raise Untestable(f"it drives {edges} edges, and {self.ground.edges} are given")
        if edges > self.ground.room(here):
            self.drive(order_of(self.new_id(), self.ground.way(here, self.ground.room(here))))
            here = self.here()
        return self.ground.way(here, edges)

    def new_order(
        self, way: Sequence[Place], released: int | None = None, actions: Actions | None = None
    ) -> Json:
        """Returns a new order; `actions` maps the index of a node to its actions."""
        order = order_of(self.new_id(), way, released=released)
        for k, these in (actions or {}).items():
            order["nodes"][k]["actions"] = these
        return order

    def update(
        self, order: Json, way: Sequence[Place], first: int, released: int | None = None
    ) -> Json:
        """Returns the update of an order whose first node is number `first` of the way."""
        rest = way[first:]
        base = None if released is None else released - first
        number = order["orderUpdateId"] + 1
        return order_of(order["orderId"], rest, released=base, update=number, first=first)

    def accept(self, order: Json) -> Json:
        """Sends an order; returns the first state that has it. Raises Differs."""
        self.order(order)
        return self.until(lambda s: view.has(s, order), "the order in a state")

    def finish(self, order: Json, edges: int | None = None) -> Json:
        """Returns the state in which an order is over, at its last node. Raises Differs."""
        count = len(order["edges"]) if edges is None else edges
        seconds = self.settings.answer + self.settings.edge * max(1, count)
        state = self.until(lambda s: view.is_driven(s, order), "the order's end", seconds)
        goal, last = order["nodes"][-1]["sequenceId"], state.get("lastNodeSequenceId")
        demand(last == goal, f"the order ended at node {last}, not at {goal}")
        return state

    def drive(self, order: Json) -> Json:
        """Sends an order and waits for its end. Raises Differs."""
        self.accept(order)
        return self.finish(order)

    def driving(self) -> Json:
        """Returns the first state in which the vehicle drives. Raises Differs."""
        return self.until(lambda s: s.get("driving") is True, "driving true", self.settings.edge)

    def answer(self, what: str = "an answer") -> Json:
        """Returns the first state after the last message sent. Raises Differs."""
        mark = self.log.newest(lambda e: e.sent)
        end = self.now() + self.settings.answer
        while not (states := self.log.values(Kind.STATE, mark)):
            demand(self.now() < end, f"{what}: no state within {self.settings.answer:.0f} s")
            self.poll()
        return states[0]

    def over(self, action_id: str, what: str = "", seconds: float | None = None) -> str:
        """Waits for an action to be over; returns its status. Raises Differs."""
        state = self.until(
            lambda s: view.is_over(s, action_id), what or f"{action_id} over in a state", seconds
        )
        return view.status(state, action_id)

    def finished(self, action_id: str, seconds: float | None = None) -> Json:
        """Returns the state in which an action is FINISHED. Raises Differs."""
        state = self.until(
            lambda s: view.is_over(s, action_id), f"{action_id} over in a state", seconds
        )
        status = view.status(state, action_id)
        demand(status == "FINISHED", f"{action_id} is {status}; FINISHED was expected")
        return state

    # --- refusals

    def refused(
        self, send: Callable[[], object], types: Sequence[str] = (), refer: str = ""
    ) -> Json:
        """Sends something that has to be refused; returns the error for it. types: those that the
        specification has for it. refer: value that the references must have. Raises Differs."""
        before = [_key(error) for error in view.rows(self.state, "errors")]
        send()

        def new_errors(state: Json) -> list[Json]:
            errors = view.rows(state, "errors")
            return [e for e in errors if _key(e) not in before]

        state = self.until(new_errors, "an error in a state")
        errors = new_errors(state)
        error = next((e for e in errors if refer in view.references(e).values()), errors[0])
        level = error.get("errorLevel")
        demand(level == "WARNING" or self.is_new, f"errorLevel is {level}; WARNING was expected")
        if types and not self.is_new:
            kind = error.get("errorType")
            text = f"errorType is {kind}; {' or '.join(types)} was expected"
            demand(kind in types, text)
        return error

    def refuses(self, order: Json, *types: str) -> Json:
        """Sends an order that has to be refused; returns the error for it. Raises Differs if the
        vehicle takes it over, or says nothing."""
        before = self.state.get("orderId"), self.state.get("orderUpdateId")
        is_same = before == (order.get("orderId"), order.get("orderUpdateId"))
        error = self.refused(lambda: self.order(order), types, str(order.get("orderId")))
        after = self.state.get("orderId"), self.state.get("orderUpdateId")
        demand(is_same or after == before, f"the order was taken over: {after} after {before}")
        return error

    # --- actions

    def harmless(self, blocking: str = "HARD") -> Json:
        """Returns an action for a node that does no harm and ends by finish_actions(). Raises
        Unsupported."""
        type = self.settings.action
        if not type:
            type = "waitForTrigger"
            self.need(type, "NODE")
            self.need("trigger", "INSTANT")
        return action_of(type, self.new_id(type), blocking, self.settings.parameters)

    def running(self, action: Json) -> Json:
        """Returns the state in which an action runs. Raises Differs."""
        id, seconds = action["actionId"], self.settings.edge
        active = ["INITIALIZING", "RUNNING", "PAUSED"] + ["FINISHED"] * (not self.is_held)
        return self.until(lambda s: view.status(s, id) in active, f"{id} RUNNING", seconds)

    @property
    def is_held(self) -> bool:
        """Whether harmless actions run until finish_actions()."""
        return not self.settings.action

    def finish_actions(self) -> None:
        """Lets running harmless actions come to their end."""
        if self.is_held:
            self.instant("trigger")


def _key(error: Json) -> str:
    """Tells errors apart."""
    return repr(sorted((k, repr(v)) for k, v in error.items()))
