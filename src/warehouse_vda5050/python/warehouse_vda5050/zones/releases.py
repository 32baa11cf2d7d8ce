# SPDX-License-Identifier: Apache-2.0
"""A vehicle's requests to enter RELEASE zones, and what became of them (6.4.3, 6.9)."""

from collections.abc import Iterable
from dataclasses import dataclass

from warehouse_vda5050.zones.zone import Grant, RequestStatus, Response, Zone, ZoneRequest

RETRY = 5.0  # from a request that came to nothing to the next [s]


@dataclass
class _Request:
    """entered: whether the robot has been in the zone with it. expiry: of the lease [s], None for
    none. lost_at: when a release was lost [s]."""

    id: str
    zone: Zone
    zone_set: str
    status: RequestStatus = RequestStatus.REQUESTED
    expiry: float | None = None
    entered: bool = False
    lost_at: float = 0.0

    @property
    def is_lost(self) -> bool:
        return self.status in (RequestStatus.REVOKED, RequestStatus.EXPIRED)


class Releases:
    """One request a zone. Times are wall clock [s since 1970], as leases are."""

    def __init__(self, name: str) -> None:
        self._name, self._count = name, 0
        self._requests: dict[str, _Request] = {}  # by zone
        self._not_before: dict[str, float] = {}  # by zone, after one that came to nothing

    def update(
        self, needed: Iterable[Zone], inside: Iterable[Zone], zone_set: str, wall: float
    ) -> None:
        """Asks for the zones that are needed soon, and drops the requests for those that are
        neither needed nor entered any more."""
        asked = {zone.id: zone for zone in needed}
        within = {zone.id for zone in inside}
        for id in [*self._requests]:
            request = self._requests[id]
            request.entered |= id in within and request.status is RequestStatus.GRANTED
            self._expire(request, wall)
            is_over = id not in within and (id not in asked or self._is_stale(request, wall))
            if is_over or request.zone_set != zone_set:
                del self._requests[id]
        for id, zone in asked.items():
            if id not in self._requests and wall >= self._not_before.get(id, 0.0):
                self._ask(zone, zone_set)

    def _is_stale(self, request: _Request, wall: float) -> bool:
        return request.is_lost and wall >= request.lost_at + RETRY

    def _expire(self, request: _Request, wall: float) -> None:
        is_over = request.expiry is not None and wall >= request.expiry
        if is_over and request.status is RequestStatus.GRANTED:
            request.status, request.lost_at = RequestStatus.EXPIRED, wall

    def _ask(self, zone: Zone, zone_set: str) -> None:
        self._count += 1
        name = f"{self._name}-{self._count}"
        self._requests[zone.id] = _Request(name, zone, zone_set)

    def take(self, response: Response, inside: Iterable[Zone], wall: float) -> bool:
        """Takes a master's answer. Returns False if no request of that id is active."""
        request = next((r for r in self._requests.values() if r.id == response.request), None)
        if request is None:
            return False
        if response.grant is Grant.GRANTED:
            request.status, request.expiry = RequestStatus.GRANTED, response.expiry
        elif response.grant is not Grant.QUEUED:
            self._refuse(request, request.zone.id in {zone.id for zone in inside}, wall)
        return True

    def _refuse(self, request: _Request, is_inside: bool, wall: float) -> None:
        """Removes a request; that of a zone which the robot is in stays until it has left it."""
        if is_inside:
            request.status, request.lost_at = RequestStatus.REVOKED, wall
        else:
            del self._requests[request.zone.id]
            self._not_before[request.zone.id] = wall + RETRY

    def clear(self) -> None:
        """Forgets all requests: other zones hold."""
        self._requests.clear()
        self._not_before.clear()

    def is_granted(self, zone: Zone) -> bool:
        """Returns whether the robot may drive in a zone: it has a release, or has lost one that it
        entered with and is to go on."""
        request = self._requests.get(zone.id)
        if request is None:
            return False
        goes_on = request.entered and zone.word == "CONTINUE"
        return request.status is RequestStatus.GRANTED or goes_on

    def lost(self) -> list[Zone]:
        """Returns the zones that were entered with a release which is lost."""
        return [r.zone for r in self._requests.values() if r.entered and r.is_lost]

    def states(self) -> tuple[ZoneRequest, ...]:
        """Returns the requests that are active; one that is CONTINUED with stays GRANTED (Table
        6)."""
        return tuple(
            ZoneRequest(
                r.id, r.zone.id, r.zone_set, RequestStatus.GRANTED if _goes_on(r) else r.status
            )
            for r in self._requests.values()
        )


def _goes_on(request: _Request) -> bool:
    return request.is_lost and request.entered and request.zone.word == "CONTINUE"
