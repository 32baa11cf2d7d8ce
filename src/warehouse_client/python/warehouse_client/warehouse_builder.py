# SPDX-License-Identifier: Apache-2.0
"""Replaces the warehouse in the world by another one."""

import time
from collections.abc import Callable, Sequence
from typing import Any

from warehouse_client.engine import Engine, EngineError
from warehouse_layout.models import models
from warehouse_layout.place.layout import Layout

PROGRESS_EVERY = 3.0  # [s, wall]

# Models in a document. A call for each model takes forty times the time; a call for all of them
# blocks other clients.
BATCH = 500


class UndoneError(EngineError):
    """Raised where the world refused a part of a warehouse, after its other parts were removed."""


class WarehouseBuilder:
    """`engine` is an engine.Engine; `report(text)` shows the progress to a person."""

    def __init__(
        self,
        engine: Engine,
        report: Callable[[str], object],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._engine, self._report, self._clock = engine, report, clock
        self._next_report = clock() + PROGRESS_EVERY

    def replace(self, layout: Layout) -> None:
        """Replaces the warehouse by all of the layout, or by its floor alone if that fails.

        Raises UndoneError, and EngineError where the world does not answer any more. Call it while
        physics is paused: a half-built warehouse must not move.
        """
        self.clear(floor=layout.has_own_floor)
        try:
            self._spawn(models.of_layout(layout))
        except EngineError as error:
            self._report(f"refused: {error}; taking away what was built so far")
            self.clear(floor=False)
            raise UndoneError(f"{error}; the half-made warehouse was taken away") from error

    def clear(self, floor: bool = True) -> None:
        """Deletes the models of a warehouse, by their names; keeps all others."""
        for kind in models.PLACED:
            # Read again for each model: items are deleted with their storage unit.
            names = self._engine.names()
            self._delete([name for name in names if models.kind_and_number(name)[0] == kind])
        if floor and models.FLOOR in self._engine.names():
            self._engine.delete(models.FLOOR)

    def _spawn(self, parts: Sequence[Any]) -> None:
        done = 0
        for batch in models.batches(parts, BATCH):
            self._progress("built", done, parts)
            self._engine.spawn(models.document(batch), batch[0].name)
            done += len(batch)

    def _delete(self, names: Sequence[str]) -> None:
        for i, name in enumerate(names):
            self._progress("taken away", i, names)
            self._engine.delete(name)

    def _progress(self, what: str, done: int, all_: Sequence[Any]) -> None:
        if self._clock() >= self._next_report:
            self._report(f"{what} {done} of {len(all_)} models")
            self._next_report = self._clock() + PROGRESS_EVERY
