# SPDX-License-Identifier: Apache-2.0
"""Closed zones of a coordinator: services close and open them, a topic says which there are, and a
parameter keeps them over a restart of the node."""

import zlib
from collections import deque
from typing import Any, NamedTuple

import rospy

from warehouse_client.command_services import CommandServices
from warehouse_fleet.hosts.controller import FleetController
from warehouse_fleet.hosts.coordinator_services import Host
from warehouse_fleet.hosts.zone_messages import (
    as_parameter,
    duration_text,
    of_parameter,
    sentence,
    zones_message,
)
from warehouse_fleet.traffic.closed_zones import ClosedZone, ZoneRequest
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_msgs.msg import ClosedZones
from warehouse_msgs.srv import (
    CloseZone,
    CloseZoneRequest,
    CloseZoneResponse,
    OpenZone,
    OpenZoneRequest,
    OpenZoneResponse,
)

KEPT = "~closed_zones"
EVENTS = 50  # that the topic holds


class _Event(NamedTuple):
    number: int
    time: float
    kind: int
    by: str
    text: str


class ZoneKeeper:
    """Keeps the closed zones of the controllers of a Host, one after the other."""

    def __init__(self, host: Host) -> None:
        self._host = host
        self._events: deque[_Event] = deque(maxlen=EVENTS)
        self._was_shut = False
        self._floor, self._time, self._zones, self._last = "", 0.0, list[ClosedZone](), 0
        self._restore(rospy.get_param(KEPT, None))
        self._topic = rospy.Publisher("warehouse/zones", ClosedZones, latch=True, queue_size=1)
        services = CommandServices(rospy)
        services.serve("warehouse/close_zone", CloseZone, self._on_close)
        services.serve("warehouse/open_zone", OpenZone, self._on_open)

    def _restore(self, kept: Any) -> None:
        """Takes over what a parameter of a node of before holds."""
        if not kept:
            return
        try:
            self._floor, self._time = str(kept["floor"]), float(kept["time"])
            self._last = int(kept["last"])
            self._zones = [of_parameter(fields) for fields in kept["zones"]]
        except (KeyError, TypeError, ValueError) as error:
            rospy.logwarn(f"the closed zones of before can't be read: {error}")

    def begin(self, controller: FleetController, time: float) -> None:
        """Closes the zones of before for a new controller, at its time [s]."""
        zones = controller.traffic.zones
        zones.last = self._last
        floor = _mark_of(controller.plan)
        if floor == self._floor:
            lost = zones.carry_over(self._zones, self._time, time)
        else:
            text = "is open again: there is another floor"
            lost = [f"the zone '{zone.reason}' {text}" for zone in self._zones]
        for text in lost:
            self._note(time, ClosedZones.ENDED, "", text)
        self._floor = floor
        self._keep(controller, time)

    def advance(self, controller: FleetController, time: float, is_due: bool) -> None:
        """Notes the zones that have opened by themselves; publishes, if it is due."""
        for zone in controller.ended_zones:
            text = sentence(zone, controller.plan.spacing, "is open again: its time is over")
            self._note(time, ClosedZones.ENDED, "", text)
        self._time = time
        if controller.ended_zones:
            self._keep(controller, time)
        elif is_due:
            # Robots that stand for long have transports wait as well.
            is_shut = bool(len(controller.traffic.zones) or controller.traffic.standing)
            if is_shut or self._was_shut:
                self._publish(controller)
            self._was_shut = is_shut

    def _on_close(self, request: CloseZoneRequest) -> CloseZoneResponse:
        host = self._host
        with host.lock:
            controller = host.controller
            if controller is None:
                return CloseZoneResponse(False, host.reason, 0, [])
            zones, time = controller.traffic.zones, controller.traffic.time
            corners = request.x1, request.y1, request.x2, request.y2
            wish = ZoneRequest(*corners, request.duration, request.reason, request.by)
            try:
                zone = zones.propose(wish, time)
            except ValueError as error:
                return CloseZoneResponse(False, str(error), 0, [])
            waits = zones.waits(zone, controller.transports.cell_of_unit)
            if request.check:
                return CloseZoneResponse(True, "", 0, waits)
            zones.close(zone)
            text = sentence(zone, controller.plan.spacing, f"is closed {duration_text(zone)}")
            self._note(time, ClosedZones.CLOSED, zone.by, text)
            self._keep(controller, time)
            return CloseZoneResponse(True, "", zone.zone_id, waits)

    def _on_open(self, request: OpenZoneRequest) -> OpenZoneResponse:
        host = self._host
        with host.lock:
            controller = host.controller
            if controller is None:
                return OpenZoneResponse(False, host.reason)
            try:
                zone = controller.traffic.zones.open(request.zone_id)
            except ValueError as error:
                return OpenZoneResponse(False, str(error))
            text = sentence(zone, controller.plan.spacing, "is open again")
            self._note(controller.traffic.time, ClosedZones.OPENED, request.by.strip()[:60], text)
            self._keep(controller, controller.traffic.time)
            return OpenZoneResponse(True, "")

    def _note(self, time: float, kind: int, by: str, text: str) -> None:
        number = self._events[-1].number + 1 if self._events else 1
        self._events.append(_Event(number, time, kind, by, text))

    def _keep(self, controller: FleetController, time: float) -> None:
        """Writes the zones that are closed now, and publishes them."""
        zones = controller.traffic.zones
        self._time, self._zones, self._last = time, list(zones), zones.last
        rows = [as_parameter(zone) for zone in zones]
        kept = {"floor": self._floor, "time": time, "last": self._last, "zones": rows}
        rospy.set_param(KEPT, kept)
        self._publish(controller)

    def _publish(self, controller: FleetController) -> None:
        message = zones_message(controller)
        message.event_id = [event.number for event in self._events]
        message.event_time = [event.time for event in self._events]
        message.event_kind = [event.kind for event in self._events]
        message.event_by = [event.by for event in self._events]
        message.event_text = [event.text for event in self._events]
        self._topic.publish(message)


def _mark_of(plan: FloorPlan) -> str:
    """Returns a text that differs from that of another floor."""
    shape = f"{plan.origin} {plan.spacing} {plan.shape}"
    return f"{shape} {zlib.crc32(plan.passable.tobytes()):08x}"
