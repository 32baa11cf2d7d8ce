# SPDX-License-Identifier: Apache-2.0
"""Records what a Model shows, with events and figures: a reader like a page, twice a second."""

import math
import re
import time
from collections.abc import Callable, Sequence
from typing import Any, Protocol

import numpy as np

from warehouse_viewer.page import protocol
from warehouse_viewer.page.journal import ALARM, TROUBLES, Journal
from warehouse_viewer.page.model import Model
from warehouse_viewer.replay.chunk import Chunk, Mark, OpenChunk

INTERVAL = 0.5  # between two updates [s, simulated]; the page draws robots in between
LENGTH = 30.0  # of a chunk [s, simulated]
FIGURES_GAP = 5.0  # between two figures [s, simulated]
PAST = 100  # events before a chunk that it repeats
ROUND = 1024.0  # places are recorded to a part of this of a metre: half the bytes
LASTS = re.compile(r" for \d.*")  # how long an alarm has held: no other alarm


class Store(Protocol):
    """Where a recording goes."""

    def add_scene(self, text: str) -> int:
        """Keeps a scene, JSON; returns its number."""

    def next_number(self) -> int:
        """Returns the number of the next chunk."""

    def add(self, chunk: Chunk) -> None:
        """Keeps a chunk."""

    def forget_after(self, time: float) -> None:
        """Drops what comes after a simulated time [s]."""

    def close(self) -> None:
        """Ends the recording."""


class Recorder:
    """Writes a Model into a Store, whenever take() is called after an update of the model.

    figures: returns what is known of the shift (`kpis`, `stations`, `fleet` or fewer), or None.
    clock: the time on the wall, seconds since 1970; None: unknown. hears_alarms: the journal has
    them, by cause; else those of the coordinator are marked.
    """

    def __init__(
        self,
        store: Store,
        model: Model,
        journal: Journal,
        figures: Callable[[], dict[str, Any] | None] = lambda: None,
        clock: Callable[[], float | None] = time.time,
        hears_alarms: bool = False,
    ) -> None:
        self._store, self._model, self._journal = store, model, journal
        self._figures, self._clock = figures, clock
        self._open: OpenChunk | None = None
        self._revision, self._scene, self._tick, self._event = 0, 0, -1, 0
        self._stamp = self._figures_stamp = -math.inf  # of the last update, of the last figures [s]
        self._newest: dict[str, Any] | None = None  # the last figures
        self._alarms: set[str] = set()
        self._hears_alarms = hears_alarms

    @property
    def is_due(self) -> bool:
        """Whether take() would record the model as it is."""
        model = self._model
        return model.revision > 0 and (
            model.revision != self._revision or not 0 <= model.stamp - self._stamp < INTERVAL - 1e-3
        )

    def take(self) -> None:
        """Records the model as it is now, if that is due."""
        if not self.is_due:
            return
        stamp = self._model.stamp
        if stamp < self._stamp:
            self._go_back(stamp)
        if self._model.revision != self._revision:
            self._take_scene()
        if self._open and stamp - self._open.begin >= LENGTH:
            self._end_chunk()
        chunk = self._open or self._begin(stamp)
        chunk.add_update(stamp, self._update())
        self._stamp = stamp
        self._take_events(chunk)
        self._take_figures(chunk)

    @property
    def open_size(self) -> int:
        """How much memory the chunk takes that still grows [bytes]."""
        return self._open.size if self._open else 0

    def open_chunk(self) -> Chunk | None:
        """Returns the chunk that still grows, as it is now; None if there is none."""
        return self._open.packed(self._store.next_number()) if self._open else None

    def close(self) -> None:
        """Writes what is left, and ends the recording."""
        self._end_chunk()
        self._store.close()

    # --- chunks
    def _begin(self, stamp: float) -> OpenChunk:
        self._open = OpenChunk(self._scene, stamp, self._clock())
        self._tick, self._figures_stamp = -1, -math.inf
        past = [entry for entry in self._journal.since(0) if entry["id"] <= self._event]
        past = [entry for entry in past if entry["time"] <= stamp][-PAST:]
        self._open.add_text(stamp, {"type": "past", "events": past})
        return self._open

    def _end_chunk(self) -> None:
        if self._open:
            self._store.add(self._open.packed(self._store.next_number()))
        self._open = None

    def _go_back(self, stamp: float) -> None:
        """The world was reset, or put back to a moment before."""
        self._end_chunk()
        self._store.forget_after(stamp)
        self._alarms.clear()

    def _take_scene(self) -> None:
        self._end_chunk()
        self._scene = self._store.add_scene(self._model.scene_text())
        self._revision = self._model.revision

    # --- what goes into them
    def _update(self) -> bytes:
        model, since = self._model, self._tick
        rows = [table.since(since) for table in model.tables]
        self._tick = model.tick
        rows[0] = _rounded(rows[0])
        return protocol.update(model.tick, model.stamp, self._scene, rows)

    def _take_events(self, chunk: OpenChunk) -> None:
        events = self._journal.since(self._event)
        if events:
            self._event = events[-1]["id"]
            chunk.add_text(self._stamp, {"type": "events", "events": events})
            chunk.add_marks(_marks(events))

    def _take_figures(self, chunk: OpenChunk) -> None:
        if self._stamp - self._figures_stamp < FIGURES_GAP:
            return
        self._figures_stamp = self._stamp
        figures = self._figures()
        if figures:
            chunk.add_text(self._stamp, {"type": "figures", **figures})
            if not self._hears_alarms:
                chunk.add_marks(self._new_alarms(figures))

    def _new_alarms(self, figures: dict[str, Any]) -> list[Mark]:
        """Returns a Mark for each alarm that was not there before."""
        texts = (figures.get("fleet") or {}).get("alarms", ())
        alarms = {LASTS.sub("", text): text for text in texts}
        new, self._alarms = sorted(alarms.keys() - self._alarms), set(alarms)
        return [Mark(self._stamp, ALARM, "", alarms[name]) for name in new]


def _marks(events: Sequence[dict[str, Any]]) -> list[Mark]:
    troubles = [event for event in events if event["kind"] in (*TROUBLES, ALARM)]
    return [Mark(e["time"], e["kind"], e["model"], e["text"]) for e in troubles]


def _rounded(robots: np.ndarray) -> np.ndarray:
    """Returns rows of robots with places to a millimetre and headings to a thousandth [rad]."""
    out = robots.copy()
    for name in ("x", "y", "yaw"):
        out[name] = np.round(out[name] * ROUND) / ROUND
    return out
