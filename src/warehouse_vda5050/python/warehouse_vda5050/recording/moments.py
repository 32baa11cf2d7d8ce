# SPDX-License-Identifier: Apache-2.0
"""What the vehicles of a recording did at any moment: order, base and horizon, state and errors."""

import json
import sys
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Generic, TypeVar

from warehouse_vda5050.master.robots_file import MOST_NUMBER
from warehouse_vda5050.recording.entry import Entry
from warehouse_vda5050.topics import Identity, Kind

Texts = tuple[str, ...]
Item = TypeVar("Item")


@dataclass(frozen=True)
class Doing:
    """What a state reports of a vehicle. base, horizon: the nodes ahead, by whether they are
    released."""

    order: str = ""
    update: int = 0
    last_node: str = ""
    base: Texts = ()
    horizon: Texts = ()
    driving: bool = False
    paused: bool = False
    mode: str = ""
    actions: Texts = ()
    errors: Texts = ()


@dataclass(frozen=True)
class Moment:
    """A vehicle at one time. told_at: when the state came [s since 1970], None without one;
    ordered, ordered_update: the newest order that it was sent."""

    identity: Identity
    number: int  # of its robot
    is_ours: bool  # a vehicle of another maker, which the warehouse drives
    connection: str
    doing: Doing
    told_at: float | None
    ordered: str
    ordered_update: int


class Timeline(Generic[Item]):
    """Values by the times from which they hold; times ascend."""

    def __init__(self) -> None:
        self._times: list[float] = []
        self._items: list[Item] = []

    def add(self, time: float, item: Item) -> None:
        """Adds a value; a time before the last one, after a clock was set back, counts as that."""
        self._times.append(max(time, self._times[-1]) if self._times else time)
        self._items.append(item)

    def at(self, time: float) -> tuple[float, Item] | None:
        """Returns the value that held at a time, and since when; None before the first."""
        place = bisect_right(self._times, time) - 1
        return None if place < 0 else (self._times[place], self._items[place])


@dataclass
class _Track:
    number: int
    is_ours: bool
    connection: Timeline[str] = field(default_factory=Timeline)
    doing: Timeline[Doing] = field(default_factory=Timeline)
    order: Timeline[tuple[str, int]] = field(default_factory=Timeline)
    last: Doing = field(default_factory=Doing)


class Moments:
    """The vehicles of a recording at any time.

    `robots`: the numbers of vehicles of other makers. Others are robots whose number is their
    serial, as vehicles.launch has it; what is neither is left out.
    """

    def __init__(self, entries: Iterable[Entry], robots: Mapping[Identity, int]) -> None:
        self._robots, self._tracks = dict(robots), dict[Identity, _Track]()
        for entry in entries:
            self._take(entry)

    @property
    def count(self) -> int:
        """The count of vehicles."""
        return len(self._tracks)

    def at(self, time: float) -> Iterator[Moment]:
        """Yields the vehicles of which a message had come by then [s since 1970]."""
        for identity, track in self._tracks.items():
            connection, doing = track.connection.at(time), track.doing.at(time)
            if connection is None and doing is None:
                continue
            _, (ordered, update) = track.order.at(time) or (0.0, ("", 0))
            yield Moment(
                identity,
                track.number,
                track.is_ours,
                connection[1] if connection else "ONLINE",
                doing[1] if doing else Doing(),
                doing[0] if doing else None,
                ordered,
                update,
            )

    def _take(self, entry: Entry) -> None:
        """Takes a message; what can't be read says nothing of a vehicle."""
        parts = entry.topic.rsplit("/", 3)
        if len(parts) < 4 or not entry.payload:
            return
        track = self._track(Identity(*parts[1:3]))
        if track is None:
            return
        try:
            value = json.loads(entry.payload)
        except (ValueError, RecursionError):
            return
        if not isinstance(value, dict):
            return
        if parts[3] == Kind.CONNECTION.value:
            track.connection.add(entry.time, _text(value, "connectionState") or "OFFLINE")
        elif parts[3] == Kind.ORDER.value and not entry.retain:
            track.order.add(entry.time, (_text(value, "orderId"), _whole(value, "orderUpdateId")))
        elif parts[3] == Kind.STATE.value:
            doing = _doing(value)
            track.last = track.last if doing == track.last else doing  # held once
            track.doing.add(entry.time, track.last)

    def _track(self, identity: Identity) -> _Track | None:
        if identity in self._tracks:
            return self._tracks[identity]
        is_ours = identity in self._robots
        number = self._robots[identity] if is_ours else _number(identity.serial)
        if not number or (not is_ours and number in self._robots.values()):
            return None
        self._tracks[identity] = _Track(number, is_ours)
        return self._tracks[identity]


def _number(serial: str) -> int:
    is_number = serial.isascii() and serial.isdigit() and len(serial) < 8
    return int(serial) if is_number and int(serial) <= MOST_NUMBER else 0


def _doing(value: Mapping[str, Any]) -> Doing:
    doing = Doing(
        _text(value, "orderId"),
        _whole(value, "orderUpdateId"),
        _text(value, "lastNodeId"),
        driving=value.get("driving") is True,
        paused=value.get("paused") is True,
        mode=_text(value, "operatingMode"),
        actions=tuple(_actions(value)),
        errors=tuple(_errors(value)),
    )
    nodes = sorted(_objects(value, "nodeStates"), key=lambda node: _whole(node, "sequenceId"))
    names = [(sys.intern(_text(n, "nodeId")), n.get("released") is True) for n in nodes]
    base = tuple(name for name, released in names if released)
    return replace(doing, base=base, horizon=tuple(n for n, released in names if not released))


def _actions(value: Mapping[str, Any]) -> Iterator[str]:
    for action in _objects(value, "actionStates"):
        status = _text(action, "actionStatus")
        if status not in ("FINISHED", "FAILED"):
            yield f"{_text(action, 'actionType') or _text(action, 'actionId')} {status}"


def _errors(value: Mapping[str, Any]) -> Iterator[str]:
    for error in _objects(value, "errors"):
        text = f"{_text(error, 'errorLevel')} {_text(error, 'errorType')}"
        description = _text(error, "errorDescription")
        yield f"{text}: {description}" if description else text


def _objects(value: Mapping[str, Any], name: str) -> list[dict[str, Any]]:
    items = value.get(name)
    return [i for i in items if isinstance(i, dict)] if isinstance(items, list) else []


def _text(value: Mapping[str, Any], name: str) -> str:
    text = value.get(name)
    return text if isinstance(text, str) else ""


def _whole(value: Mapping[str, Any], name: str) -> int:
    number = value.get(name)
    return number if isinstance(number, int) and not isinstance(number, bool) else 0
