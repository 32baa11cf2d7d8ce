# SPDX-License-Identifier: Apache-2.0
"""Zone sets and requests of 3.0.0; sections are its own. A case leaves no zones behind: an empty
set is enabled after it."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator
from typing import Any

from warehouse_vda5050.conform import view
from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.ground import Place
from warehouse_vda5050.conform.probe import Json, Probe
from warehouse_vda5050.conform.verdict import Unsupported, demand
from warehouse_vda5050.topics import Kind

chapter = Chapter("zones")
case = chapter.case
ONLY = ("3.0.0",)
HALF = 0.15  # half a side of a zone around a place, as a share of the edge
PAST = "2020-01-01T00:00:00.000Z"
SLOW = 0.2  # [m/s]
NONE_KNOW = ("COORDINATED_REPLANNING", "ACTION", "PENALTY", "PRIORITY", "SPEED_LIMIT")


def _types(probe: Probe) -> list[str]:
    kind = probe.sheet.get("typeSpecification") or {}
    types = kind.get("supportedZones")
    return [str(type) for type in types] if isinstance(types, list) else []


def _need(probe: Probe, *types: str) -> None:
    for type in types:
        if type not in _types(probe):
            raise Unsupported(f"the factsheet has no {type} among supportedZones")
    if not types and not _types(probe):
        raise Unsupported("the factsheet has no supportedZones")


def _zone(around: Place, edge: float, type: str, **more: Any) -> Json:
    half = HALF * edge
    corners = [(-half, -half), (half, -half), (half, half), (-half, half)]
    vertices = [{"x": around.x + x, "y": around.y + y} for x, y in corners]
    return {"zoneId": "zone", "zoneType": type, "vertices": vertices, **more}


def _send(probe: Probe, map_id: str, *zones: Json, name: str = "") -> str:
    """Sends a zone set; returns its id."""
    name = name or probe.new_id("conform-zones")
    content = {"mapId": map_id, "zoneSetId": name, "zones": [*zones]}
    probe.send(Kind.ZONE_SET, {"zoneSet": content})
    return name


def _status(state: Json, name: str) -> str:
    rows = [row for row in view.rows(state, "zoneSets") if row.get("zoneSetId") == name]
    return str(rows[0].get("zoneSetStatus")) if rows else ""


def _known(probe: Probe, name: str) -> Json:
    return probe.until(lambda s: bool(_status(s, name)), "the zone set in zoneSets")


def _enable(probe: Probe, name: str) -> None:
    state = probe.finished(probe.instant("enableZoneSet", [("zoneSetId", name)]))
    demand(_status(state, name) == "ENABLED", f"its status is {_status(state, name) or 'none'}")


@contextlib.contextmanager
def _held(probe: Probe, map_id: str, *zones: Json) -> Iterator[None]:
    """Has zones hold in its block, and none after it."""
    name = _send(probe, map_id, *zones)
    _known(probe, name)
    _enable(probe, name)
    try:
        yield
    finally:
        _clear(probe, map_id)


def _clear(probe: Probe, map_id: str) -> None:
    """Enables an empty set, and deletes the others of this program."""
    empty = _send(probe, map_id)
    _known(probe, empty)
    probe.finished(probe.instant("enableZoneSet", [("zoneSetId", empty)]))
    for row in view.rows(probe.state, "zoneSets"):
        name = str(row.get("zoneSetId"))
        if name.startswith("conform-zones") and name != empty:
            probe.finished(probe.instant("deleteZoneSet", [("zoneSetId", name)]))


def _edge(way: list[Place]) -> float:
    return math.dist((way[0].x, way[0].y), (way[1].x, way[1].y))


def _request(state: Json) -> Json | None:
    return next(iter(view.rows(state, "zoneRequests")), None)


def _asks(probe: Probe) -> Json:
    """Returns the request of the newest state, once there is one."""
    state = probe.until(lambda s: _request(s) is not None, "a zoneRequest", probe.settings.edge)
    request = _request(state)
    assert request
    return request


def _answer(probe: Probe, request: Json, grant: str, **more: str) -> None:
    row = {"requestId": request.get("requestId"), "grantType": grant, **more}
    probe.send(Kind.RESPONSES, {"responses": [row]})


def _stays_out(probe: Probe, order: Json, what: str) -> None:
    """Demands that node 1 of an order is not reached within the time of two edges."""
    reached = order["nodes"][1]["sequenceId"]
    probe.never(
        lambda s: view.has(s, order) and (s.get("lastNodeSequenceId") or 0) >= reached,
        what,
        2 * probe.settings.edge,
    )


def _end(probe: Probe) -> None:
    id = probe.instant("cancelOrder")
    probe.over(id, seconds=probe.settings.edge)


@case("disabled", "6.4.2", edges=1, versions=ONLY)
def disabled(probe: Probe) -> None:
    """A newly added zone set is DISABLED, in zoneSets of the state."""
    _need(probe)
    way = probe.way(1)
    name = _send(probe, way[0].map_id)
    status = _status(_known(probe, name), name)
    demand(status == "DISABLED", f"its zoneSetStatus is {status}")
    _clear(probe, way[0].map_id)


@case("enable", "6.4.2", edges=1, versions=ONLY)
def enable(probe: Probe) -> None:
    """enableZoneSet makes a set ENABLED, and the one before DISABLED: one is active at once."""
    _need(probe)
    map_id = probe.way(1)[0].map_id
    names = [_send(probe, map_id) for _ in range(2)]
    for name in names:
        _known(probe, name)
        _enable(probe, name)
    former = _status(probe.state, names[0])
    demand(former == "DISABLED", f"the one before is {former}")
    _clear(probe, map_id)


@case("delete", "6.2.3.1", edges=1, versions=ONLY)
def delete(probe: Probe) -> None:
    """deleteZoneSet removes a set from zoneSets."""
    _need(probe)
    probe.need("deleteZoneSet", "INSTANT")
    name = _send(probe, probe.way(1)[0].map_id)
    _known(probe, name)
    state = probe.finished(probe.instant("deleteZoneSet", [("zoneSetId", name)]))
    demand(not _status(state, name), "it is in zoneSets still")


@case("unknown", "6.2.3.1", versions=ONLY)
def unknown(probe: Probe) -> None:
    """enableZoneSet of a set that was never sent is FAILED."""
    _need(probe)
    status = probe.over(probe.instant("enableZoneSet", [("zoneSetId", "conform-none")]))
    demand(status == "FAILED", f"it is {status}")


@case("duplicate", "6.4.2", edges=1, versions=ONLY)
def duplicate(probe: Probe) -> None:
    """A zone set with a known id is not taken over: DUPLICATE_ZONE_SET."""
    _need(probe)
    map_id = probe.way(1)[0].map_id
    name = _send(probe, map_id)
    _known(probe, name)
    error = probe.refused(lambda: _send(probe, map_id, name=name))
    kind = error.get("errorType")
    demand(kind == "DUPLICATE_ZONE_SET", f"errorType is {kind}")
    _clear(probe, map_id)


@case("other_type", "6.4", edges=1, versions=ONLY)
def other_type(probe: Probe) -> None:
    """A zone of a type that supportedZones lacks is refused, not ignored."""
    _need(probe)
    type = next((name for name in NONE_KNOW if name not in _types(probe)), "")
    if not type:
        raise Unsupported("the factsheet has all types")
    factors = {"penaltyFactor": 0.5, "priorityFactor": 0.5, "maximumSpeed": 0.1}
    actions: Json = {key: [] for key in ("entryActions", "duringActions", "exitActions")}
    way = probe.way(1)
    zone = _zone(way[1], _edge(way), type, **factors, **actions)
    name = probe.new_id("conform-zones")
    probe.refused(lambda: _send(probe, way[0].map_id, zone, name=name))
    demand(not _status(probe.state, name), "it is in zoneSets")


@case("blocked", "6.4.1.1", edges=1, versions=ONLY)
def blocked(probe: Probe) -> None:
    """A vehicle does not enter a BLOCKED zone, whatever its order says."""
    _need(probe, "BLOCKED")
    way = probe.way(1)
    order = probe.new_order(way)
    with _held(probe, way[0].map_id, _zone(way[1], _edge(way), "BLOCKED")):
        probe.refused(lambda: probe.order(order))
        _stays_out(probe, order, "it drives into the zone")
        if view.has(probe.state, order):
            _end(probe)


@case("one_way", "6.4.1.2", edges=1, versions=ONLY)
def one_way(probe: Probe) -> None:
    """A vehicle does not drive through a DIRECTED zone against its direction."""
    _need(probe, "DIRECTED")
    way = probe.way(1)
    order = probe.new_order(way)
    against = math.atan2(way[0].y - way[1].y, way[0].x - way[1].x)
    more = {"direction": against, "directedLimitation": "RESTRICTED"}
    with _held(probe, way[0].map_id, _zone(way[1], _edge(way), "DIRECTED", **more)):
        probe.refused(lambda: probe.order(order))
        _stays_out(probe, order, "it drives against the direction")
        if view.has(probe.state, order):
            _end(probe)


@case("speed_limit", "6.4.1.1", edges=3, versions=ONLY)
def speed_limit(probe: Probe) -> None:
    """A vehicle is not faster in a SPEED_LIMIT zone, and has slowed down where it enters."""
    _need(probe, "SPEED_LIMIT")
    way = probe.way(3)
    _demand_speed(probe, way, probe.new_order(way), {"maximumSpeed": SLOW}, SLOW)


@case("lowest_limit", "6.4.4", edges=3, versions=ONLY)
def lowest_limit(probe: Probe) -> None:
    """The lowest of the competing maximumSpeed values of zones and edges applies."""
    _need(probe, "SPEED_LIMIT")
    way = probe.way(3)
    order = probe.new_order(way)
    order["edges"][1]["maxSpeed"] = SLOW
    _demand_speed(probe, way, order, {"maximumSpeed": 2 * SLOW}, SLOW)


def _demand_speed(probe: Probe, way: list[Place], order: Json, more: Json, limit: float) -> None:
    """Demands that an order's second edge, all in a zone, is not driven faster than at a limit
    [m/s]."""
    zone = _zone(way[1], _edge(way), "SPEED_LIMIT", **more)
    zone["vertices"] = _around(way[1], way[2])
    mark = len(probe.log.entries)
    with _held(probe, way[0].map_id, zone):
        probe.drive(order)
    fastest = view.fastest_on(probe.log.values(Kind.STATE, mark), order, 1)
    demand(fastest <= 1.1 * limit, f"it drove at {fastest:.2f} m/s in the zone")


def _release(way: list[Place], loss: str = "STOP") -> Json:
    return _zone(way[1], _edge(way), "RELEASE", releaseLossBehavior=loss)


@case("release", "6.4.3", edges=2, versions=ONLY)
def release(probe: Probe) -> None:
    """A vehicle requests ACCESS before a RELEASE zone, enters when it is GRANTED, and removes the
    request after it."""
    _need(probe, "RELEASE")
    way = probe.way(2)
    order = probe.new_order(way)
    with _held(probe, way[0].map_id, _release(way)):
        probe.accept(order)
        request = _asks(probe)
        words = request.get("requestType"), request.get("zoneId"), request.get("requestStatus")
        demand(words == ("ACCESS", "zone", "REQUESTED"), f"the request is {words}")
        _answer(probe, request, "QUEUED")
        _stays_out(probe, order, "it enters before the request is granted")
        _answer(probe, request, "GRANTED")
        probe.until(_is_granted, "requestStatus GRANTED")
        state = probe.finish(order)
        demand(_request(state) is None, "the request is there after the zone was left")


def _is_granted(state: Json) -> bool:
    return (_request(state) or {}).get("requestStatus") == "GRANTED"


@case("rejected", "6.4.3", edges=1, versions=ONLY)
def rejected(probe: Probe) -> None:
    """A vehicle whose request is REJECTED does not enter."""
    _need(probe, "RELEASE")
    way = probe.way(1)
    order = probe.new_order(way)
    with _held(probe, way[0].map_id, _release(way)):
        probe.accept(order)
        _answer(probe, _asks(probe), "REJECTED")
        _stays_out(probe, order, "it enters although the request was rejected")
        _end(probe)


@case("expired", "6.4.3", edges=1, versions=ONLY)
def expired(probe: Probe) -> None:
    """A grant whose leaseExpiry has passed is EXPIRED, and the zone is not entered."""
    _need(probe, "RELEASE")
    way = probe.way(1)
    order = probe.new_order(way)
    with _held(probe, way[0].map_id, _release(way)):
        probe.accept(order)
        mark = len(probe.log.entries)
        _answer(probe, _asks(probe), "GRANTED", leaseExpiry=PAST)
        _stays_out(probe, order, "it enters after leaseExpiry")
        rows = [_request(state) or {} for state in probe.log.values(Kind.STATE, mark)]
        demand(any(row.get("requestStatus") == "EXPIRED" for row in rows), "no state says EXPIRED")
        _end(probe)


@case("release_lost", "6.4.1.1", edges=2, versions=ONLY)
def release_lost(probe: Probe) -> None:
    """A vehicle in a RELEASE zone of STOP whose release is REVOKED stops: RELEASE_LOST. Another
    GRANTED lets it go on."""
    _need(probe, "RELEASE")
    way = probe.way(2)
    order = probe.new_order(way)
    wide = _release(way)
    wide["vertices"] = _around(way[1], way[2])
    with _held(probe, way[0].map_id, wide):
        probe.accept(order)
        request = _asks(probe)
        _answer(probe, request, "GRANTED")
        node = order["nodes"][1]["sequenceId"]
        at = probe.until(
            lambda s: view.has(s, order) and (s.get("lastNodeSequenceId") or 0) >= node,
            "the zone",
            2 * probe.settings.edge,
        )
        demand(_is_granted(at), "the request is not GRANTED while the vehicle is in the zone")
        _answer(probe, request, "REVOKED")
        probe.until(lambda s: "RELEASE_LOST" in _errors(s), "RELEASE_LOST")
        probe.until(lambda s: not s.get("driving"), "driving false", probe.settings.edge)
        _answer(probe, request, "GRANTED")
        probe.finish(order)
        probe.until(lambda s: "RELEASE_LOST" not in _errors(s), "the end of RELEASE_LOST")


def _errors(state: Json) -> list[str]:
    return [str(error.get("errorType")) for error in view.rows(state, "errors")]


def _around(a: Place, b: Place) -> list[Json]:
    """Returns the corners of a rectangle around two places."""
    half = HALF * math.dist((a.x, a.y), (b.x, b.y))
    (x0, x1), (y0, y1) = sorted((a.x, b.x)), sorted((a.y, b.y))
    corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    outwards = [(-half, -half), (half, -half), (half, half), (-half, half)]
    return [{"x": x + dx, "y": y + dy} for (x, y), (dx, dy) in zip(corners, outwards)]
