# SPDX-License-Identifier: Apache-2.0
"""The handover note of a shift, as Markdown: what the next people should know."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from warehouse_viewer.watch.causes import span

if TYPE_CHECKING:
    from warehouse_msgs.msg import CoordinatorState, Kpis

SHOWN = 30  # past alarms and commands
HOUR = 3600.0  # [s]


class Situation(NamedTuple):
    """What a note is written from; `since` and `now` are simulated [s]. Alarms, stations and
    commands are as the API has them; coordinator and kpis are None where none runs."""

    name: str
    since: float
    now: float
    stop: str | None
    alarms: Sequence[Mapping[str, Any]]
    past: Sequence[Mapping[str, Any]]
    robots: Sequence[Any]
    stations: Sequence[Mapping[str, Any]]
    commands: Sequence[Mapping[str, Any]]
    coordinator: CoordinatorState | None
    kpis: Kpis | None
    zones: Sequence[Mapping[str, Any]] = ()


def written(about: Situation, wall: str) -> str:
    """Returns the note; `wall`: the time on the wall."""
    begin, now = clock(about.since), clock(about.now)
    lines = [
        f"# Handover, {wall}",
        f"{about.name or 'Warehouse'}: from {begin} to {now} of simulated time",
        *_part("Look after", [*_open(about)] or ["nothing"]),
        *_part("Figures", _figures(about.kpis)),
        *_part("What happened", _past(about)),
        *_part("Who did what", _commands(about)),
        *_part("Remarks", ()),
    ]
    return "\n\n".join(lines) + "\n\n\n"


def clock(seconds: float) -> str:
    """Returns a simulated time as the pages write it: 0:02:05."""
    whole = int(max(0.0, seconds) + 1e-6)
    return f"{whole // 3600}:{whole // 60 % 60:02}:{whole % 60:02}"


def _part(title: str, rows: Iterable[str]) -> list[str]:
    texts = [f"- {row}" for row in rows]
    return [f"## {title}", *(["\n".join(texts)] if texts else [])]


def _open(about: Situation) -> Iterator[str]:
    """Yields what holds now."""
    if about.stop is not None:
        yield f"Emergency stop, by {about.stop}: no robot moves"
    for alarm in about.alarms:
        who = f"seen by {alarm['seen_by']}" if alarm["seen_by"] else "seen by no one yet"
        yield f"{alarm['title']}: {alarm['text']}, for {span(about.now - alarm['since'])}; {who}"
    for zone in about.zones:
        by = f", by {zone['closed_by']}" if zone["closed_by"] else ""
        until = "it is opened" if zone["until"] is None else clock(zone["until"])
        yield f"Zone '{zone['reason']}' is closed until {until}{by}"
    state = about.coordinator
    if state:
        yield from _named("Out of service", state.out_of_service_kiva)
        yield from _named("Manual", state.manual_kiva)
    broken = [robot for robot in about.robots if robot.failures]
    yield from _named("Broken", [robot.id for robot in broken])
    low = [robot.id for robot in about.robots if robot.charge < 0.2]
    yield from _named("Battery below 20 %", low)
    for station in about.stations:
        if not station["open"]:
            yield f"{station['name']} is closed"
        elif station["mode"] == "MANUAL":
            yield f"{station['name']} is manual"
    if about.kpis and about.kpis.items_on_floor:
        yield f"{about.kpis.items_on_floor} items lie on the floor"


def _named(what: str, robots: Sequence[int]) -> Iterator[str]:
    if robots:
        names = ", ".join(f"kiva{number}" for number in robots[:SHOWN])
        more = f" and {len(robots) - SHOWN} more" if len(robots) > SHOWN else ""
        yield f"{what}: {names}{more}"


def _figures(kpis: Kpis | None) -> Iterator[str]:
    if kpis is None:
        yield "no shift is running"
        return
    waiting = kpis.orders_waiting + kpis.orders_at_stations
    yield f"{kpis.orders_completed} orders done, {waiting} open, {kpis.orders_late} of them late"
    yield (
        f"{kpis.items_picked} pieces picked: {kpis.item_throughput_per_hour:.0f} an hour of at"
        f" most {kpis.item_upper_bound_per_hour:.0f}"
    )
    yield f"{kpis.collisions} collisions, {kpis.failures} failures of robots"
    yield f"robots available {100 * kpis.availability:.1f} %, stock {100 * kpis.stock_level:.0f} %"


def _past(about: Situation) -> Iterator[str]:
    recent = [alarm for alarm in about.past if alarm["until"] >= about.since]
    for alarm in reversed(recent[:SHOWN]):
        did = "; ".join(f"{row['by'] or 'no name'}: {row['what']}" for row in alarm["actions"])
        text = f"{clock(alarm['since'])}, for {span(alarm['duration'])}: {alarm['text']}"
        yield f"{text}; {did}" if did else text
    if len(recent) > SHOWN:
        yield f"{len(recent) - SHOWN} alarms before these"


def _commands(about: Situation) -> Iterator[str]:
    recent = [row for row in about.commands if row["time"] >= about.since and row["status"] < 400]
    for row in recent[-SHOWN:]:
        by = row["by"] or row["address"]
        yield f"{clock(row['time'])} {by}: {row['method']} {row['path']} {row['body']}".rstrip()
    if len(recent) > SHOWN:
        yield f"{len(recent) - SHOWN} commands before these: /api/v1/commands.csv"
