# SPDX-License-Identifier: Apache-2.0
"""Masters of 3.0.0 that break one rule of zones or of planned paths each: messages damaged on their
way, or our master's code with one thing wrong."""

from dataclasses import replace

from damage import Additions
from master_mutants import Mutant

from warehouse_vda5050.master import zone_desk
from warehouse_vda5050.master.fleet import RemoteFleet
from warehouse_vda5050.master.zone_desk import ClosedArea, ZoneDesk
from warehouse_vda5050.model import VehicleState
from warehouse_vda5050.mqtt.master_link import MasterLink
from warehouse_vda5050.zones.zone import Grant, Response

MUTANTS: dict[str, Mutant] = {}
additions = Additions(MUTANTS, Mutant, "/zoneSet")
patched, json_of = additions.patched, additions.json_of
CHAPTERS = ("zones", "paths")


def zones_of(value):
    return value["zoneSet"]["zones"]


# --- zone sets


@json_of("without_map", "a zone set has its mapId")
def _(value, memory):
    del value["zoneSet"]["mapId"]


@json_of("other_map", "mapId of a zone set is the vehicle's")
def _(value, memory):
    value["zoneSet"]["mapId"] = "cellar"


@json_of("loss_missing", "a RELEASE zone says what a loss of the release means")
def _(value, memory):
    for zone in zones_of(value):
        if zone["zoneType"] == "RELEASE":
            zone["releaseLossBehavior"] = "PARK"


@json_of("one_zone_id", "each zone has an id of its own")
def _(value, memory):
    for zone in zones_of(value):
        zone["zoneId"] = "zone"


@json_of("two_vertices", "a zone has three vertices at least")
def _(value, memory):
    for zone in zones_of(value):
        zone["vertices"] = zone["vertices"][:2]


@json_of("crossed", "sides of a zone do not cross")
def _(value, memory):
    for zone in zones_of(value):
        corners = zone["vertices"]
        corners[1], corners[2] = corners[2], corners[1]


@json_of("clockwise", "vertices are counterclockwise")
def _(value, memory):
    for zone in zones_of(value):
        zone["vertices"].reverse()


@json_of("unsupported", "types are those of supportedZones")
def _(value, memory):
    for zone in zones_of(value):
        zone["zoneType"], zone["penaltyFactor"] = "PENALTY", 0.5


@json_of("same_set_id", "other zones have another zoneSetId")
def _(value, memory):
    value["zoneSet"]["zoneSetId"] = "warehouse-zones"


@json_of("zone_header_still", "headerId of zone sets counts up")
def _(value, memory):
    value["headerId"] = 0


@json_of("response_header_still", "headerId of responses counts up", "/responses")
def _(value, memory):
    value["headerId"] = 0


@json_of("zone_time_local", "timestamp of zone sets is UTC")
def _(value, memory):
    value["timestamp"] = value["timestamp"].replace("Z", "+02:00")


def _of_all(self, robot, view, run, spacing, former=ZoneDesk.__init__):
    former(self, robot, view, run, spacing)
    self._name = f"warehouse-{run}"


patched("set_id_of_all", "a zoneSetId is unique", (ZoneDesk, "__init__", _of_all))


def _sent_for_ever(self, zones, state, now, former=ZoneDesk._bring):
    if int(now) % 3 == 0 and now % 1 < 0.1:
        yield zones
    yield from former(self, zones, state, now)


def _never_enabled(self, action, name, now, former=ZoneDesk._ask):
    if action != "enableZoneSet":
        former(self, action, name, now)


def _enabled_wrongly(self, action, name, now, former=ZoneDesk._ask):
    former(self, action, f"{name}x" if action == "enableZoneSet" else name, now)


def _deletes_enabled(self, zones, state, now, former=ZoneDesk._bring):
    for known in state.zone_sets:
        if known.enabled:
            self._ask("deleteZoneSet", known.id, now)
    yield from former(self, zones, state, now)


def _once(self, zones, state, now, former=ZoneDesk._bring):
    done = vars(self).setdefault("_done", set())
    if zones.id in done and zones.id not in {s.id for s in state.zone_sets}:
        return
    if zones.id in {s.id for s in state.zone_sets}:
        done.add(zones.id)
    yield from former(self, zones, state, now)


def _in_any_mode(self, now, former=ZoneDesk.messages):
    with_modes = former(self, now)
    instants = self._instants.due(now) if not self._view.takes_orders else None
    return [*with_modes, instants] if instants else with_modes


patched("resent", "a set that is there is not sent again", (ZoneDesk, "_bring", _sent_for_ever))
patched("never_enabled", "a set is enabled", (ZoneDesk, "_ask", _never_enabled))
patched("enables_another", "the set that was sent is enabled", (ZoneDesk, "_ask", _enabled_wrongly))
patched("deletes_enabled", "what is enabled is not deleted", (ZoneDesk, "_bring", _deletes_enabled))
patched("lost_sets", "a vehicle that forgot its zones gets them again", (ZoneDesk, "_bring", _once))
patched(
    "deaf_to_refusal",
    "a set that is refused is not sent for ever",
    (zone_desk, "_refusal_of", lambda state, name: ""),
)
patched(
    "enables_in_manual",
    "a person's vehicle is sent no actions",
    (ZoneDesk, "messages", _in_any_mode),
)


# --- requests


def _unanswered(self, state, now):
    return ()


def _granted(self, zone_set, zone):
    return Grant.GRANTED


def _known_only(self, state, now, former=ZoneDesk._responses):
    known = {f"closed{area.zone_id}" for area in self._areas}
    requests = tuple(r for r in state.zone_requests if r.zone in known)
    yield from former(self, replace(state, zone_requests=requests), now)


def _for_ever(self, state, now):
    for request in state.zone_requests:
        yield Response(request.id, self._grant(request.zone_set, request.zone))


def _of_others(self, state, now, former=ZoneDesk._responses):
    for response in former(self, state, now):
        yield replace(response, request=f"{response.request}-other")


def _one_more(self, state, now, former=ZoneDesk._responses):
    for response in former(self, state, now):
        yield response
        yield replace(response, request="never-asked")


def _with_lease(self, state, now, former=ZoneDesk._responses):
    for response in former(self, state, now):
        yield replace(response, expiry=1.7e9 + now + 60.0)


patched("unanswered", "requests are answered", (ZoneDesk, "_responses", _unanswered))
patched("all_granted", "what is no zone is not granted", (ZoneDesk, "_grant", _granted))
patched("known_answered", "each request is answered", (ZoneDesk, "_responses", _known_only))
patched("answers_for_ever", "one answer is enough", (ZoneDesk, "_responses", _for_ever))
patched("answers_another", "answers name the request", (ZoneDesk, "_responses", _of_others))
patched("answers_unasked", "no answer without a request", (ZoneDesk, "_responses", _one_more))
patched("leases_all", "only what is granted has a lease", (ZoneDesk, "_responses", _with_lease))


@json_of("other_grant", "grantType is one of four", "/responses")
def _(value, memory):
    for row in value["responses"]:
        row["grantType"] = "ALLOWED"


# --- orders


def _on_the_way(self, areas, former=RemoteFleet.close_zones):
    former(self, [*areas, ClosedArea(3, 3.5, 5.5, 4.5, 6.5)])


patched(
    "drives_through",
    "no order leads through a BLOCKED zone",
    (RemoteFleet, "close_zones", _on_the_way),
)


# --- paths


def _drops(self, identity, message, now, former=RemoteFleet.take):
    is_state = isinstance(message, VehicleState)
    if not (is_state and message.planned and message.planned.trajectory.degree > 1):
        former(self, identity, message, now)


def _knows_nodes(self, identity, message, now, former=RemoteFleet.take):
    planned = message.planned if isinstance(message, VehicleState) else None
    if not (planned and any(name.startswith("conform_") for name in planned.nodes)):
        former(self, identity, message, now)


def _no_long_states(self, topic, payload, retained, former=MasterLink._on_message):
    if len(payload) < 20_000:
        former(self, topic, payload, retained)


def _gives_up(self, topic, payload, retained, former=MasterLink._on_message):
    spoilt = vars(self).setdefault("_spoilt", set())
    lines = []
    self._write = lines.append
    if topic not in spoilt:
        former(self, topic, payload, retained)
    if lines:
        spoilt.add(topic)


patched("no_curves", "a planned path may be a curve", (RemoteFleet, "take", _drops))
patched("own_nodes", "traversedNodes may be any nodes", (RemoteFleet, "take", _knows_nodes))
patched("no_long", "long states are read", (MasterLink, "_on_message", _no_long_states))
patched("gives_up", "one unreadable state is no end", (MasterLink, "_on_message", _gives_up))
