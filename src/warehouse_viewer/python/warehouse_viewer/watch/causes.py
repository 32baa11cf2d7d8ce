# SPDX-License-Identifier: Apache-2.0
"""Joins what is wrong to failures with their consequences: one alarm for each cause."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import NamedTuple

from warehouse_viewer.watch.alarm_book import OF_ROBOT, Trouble
from warehouse_viewer.watch.alarm_kinds import KINDS
from warehouse_viewer.watch.reasons import Reasons
from warehouse_viewer.watch.troubles import QUEUED, STARVED, patience

SHOWN = 6  # robots that a consequence names
MINUTE = 60.0  # [s]


class Remedy(NamedTuple):
    """What a person can do about an alarm: `action` on `target`, under the words of its button."""

    action: str
    label: str
    target: str


def by_cause(pending: Iterable[Trouble], reasons: Reasons, now: float) -> list[Trouble]:
    """Returns a Trouble for each cause, at `now` [s]: what follows from it is among its
    consequences."""
    causes, rest = _robots_at_fault(pending)
    waiting, stuck = reasons.waiting(), reasons.stuck()
    rest = _waits_by_root(rest, causes, reasons, now)
    for name, cause in causes.items():
        robot = int(name.removeprefix("kiva"))
        causes[name] = _with_queue(cause, waiting.get(robot, []), stuck.get(robot, []), now)
    starved = {station for rows in stuck.values() for station, _, _ in rows}
    rest = [t for t in rest if t.kind != "STATION_STARVED" or _is_news(t, starved, reasons, now)]
    rest = _with_watchdog(causes, rest)
    return [*causes.values(), *rest]


def _is_news(trouble: Trouble, explained: Collection[str], reasons: Reasons, now: float) -> bool:
    """Returns whether a station stands still for no fault of a robot, and for as long as an alarm
    takes: after a repair its next unit is on its way."""
    station = trouble.subject
    return station not in explained and now - reasons.explained(station) >= STARVED


def _robots_at_fault(pending: Iterable[Trouble]) -> tuple[dict[str, Trouble], list[Trouble]]:
    """Returns one Trouble for each robot that is at fault, and what is left."""
    causes: dict[str, Trouble] = {}
    rest = []
    for trouble in pending:
        if trouble.kind not in OF_ROBOT or not trouble.subject.startswith("kiva"):
            rest.append(trouble)
            continue
        known = causes.get(trouble.subject)
        causes[trouble.subject] = _joined(known, trouble) if known else trouble
    return causes, rest


def _joined(known: Trouble, other: Trouble) -> Trouble:
    """Returns the worse of two Troubles of a robot, with the other's text."""
    first, second = sorted((known, other), key=lambda t: OF_ROBOT.index(t.kind))
    if first.kind == second.kind:
        longest = max(first.text, second.text, key=len)
        return first._replace(text=longest, since=_earlier(first.since, second.since))
    text = second.text.removeprefix(f"{second.subject}: ")
    return first._replace(consequences=(*first.consequences, *second.consequences, text))


def _earlier(first: float | None, other: float | None) -> float | None:
    known = [since for since in (first, other) if since is not None]
    return min(known) if known else None


def _waits_by_root(
    rest: list[Trouble], causes: dict[str, Trouble], reasons: Reasons, now: float
) -> list[Trouble]:
    """Leaves out robots that wait for one at fault, or did until a moment ago: what has waited for
    it moves soon. Behind one that works a queue moves on, and is given the time of one. Those that
    wait for a robot that a person holds, or that itself waits, are one Trouble of that robot, which
    is added to `causes`."""
    out = []
    for trouble in rest:
        if trouble.kind != "ROBOT_WAITS":
            out.append(trouble)
            continue
        root = reasons.root(int(trouble.subject.removeprefix("kiva")))
        name, known = f"kiva{root}", causes.get(f"kiva{root}")
        since = trouble.since or 0.0
        if not reasons.fault(root):
            since = max(since, *map(reasons.explained, (trouble.subject, name)))
        if now - since < (QUEUED if reasons.works(root) else patience(trouble.text)):
            continue
        if known is None:
            text = f"{name} {reasons.robot(root).text}"
            causes[name] = Trouble("ROBOT_WAITS", name, text, since)
        elif known.kind == "ROBOT_WAITS":
            causes[name] = known._replace(since=_earlier(known.since, since))
    return out


def _with_queue(
    cause: Trouble, robots: Collection[int], stations: list[tuple[str, int, float]], now: float
) -> Trouble:
    """Adds the robots that wait behind a cause, and the stations that stand still for it."""
    follows = []
    if robots:
        names = [f"kiva{robot}" for robot in robots]
        more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
        verb = "waits" if len(names) == 1 else "wait"
        count = "1 robot" if len(names) == 1 else f"{len(names)} robots"
        follows.append(f"{count} {verb} behind it: {', '.join(names[:SHOWN])}{more}")
    follows += [
        f"{name} stands still for {span(now - since)}: unit {unit} does not come"
        for name, unit, since in stations
    ]
    return cause._replace(consequences=(*follows, *cause.consequences), queue=len(robots))


def _with_watchdog(causes: dict[str, Trouble], rest: list[Trouble]) -> list[Trouble]:
    """Puts the watchdog's alarm among the consequences of the cause with the longest queue."""
    alarms = [trouble for trouble in rest if trouble.kind == "WATCHDOG"]
    if not alarms or not causes:
        return rest
    name = max(causes, key=lambda name: causes[name].queue)
    texts = tuple(trouble.text for trouble in alarms)
    causes[name] = causes[name]._replace(consequences=(*causes[name].consequences, *texts))
    return [trouble for trouble in rest if trouble.kind != "WATCHDOG"]


def span(seconds: float) -> str:
    """Returns a time as the pages write it: 40 s, 12 min, 1 h 5 min."""
    if seconds < 100:
        return f"{max(0, round(seconds))} s"
    minutes = round(seconds / MINUTE)
    return f"{minutes} min" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"


def remedies(trouble: Trouble, modes: Mapping[str, str]) -> list[Remedy]:
    """Returns what a person can do about a Trouble. `modes`: of robots that are not automatic, and
    of stations that are manual."""
    name = trouble.subject
    mode = modes.get(name, "AUTOMATIC")
    actions = [action for action in KINDS[trouble.kind].remedies if _fits(action, name, mode)]
    return [Remedy(action, LABELS[action], name) for action in actions]


LABELS = {
    "SHOW": "Show on the floor",
    "OUT_OF_SERVICE": "Out of service",
    "REPAIR": "Repair",
    "TOW": "Tow",
    "AUTOMATIC": "Automatic again",
    "PICK_UP": "Pick it up",
    "STATION_AUTOMATIC": "Automatic again",
    "CLOSE": "Close",
    "RELEASE": "Release the stop",
    "MOMENT": "Go to the moment",
}
LINKS = ("SHOW", "MOMENT")  # actions that need no request to the server


def _fits(action: str, name: str, mode: str) -> bool:
    is_robot = name.startswith("kiva")
    return {
        "OUT_OF_SERVICE": is_robot and mode != "OUT_OF_SERVICE",
        "AUTOMATIC": is_robot and mode != "AUTOMATIC",
        "REPAIR": is_robot,
        "TOW": is_robot,
        "PICK_UP": name.startswith("item"),
    }.get(action, True)
