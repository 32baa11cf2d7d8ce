# SPDX-License-Identifier: Apache-2.0
"""Closed zones as the HTTP API and the page show them."""

from typing import Any

from warehouse_msgs.msg import ClosedZone, ClosedZones


def zones(message: ClosedZones | None) -> dict[str, Any]:
    """Returns the closed zones of a message as JSON; None: there are none."""
    if message is None:
        return {"zones": [], "waiting": []}
    held = zip(message.transport_id, message.shelf_id, message.why)
    return {
        "zones": [_zone(zone) for zone in message.zones],
        "waiting": [
            {"transport": number, "storage_unit": f"storage_unit{unit}", "why": why}
            for number, unit, why in held
        ],
    }


def _zone(zone: ClosedZone) -> dict[str, Any]:
    return {
        "id": zone.zone_id,
        "reason": zone.reason,
        "closed_by": zone.closed_by,
        "x_min": zone.x_min,
        "y_min": zone.y_min,
        "x_max": zone.x_max,
        "y_max": zone.y_max,
        "since": round(zone.since, 3),
        "until": round(zone.until, 3) if zone.until else None,
        "inside": [f"kiva{number}" for number in zone.inside],
        "waits": list(zone.waits),
    }
