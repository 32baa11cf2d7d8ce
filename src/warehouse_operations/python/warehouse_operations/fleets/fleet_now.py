# SPDX-License-Identifier: Apache-2.0
"""A fleet at a moment, as plain data: robots, units, transports under way. A ForkedFleet goes on
from it."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from warehouse_fleet.robots.robot_table import NOWHERE
from warehouse_fleet.transports.transport_book import (
    OPEN,
    STORE,
    Leave,
    Step,
    Transport,
    TransportEvent,
)
from warehouse_operations.fleets.ideal_lifts import Journey

if TYPE_CHECKING:
    from warehouse_operations.fleets.ideal import IdealFleet
    from warehouse_operations.fleets.ideal_trips import Trips
    from warehouse_operations.fleets.world_fleet import WorldFleet


PLANNED = 4  # values of the argument of a planned act: act, its argument, robot, plan


@dataclass(frozen=True)
class RobotNow:
    """A robot: its cell, the charge of its battery, whether the fleet commands it, and whether it
    is broken."""

    cell: int
    charge: float = 1.0
    in_service: bool = True
    broken: bool = False


@dataclass(frozen=True)
class TransportNow:
    """A transport at a step, done by the robot of an id; 0: by none yet.

    cell: its destination. place: the storage place that is kept for its unit. since: begin of the
    step [s]. left: what the step's motion still takes [s]; NaN: by the robot's way.
    """

    number: int
    shelf: int
    station: str
    cell: int
    step: Step = OPEN
    kiva_id: int = 0
    then: int = STORE
    priority: int = 0
    leave: Leave = Leave.NO
    since: float = 0.0
    place: int = NOWHERE
    left: float = math.nan

    def transport(self) -> Transport:
        """Returns the Transport, without its robot."""
        fields = self.number, self.shelf, self.station, self.cell, self.then, self.priority
        return Transport(*fields, step=self.step, leave=self.leave, since=self.since)


@dataclass(frozen=True)
class FleetNow:
    """A fleet at a time [s].

    robots: by id. units: the cell of each unit that is not carried, by id. events: of transports,
    to be taken yet. closed: stations that get no units. carried: the id of the robot on which a
    unit is, of those that no transport carries at least: their robots lost it.
    """

    time: float
    robots: Mapping[int, RobotNow]
    units: Mapping[int, int]
    transports: Sequence[TransportNow] = ()
    events: Sequence[TransportEvent] = ()
    closed: Sequence[str] = field(default_factory=tuple)
    carried: Mapping[int, int] = field(default_factory=dict)


def of_world_fleet(fleet: "WorldFleet") -> FleetNow:
    """Returns the state of simulated robots."""
    transports, table = fleet.transports, fleet.robots
    ids = table.kiva_ids.tolist()
    columns = table.cell.tolist(), table.charge.tolist(), table.automatic.tolist()
    broken = (table.broken | table.lifts_not | table.lost).tolist()
    robots = {kiva_id: RobotNow(*row) for kiva_id, *row in zip(ids, *columns, broken)}
    units = {unit: int(cell) for unit, cell in transports.cell_of_unit.items() if cell >= 0}
    states = fleet.world.storage_units
    carriers = zip(states["shelf_id"].tolist(), states["kiva_id"].tolist())
    return FleetNow(
        fleet.time,
        robots,
        units,
        [_transport(transport, ids, transport.place) for transport in transports.book],
        transports.book.pending_events,
        [name for name, is_open in transports.is_open.items() if not is_open],
        {unit: kiva_id for unit, kiva_id in carriers if kiva_id},
    )


def of_ideal_fleet(fleet: "IdealFleet") -> FleetNow:
    """Returns the state of ideal robots, whose motions have a time at which they end."""
    trips = fleet.trips
    ids = [robot.kiva_id for robot in trips.robots]
    charge = trips.upkeep.charge if trips.upkeep else [1.0] * len(ids)
    carried = trips.without_transport()
    broken = set(carried.values())
    robots = {
        robot.kiva_id: RobotNow(
            robot.cell, float(charge[robot.index]), robot.in_service, robot.kiva_id in broken
        )
        for robot in trips.robots
    }
    ends = time_left(trips)
    transports = [
        _transport(transport, ids, _place(trips.robots, transport), ends.get(transport.number))
        for transport in trips.book
    ]
    closed = [name for name, is_open in fleet.is_open.items() if not is_open]
    events = trips.book.pending_events
    units = dict(fleet.cell_of_unit)
    return FleetNow(fleet.time, robots, units, transports, events, closed, carried)


def time_left(trips: "Trips") -> dict[int, float]:
    """Returns how long the present motion of each transport still takes [s], by number."""
    left: dict[int, float] = {}
    for event in trips.queue:
        if not isinstance(event.argument, tuple) or len(event.argument) != PLANNED:
            continue
        _, about, robot, plan = event.argument
        if plan == robot.plan:
            rest = robot.halt
            if isinstance(about, Journey):
                rest, about = rest + about.left, about.argument
            transport = about if isinstance(about, Transport) else about[0]
            left[transport.number] = event.time - trips.time + rest
    return left


def _place(robots: Sequence[Any], transport: Transport) -> int:
    place = robots[transport.robot].place if transport.robot != NOWHERE else None
    return NOWHERE if place is None else int(place)


def _transport(
    transport: Transport, ids: Sequence[int], place: int, left: float | None = None
) -> TransportNow:
    return TransportNow(
        transport.number,
        transport.shelf,
        transport.station,
        int(transport.cell),
        transport.step,
        ids[transport.robot] if transport.robot != NOWHERE else 0,
        transport.then,
        transport.priority,
        transport.leave,
        transport.since,
        place,
        math.nan if left is None else left,
    )


def of(fleet: Any) -> FleetNow:
    """Returns the state of either fleet of a shift in this process."""
    return of_ideal_fleet(fleet) if hasattr(fleet, "trips") else of_world_fleet(fleet)
