# SPDX-License-Identifier: Apache-2.0
"""Records what happens in a world of this process."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np

from warehouse_layout.message_enums import EventKind
from warehouse_viewer.page.journal import Journal
from warehouse_viewer.page.model import Model
from warehouse_viewer.replay.file import NAME, FileWriter
from warehouse_viewer.replay.recorder import INTERVAL, Recorder
from warehouse_viewer.replay.run_feed import RunFeed

if TYPE_CHECKING:
    from kiva_plugin_cpp import World

EVENTS_KEPT = 10_000  # more than come between two updates


class RunRecorder:
    """Writes a world into the file NAME of a folder, twice a simulated second.

    about, figures: as of FileWriter and Recorder. Raises RecordingError, as all its methods.
    """

    def __init__(
        self,
        folder: Path,
        about: dict[str, Any],
        world: World,
        figures: Callable[[], dict[str, Any] | None] = lambda: None,
    ) -> None:
        self._writer = FileWriter(folder / NAME, about)
        self._world, self._feed = world, RunFeed(world)
        self._model, self._journal = Model(), Journal(EVENTS_KEPT)
        self._recorder = Recorder(self._writer, self._model, self._journal, figures, lambda: None)
        self._due = world.time

    @property
    def objects(self) -> SimpleNamespace:
        """What is there, as RunFeed has it."""
        return self._feed.objects

    @property
    def is_due(self) -> bool:
        """Whether it is time for take()."""
        return bool(self._world.time >= self._due)

    def take(self, events: Iterable[np.ndarray], waiting: Collection[int]) -> None:
        """Records the world as it is now.

        events: those of the world since the last call. waiting: the numbers of robots that wait
        for too long.
        """
        self._due = self._world.time + INTERVAL - 1e-3
        for event in (event_ for some in events for event_ in some):
            self._journal.add(_entry(event))
        feed = self._feed
        feed.update()
        self._model.update(feed.objects, feed.states, feed.fleet_state, feed.scenery, waiting)
        self._recorder.take()

    def close(self) -> int:
        """Ends the recording; returns its length [bytes]."""
        self._recorder.close()
        return self._writer.size


def _entry(event: np.void) -> dict[str, Any]:
    """Returns an event of a world as a Journal has it."""
    return {
        "time": round(float(event["time"]), 3),
        "kind": EventKind(event["kind"]).name,
        "command": int(event["command"]),
        "model": event["model"],
        "other": event["other"],
        "text": event["text"],
    }
