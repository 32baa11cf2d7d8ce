# SPDX-License-Identifier: Apache-2.0
"""The last hour of a running warehouse, recorded continuously."""

from collections.abc import Callable
from typing import Any

from starlette.routing import Route

from warehouse_viewer.page.journal import Journal
from warehouse_viewer.page.model import Model
from warehouse_viewer.replay.memory import SECONDS, MemoryStore
from warehouse_viewer.replay.recorder import INTERVAL, Recorder
from warehouse_viewer.replay.routes import RecordingRoutes

LEAST_GAP, MOST_GAP = 0.08, 0.2  # between two looks at the model [s, wall]


class LiveRecording:
    """Keeps what a Model shows for `seconds` (simulated). Lives in the hub's asyncio loop."""

    def __init__(
        self,
        model: Model,
        journal: Journal,
        figures: Callable[[], dict[str, Any] | None],
        seconds: float = SECONDS,
    ) -> None:
        self.store = MemoryStore(seconds)
        self._recorder = Recorder(self.store, model, journal, figures, hears_alarms=True)

    def take(self) -> None:
        """Records the model as it is now, if that is due."""
        self._recorder.take()

    @property
    def size(self) -> int:
        """How much memory it takes [bytes]."""
        return self.store.size + self._recorder.open_size

    def routes(self) -> list[Route]:
        """Returns the routes by which a page plays it."""
        return RecordingRoutes(self.store, self._recorder.open_chunk).routes()

    @staticmethod
    def gap(factor: float) -> float:
        """Returns how long to wait between two looks [s, wall], at a real-time factor."""
        return min(MOST_GAP, max(LEAST_GAP, 0.4 * INTERVAL / max(factor, 1e-3)))
