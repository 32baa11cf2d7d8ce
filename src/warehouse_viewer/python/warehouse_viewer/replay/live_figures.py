# SPDX-License-Identifier: Apache-2.0
"""The figures of a shift behind ROS, as a recording has them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from warehouse_viewer.api import catalogue
from warehouse_viewer.api.operations_json import plain, stations

if TYPE_CHECKING:
    from warehouse_viewer.ros.feed import Feed
    from warehouse_viewer.ros.shift_feed import ShiftFeed

SHOWN: dict[str, Callable[[Any], Any]] = {
    "kpis": plain,
    "stations": stations,
    "fleet": catalogue.plain_coordinator,
}


def shown(messages: Mapping[str, Any]) -> dict[str, Any]:
    """Returns those of Kpis, StationStates and CoordinatorState that there are, as JSON."""
    return {name: SHOWN[name](message) for name, message in messages.items() if message is not None}


class LiveFigures:
    """The newest of those messages. feed: a ros.feed.Feed; shift: a ros.shift_feed.ShiftFeed."""

    def __init__(self, feed: Feed, shift: ShiftFeed) -> None:
        self._feed, self._shift = feed, shift

    def read(self) -> dict[str, Any] | None:
        """Returns them as JSON; None where neither coordinator nor shift runs."""
        messages = {name: self._shift[name] for name in ("kpis", "stations")}
        return shown(messages | {"fleet": self._feed.coordinator}) or None
