# SPDX-License-Identifier: Apache-2.0
"""What happens to closed zones, as events."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from warehouse_client.message_names import constants
from warehouse_msgs.msg import ClosedZones

if TYPE_CHECKING:
    from collections.abc import Mapping

KINDS = {number: f"ZONE_{name}" for number, name in constants(ClosedZones).items()}


class ZoneLog:
    """Turns the events of ClosedZones messages into rows of a journal, each once."""

    def __init__(self) -> None:
        self._last = 0

    def news(self, message: ClosedZones) -> list[dict[str, Any]]:
        """Returns the rows of the events since the last message."""
        if message.event_id and message.event_id[-1] < self._last:
            self._last = 0  # a coordinator that was restarted counts from 1 again
        columns = (
            message.event_id,
            message.event_time,
            message.event_kind,
            message.event_by,
            message.event_text,
        )
        rows = [
            {
                "kind": KINDS.get(kind, "ZONE"),
                "time": round(time, 3),
                "command": 0,
                "model": "",
                "other": "",
                "text": f"{text}, by {by}" if by else text,
            }
            for number, time, kind, by, text in zip(*columns)
            if number > self._last
        ]
        self._last = max(message.event_id, default=self._last)
        return rows


def held_units(message: ClosedZones | None) -> Mapping[int, str]:
    """Returns why units wait for a closed zone, by their numbers."""
    return dict(zip(message.shelf_id, message.why)) if message else {}
