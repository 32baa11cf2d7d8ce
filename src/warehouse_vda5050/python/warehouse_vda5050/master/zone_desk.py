# SPDX-License-Identifier: Apache-2.0
"""The floor's closed zones as zone sets of one vehicle of 3.0.0, and the answers to its requests.

A vehicle outside a closed zone gets it as BLOCKED. One that is in it gets it as RELEASE, with the
release, so that it can leave. A zone set never changes, so other zones are another set: it is sent
until the vehicle has it, enabled, and those before it are deleted.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, field

from warehouse_vda5050.master.instant import RESEND, InstantRequests
from warehouse_vda5050.master.robots_file import RemoteRobot
from warehouse_vda5050.master.text_limits import zones_too_long
from warehouse_vda5050.master.vehicle_view import VehicleView
from warehouse_vda5050.model import Factsheet, InstantActions, Responses, VehicleState, ZoneSet
from warehouse_vda5050.zones.zone import Grant, RequestStatus, Response, Zone, ZoneType

PREFIX = "warehouse-"  # of the ids of all sets from here, also of earlier runs
MARGIN = 0.02  # between a zone and a robot that turns in the cell beside it [m]
LEAST = 0.1  # half of the least width of a zone [m]
UNANSWERED = 5  # times that a set is sent before an alarm says that it is not answered
SLOWEST = 60.0  # between two times from then on [s]
AGAIN = 10.0  # until what was answered in vain is asked for again [s]
ZoneMessage = ZoneSet | InstantActions | Responses


@dataclass(frozen=True)
class ClosedArea:
    """A closed rectangle of whole cells: its edges in the frame world [m], and the numbers of the
    robots in it."""

    zone_id: int
    x_min: float
    y_min: float
    x_max: float
    y_max: float
    inside: frozenset[int] = field(default_factory=frozenset)


class ZoneDesk:
    """The zones of one vehicle; `run` distinguishes the sets of this run. Times are those of any
    clock [s]."""

    def __init__(self, robot: RemoteRobot, view: VehicleView, run: str, spacing: float) -> None:
        self._robot, self._view, self._spacing = robot, view, spacing
        self._name = f"{PREFIX}{run}-{robot.number}"
        self._instants = InstantRequests(f"{run}-{robot.number}-zones")
        self._sheet = Factsheet()
        self._areas: tuple[ClosedArea, ...] = ()
        self._count = 0
        self._set: ZoneSet | None = None  # that the vehicle is to drive by
        self._due = self._ask_at = 0.0
        self._times = 0  # that the set was sent without an answer
        self._refusal = ""
        self._answers: dict[str, tuple[Grant, float]] = {}  # by request: the last, and when
        self._news: list[str] = []

    def take_factsheet(self, sheet: Factsheet) -> None:
        """Adapts the zones to those that the vehicle keeps to."""
        self._sheet = sheet
        self._instants.lengths = sheet.lengths

    def close(self, areas: Iterable[ClosedArea]) -> None:
        """Takes the closed zones of the floor as they are now."""
        self._areas = tuple(areas)

    def take_state(self, state: VehicleState) -> None:
        """Takes what the vehicle says of its zones."""
        self._instants.take(state)
        wanting = [r.id for r in state.zone_requests]
        self._answers = {id: last for id, last in self._answers.items() if id in wanting}
        if self._set and not self._refusal:
            self._refusal = _refusal_of(state, self._set.id)
            if self._refusal:
                self._news.append(f"its zones are refused: {self._refusal}")

    def take_news(self) -> list[str]:
        """Returns why zones were refused, since the last call."""
        news, self._news = self._news, []
        return news

    def messages(self, now: float) -> list[ZoneMessage]:
        """Returns the messages to send."""
        state = self._view.state
        if state is None or not self._view.hears or not self._sheet.zone_types:
            return []
        self._choose(state)
        sent: list[ZoneMessage] = []
        if self._set and not self._refusal:
            sent += self._bring(self._set, state, now)
        responses = tuple(self._responses(state, now))
        sent += [Responses(responses)] if responses else []
        # A vehicle in another mode is a person's: it is sent no actions.
        instants = self._instants.due(now) if self._view.takes_orders else None
        return [*sent, instants] if instants else sent

    # --- zone sets

    def _choose(self, state: VehicleState) -> None:
        """Makes another set where the zones are others than those the vehicle has."""
        zones = tuple(self._zones())
        before = self._set.zones if self._set else ()
        left = any(s.enabled and s.id.startswith(PREFIX) for s in state.zone_sets)
        if zones == before and (self._set or not left):
            return
        self._count += 1
        self._due, self._ask_at, self._times, self._refusal = 0.0, 0.0, 0, ""
        self._set = ZoneSet(f"{self._name}-{self._count}", self._view.map_id, zones)
        if 0 < self._sheet.max_zones < len(zones):
            self._refusal = f"{len(zones)} are closed, and {self._sheet.max_zones} are its most"
        else:
            self._refusal = zones_too_long(self._set, self._sheet.lengths)
        if self._refusal:
            self._news.append(f"its zones are not sent: {self._refusal}")

    def _zones(self) -> Iterable[Zone]:
        types = self._sheet.zone_types
        for area in self._areas:
            is_in = self._robot.number in area.inside
            if ZoneType.RELEASE in types and (is_in or ZoneType.BLOCKED not in types):
                yield self._zone(area, ZoneType.RELEASE, "CONTINUE")
            elif ZoneType.BLOCKED in types and not is_in:
                yield self._zone(area, ZoneType.BLOCKED, "")

    def _zone(self, area: ClosedArea, type: ZoneType, word: str) -> Zone:
        inset = self._inset
        x = min(inset, (area.x_max - area.x_min) / 2 - LEAST)
        y = min(inset, (area.y_max - area.y_min) / 2 - LEAST)
        left, right, low, high = area.x_min + x, area.x_max - x, area.y_min + y, area.y_max - y
        corners = ((left, low), (right, low), (right, high), (left, high))
        place = self._robot.frame.to_vehicle
        return Zone(f"closed{area.zone_id}", type, tuple(place(*c) for c in corners), 0.0, word)

    @property
    def _inset(self) -> float:
        """How far a robot that turns in the cell beside a zone reaches into it [m]."""
        load = self._sheet.load_size
        length, width = max(self._sheet.length, load[0]), max(self._sheet.width, load[1])
        return max(0.0, math.hypot(length, width) / 2 - self._spacing / 2 + MARGIN)

    def _bring(self, zones: ZoneSet, state: VehicleState, now: float) -> Iterable[ZoneSet]:
        """Yields the set until the vehicle has it; then enables it, and deletes those before."""
        known = {s.id: s for s in state.zone_sets}
        if zones.id not in known:
            if now >= self._due:
                self._back_off(zones, now)
                yield zones
            return
        # It was answered: a vehicle that forgets it gets it at once.
        self._due, self._times = 0.0, 0
        if not known[zones.id].enabled:
            self._ask("enableZoneSet", zones.id, now)
        else:
            for name in known:
                if name.startswith(PREFIX) and not known[name].enabled:
                    self._ask("deleteZoneSet", name, now)

    def _back_off(self, zones: ZoneSet, now: float) -> None:
        """Waits twice as long each time that the set was not answered; says so once."""
        self._due = now + min(RESEND * 2**self._times, SLOWEST)
        self._times = min(self._times + 1, UNANSWERED + 1)
        if self._times == UNANSWERED:
            text = f"zone set {zones.id} was sent {UNANSWERED} times, and no state has it"
            self._news.append(f"its zones are not answered: {text}; they do not hold for it")

    def _ask(self, action: str, name: str, now: float) -> None:
        if now >= self._ask_at:
            self._ask_at = now + AGAIN
            self._instants.ask(action, ("zoneSetId", name))

    # --- requests

    def _responses(self, state: VehicleState, now: float) -> Iterable[Response]:
        for request in state.zone_requests:
            grant = self._grant(request.zone_set, request.zone)
            last, at = self._answers.get(request.id, (None, 0.0))
            is_heard = grant is not Grant.GRANTED or request.status is RequestStatus.GRANTED
            if last is grant and (is_heard or now < at + RESEND):
                continue
            self._answers[request.id] = grant, now
            yield Response(request.id, grant)

    def _grant(self, zone_set: str, zone: str) -> Grant:
        """Lets a vehicle that is in a closed zone drive there, to leave it; one outside waits."""
        if self._set is None or zone_set != self._set.id:
            return Grant.REJECTED
        inside = {f"closed{a.zone_id}" for a in self._areas if self._robot.number in a.inside}
        return Grant.GRANTED if zone in inside else Grant.QUEUED


def _refusal_of(state: VehicleState, name: str) -> str:
    """Returns why a vehicle refuses a zone set, '' if it does not."""
    reasons = [e.description for e in state.errors if ("zoneSetId", name) in e.references]
    known = name in {zones.id for zones in state.zone_sets}
    return reasons[0] if reasons and not known else ""
