# SPDX-License-Identifier: Apache-2.0
"""Prints what a master has to know of the running warehouse, as JSON: cells, robots, units and a
trip for each of several robots that is in no other's way."""

import json

import rospy

from warehouse_client.routes import NoRouteError, route
from warehouse_msgs.msg import WarehouseState
from warehouse_vda5050.fetch_trip import free_cells, wait_for_warehouse
from warehouse_vda5050.ros.floor import grid_of, read_map


def cells_of(state: WarehouseState, grid):
    robots = {k.kiva_id: grid.cell_at(k.pose.x, k.pose.y) for k in state.kivas}
    units = {
        int(u.name.removeprefix("storage_unit")): grid.cell_at(u.pose.position.x, u.pose.position.y)
        for u in state.storage_units
    }
    return robots, units


def trips(state, grid, robots, units):
    """Yields for robots, one after another: to a unit, on to a station, back to the unit's place.

    A way keeps clear of all other robots where they stand."""
    goals = [(s.name, grid.cell_at(s.x[s.service], s.y[s.service])) for s in state.stations]
    for kiva, here in robots.items():
        others = {cell for cell in robots.values() if cell != here}
        free = free_cells(grid) - others
        for unit, place in sorted(units.items(), key=lambda item: _far(item[1], here)):
            loaded = free - (set(units.values()) - {place})
            for station, goal in goals:
                try:
                    there = route(free, here, place)
                    onward = route(loaded, place, goal)
                    back = route(loaded, goal, place)
                except NoRouteError:
                    continue
                yield {
                    "robot": kiva,
                    "unit": unit,
                    "station": station,
                    "there": there,
                    "onward": onward,
                    "back": back,
                    **longest_straight(onward),
                }
                break
            else:
                continue
            break


def longest_straight(way):
    """Returns the longest straight of a way, and the approach to it."""
    corners = [
        k
        for k in range(1, len(way) - 1)
        if way[k - 1][0] != way[k + 1][0] and way[k - 1][1] != way[k + 1][1]
    ]
    ends = [0, *corners, len(way) - 1]
    first, last = max(zip(ends, ends[1:]), key=lambda run: run[1] - run[0])
    return {"approach": way[: first + 1], "straight": way[first : last + 1]}


def steps_aside(grid, robots):
    """Returns for each robot a step to a free neighbour and back: twenty at once."""
    taken = set(robots.values()) | grid.blocked
    ways = {}
    for kiva, (x, y) in robots.items():
        for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            cell = (x + dx, y + dy)
            if grid.contains(cell) and cell not in taken:
                taken.add(cell)
                ways[kiva] = [(x, y), cell]
                break
    return ways


def main() -> None:
    rospy.init_node("floor", anonymous=True)
    state = wait_for_warehouse()
    grid = grid_of(read_map())
    robots, units = cells_of(state, grid)
    chosen = []
    for trip in trips(state, grid, robots, units):
        chosen.append(trip)
        if len(chosen) == 3:
            break
    floor = {key: getattr(grid, key) for key in ("x", "y", "spacing", "columns", "rows")}
    steps = steps_aside(grid, robots)
    print(json.dumps({"floor": floor, "robots": robots, "trips": chosen, "steps": steps}))


def _far(a, b):
    return abs(a[0] - b[0]) + abs(a[1] - b[1])


if __name__ == "__main__":
    main()
