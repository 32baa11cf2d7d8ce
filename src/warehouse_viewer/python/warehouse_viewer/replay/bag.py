# SPDX-License-Identifier: Apache-2.0
"""A bag of the warehouse's topics as a recording."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from warehouse_viewer import bag_reader
from warehouse_viewer.api import catalogue
from warehouse_viewer.drawing.recording import PARTS
from warehouse_viewer.page.activities import wait_too_long
from warehouse_viewer.page.journal import Journal
from warehouse_viewer.page.model import Model
from warehouse_viewer.replay.blocks import RecordingError
from warehouse_viewer.replay.file import FileWriter
from warehouse_viewer.replay.live_figures import shown
from warehouse_viewer.replay.recorder import Recorder

if TYPE_CHECKING:
    from genpy import Message

EVENTS = "/warehouse/events"
FIGURES = {
    "/warehouse/kpis": "kpis",
    "/warehouse/stations": "stations",
    "/warehouse/coordinator": "fleet",
}


def convert(bag: Path, path: Path, progress: Callable[[float], None]) -> None:
    """Writes a bag as a recording; calls progress with the part that is done, 0 … 1.

    Raises RecordingError where the bag can't be read or holds nothing to play.
    """
    writer = FileWriter(path, {"name": bag.stem, "from": "bag"})
    conversion = _Conversion(writer)
    for message in bag_reader.messages(bag, [*PARTS, EVENTS, *FIGURES], RecordingError):
        conversion.take(message.topic, message.message, message.time)
        progress(message.part)
    if not conversion.count:
        needed = ", ".join(PARTS)
        raise RecordingError(f"{bag}: nothing to play; at least {needed} were expected in it")
    conversion.recorder.close()


class _Conversion:
    """Takes messages of a bag in, and records the warehouse after each state of its fleet."""

    def __init__(self, writer: FileWriter) -> None:
        self._model, self._journal = Model(), Journal()
        self._parts: dict[str, Any] = {}
        self._figures: dict[str, Any] = {}
        self._wall: float | None = None
        self.recorder = Recorder(writer, self._model, self._journal, self._read, lambda: self._wall)
        self.count = 0  # of states

    def take(self, topic: str, message: Message, wall: float) -> None:
        """Takes a message that was recorded then [s since 1970, or simulated]."""
        # rosbag writes simulated time where the clock of the warehouse ran: that is not a date.
        self._wall = wall if wall > 1e9 else None
        if topic == EVENTS:
            self._journal.add(catalogue.event(message))
        elif topic in FIGURES:
            self._figures[FIGURES[topic]] = message
        else:
            self._parts[PARTS[topic]] = message
            if topic.endswith("/fleet"):
                self._show()

    def _show(self) -> None:
        parts = self._parts
        objects, states = parts.get("objects"), parts.get("states")
        fits = objects and states and objects.revision == states.revision
        if not fits or "scenery" not in parts:
            return
        waiting = wait_too_long(self._figures.get("fleet"))
        self._model.update(objects, states, parts["fleet"], parts["scenery"], waiting)
        self.recorder.take()
        self.count += 1

    def _read(self) -> dict[str, Any] | None:
        return shown(self._figures) or None
