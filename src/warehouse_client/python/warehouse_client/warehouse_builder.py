# SPDX-License-Identifier: Apache-2.0
"""Replaces the warehouse in the world by another one."""

from collections.abc import Callable

from warehouse_client.engine import Engine, UndoneError
from warehouse_layout.models import models
from warehouse_layout.place.layout import Layout

# Models in a document. The world does nothing else while it adds those of one.
BATCH = 500
MANY = 20_000  # models that take seconds; how far they are is in the log of the world


class WarehouseBuilder:
    """`engine` is an engine.Engine; `report(text)` shows the progress to a person."""

    def __init__(self, engine: Engine, report: Callable[[str], object]) -> None:
        self._engine, self._report = engine, report

    def replace(self, layout: Layout) -> None:
        """Replaces the warehouse by all of the layout, or by its floor alone if that fails.

        Raises UndoneError; UnchangedError where the old warehouse stands; and EngineError where the
        world does not answer any more. Call it while physics is paused: a half-built warehouse must
        not move.
        """
        parts = models.of_layout(layout)
        if len(parts) >= MANY:
            self._report(f"building {len(parts)} models")
        documents = map(models.document, models.batches(parts, BATCH))
        floor = [models.FLOOR] if layout.has_own_floor else []
        try:
            self._engine.replace(models.PLACED, floor, documents)
        except UndoneError as error:
            raise UndoneError(f"{error}; the half-made warehouse was taken away") from error

    def clear(self) -> None:
        """Deletes the models of a warehouse, by their names; keeps its floor and all others."""
        self._engine.replace(models.PLACED, [], [])
