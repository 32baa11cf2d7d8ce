# SPDX-License-Identifier: Apache-2.0
"""Zone sets, answers to requests, and orders that keep to zones (3.0.0: 6.4, 6.9). Sections are
those of 3.0.0; what a master closes is its own business, so most is judged at the end of the
run."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.log import Entry
from warehouse_vda5050.conform.master.actor import Actor
from warehouse_vda5050.conform.master.cases.actions import instant_actions
from warehouse_vda5050.conform.master.facts import held_for, value_of
from warehouse_vda5050.conform.master.orders import Ordered, orders_of
from warehouse_vda5050.conform.master.row import Row
from warehouse_vda5050.conform.master.stage import Stage
from warehouse_vda5050.conform.verdict import Untestable, demand
from warehouse_vda5050.model import OperatingMode
from warehouse_vda5050.schemas import why_invalid
from warehouse_vda5050.topics import Kind
from warehouse_vda5050.zones.outline import Box, area, overlaps
from warehouse_vda5050.zones.route import Stretch
from warehouse_vda5050.zones.zone import Point

chapter = Chapter("zones")
case = chapter.case
Json = dict[str, Any]
ONLY = ("3.0.0",)
DISABLED = 10.0  # for which the newest zone set may stay so [s]
ANSWERED = 5.0  # within which a request is answered [s]
STEP = 2.0  # between two states, the most that counts [s]
MOST, WINDOW = 10, 10.0  # answers to one request, and in which time [s]
FEW = 2  # zone sets to a vehicle that refuses each of them
DRIVEN = ("AUTOMATIC", "SEMIAUTOMATIC")  # modes in which a master is in control
NO_ZONE = "conform-none"


class Sent(NamedTuple):
    """A zone set as it was sent."""

    entry: Entry
    content: Json

    @property
    def id(self) -> str:
        """Its zoneSetId."""
        return str(self.content.get("zoneSetId"))

    @property
    def name(self) -> str:
        """The vehicle and the set, for people."""
        return f"{self.entry.vehicle}: zone set {self.id}"

    @property
    def zones(self) -> list[Json]:
        """Its zones."""
        return view.rows(self.content, "zones")


class Answer(Row):
    """A response as it was sent."""

    id_field = "requestId"

    @property
    def grant(self) -> str:
        """Its grantType."""
        return str(self.row.get("grantType"))

    @property
    def name(self) -> str:
        """The vehicle and the request, for people."""
        return f"{self.key[0]}: {self.grant} for {self.key[1]}"


def _sets(stage: Stage) -> list[Sent]:
    """Returns all zone sets. Raises Untestable without any."""
    entries = stage.received(Kind.ZONE_SET)
    contents = ((e, (e.value or {}).get("zoneSet")) for e in entries)
    sent = [Sent(e, content) for e, content in contents if isinstance(content, dict)]
    if not sent:
        raise Untestable("the master sent no zone set")
    return sent


def _answers(stage: Stage) -> Iterator[Answer]:
    for entry in stage.received(Kind.RESPONSES):
        yield from (Answer(entry, row) for row in view.rows(entry.value, "responses"))


def _corners(zone: Json) -> list[Point]:
    return [(float(v["x"]), float(v["y"])) for v in view.rows(zone, "vertices")]


# --- zone sets


@case("form", "7.6", audit=True, versions=ONLY)
def form(stage: Stage) -> None:
    """Each zone set and each message of responses fits the official schema."""
    entries = [e for kind in (Kind.ZONE_SET, Kind.RESPONSES) for e in stage.received(kind)]
    if not entries:
        raise Untestable("the master sent no zone sets and no responses")
    for entry in entries:
        why = why_invalid(entry.kind, entry.payload)
        demand(not why, f"{entry.topic}: {why}")


@case("supported", "6.4", audit=True, versions=ONLY)
def supported(stage: Stage) -> None:
    """Zones are of the types in the vehicle's supportedZones."""
    for sent in _sets(stage):
        scene, now = sent.entry.scene, sent.entry.time
        kind = (value_of(scene, "sheet") or {}).get("typeSpecification") or {}
        if held_for(scene, "sheet", now) >= stage.settings.reaction:
            for zone in sent.zones:
                type = zone.get("zoneType")
                fits = type in (kind.get("supportedZones") or ())
                demand(fits, f"{sent.name} has a {type} zone, which the factsheet lacks")


@case("map", "7.6", audit=True, versions=ONLY)
def map_id(stage: Stage) -> None:
    """mapId is the map that the vehicle reports."""
    maps = {actor.name: actor.map_id for actor in stage.actors}
    for sent in _sets(stage):
        name, expected = sent.content.get("mapId"), maps[sent.entry.vehicle]
        demand(name == expected, f"{sent.name}: mapId is {name!r}, not {expected!r}")


@case("names", "7.6", audit=True, versions=ONLY)
def names(stage: Stage) -> None:
    """zoneId is of one zone in its set."""
    for sent in _sets(stage):
        ids = [zone.get("zoneId") for zone in sent.zones]
        demand(len({*ids}) == len(ids), f"{sent.name} has the zoneIds {ids}")


@case("polygons", "7.6", audit=True, versions=ONLY)
def polygons(stage: Stage) -> None:
    """Zones are simple polygons of three vertices at least, counterclockwise."""
    for sent in _sets(stage):
        for zone in sent.zones:
            corners, name = _corners(zone), f"{sent.name}, zone {zone.get('zoneId')}"
            demand(len(corners) >= 3, f"{name} has {len(corners)} vertices")
            demand(_is_simple(corners), f"{name}: two sides cross each other")
            demand(area(corners) > 0, f"{name}: its vertices are in clockwise order")


def _is_simple(corners: list[Point]) -> bool:
    """Returns whether no two sides of a polygon cross, apart from those that share a vertex."""
    sides = [*zip(corners, [*corners[1:], *corners[:1]])]
    pairs = itertools.combinations(range(len(sides)), 2)
    apart = ((a, b) for a, b in pairs if b - a not in (1, len(sides) - 1))
    return not any(_cross(*sides[a], *sides[b]) for a, b in apart)


def _cross(a: Point, b: Point, c: Point, d: Point) -> bool:
    def side(p: Point, q: Point, r: Point) -> float:
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    return side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0


@case("content", "6.4.2", audit=True, versions=ONLY)
def content(stage: Stage) -> None:
    """A zoneSetId stands for one content, and is unique: other zones have another id."""
    known: dict[str, Sent] = {}
    for sent in _sets(stage):
        before = known.setdefault(sent.id, sent)
        other = f"another content than at {before.entry.time:.1f} s to {before.entry.vehicle}"
        demand(before.content == sent.content, f"{sent.name} has {other}")


@case("again", "6.4.2", audit=True, versions=ONLY)
def again(stage: Stage) -> None:
    """A zone set that the vehicle has is not sent again: DUPLICATE_ZONE_SET is an error."""
    for sent in _sets(stage):
        scene, now = sent.entry.scene, sent.entry.time
        has = sent.id in value_of(scene, "zone_sets", {})
        held = held_for(scene, "zone_sets", now) >= stage.settings.reaction
        demand(not (has and held), f"{sent.name} is among the vehicle's zoneSets")


@case("enabled", "6.4.2", audit=True, versions=ONLY)
def enabled(stage: Stage) -> None:
    """The zone set that was sent last is enabled by enableZoneSet: a new one is DISABLED."""
    _sets(stage)
    for actor in stage.actors:
        for name, seconds in _waits(stage, actor).items():
            text = f"{actor.name}: zone set {name} was DISABLED for {seconds:.0f} s"
            demand(seconds <= DISABLED, text)


def _waits(stage: Stage, actor: Actor) -> dict[str, float]:
    """Returns for how long zone sets were DISABLED, each as long as it was the newest and the
    master was in control of the vehicle [s]."""
    waits: dict[str, float] = {}
    newest, last = "", 0.0
    for entry in (e for e in stage.log.entries if e.vehicle == actor.name):
        if entry.kind is Kind.ZONE_SET:
            newest = Sent(entry, (entry.value or {}).get("zoneSet") or {}).id
        elif entry.sent and entry.kind is Kind.STATE:
            rows = view.rows(entry.value, "zoneSets")
            waiting = {str(row.get("zoneSetId")) for row in rows if not _is_enabled(row)}
            if newest in waiting and (entry.value or {}).get("operatingMode") in DRIVEN:
                waits[newest] = waits.get(newest, 0.0) + min(STEP, entry.time - last)
            last = entry.time
    return waits


def _is_enabled(row: Json) -> bool:
    return row.get("zoneSetStatus") == "ENABLED"


@case("actions", "6.2.3.1", audit=True, versions=ONLY)
def actions(stage: Stage) -> None:
    """enableZoneSet names a zone set that the vehicle has, deleteZoneSet one that is DISABLED."""
    entries = [e for e in stage.received(Kind.INSTANT_ACTIONS) if not e.missed]
    rows = [(e, action) for e in entries for action in instant_actions(e)]
    about = [row for row in rows if row[1].get("actionType") in ("enableZoneSet", "deleteZoneSet")]
    if not about:
        raise Untestable("the master sent no enableZoneSet and no deleteZoneSet")
    done = _reported(stage)
    for entry, action in about:
        if done.get((entry.vehicle, str(action.get("actionId"))), math.inf) > entry.time:
            _demand_fit(stage, entry, action)


def _reported(stage: Stage) -> dict[tuple[str, str], float]:
    """Returns when actions were first reported by their vehicles."""
    times: dict[tuple[str, str], float] = {}
    for entry in stage.log.entries:
        if entry.sent and entry.kind is Kind.STATE:
            for row in view.rows(entry.value, "actionStates"):
                times.setdefault((entry.vehicle, str(row.get("actionId"))), entry.time)
    return times


def _demand_fit(stage: Stage, entry: Entry, action: Json) -> None:
    scene, type = entry.scene, str(action.get("actionType"))
    if held_for(scene, "zone_sets", entry.time) < stage.settings.reaction:
        return  # the master may act by the state before
    name = next(
        (str(p.get("value")) for p in view.rows(action, "actionParameters")),
        "",
    )
    sets = value_of(scene, "zone_sets", {})
    demand(name in sets, f"{entry.vehicle}: {type} {name!r}, which the vehicle does not have")
    is_used = type == "deleteZoneSet" and sets[name]
    demand(not is_used, f"{entry.vehicle}: {type} {name!r}, which is ENABLED")


@case("restarted", "6.4.2", versions=ONLY)
def restarted(stage: Stage) -> None:
    """A vehicle that comes back without its zone set is sent a zone set again, and it is
    enabled."""
    actor = stage.idle(_with_zones(stage))
    before = value_of(actor.facts.scene(), "zones")
    actor.restart()
    _demand_zones(stage, actor, f"{before} is gone, and")


@case("manual", "6.6.6", versions=ONLY)
def manual(stage: Stage) -> None:
    """A vehicle in MANUAL is sent no enableZoneSet; in AUTOMATIC its zone set is enabled."""
    actor = stage.idle(_with_zones(stage))
    actor.report(mode=OperatingMode.MANUAL)
    actor.restart()
    mark = stage.mark
    stage.wait(stage.settings.reaction + stage.settings.watch)
    entries = stage.received(Kind.INSTANT_ACTIONS, mark, actor)
    kinds = {str(a.get("actionType")) for e in entries for a in instant_actions(e)}
    demand("enableZoneSet" not in kinds, f"{actor.name}: enableZoneSet came in MANUAL")
    actor.calm()
    actor.vehicle.request_state()
    _demand_zones(stage, actor, "it is AUTOMATIC, and")


def _with_zones(stage: Stage) -> Actor:
    """Returns a vehicle that has a zone set enabled. Raises Untestable."""

    def driving_by_zones() -> Actor | None:
        return next((a for a in stage.actors if value_of(a.facts.scene(), "zones")), None)

    actor = stage.until(driving_by_zones, stage.settings.watch)
    if actor is None:
        raise Untestable("the master has enabled no zone set")
    assert isinstance(actor, Actor)
    return actor


def _demand_zones(stage: Stage, actor: Actor, text: str) -> None:
    has_zones = stage.until(
        lambda: value_of(actor.facts.scene(), "zones"), stage.settings.reaction + DISABLED
    )
    demand(has_zones, f"{actor.name}: {text} no zone set was enabled")


# --- requests


def _request(zone: str, zone_set: str, id: str) -> Json:
    return {
        "requestId": id,
        "requestType": "ACCESS",
        "zoneId": zone,
        "zoneSetId": zone_set,
        "requestStatus": "REQUESTED",
    }


def _ask(stage: Stage, actor: Actor, zone: str, id: str) -> list[Answer]:
    """Has a vehicle request a zone of the set that it drives by. Returns the answers."""
    zone_set = str(value_of(actor.facts.scene(), "zones"))
    request = _request(zone, zone_set, id)

    def edit(state: Json) -> None:
        state["zoneRequests"] = [*(state.get("zoneRequests") or ()), request]

    mark = stage.mark
    actor.link.edits[Kind.STATE] = edit
    actor.vehicle.request_state()

    def answers() -> list[Answer]:
        known = [a for a in _answers(stage) if a.key == (actor.name, id)]
        return [a for a in known if a.entry in stage.log.entries[mark:]]

    stage.until(answers, ANSWERED)
    stage.wait(1.0)
    return answers()


@case("no_zone", "6.9", versions=ONLY)
def no_zone(stage: Stage) -> None:
    """A request for a zone that its set does not have is answered, and not GRANTED."""
    actor = _with_zones(stage)
    answers = _ask(stage, actor, NO_ZONE, "conform-no-zone")
    demand(answers, f"{actor.name}: no answer came within {ANSWERED:g} s")
    for answer in answers:
        demand(answer.grant != "GRANTED", answer.name)


@case("answered", "6.9", audit=True, versions=ONLY)
def answered(stage: Stage) -> None:
    """Each request of a vehicle is answered by its requestId."""
    first, last = _requests(stage)
    if not first:
        raise Untestable("no vehicle came to a RELEASE zone")
    times: dict[tuple[str, str], float] = {}
    for answer in _answers(stage):
        times.setdefault(answer.key, answer.entry.time)
    for key, began in first.items():
        took = min(times.get(key, math.inf), last[key]) - began
        text = f"{key[0]}: request {key[1]} had no answer for {took:.1f} s"
        demand(took <= ANSWERED, text)


def _requests(
    stage: Stage,
) -> tuple[dict[tuple[str, str], float], dict[tuple[str, str], float]]:
    """Returns when each request was in a state first, and last."""
    first: dict[tuple[str, str], float] = {}
    last: dict[tuple[str, str], float] = {}
    for entry in stage.log.entries:
        if entry.sent and entry.kind is Kind.STATE:
            for row in view.rows(entry.value, "zoneRequests"):
                key = entry.vehicle, str(row.get("requestId"))
                first.setdefault(key, entry.time)
                last[key] = entry.time
    return first, last


def _given(stage: Stage) -> list[Answer]:
    """Returns all answers. Raises Untestable without any."""
    answers = [*_answers(stage)]
    if not answers:
        raise Untestable("the master sent no responses")
    return answers


@case("asked", "6.9", audit=True, versions=ONLY)
def asked(stage: Stage) -> None:
    """A response names a request that the vehicle has made before."""
    first, _ = _requests(stage)
    for answer in _given(stage):
        was_asked = first.get(answer.key, math.inf) <= answer.entry.time
        demand(was_asked, f"{answer.name}: there was no such request")


@case("leases", "7.5", audit=True, versions=ONLY)
def leases(stage: Stage) -> None:
    """leaseExpiry is sent with GRANTED alone."""
    for answer in _given(stage):
        extra = answer.grant != "GRANTED" and answer.row.get("leaseExpiry") is not None
        demand(not extra, f"{answer.name} has a leaseExpiry")


@case("repeats", "6.9", audit=True, versions=ONLY)
def repeats(stage: Stage) -> None:
    """A request is not answered again and again by the same."""
    times: dict[tuple[str, str, str], list[float]] = {}
    for answer in _given(stage):
        key = *answer.key, f"{answer.grant} {answer.row.get('leaseExpiry')}"
        recent = times.setdefault(key, [])
        recent.append(answer.entry.time)
        lately = [t for t in recent if t > recent[-1] - WINDOW]
        demand(len(lately) <= MOST, f"{answer.name} came {len(lately)} times in {WINDOW:.0f} s")


# --- orders


@case("blocked", "6.4.1.1", audit=True, versions=ONLY)
def blocked(stage: Stage) -> None:
    """What an order releases does not lead through a BLOCKED zone of the set that is enabled."""
    sets = {sent.id: sent for sent in _sets(stage)}
    for order in orders_of(stage):
        held = held_for(order.scene, "zones", order.entry.time) >= stage.settings.reaction
        sent = sets.get(str(value_of(order.scene, "zones")))
        if sent and held and not order.is_copy:
            for zone in (z for z in sent.zones if z.get("zoneType") == "BLOCKED"):
                _demand_out(order, str(zone.get("zoneId")), _corners(zone))


def _demand_out(order: Ordered, name: str, corners: list[Point]) -> None:
    is_within = _inside(corners)
    for stretch in _stretches(order):
        # A vehicle that stands in a zone is to leave it.
        leaves = is_within(Box(*stretch.start, stretch.heading, stretch.length, stretch.width))
        way = math.dist(stretch.start, stretch.end) + stretch.length
        x, y = ((a + b) / 2 for a, b in zip(stretch.start, stretch.end))
        enters = is_within(Box(x, y, stretch.heading, way, stretch.width))
        end = tuple(round(value, 2) for value in stretch.end)
        demand(leaves or not enters, f"{order.name}: zone {name} is on the way to {end}")


def _inside(corners: list[Point]) -> Callable[[Box], bool]:
    return lambda box: overlaps(corners, box)


def _stretches(order: Ordered) -> Iterator[Stretch]:
    """Yields the released ways between nodes, as wide as the vehicle without a load."""
    body = (value_of(order.scene, "sheet") or {}).get("physicalParameters") or {}
    size = float(body.get("length") or 0.0), float(body.get("width") or 0.0)
    places = [n.get("nodePosition") for n in order.nodes if n["released"]]
    for a, b in zip(places, places[1:]):
        if a and b:
            yield Stretch((a["x"], a["y"]), (b["x"], b["y"]), False, *size)


# --- zone sets that are refused


@case("refused", "6.4.2", versions=ONLY)
def refused(stage: Stage) -> None:
    """A vehicle that refuses its zone sets is not sent them again and again."""
    actor = stage.idle(_with_zones(stage))
    mark = stage.mark
    actor.restart()
    actor.vehicle.no_zones = True
    stage.wait(2 * stage.settings.watch)
    sent = stage.received(Kind.ZONE_SET, mark, actor)
    ids = [str(((e.value or {}).get("zoneSet") or {}).get("zoneSetId")) for e in sent]
    most = max(map(ids.count, ids), default=0)
    demand(most <= FEW, f"{most} came within {2 * stage.settings.watch:.0f} s")
