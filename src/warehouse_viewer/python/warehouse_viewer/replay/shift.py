# SPDX-License-Identifier: Apache-2.0
"""Records a shift that is simulated in this process: --record of simulate."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from warehouse_fleet.coordinator_messages import state_message
from warehouse_operations.operations import Operations
from warehouse_operations.stations import WorkStation
from warehouse_viewer.api import catalogue
from warehouse_viewer.message_enums import EventKind
from warehouse_viewer.page.journal import Journal
from warehouse_viewer.page.model import Model
from warehouse_viewer.replay.blocks import RecordingError
from warehouse_viewer.replay.file import NAME, FileWriter
from warehouse_viewer.replay.recorder import INTERVAL, Recorder
from warehouse_viewer.replay.shift_feed import ShiftFeed

EVENTS_KEPT = 10_000  # more than come between two updates


class ShiftRecorder:
    """Writes a shift into the file NAME of a folder, twice a simulated second.

    To be called with the Operations after each cycle, and closed in the end. Raises RecordingError.
    """

    def __init__(self, folder: Path) -> None:
        self._path = folder / NAME
        self._journal = Journal(EVENTS_KEPT)
        self._recorder: Recorder | None = None
        self._due = 0.0

    def __call__(self, ops: Operations) -> None:
        """Records the shift as it is now, if that is due."""
        if ops.time < self._due:
            return
        recorder = self._recorder or self._begin(ops)
        self._due = ops.time + INTERVAL - 1e-3
        self._take_events(ops.fleet)
        feed = self._feed
        feed.update()
        self._model.update(
            feed.objects, feed.states, feed.fleet_state, feed.scenery, feed.waiting()
        )
        recorder.take()

    def close(self) -> int:
        """Ends the recording; returns its length [bytes]."""
        if not self._recorder:
            return 0
        self._recorder.close()
        return self._writer.size

    def _begin(self, ops: Operations) -> Recorder:
        if ops.ideal:
            raise RecordingError(
                "--record: ideal robots are nowhere between two cells; without --no-physics was"
                " expected"
            )
        fleet: Any = ops.fleet
        fleet.events = []
        self._feed, self._model = ShiftFeed(fleet), Model()
        self._writer = FileWriter(self._path, {"name": ops.site.name, "from": "simulate"})
        self._recorder = Recorder(
            self._writer, self._model, self._journal, lambda: self._figures(ops), lambda: None
        )
        return self._recorder

    def _figures(self, ops: Operations) -> dict[str, Any]:
        return figures(ops) | {"fleet": coordinator(ops.fleet, self._feed.objects)}

    def _take_events(self, fleet: Any) -> None:
        for event in _concatenated(fleet.events):
            self._journal.add(event)
        fleet.events.clear()


def figures(ops: Operations) -> dict[str, Any]:
    """Returns what a recording tells of a shift now."""
    shift = ops.shift
    tally, hours = shift.tally, max(shift.now - shift.began, 1e-9) / 3600
    return {
        # Not Operations.kpis(): its quantiles cost more the longer a shift lasts.
        "kpis": {
            "items_picked": tally.items_picked,
            "item_throughput_per_hour": tally.items_picked / hours,
            "orders_completed": tally.orders_completed,
            "orders_late": sum(0 < one.due < shift.now for one in shift.orders.values()),
        },
        "stations": [station(one, shift.now) for one in shift.stations],
    }


def coordinator(fleet: Any, objects: Any) -> dict[str, Any]:
    """Returns what a coordinator tells of a WorldFleet, as JSON has it; `objects` as
    ShiftFeed.objects."""
    watch = SimpleNamespace(by_hand=(), collisions=fleet.collisions, objects=objects)
    return catalogue.plain_coordinator(state_message(fleet.controller, watch, 0, ""))


def station(one: WorkStation, now: float) -> dict[str, Any]:
    """Returns a station at a time of the shift [s]."""
    return {
        "name": one.name,
        "kind": one.kind,
        "open": one.is_open,
        "inbound": sorted(one.inbound),
        "pieces": one.pieces,
        "busy_fraction": one.busy_fraction(now),
    }


def _concatenated(events: list[np.ndarray]) -> list[dict[str, Any]]:
    """Returns events of a world as a Journal has them."""
    return [_entry(event) for some in events for event in some]


def _entry(event: np.void) -> dict[str, Any]:
    return {
        "time": round(float(event["time"]), 3),
        "kind": EventKind(event["kind"]).name,
        "command": int(event["command"]),
        "model": event["model"],
        "other": event["other"],
        "text": event["text"],
    }
