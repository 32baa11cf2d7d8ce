# SPDX-License-Identifier: Apache-2.0
"""Answers requests for a warehouse."""

import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import astuple
from types import ModuleType
from typing import Any

from genpy import Time
from std_msgs.msg import Header

from warehouse_client import identity, survey
from warehouse_client.build_transaction import BuildTransaction
from warehouse_client.engine import Engine, EngineError, UnchangedError, UndoneError
from warehouse_client.warehouse_builder import WarehouseBuilder
from warehouse_layout.file.layout_file import LayoutFileError
from warehouse_layout.file.request import FIT, Request, RequestError, resolve
from warehouse_layout.generate.cells import Cells
from warehouse_layout.generate.fit import fit, fit_largest
from warehouse_layout.generate.generated import plan
from warehouse_layout.models import models
from warehouse_layout.place.layout import SEED, Floor, Layout
from warehouse_msgs.srv import CreateWarehouseRequest, CreateWarehouseResponse
from warehouse_sim import hints
from warehouse_sim.layout_building import LayoutBuilding

GREETED = "~greeted"
CLOCK_PATIENCE = 1.0  # for the world to tell the time of an answer [s, wall]
COORDINATOR = "coordinator/demand"  # a parameter that a launch with a coordinator sets


class WarehouseService:
    """Builds one warehouse at a time. `ros` is rospy; `report(text)` writes to the terminal of the
    launch.

    keeps_floor: a warehouse stands on the free cells of the world's own floor, in its largest room
    or in that of the point `at`, (x, y) [m]. seed: draws the random parts of a layout. layouts:
    places those of layout files.
    """

    def __init__(
        self,
        ros: ModuleType,
        report: Callable[[str], object],
        keeps_floor: bool = False,
        seed: int = SEED,
        at: tuple[float, float] | None = None,
        layouts: LayoutBuilding | None = None,
    ) -> None:
        self._ros, self._report, self._lock = ros, report, threading.Lock()
        self._keeps_floor, self._seed, self._at = keeps_floor, seed, at
        self._layouts = layouts or LayoutBuilding(seed)

    def handle(self, request: CreateWarehouseRequest) -> CreateWarehouseResponse:
        """Answers a CreateWarehouse request; a refusal changes nothing."""
        try:
            message = self.create(
                request.warehouse_name,
                request.warehouse_id,
                (request.robots, request.items, request.shelves),
            )
            success = True
        except (RequestError, LayoutFileError, EngineError) as error:
            message, success = str(error), False
        return CreateWarehouseResponse(self._header(), success, message)

    def create(self, name: str, number: int = 0, counts: tuple[int, int, int] = (0, 0, 0)) -> str:
        """Builds a warehouse and returns a description of it.

        name: a preset, or a layout file, where counts are 0. Raises RequestError, LayoutFileError,
        EngineError.
        """
        path = ""
        with self._lock, Engine(self._ros) as engine:
            if self._layouts.takes(name) and not any(counts):
                name, path, layout = self._layouts.place(name, engine)
                request: Any = _counted(layout)
            else:
                fits = name == FIT and not any(counts)
                request, layout = self._layout(None if fits else resolve(name, *counts), engine)
            transaction = BuildTransaction(self._ros, engine)
            transaction.begin(name)
            try:
                WarehouseBuilder(engine, self._report).replace(layout)
            except UnchangedError:
                transaction.commit()
                raise
            except UndoneError:
                self._finish(transaction, "", 0, layout.floor)
                raise
            self._finish(transaction, name, number, layout.floor, path)
        title = f"{name}: " if name else ""
        return f"{title}{request} {_where(layout)}"

    def _header(self) -> Header:
        """Returns the header of an answer, at time 0 where no world tells the time."""
        with suppress(EngineError), Engine(self._ros, CLOCK_PATIENCE) as engine:
            return Header(stamp=Time.from_sec(engine.time()), frame_id="world")
        return Header(frame_id="world")

    def _layout(self, request: Request | None, engine: Engine) -> tuple[Request, Layout]:
        """Returns (Request, Layout); request: None for the largest warehouse that fits."""
        cells = Cells.of_map(engine.map()) if self._keeps_floor else None
        if cells is None or not cells.taken.size:
            if request is None:
                raise RequestError(f"size {FIT} is for a world that is given (world:=…)")
            self._layouts.check_grid(engine)
            return request, plan(request, self._seed)
        if request is None:
            return fit_largest(cells, self._seed, self._at)
        return request, fit(request, cells, self._seed, self._at)

    def _finish(
        self, transaction: BuildTransaction, name: str, number: int, floor: Floor, path: str = ""
    ) -> None:
        identity.write(self._ros, name, number)
        self._ros.set_param(identity.LAYOUT, path)
        self._ros.set_param("warehouse/floor", [float(edge) for edge in astuple(floor)])
        transaction.commit()

    def start(self, size: str) -> None:
        """Greets for the warehouse that stands, or builds the preset or layout `size`, if any.

        First removes a half-built warehouse of a node that died, and its pause.
        """
        try:
            self._find_or_build("" if size == "none" else size)
        except (RequestError, LayoutFileError) as error:
            self._report(f"nothing was built: {error}")

    def _find_or_build(self, size: str) -> None:
        with Engine(self._ros) as engine:
            undone = self._undo(engine)
            standing = {models.kind_and_number(name)[0] for name in engine.names()} - {None}
        if undone or (size and not standing):
            self._greet(self.create(size or "empty"))
        elif not self._ros.has_param(GREETED):
            self._greet()

    def _undo(self, engine: Engine) -> bool:
        """Removes a half-built warehouse; returns whether there was one."""
        transaction = BuildTransaction(self._ros, engine)
        if not transaction.is_unfinished:
            return False
        self._report("a warehouse was left half-built; taking it away")
        WarehouseBuilder(engine, self._report).clear()
        identity.write(self._ros, "", 0)
        transaction.commit()
        return True

    def _greet(self, title: str = "") -> None:
        """Reports what stands in the world, with commands to try."""
        with Engine(self._ros) as engine:
            standing = survey.of_engine(engine)
        title = title or f"{identity.read(self._ros)[0] or 'world'}: {standing}"
        to_try = hints.commands(standing, self._ros.has_param(COORDINATOR))
        to_try = hints.within(self._ros.get_namespace(), to_try)
        self._report(hints.greeting(title, to_try))
        self._ros.set_param(GREETED, True)


def _counted(layout: Layout) -> Request:
    """Returns the counts of a Layout."""
    rows = (layout.robots, layout.units, layout.item_unit, layout.belts)
    return Request(*map(len, rows))


def _where(layout: Layout) -> str:
    """Returns words for the floor of a layout, and for unusual stations."""
    if layout.has_own_floor:
        width, length = layout.floor.size
        return f"on a {width:g} x {length:g} m floor"
    if not len(layout.drops):
        return layout.where
    if layout.plan is None:
        return f"{layout.where}; there is no room for stations"
    queues = any(len(station.queue) for station in layout.plan.stations)
    return layout.where if queues else f"{layout.where}; no room for queues before its stations"
