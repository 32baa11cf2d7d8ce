# SPDX-License-Identifier: Apache-2.0
"""Closed zones as messages, as sentences, and as what a parameter holds."""

import math
from typing import Any

import numpy as np
import rospy

from warehouse_fleet.hosts.controller import FleetController
from warehouse_fleet.traffic.closed_zones import ClosedZone
from warehouse_msgs.msg import ClosedZone as ClosedZoneMessage
from warehouse_msgs.msg import ClosedZones as ClosedZonesMessage


def zones_message(controller: FleetController) -> ClosedZonesMessage:
    """Returns the closed zones, the robots inside, and the transports that wait; without events."""
    message = ClosedZonesMessage()
    message.header.stamp = rospy.Time.from_sec(controller.traffic.time)
    message.zones = [_zone_message(controller, zone) for zone in controller.traffic.zones]
    for transport, why in controller.transports.held():
        message.transport_id.append(transport.number)
        message.shelf_id.append(transport.shelf)
        message.why.append(why)
    return message


def _zone_message(controller: FleetController, zone: ClosedZone) -> ClosedZoneMessage:
    zones, robots = controller.traffic.zones, controller.robots
    inside = np.isin(robots.cell, zones.cells_of(zone)) & ~robots.gone
    return ClosedZoneMessage(
        zone_id=zone.zone_id,
        reason=zone.reason,
        closed_by=zone.by,
        x_min=zone.x_min,
        y_min=zone.y_min,
        x_max=zone.x_max,
        y_max=zone.y_max,
        since=zone.since,
        until=zone.until if math.isfinite(zone.until) else 0.0,
        inside=robots.kiva_ids[inside].tolist(),
        waits=zones.waits(zone, controller.transports.cell_of_unit),
    )


def sentence(zone: ClosedZone, spacing: float, what: str) -> str:
    """Returns what has happened to a zone as a sentence."""
    half = spacing / 2
    low, high = (zone.x_min + half, zone.y_min + half), (zone.x_max - half, zone.y_max - half)
    where = f"({low[0]:g}, {low[1]:g}) to ({high[0]:g}, {high[1]:g})"
    return f"zone '{zone.reason}' from {where} {what}"


def duration_text(zone: ClosedZone) -> str:
    """Returns for how long a zone is closed."""
    if math.isinf(zone.until):
        return "until it is opened"
    seconds = zone.until - zone.since
    return f"for {seconds:.0f} s" if seconds < 120 else f"for {seconds / 60:.0f} min"


def as_parameter(zone: ClosedZone) -> dict[str, Any]:
    """Returns a zone as a ROS parameter, which has no infinity."""
    fields = dict(vars(zone))
    return fields | {"until": zone.until if math.isfinite(zone.until) else 0.0}


def of_parameter(fields: Any) -> ClosedZone:
    """Returns the zone of a ROS parameter. Raises ValueError if it holds none."""
    names = ("x_min", "y_min", "x_max", "y_max", "since", "until")
    try:
        *edges, since, until = (float(fields[name]) for name in names)
        about = int(fields["zone_id"]), str(fields["reason"]), str(fields["by"])
    except (KeyError, TypeError) as error:
        raise ValueError(f"no closed zone: {error!r}") from error
    x_min, y_min, x_max, y_max = edges
    return ClosedZone(*about, x_min, y_min, x_max, y_max, since, until or math.inf)
