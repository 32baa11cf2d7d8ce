# SPDX-License-Identifier: Apache-2.0
"""Records a shift that is simulated in this process: --record of simulate."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from warehouse_fleet.hosts.coordinator_messages import state_message
from warehouse_fleet.transports.waiting import Waiting
from warehouse_operations.runs.operations import Operations
from warehouse_operations.stock.stations import WorkStation
from warehouse_viewer.api import catalogue
from warehouse_viewer.page.activities import TOO_LONG
from warehouse_viewer.replay.blocks import RecordingError
from warehouse_viewer.replay.run import RunRecorder

if TYPE_CHECKING:
    from warehouse_fleet.hosts.fleet_driver import FleetDriver
    from warehouse_operations.fleets.world_fleet import WorldFleet


class ShiftRecorder:
    """Writes a shift into the file NAME of a folder, twice a simulated second.

    To be called with the Operations after each cycle, and closed in the end. Raises RecordingError.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._run: RunRecorder | None = None

    def __call__(self, ops: Operations) -> None:
        """Records the shift as it is now, if that is due."""
        run = self._run = self._run or self._begin(ops)
        if run.is_due:
            fleet: Any = ops.fleet
            run.take(fleet.events, waiting(fleet))
            fleet.events.clear()

    def close(self) -> int:
        """Ends the recording; returns its length [bytes]."""
        return self._run.close() if self._run else 0

    def _begin(self, ops: Operations) -> RunRecorder:
        if ops.ideal:
            raise RecordingError(
                "--record: ideal robots have no place between two cells; leave out --no-physics"
            )
        fleet: Any = ops.fleet
        fleet.events = []
        about = {"name": ops.site.name, "from": "simulate"}
        run = RunRecorder(
            self._folder,
            about,
            fleet.world,
            lambda: figures(ops) | {"fleet": coordinator(fleet, run.objects)},
        )
        return run


def waiting(fleet: FleetDriver) -> list[int]:
    """Returns the numbers of the robots of a FleetDriver that wait for too long."""
    traffic, robots = fleet.traffic, fleet.robots
    waits = Waiting(traffic, fleet.transports).long()
    long = [robot for robot, _ in waits if traffic.time - robots.still_since[robot] >= TOO_LONG]
    return robots.kiva_ids[long].tolist()


def figures(ops: Operations) -> dict[str, Any]:
    """Returns what a recording keeps of a shift now."""
    shift = ops.shift
    tally, hours = shift.tally, max(shift.now - shift.began, 1e-9) / 3600
    return {
        # Not Operations.kpis(): its quantiles cost more the longer a shift lasts.
        "kpis": {
            "items_picked": tally.items_picked,
            "item_throughput_per_hour": tally.items_picked / hours,
            "orders_completed": tally.orders_completed,
            "orders_late": sum(0 < order.due < shift.now for order in shift.orders.values()),
        },
        "stations": [station(work_station, shift.now) for work_station in shift.stations],
    }


def coordinator(fleet: WorldFleet, objects: SimpleNamespace) -> dict[str, Any]:
    """Returns the state of a WorldFleet's coordinator as JSON; `objects` as
    RunFeed.objects."""
    watch = SimpleNamespace(
        by_hand=(),
        collisions=fleet.collisions,
        fleet=fleet.world.fleet,
        objects=objects,
        reasons={},
        refusals=lambda _now: {},
    )
    return catalogue.plain_coordinator(state_message(fleet.controller, watch, 0, ""))


def station(work_station: WorkStation, now: float) -> dict[str, Any]:
    """Returns a station at a time of the shift [s]."""
    return {
        "name": work_station.name,
        "kind": work_station.kind,
        "open": work_station.is_open,
        "inbound": sorted(work_station.inbound),
        "pieces": work_station.pieces,
        "busy_fraction": work_station.busy_fraction(now),
    }
