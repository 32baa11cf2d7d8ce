# SPDX-License-Identifier: Apache-2.0
"""The trip of the demonstration: where from and where to, and the orders for it."""

from itertools import product
from typing import Any

import rospy

from warehouse_client.message_check import subscribe
from warehouse_client.routes import NoRouteError, route
from warehouse_msgs.msg import WarehouseState
from warehouse_vda5050.demo_master import DemoMaster, TripError, order_of
from warehouse_vda5050.grid import Cell, Grid
from warehouse_vda5050.model import Action, BlockingType
from warehouse_vda5050.ros.floor import grid_of, read_map
from warehouse_vda5050.topics import Identity

WAIT = 60.0  # for the warehouse to be built [s]


class FetchTrip:
    """One unit from its place to the cell where a station serves, and the robot out of its way."""

    def __init__(self, master: DemoMaster) -> None:
        self._master = master

    def run(self) -> None:
        """Drives the trip. Raises TripError."""
        master = self._master
        warehouse = wait_for_warehouse()
        vehicles = master.wait_for_vehicles(len(warehouse.kivas))
        print(f"{len(vehicles)} vehicles at the broker", flush=True)
        grid = grid_of(read_map())
        robots = {k.kiva_id: grid.cell_at(k.pose.x, k.pose.y) for k in warehouse.kivas}
        units = {
            int(standing.name.removeprefix("storage_unit")): grid.cell_at(
                standing.pose.position.x, standing.pose.position.y
            )
            for standing in warehouse.storage_units
        }
        who, unit, goal = self._choose(warehouse, vehicles, grid, robots, units)
        self._drive(who, unit, goal, grid, robots, units)

    def _choose(
        self,
        warehouse: Any,
        vehicles: list[Identity],
        grid: Grid,
        robots: dict[int, Cell],
        units: dict[int, Cell],
    ) -> tuple[Identity, int, Cell]:
        station = next(iter(warehouse.stations), None)
        if station is None:
            raise TripError("the warehouse has no station")
        goal = grid.cell_at(station.x[station.service], station.y[station.service])
        for who in sorted(vehicles, key=lambda vehicle: vehicle.serial):
            for unit, place in units.items():
                here = robots.get(int(who.serial))
                if here and _ways(grid, here, place, goal, robots, units):
                    print(f"unit {unit} goes from {grid.node_id(place)} to station {station.name}")
                    return who, unit, goal
        raise TripError("no robot has a way to a unit and on to a station")

    def _drive(
        self,
        who: Identity,
        unit: int,
        goal: Cell,
        grid: Grid,
        robots: dict[int, Cell],
        units: dict[int, Cell],
    ) -> None:
        here, place = robots[int(who.serial)], units[unit]
        ways = _ways(grid, here, place, goal, robots, units)
        assert ways
        there, onward = ways
        pick = _action("pick", [("loadId", str(unit))])
        stamp = str(rospy.Time.now().to_nsec())
        fetch = order_of(f"fetch-{stamp}", there, grid, {len(there) - 1: pick})
        self._master.carry_out(who, fetch)
        bring = order_of(f"bring-{stamp}", onward, grid, {len(onward) - 1: _action("drop", [])})
        state = self._master.carry_out(who, bring)
        if state.loads:
            raise TripError(f"{who.serial} still carries {state.loads[0].id}")
        print(f"unit {unit} stands at {state.last_node}", flush=True)


def free_cells(grid: Grid) -> set[Cell]:
    """Returns the cells of a floor that nothing blocks."""
    return set(product(range(grid.columns), range(grid.rows))) - grid.blocked


def _action(type: str, parameters: list[tuple[str, Any]]) -> Action:
    pairs = [("stationType", "place"), ("loadType", "unit"), *parameters]
    return Action(type, f"{type}-1", BlockingType.HARD, tuple(pairs))


def _ways(
    grid: Grid,
    here: Cell,
    place: Cell,
    goal: Cell,
    robots: dict[int, Cell],
    units: dict[int, Cell],
) -> tuple[list[Cell], list[Cell]] | None:
    """Returns the way to a unit, beneath others, and the way on with it; None without one."""
    others = {cell for cell in robots.values() if cell != here}
    standing = set(units.values()) - {place}
    free = free_cells(grid) - others
    try:
        there = route(free, here, place)
        onward = route(free - standing, place, goal)
    except NoRouteError:
        return None
    return there, onward


def wait_for_warehouse() -> WarehouseState:
    """Returns the warehouse once robots, units and stations stand in it. Raises TripError."""
    messages: list[WarehouseState] = []

    def look(state: WarehouseState) -> None:
        if state.kivas and state.storage_units and state.stations:
            messages.append(state)

    subscribe(rospy, "warehouse/state", WarehouseState, look, queue_size=1)
    for _ in range(int(WAIT * 10)):
        if messages:
            return messages[-1]
        rospy.rostime.wallsleep(0.1)
    raise TripError("the warehouse was not built in time")
