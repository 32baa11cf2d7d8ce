# SPDX-License-Identifier: Apache-2.0
"""All robots of the running warehouse as vehicles; they come and go with the robots."""

import random
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from warehouse_vda5050.codec import Codec
from warehouse_vda5050.faults.kinds import FaultError, FaultRequest
from warehouse_vda5050.faults.vehicle_faults import VehicleFaults
from warehouse_vda5050.grid import Grid
from warehouse_vda5050.model import Factsheet
from warehouse_vda5050.mqtt.loop import MqttLoop
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.mqtt.vehicle_link import VehicleLink
from warehouse_vda5050.simulated_driver import Sighting, SimulatedDriver, World
from warehouse_vda5050.topics import Identity, Topics
from warehouse_vda5050.vehicle import Vehicle, VehicleSettings


@dataclass(frozen=True)
class SiteSettings:
    """What all vehicles share; `moving`, `visualization` and `logs` as in VehicleSettings."""

    manufacturer: str
    codec: Codec
    topics: Topics
    broker: BrokerSettings
    moving: float = 1.0
    visualization: float = 1.0
    logs: Path | None = None


class Vehicles:
    """The vehicles of one warehouse by their robots' numbers. happened(kiva_id, text, begins) is
    called when a fault on demand begins or ends."""

    def __init__(
        self,
        world: World,
        settings: SiteSettings,
        happened: Callable[[int, str, bool], None] = lambda _id, _text, _begins: None,
    ) -> None:
        self.loop = MqttLoop()
        self.links: dict[int, VehicleLink] = {}
        self._drivers: dict[int, SimulatedDriver] = {}
        self._world, self._settings, self._happened = world, settings, happened
        self._grid: Grid | None = None
        # No path has the number of one of an earlier run.
        self._first_path = random.randrange(1, 1 << 31)

    def set_grid(self, grid: Grid) -> None:
        """Takes over the floor; on another floor the vehicles begin again."""
        before, self._grid = self._grid, grid
        if before and _shape(before) != _shape(grid):
            for kiva_id in [*self.links]:
                self._remove(kiva_id)
        for link in self.links.values():
            link.vehicle.set_grid(grid)

    def update(
        self,
        sightings: dict[int, Sighting],
        refusals: list[tuple[int, str]],
        silence: str = "",
    ) -> None:
        """Takes the world's messages, and updates all vehicles. silence: why the world no longer
        sends any, '' if it does."""
        for kiva_id in self.links.keys() - sightings.keys():
            self._remove(kiva_id)
        for kiva_id, text in refusals:
            if kiva_id in self._drivers:
                self._drivers[kiva_id].refusal = text
        now = time.monotonic()
        for kiva_id, sighting in sightings.items():
            if kiva_id not in self.links and self._grid:
                self._add(kiva_id, self._grid)
            if kiva_id in self.links:
                driver, link = self._drivers[kiva_id], self.links[kiva_id]
                is_new = (driver.sighting, driver.silence) != (sighting, silence)
                driver.sighting, driver.silence = sighting, silence
                if is_new or not link.rests(now):
                    link.tick(now)

    def begin_fault(self, kiva_id: int, request: FaultRequest) -> None:
        """Lets a vehicle misbehave, or ends that. Raises FaultError."""
        self.check(kiva_id)
        self.links[kiva_id].faults.active.begin(request, time.monotonic())

    def check(self, kiva_id: int) -> None:
        """Raises FaultError unless the robot is a vehicle."""
        numbers = sorted([*self.links])
        if kiva_id not in numbers:
            more = f" and {len(numbers) - 10} more" if len(numbers) > 10 else ""
            names = ", ".join(f"kiva{number}" for number in numbers[:10])
            raise FaultError(f"kiva{kiva_id} is no vehicle; vehicles are {names or 'none'}{more}")

    def _add(self, kiva_id: int, grid: Grid) -> None:
        settings = self._settings
        driver = SimulatedDriver(kiva_id, self._world, Factsheet(description="simulated robot"))
        faults = VehicleFaults(driver, lambda text, begins: self._note(kiva_id, text, begins))
        vehicle = Vehicle(
            faults.driver,
            grid,
            VehicleSettings(
                moving=settings.moving,
                visualization=settings.visualization,
                first_path=self._first_path,
                begins_at_zero=settings.codec.version.startswith("3"),
                zones=settings.codec.version.startswith("3"),
                logs=settings.logs,
                name=f"{settings.manufacturer}-{kiva_id}",
            ),
        )
        identity = Identity(settings.manufacturer, str(kiva_id))
        link = VehicleLink(
            vehicle, identity, settings.codec, settings.topics, settings.broker, faults
        )
        self._drivers[kiva_id], self.links[kiva_id] = driver, link
        self.loop.add(link.link)

    def _note(self, kiva_id: int, text: str, begins: bool) -> None:
        self.links[kiva_id].vehicle.note_event(text)
        self._happened(kiva_id, text, begins)

    def _remove(self, kiva_id: int) -> None:
        self.links.pop(kiva_id).close()
        self._drivers.pop(kiva_id).sighting = None

    def close(self) -> None:
        """Gives robots back, says OFFLINE for all and disconnects."""
        for kiva_id, link in self.links.items():
            link.vehicle.abandon()
            self._drivers[kiva_id].give_back()
            link.close()
        self.loop.close()


def _shape(grid: Grid) -> tuple[float, float, float, int, int]:
    return grid.x, grid.y, grid.spacing, grid.columns, grid.rows
