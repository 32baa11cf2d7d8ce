# SPDX-License-Identifier: Apache-2.0
"""The fleet of a running warehouse at a moment, by its messages."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from warehouse_client.warehouse import WarehouseClient
from warehouse_fleet.robots.failures import DOWN
from warehouse_fleet.transports.transport_book import (
    BRINGING,
    DROPPING,
    FETCHING,
    LIFTING,
    OPEN,
    STORING,
    WAITING,
    Kind,
    Step,
    TransportEvent,
)
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_operations.fleets.fleet_now import FleetNow, RobotNow, TransportNow
from warehouse_operations.shift.shift import Shift
from warehouse_operations.stock.stations import Visit

STEPS = {"lifting": LIFTING, "dropping": DROPPING}  # by what the coordinator says a robot does


def fleet_now(
    shift: Shift,
    plan: FloorPlan,
    warehouse: WarehouseClient,
    state: Any,
    robot_of: Mapping[int, int],
) -> FleetNow:
    """Returns the fleet of a shift. state: the CoordinatorState. robot_of: the robot of each
    transport that has one."""
    doing = dict(zip(state.doing_kiva, state.doing))
    transports = list(_transports(shift, plan, doing, robot_of))
    closed = [station.name for station in shift.stations if not station.is_open]
    events = [
        TransportEvent(shift.now, visit.transport_id, Kind.CANCELLED, 0, visit.unit, "", "")
        for visit in shift.visits.under_way
        if is_cancelled(visit)
    ]
    robots = _robots(plan, warehouse.fleet, {*state.manual_kiva, *state.out_of_service_kiva})
    units = warehouse.standing_units(plan)
    carriers = zip(warehouse.fleet.shelf_id, warehouse.fleet.kiva_id)
    carried = {unit: kiva_id for unit, kiva_id in carriers if unit and kiva_id in robots}
    return FleetNow(shift.now, robots, units, transports, events, closed, carried)


def is_cancelled(visit: Visit) -> bool:
    """Returns whether the unit of a visit does not come, and was not lifted."""
    return visit.released is not None and visit.lifted is None


def _robots(plan: FloorPlan, fleet: Any, away: set[int]) -> dict[int, RobotNow]:
    cells = np.asarray(plan.cell_of(fleet.x, fleet.y)).tolist()
    broken = (np.frombuffer(bytes(fleet.failures), np.uint8) & DOWN).astype(bool).tolist()
    charge = np.asarray(fleet.charge, float).tolist()
    return {
        kiva_id: RobotNow(int(cell), level, kiva_id not in away, is_broken)
        for kiva_id, cell, level, is_broken in zip(fleet.kiva_id, cells, charge, broken)
        if cell >= 0
    }


def _transports(
    shift: Shift, plan: FloorPlan, doing: Mapping[int, str], robot_of: Mapping[int, int]
) -> Iterator[TransportNow]:
    service = {s.name: int(s.cells[s.service]) for s in plan.stations}
    for visit in shift.visits.under_way:
        if is_cancelled(visit):
            continue
        kiva_id = robot_of.get(visit.transport_id, 0)
        name = visit.station.name
        step = _step(visit, kiva_id, doing.get(kiva_id, ""))
        since = shift.now if step in (LIFTING, DROPPING) else visit.requested
        yield TransportNow(
            visit.transport_id, visit.unit, name, service[name], step, kiva_id, since=since
        )


def _step(visit: Visit, kiva_id: int, doing: str) -> Step:
    """Returns the step of the transport of a visit."""
    if visit.lifted is None:
        return STEPS.get(doing, FETCHING) if kiva_id else OPEN
    if visit.released is not None:
        return STEPS.get(doing, STORING)
    return BRINGING if visit.arrived is None else WAITING
