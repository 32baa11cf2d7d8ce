# SPDX-License-Identifier: Apache-2.0
"""Orders of a master in their context: what it sent before, and what the vehicle had of it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.log import Entry
from warehouse_vda5050.conform.master import form
from warehouse_vda5050.conform.master.facts import Scene, value_of
from warehouse_vda5050.conform.master.stage import Stage
from warehouse_vda5050.conform.verdict import Untestable
from warehouse_vda5050.topics import Kind

Json = dict[str, Any]
HEADER = ("headerId", "timestamp", "version", "manufacturer", "serialNumber")


@dataclass
class Course:
    """One order of one vehicle so far. sent: the content of each update, by its number; newest: the
    last of them; accepted: the last that the vehicle took over. nodes and edges: what is released,
    by sequenceId. refused: updates whose refusal was reported, and when."""

    id: str
    sent: dict[int, Json] = field(default_factory=dict)
    newest: int = -1
    accepted: int = -1
    nodes: dict[int, Json] = field(default_factory=dict)
    edges: dict[int, Json] = field(default_factory=dict)
    refused: dict[int, float] = field(default_factory=dict)
    cancelled_at: float | None = None

    def copy(self) -> Course:
        """Returns it as it is now."""
        return Course(
            self.id,
            {**self.sent},
            self.newest,
            self.accepted,
            {**self.nodes},
            {**self.edges},
            {**self.refused},
            self.cancelled_at,
        )


@dataclass(frozen=True)
class Ordered:
    """A message on the topic order. before: its order as it was, None if it is the first of it;
    earlier: the ids of all orders of this vehicle before."""

    entry: Entry
    value: Json
    before: Course | None
    earlier: frozenset[str]

    @property
    def scene(self) -> Scene:
        """What held of the vehicle."""
        return self.entry.scene

    @property
    def id(self) -> str:
        """Its orderId."""
        return str(self.value["orderId"])

    @property
    def update(self) -> int:
        """Its orderUpdateId."""
        return int(self.value["orderUpdateId"])

    @property
    def nodes(self) -> list[Json]:
        """Its nodes."""
        return view.rows(self.value, "nodes")

    @property
    def edges(self) -> list[Json]:
        """Its edges."""
        return view.rows(self.value, "edges")

    @property
    def is_new(self) -> bool:
        """Whether the vehicle has another order, or none."""
        return bool(self.id != value_of(self.scene, "order"))

    @property
    def is_copy(self) -> bool:
        """Whether this update was sent before."""
        return self.before is not None and self.update in self.before.sent

    @property
    def name(self) -> str:
        """The vehicle, the order and its update, for people."""
        return f"{self.entry.vehicle}: order {self.id} update {self.update}"


def orders_of(stage: Stage) -> list[Ordered]:
    """Returns all orders that have their form. Raises Untestable without any."""
    if stage.orders_at != stage.mark:
        stage.orders, stage.orders_at = [*_ordered(stage)], stage.mark
    if not stage.orders:
        raise Untestable("the master sent no order that can be read")
    return stage.orders


def updates_of(stage: Stage) -> list[Ordered]:
    """Returns the updates among them: those of an order that the vehicle has. Raises Untestable."""
    orders = orders_of(stage)
    updates = [o for o in orders if o.before and o.before.accepted >= 0 and not o.is_copy]
    if not updates:
        raise Untestable("the master sent no update of an order")
    return updates


def _ordered(stage: Stage) -> Iterator[Ordered]:
    courses: dict[tuple[str, str], Course] = {}
    active: dict[str, Course] = {}
    for entry in stage.log.entries:
        if entry.sent:
            _note_refusals(entry, active.get(entry.vehicle))
        elif entry.kind is Kind.INSTANT_ACTIONS:
            _note_cancel(entry, active.get(entry.vehicle))
        elif not form.faults(Kind.ORDER, entry.value, stage.codec.version):
            value = entry.value or {}
            key = entry.vehicle, value["orderId"]
            course = courses.get(key)
            earlier = frozenset(id for name, id in courses if name == entry.vehicle)
            yield Ordered(entry, value, course.copy() if course else None, earlier)
            courses[key] = active[entry.vehicle] = _after(course, entry, value)


def _after(course: Course | None, entry: Entry, value: Json) -> Course:
    course = course or Course(value["orderId"])
    number = value["orderUpdateId"]
    course.sent.setdefault(number, content(value))
    course.newest = max(course.newest, number)
    if value_of(entry.scene, "accepted") and number > course.accepted:
        course.accepted = number
        released = [n for n in view.rows(value, "nodes") if n["released"]]
        course.nodes.update((n["sequenceId"], n) for n in released)
        ways = [e for e in view.rows(value, "edges") if e["released"]]
        course.edges.update((e["sequenceId"], e) for e in ways)
    return course


def _note_refusals(entry: Entry, course: Course | None) -> None:
    if entry.kind is not Kind.STATE or course is None:
        return
    for error in view.rows(entry.value, "errors"):
        known = view.references(error)
        number = known.get("orderUpdateId", "")
        names_it = known.get("orderId") == course.id and number.isdecimal()
        if names_it and int(number) != course.accepted:
            course.refused.setdefault(int(number), entry.time)


def _note_cancel(entry: Entry, course: Course | None) -> None:
    kinds = [row.get("actionType") for row in view.rows(entry.value, "actions")]
    if course and "cancelOrder" in kinds and not entry.missed:
        course.cancelled_at = entry.time


def content(value: Json) -> Json:
    """Returns a message without its header."""
    return {key: item for key, item in value.items() if key not in HEADER}
