# SPDX-License-Identifier: Apache-2.0
"""Carries out the events of a scenario in a shift, each at its time."""

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np

from warehouse_operations.runs.event_file import Event
from warehouse_operations.runs.names import Names
from warehouse_operations.shift.shift import Shift
from warehouse_operations.stock.order_file import OrderDraft, read_csv
from warehouse_operations.stock.site import Site


class Scene(Protocol):
    """A shift with its fleet; ideal: whether robots are."""

    @property
    def shift(self) -> Shift:
        """The shift."""

    @property
    def fleet(self) -> Any:
        """An IdealFleet or a WorldFleet."""

    @property
    def site(self) -> Site:
        """The warehouse, with all robots."""

    @property
    def ideal(self) -> bool:
        """Whether robots are ideal."""


class Director:
    """Carries out events in a shift. spare: ids of robots that are out of service at first.

    Raises EventError at once for an event with an unknown station, robot or SKU.
    """

    def __init__(
        self, ops: Scene, events: Sequence[Event], spare: Sequence[int] = (), seed: int = 1
    ) -> None:
        self._ops, self._shift = ops, ops.shift
        self._rng = np.random.default_rng((seed, len(events)))
        self._spare = list(spare)[::-1]  # the next one last
        self._working = [robot for robot in sorted(ops.site.robots) if robot not in spare]
        for robot in spare:
            ops.fleet.set_in_service(robot, False)
        names = Names(
            [station.name for station in self._shift.stations],
            ops.site.robots,
            self._shift.assortment.skus,
            ops.ideal,
        )
        for event in events:
            names.check(event)
            self._shift.context.clock.schedule(self._shift.began + event.at, self._carry_out, event)

    def _carry_out(self, event: Event) -> None:
        self._shift.context.update_hash("event", event.kind, str(event.value))
        getattr(self, f"_{event.kind}")(event)

    def _close(self, event: Event) -> None:
        self._set_open(event.value, False)

    def _open(self, event: Event) -> None:
        self._set_open(event.value, True)

    def _set_open(self, name: str, is_open: bool) -> None:
        self._shift.set_station(name, is_open, self._shift.station(name).mode)

    def _robots(self, event: Event) -> None:
        for _ in range(abs(event.value)):
            source, target = self._spare, self._working
            if event.value < 0:
                source, target = target, source
            if not source:
                return
            robot = source.pop()
            target.append(robot)
            self._ops.fleet.set_in_service(robot, event.value > 0)

    def _fail(self, event: Event) -> None:
        robots = [event.value]
        if isinstance(event.value, float):
            count = max(round(event.value * len(self._working)), 1)
            count = min(count, len(self._working))
            robots = self._rng.choice(self._working, count, replace=False).tolist()
        for robot in robots:
            self._ops.fleet.fail(int(robot), event.duration)

    def _speed(self, event: Event) -> None:
        fleet: Any = self._ops.fleet
        fleet.set_speed(event.value)

    def _sku_out(self, event: Event) -> None:
        self._shift.take_out(event.value)

    def _orders(self, event: Event) -> None:
        now = self._shift.now
        for order in read_csv(event.value):
            self._shift.context.clock.schedule(now + order.at, self._submit, (order, now))

    def _submit(self, argument: tuple[OrderDraft, float]) -> None:
        order, begin = argument
        due = order.due + begin if order.due else 0.0
        _, text = self._shift.submit(order.lines, due, order.priority, order.reference)
        if text and not text.startswith("waits"):
            self._shift.notices.add(f"order {order.reference} is refused: {text}")

    def _picker(self, event: Event) -> None:
        station = self._shift.station(event.value["station"])
        if "seconds_a_piece" in event.value:
            station.set_pace(event.value["seconds_a_piece"])
        if "pickers" in event.value:
            station.set_pickers(event.value["pickers"], self._shift.now)
        station.next_work()

    def _priority(self, event: Event) -> None:
        name, priority = event.value["order"], event.value["to"]
        named = [order for order in self._shift.orders.values() if name in order.names]
        for order in named:
            self._shift.change_order(order.order_id, priority, None)
        if not named:
            self._shift.notices.add(f"order {name} is not open: it gets no other priority")

    def _policy(self, event: Event) -> None:
        self._shift.policies.change(event.value)
