# SPDX-License-Identifier: Apache-2.0
"""What a case has in its hands: vehicles, all messages, and waiting for what the master does."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from warehouse_vda5050.codec import Codec
from warehouse_vda5050.conform.log import Entry, Log
from warehouse_vda5050.conform.master.actor import Actor, Role
from warehouse_vda5050.conform.master.facts import Scene
from warehouse_vda5050.conform.master.settings import Settings
from warehouse_vda5050.conform.master.wire import StageWire
from warehouse_vda5050.conform.names import of_wire
from warehouse_vda5050.conform.verdict import Interrupted, Untestable, demand
from warehouse_vda5050.conform.wire import Arrived
from warehouse_vda5050.mqtt.loop import Outgoing
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.topics import Kind, TopicError, Topics, heard_by_vehicle

Json = dict[str, Any]
STEP = 0.05  # [s]
LEAST = 2.0  # until a person is asked for an order [s]
LAG = 1.0  # between two connections for one message [s]


class Stage:
    """Vehicles that one master drives. say(text) asks a person for something. `orders` are those in
    the log's first `orders_at` messages, as orders_of() returns them."""

    def __init__(
        self,
        wire: StageWire,
        roles: Sequence[Role],
        codec: Codec,
        topics: Topics,
        settings: Settings,
        map_id: str = "warehouse",
        broker: BrokerSettings | None = None,
        say: Callable[[str], None] = lambda _text: None,
    ) -> None:
        self.wire, self.codec, self.topics, self.settings = wire, codec, topics, settings
        self.log, self.observed, self.foreign = Log(), Log(), Log()
        self.orders: list[Any] = []
        self.orders_at = -1
        self.interrupted = False
        self._say, self._said = say, False
        self._fruitless = 0  # waits for an order in a row that came to nothing
        self._began, self._end = wire.now(), float("inf")
        self._ours: list[tuple[str, bytes, float]] = []  # messages of vehicles, lately
        self._unmatched: list[tuple[Arrived, float]] = []  # that no vehicle has received yet
        self._received: list[tuple[str, bytes, float]] = []  # by vehicles, lately
        wire.take = self._observe
        self.actors = [
            Actor(
                role,
                map_id,
                codec,
                topics,
                wire,
                broker or BrokerSettings(),
                self._hear,
                self._note_sent,
            )
            for role in roles
        ]
        for actor in self.actors:
            for kind in Kind:
                wire.hear(topics.of(actor.role.identity, kind))

    # --- messages

    def _add(self, log: Log, actor: Actor, kind: Kind, payload: bytes, **how: Any) -> None:
        value = of_wire(self.codec, kind, payload)
        log.add(Entry(self.now(), kind, payload, value, vehicle=actor.name, **how))

    def _hear(self, actor: Actor, kind: Kind, payload: bytes, scene: Scene) -> None:
        topic = self.topics.of(actor.role.identity, kind)
        self._received.append((topic, payload, self.now()))
        self._add(self.log, actor, kind, payload, scene=self._local(scene))

    def _note_sent(self, actor: Actor, message: Outgoing) -> None:
        self._ours.append((message.topic, message.payload, self.now()))
        kind = Kind(message.topic.rpartition("/")[2])
        self._add(self.log, actor, kind, message.payload, sent=True)

    def _local(self, scene: Scene) -> Scene:
        """Returns facts with times since the run began."""
        return {name: fact._replace(since=fact.since - self._began) for name, fact in scene.items()}

    def _observe(self, message: Arrived) -> None:
        try:
            identity, kind = self.topics.parse(message.topic)
        except TopicError:
            return
        actor = next((a for a in self.actors if a.role.identity == identity), None)
        if actor is None:
            return
        if kind in self.to_vehicle:
            how = {"qos": message.qos, "retained": message.retained}
            self._add(self.observed, actor, kind, message.payload, **how)
            if not message.retained and not self._take_from(self._received, message):
                self._unmatched.append((message, self.now()))
        elif not self._take_from(self._ours, message) and not message.retained:
            is_will = kind is Kind.CONNECTION and b"BROKEN" in message.payload
            log = self.log if is_will else self.foreign
            self._add(log, actor, kind, message.payload, sent=is_will)

    @staticmethod
    def _take_from(known: list[tuple[str, bytes, float]], message: Arrived) -> bool:
        for k, (topic, payload, _) in enumerate(known):
            if (topic, payload) == (message.topic, message.payload):
                del known[k]
                return True
        return False

    def _match(self) -> None:
        """Notes what the master has sent to vehicles that did not receive it."""
        now, waiting = self.now(), []
        for message, since in self._unmatched:
            if self._take_from(self._received, message):
                continue
            if now - since < LAG:
                waiting.append((message, since))
                continue
            identity, kind = self.topics.parse(message.topic)
            actor = next(a for a in self.actors if a.role.identity == identity)
            scene = self._local(actor.facts.scene())
            self._add(self.log, actor, kind, message.payload, scene=scene, missed=True)
        self._unmatched = waiting
        self._received = [row for row in self._received if now - row[2] < 10 * LAG]
        self._ours = [row for row in self._ours if now - row[2] < 10 * LAG]

    # --- time

    def now(self) -> float:
        """Returns the time since the run began [s]."""
        return self.wire.now() - self._began

    def limit(self, seconds: float) -> None:
        """Ends all waiting after a number of seconds."""
        self._end = self.now() + seconds

    def poll(self) -> None:
        """Goes on for a moment. Raises Interrupted, and Differs at the limit."""
        if self.interrupted:
            raise Interrupted
        if self.now() > self._end:
            raise Untestable("no verdict within the time of a case")
        self.wire.poll(STEP)
        for actor in self.actors:
            actor.tick(self.wire.now())
        self._match()

    def wait(self, seconds: float) -> None:
        """Goes on for a while."""
        end = self.now() + seconds
        while self.now() < end:
            self.poll()

    def until(self, condition: Callable[[], Any], seconds: float) -> Any:
        """Returns what condition() returns once that is true, or after `seconds`."""
        end = self.now() + seconds
        while not (result := condition()) and self.now() < end:
            self.poll()
        return result

    # --- what the master sends

    @property
    def mark(self) -> int:
        """The number of the next message."""
        return len(self.log.entries)

    def received(self, kind: Kind, since: int = 0, actor: Actor | None = None) -> list[Entry]:
        """Returns messages of the master, from number `since` on."""
        entries = self.log.heard(kind, since)
        return [e for e in entries if actor is None or e.vehicle == actor.name]

    def an_order(self, since: int, actor: Actor | None = None, accepted: bool = True) -> Entry:
        """Waits for an order, or an update; returns the first from number `since` on that its
        vehicle took over, or whichever it is. Raises Untestable if the master sends none."""

        def newest() -> Entry | None:
            entries = self.received(Kind.ORDER, since, actor)
            fit = (e for e in entries if not accepted or e.scene["accepted"].value)
            return next((e for e in fit if not e.missed), None)

        entry = self._awaited(newest, actor)
        assert isinstance(entry, Entry)
        return entry

    def _awaited(self, condition: Callable[[], Any], actor: Actor | None) -> Any:
        """Waits for the master as long as it is worth it. Raises Untestable."""
        settings = self.settings
        seconds = settings.impatience if self._fruitless >= 2 else settings.patience
        result = self.until(condition, min(LEAST, seconds))
        if not result:
            self._ask(actor)
            result = self.until(condition, seconds)
        if result:
            self._fruitless = 0
            return result
        self._fruitless += 1
        name = actor.name if actor else " or ".join(a.name for a in self.actors)
        raise Untestable(f"the master sent no order to {name} within {seconds:.0f} s")

    def _ask(self, actor: Actor | None) -> None:
        if not self._said:
            name = actor.name if actor else " or ".join(a.name for a in self.actors)
            self._say(f"let the master send an order to {name}, and more whenever it has none")
            self._said = True

    def under_way(self, edges: int = 1) -> Actor:
        """Returns a vehicle with an order under way that has a number of edges left. Raises
        Untestable."""

        def busy() -> Actor | None:
            rows = ((a, a.vehicle.state()) for a in self.actors)
            return next((a for a, s in rows if len(s.edges) >= edges and not s.paused), None)

        actor = self._awaited(busy, None)
        assert isinstance(actor, Actor)
        return actor

    def idle(self, actor: Actor | None = None) -> Actor:
        """Returns a vehicle whose order is over, of those that had one. Raises Untestable."""
        chosen = [actor] if actor else self.actors

        def ended() -> Actor | None:
            had = (a for a in chosen if a.vehicle.order is not None)
            return next((a for a in had if not a.is_busy), None)

        if not any(a.vehicle.order for a in chosen):
            self.an_order(self.mark, actor)
        found_idle = self.until(ended, self.settings.trip)
        if not found_idle:
            raise Untestable("no order came to its end")
        assert isinstance(found_idle, Actor)
        return found_idle

    def no_orders(self, actor: Actor, why: str, seconds: float | None = None) -> None:
        """Raises Differs if the master sends an order to a vehicle, from some time after now on."""
        self.wait(self.settings.reaction)
        mark = self.mark
        self.wait(self.settings.watch if seconds is None else seconds)
        orders = self.received(Kind.ORDER, mark, actor)
        demand(not orders, f"{len(orders)} orders {why}")

    def goes_on(self, actor: Actor) -> Entry:
        """Ends all accidents of a vehicle; returns the first order after them. Raises
        Untestable."""
        actor.calm()
        if actor.is_busy:
            self.until(lambda: not actor.is_busy, self.settings.trip)
        return self.an_order(self.mark, actor)

    @property
    def is_new(self) -> bool:
        """Whether the version is 3.0."""
        return self.codec.version.startswith("3")

    @property
    def to_vehicle(self) -> tuple[Kind, ...]:
        """The kinds of messages that are the master's, in the version."""
        return heard_by_vehicle(self.codec.version)

    def close(self) -> None:
        """Says OFFLINE for all vehicles, and disconnects."""
        for actor in self.actors:
            actor.link.close()
        self.wire.close()
