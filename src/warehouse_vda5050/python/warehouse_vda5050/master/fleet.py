# SPDX-License-Identifier: Apache-2.0
"""All vehicles behind the broker: commands by robot's number in, messages by vehicle out."""

from collections.abc import Iterable, Iterator, Sequence

from warehouse_vda5050.grid import Grid
from warehouse_vda5050.master.commands import Cancel, Command, RefusedError, Stop
from warehouse_vda5050.master.load_fit import Measure, unknown
from warehouse_vda5050.master.remote_vehicle import Happened, RemoteVehicle
from warehouse_vda5050.master.robots_file import RemoteRobot
from warehouse_vda5050.master.seen import SeenVehicles
from warehouse_vda5050.master.shadow import Shadow, shadow_of
from warehouse_vda5050.master.zone_desk import ClosedArea, ZoneDesk
from warehouse_vda5050.model import (
    Connection,
    Factsheet,
    InvalidFactsheet,
    ToVehicle,
    VehicleState,
)
from warehouse_vda5050.topics import Identity

ALL = 0  # the number that stands for every robot in a Stop


class RemoteFleet:
    """The vehicles of a file of robots. One thread at a time. zones: whether they may keep to zone
    sets, which 3.0 alone has; `measure` returns a storage unit's measures."""

    def __init__(
        self,
        robots: Iterable[RemoteRobot],
        grid: Grid,
        run: str,
        zones: bool = False,
        measure: Measure = unknown,
    ) -> None:
        self.grid, self._run, self._has_zones, self._measure = grid, run, zones, measure
        self._areas: tuple[ClosedArea, ...] = ()
        self._vehicles: dict[int, RemoteVehicle] = {}
        self._zones: dict[Identity, ZoneDesk] = {}
        self._by_identity: dict[Identity, RemoteVehicle] = {}
        self.roster = SeenVehicles()
        for robot in robots:
            self._add(robot)

    def _add(self, robot: RemoteRobot) -> RemoteVehicle:
        vehicle = RemoteVehicle(robot, self.grid, self._run, self._measure)
        self._vehicles[robot.number] = self._by_identity[robot.identity] = vehicle
        if self._has_zones:
            desk = ZoneDesk(robot, vehicle.view, self._run, self.grid.spacing)
            self._zones[robot.identity] = desk
            if self._areas:
                desk.close(self._areas)
        return vehicle

    def add(self, robot: RemoteRobot, now: float) -> None:
        """Adds a vehicle that was seen at the broker. Raises RefusedError: it is there already."""
        identity = robot.identity
        if other := self._by_identity.get(identity):
            name = f"{identity.manufacturer}/{identity.serial}"
            raise RefusedError(f"{name} is kiva{other.robot.number} already")
        self._add(robot)
        newest = self.roster.get(identity)
        if newest is None:
            return
        if newest.connection is not None:
            self._deliver(identity, Connection(newest.connection), now)
        for message in (newest.sheet, newest.state):
            if message is not None:
                self._deliver(identity, message, now)

    def check_removable(self, number: int) -> None:
        """Raises RefusedError unless a vehicle is there, idle and without a load."""
        vehicle = self._vehicles.get(number)
        if vehicle is None:
            raise RefusedError(f"kiva{number} is no vehicle of this master")
        if not vehicle.is_idle:
            raise RefusedError(f"kiva{number} carries out a command: make it manual, and wait")
        if vehicle.load:
            raise RefusedError(f"kiva{number} carries storage_unit{vehicle.load}: have it put down")

    def remove(self, number: int) -> None:
        """Removes a vehicle. Raises RefusedError as check_removable()."""
        self.check_removable(number)
        vehicle = self._vehicles.pop(number)
        self._zones.pop(vehicle.robot.identity, None)
        del self._by_identity[vehicle.robot.identity]

    def of(self, identity: Identity) -> RemoteVehicle | None:
        """Returns the vehicle of a name, None if it is no robot of this warehouse."""
        return self._by_identity.get(identity)

    @property
    def vehicles(self) -> Sequence[RemoteVehicle]:
        """The vehicles, by number."""
        return list(self._vehicles.values())

    def set_grid(self, grid: Grid) -> None:
        """Takes over the cells of the floor as it is now."""
        self.grid = grid
        for vehicle in self._vehicles.values():
            vehicle.set_grid(grid)

    def command(self, kiva_id: int, command: Command) -> None:
        """Gives a command to its vehicle; those to other robots are others' business."""
        if kiva_id == ALL and isinstance(command, (Stop, Cancel)):
            for vehicle in self._vehicles.values():
                vehicle.command(command)
        elif kiva_id in self._vehicles:
            self._vehicles[kiva_id].command(command)

    def expect_unit(self, kiva_id: int, unit: int) -> None:
        """Lets a vehicle say that it can't carry a unit that it is to fetch."""
        if kiva_id in self._vehicles:
            self._vehicles[kiva_id].expect_unit(unit)

    def take(
        self,
        identity: Identity,
        message: VehicleState | Connection | Factsheet | InvalidFactsheet,
        now: float,
    ) -> None:
        """Takes a vehicle's message; those of vehicles that are in no file are seen alone."""
        self.roster.take(identity, message)
        self._deliver(identity, message, now)

    def _deliver(
        self,
        identity: Identity,
        message: VehicleState | Connection | Factsheet | InvalidFactsheet,
        now: float,
    ) -> None:
        vehicle = self._by_identity.get(identity)
        if vehicle is None:
            return
        zones = self._zones.get(identity)
        if isinstance(message, VehicleState):
            vehicle.take_state(message, now)
            if zones and vehicle.view.state is message:
                zones.take_state(message)
        elif isinstance(message, InvalidFactsheet):
            vehicle.refuse_factsheet(message.fault)
        elif isinstance(message, Factsheet):
            vehicle.take_factsheet(message)
            if zones:
                zones.take_factsheet(message)
        else:
            vehicle.take_connection(message.state, now)

    def close_zones(self, areas: Iterable[ClosedArea]) -> None:
        """Takes the closed zones of the floor as they are now."""
        areas = self._areas = tuple(areas)
        for zones in self._zones.values():
            zones.close(areas)

    def messages(self, now: float) -> Iterator[tuple[Identity, ToVehicle]]:
        """Yields the messages to send, with the vehicle of each."""
        for vehicle in self._vehicles.values():
            for message in vehicle.messages(now):
                yield vehicle.robot.identity, message
        for identity, zones in self._zones.items():
            for about in zones.messages(now):
                yield identity, about

    def shadows(self, now: float) -> list[Shadow]:
        """Returns the warehouse's rows of the vehicles that have reported a position."""
        shadows = (shadow_of(vehicle, now) for vehicle in self._vehicles.values())
        return [shadow for shadow in shadows if shadow is not None]

    def take_events(self) -> list[Happened]:
        """Returns what has happened since the last call."""
        for identity, zones in self._zones.items():
            self._by_identity[identity].note_refusals(zones.take_news())
        return [event for v in self._vehicles.values() for event in v.take_events()]
