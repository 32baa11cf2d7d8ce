# SPDX-License-Identifier: Apache-2.0
"""Vehicles of 3.0.0 that break one rule of zones each: our vehicle's code with one thing wrong."""

import math
from dataclasses import replace

from damage import Additions
from mutants import Mutant

from warehouse_vda5050.validation import MessageError
from warehouse_vda5050.vehicle import zone_guard
from warehouse_vda5050.vehicle.vehicle import Vehicle
from warehouse_vda5050.vehicle.zone_guard import ZoneGuard
from warehouse_vda5050.zones.releases import Releases
from warehouse_vda5050.zones.route import Stretch
from warehouse_vda5050.zones.store import ZoneStore
from warehouse_vda5050.zones.zone import Grant, ZoneType

MUTANTS: dict[str, Mutant] = {}
patched = Additions(MUTANTS, Mutant).patched


def _enabled_at_once(self, zones, former=ZoneStore.add):
    former(self, zones)
    self.enabled = zones


def _never_disabled(self, former=ZoneStore.states):
    return tuple(replace(state, enabled=True) for state in former(self))


def _taken_over(self, zones, former=ZoneStore.add):
    self._sets.pop(zones.id, None)
    former(self, zones)


def _kept_in_silence(self, zones, former=ZoneStore.add):
    try:
        former(self, zones)
    except MessageError:
        self._sets.setdefault(zones.id, zones)


def _any_known(self, id):
    self.enabled = self._sets.get(id)
    return ""


def _all_granted(self, zone):
    return True


def _once_asked(self, zone):
    return zone.id in self._requests


def _queued_is_granted(self, response, inside, wall, former=Releases.take):
    queued = response.grant is Grant.QUEUED
    return former(
        self, replace(response, grant=Grant.GRANTED) if queued else response, inside, wall
    )


def _rejected_is_granted(self, response, inside, wall, former=Releases.take):
    rejected = response.grant is Grant.REJECTED
    new = replace(response, grant=Grant.GRANTED) if rejected else response
    return former(self, new, inside, wall)


def _deaf_to_revoked(self, response, inside, wall, former=Releases.take):
    return response.grant is Grant.REVOKED or former(self, response, inside, wall)


def _not_again(self, response, inside, wall, former=Releases.take):
    lost = any(request.is_lost for request in self._requests.values())
    return lost or former(self, response, inside, wall)


def _only(*types, former=Stretch.is_forbidden):
    return lambda self, zone: zone.type in types and former(self, zone)


def _keeps_requests(self, needed, inside, zone_set, wall, former=Releases.update):
    zones = [request.zone for request in self._requests.values()]
    former(self, [*needed, *zones], inside, zone_set, wall)


def _no_expiry(self, request, wall):
    return None


def _nothing(self):
    return None


def _goes_on(self, zone, former=Releases.is_granted):
    return former(self, zone) or zone in self.lost()


def _zones_first(self, order):
    edges, zones = order.speeds(), self.zones.speeds
    return [edge if math.isinf(zone) else zone for edge, zone in zip(edges, zones)] or edges


def _no_hints(zone, text, precise, former=zone_guard._error):
    return former(zone, text, None)


patched("enabled_at_once", "a new set is DISABLED", (ZoneStore, "add", _enabled_at_once))
patched("all_enabled", "one set is ENABLED at once", (ZoneStore, "states", _never_disabled))
patched("set_changed", "a known id is not taken over", (ZoneStore, "add", _taken_over))
patched(
    "any_type_kept",
    "types that are not supported are refused",
    (ZoneStore, "add", _kept_in_silence),
)
patched(
    "any_type_taken",
    "types that are not supported are refused by their name",
    (zone_guard, "ZoneStore", lambda types: ZoneStore((*types, *ZoneType))),
)
patched(
    "unknown_enabled", "a set that was not sent is not enabled", (ZoneStore, "enable", _any_known)
)
patched("never_deleted", "deleteZoneSet deletes", (ZoneStore, "delete", lambda self, id: ""))
patched(
    "no_release_needed", "a RELEASE zone needs a release", (Releases, "is_granted", _all_granted)
)
patched("request_is_enough", "a request is no release", (Releases, "is_granted", _once_asked))
patched("queued_enters", "QUEUED is no release", (Releases, "take", _queued_is_granted))
patched("rejected_enters", "REJECTED is no release", (Releases, "take", _rejected_is_granted))
patched("deaf_to_revoked", "REVOKED takes a release", (Releases, "take", _deaf_to_revoked))
patched("stays_lost", "another GRANTED lets it go on", (Releases, "take", _not_again))
patched("never_expires", "a lease ends", (Releases, "_expire", _no_expiry))
patched("keeps_requests", "a request ends behind its zone", (Releases, "update", _keeps_requests))
patched(
    "blocked_ignored",
    "a BLOCKED zone is not entered",
    (Stretch, "is_forbidden", _only(ZoneType.DIRECTED, ZoneType.BIDIRECTED)),
)
patched(
    "one_way_ignored",
    "a DIRECTED zone has a direction",
    (Stretch, "is_forbidden", _only(ZoneType.BLOCKED)),
)
patched(
    "drives_on",
    "it stops where it loses its release",
    (ZoneGuard, "_hold", _nothing),
    (Releases, "is_granted", _goes_on),
)
patched("names_no_type", "RELEASE_LOST is the error's type", (zone_guard, "_error", _no_hints))
patched(
    "zone_speed_ignored",
    "a SPEED_LIMIT zone limits the speed",
    (ZoneGuard, "_speeds", lambda self, way: [math.inf] * len(way)),
)
patched("zone_over_edge", "the lowest limit applies", (Vehicle, "_speeds", _zones_first))
patched(
    "edge_over_zone",
    "a limit of an edge does not hide one of a zone",
    (Vehicle, "_speeds", lambda self, order: order.speeds()),
)
