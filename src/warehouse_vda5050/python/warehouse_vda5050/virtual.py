# SPDX-License-Identifier: Apache-2.0
"""Many vehicles without a world: our vehicle core, and robots that drive by a formula."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

from warehouse_vda5050.codec import Codec
from warehouse_vda5050.faults.kinds import FaultError, FaultRequest
from warehouse_vda5050.faults.vehicle_faults import VehicleFaults
from warehouse_vda5050.formula_driver import FormulaRobot
from warehouse_vda5050.grid import Cell, Grid
from warehouse_vda5050.model import Factsheet
from warehouse_vda5050.mqtt.loop import MqttLoop
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.mqtt.vehicle_link import VehicleLink
from warehouse_vda5050.topics import Identity, Kind, Topics
from warehouse_vda5050.vehicle import Vehicle, VehicleSettings

MOST = 10_000  # vehicles of one program


@dataclass(frozen=True)
class VirtualSettings:
    """The vehicles; `moving` and `visualization` as in VehicleSettings, speed [m/s]."""

    count: int
    manufacturer: str
    codec: Codec
    topics: Topics
    broker: BrokerSettings
    grid: Grid
    speed: float = 1.5
    moving: float = 1.0
    visualization: float = 1.0


class VirtualRobot(FormulaRobot):
    """A robot of a virtual fleet."""

    def factsheet(self) -> Factsheet:
        """Returns what it is."""
        return Factsheet(description="virtual robot", max_speed=self._speed)


class VirtualFleet:
    """Vehicles 1 … count at a broker, spread over a floor. They don't feel each other.

    `loop` serves their connections. Raises ValueError where the floor is too small.
    """

    def __init__(self, settings: VirtualSettings) -> None:
        self.loop = MqttLoop()
        self._robots: list[FormulaRobot] = []
        self.links: list[VehicleLink] = []
        self._now: float | None = None
        for number, cell in enumerate(_spread(settings.grid, settings.count), 1):
            self._add(settings, number, cell)

    def _add(self, settings: VirtualSettings, number: int, cell: Cell) -> None:
        robot = VirtualRobot(*settings.grid.position(cell), 0.0, settings.speed)
        faults = VehicleFaults(robot, lambda text, _begins: vehicle.note_event(text))
        vehicle = Vehicle(
            faults.driver,
            settings.grid,
            VehicleSettings(
                moving=settings.moving,
                visualization=settings.visualization,
                begins_at_zero=settings.codec.version.startswith("3"),
                zones=settings.codec.version.startswith("3"),
                name=f"{settings.manufacturer}-{number}",
            ),
        )
        identity = Identity(settings.manufacturer, str(number))
        link = VehicleLink(
            vehicle, identity, settings.codec, settings.topics, settings.broker, faults
        )
        self._robots.append(robot)
        self.links.append(link)
        self.loop.add(link.link)

    def tick(self, now: float) -> None:
        """Lets the robots drive on to `now`, any clock [s], and sends what the vehicles report."""
        seconds = now - (now if self._now is None else self._now)
        self._now = now
        for robot, link in zip(self._robots, self.links):
            robot.step(seconds)
            if robot.is_moving or not link.rests(now):
                link.tick(now)

    def begin_fault(self, number: int, request: FaultRequest, now: float) -> None:
        """Lets a vehicle misbehave, or ends that. Raises FaultError."""
        if not 1 <= number <= len(self.links):
            raise FaultError(f"vehicle {number} is not there; 1 to {len(self.links)} are")
        self.links[number - 1].faults.active.begin(request, now)

    @property
    def sent(self) -> Counter[Kind]:
        """The count of messages that were sent, by kind."""
        return sum((link.sent_counts for link in self.links), Counter())

    @property
    def connected(self) -> int:
        """The count of vehicles that are connected."""
        return sum(link.link.connected for link in self.links)

    @property
    def moving(self) -> int:
        """The count of vehicles that drive."""
        return sum(robot.is_moving for robot in self._robots)

    def close(self) -> None:
        """Says OFFLINE for all and disconnects."""
        for link in self.links:
            link.close()
        self.loop.close()


def _spread(grid: Grid, count: int) -> Iterator[Cell]:
    """Yields `count` cells, spread evenly over a floor. Raises ValueError."""
    cells = grid.columns * grid.rows
    if not 1 <= count <= min(cells, MOST):
        most = min(cells, MOST)
        raise ValueError(f"vehicles is {count}; 1 to {most} was expected on {cells} cells")
    for k in range(count):
        at = k * cells // count
        yield at % grid.columns, at // grid.columns
