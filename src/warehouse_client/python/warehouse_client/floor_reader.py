# SPDX-License-Identifier: Apache-2.0
"""Stations and storage places as messages, read from the world's scenery and its map."""

from typing import Any

from nav_msgs.srv import GetMap

from warehouse_layout.floor import plan_reader
from warehouse_layout.floor.floor_plan import FloorError, FloorPlan
from warehouse_msgs.msg import Station


def station_messages(plan: FloorPlan) -> list[Station]:
    """Returns the Station messages of a FloorPlan."""
    return [
        Station(
            name=station.name,
            kind=station.kind,
            **dict(zip("xy", plan.point_of(station.cells))),
            service=station.service,
            belt=station.belt,
        )
        for station in plan.stations
    ]


class FloorReader:
    """Stations and storage places of the warehouse that stands. `ros` is rospy.

    `stations` are Station messages, `places` are the x and the y of storage places [m].
    """

    def __init__(self, ros: Any) -> None:
        self._ros = ros
        self._scenery: Any = None
        self._warning: str | None = None
        self.stations: list[Station] = []
        self.places: Any = ([], [])

    def take(self, scenery: Any) -> bool:
        """Reads the floor again if a Scenery (or None) has other things. Returns whether it did."""
        if scenery is None or same_things(scenery, self._scenery):
            return False
        try:
            grid = self._ros.ServiceProxy("warehouse/map", GetMap)().map
            plan = plan_reader.of_messages(grid, scenery) if grid.data else None
        except self._ros.ServiceException:
            return False  # the world starts or ends; a later call reads it
        except FloorError as error:
            self._warn(f"the floor has no stations: {error}")
            plan = None
        self._scenery = scenery
        self._take(plan)
        return True

    def _take(self, plan: FloorPlan | None) -> None:
        """Sets stations and places of a FloorPlan; None without a floor."""
        self.stations = station_messages(plan) if plan else []
        self.places = plan.point_of(plan.storage.ravel().nonzero()[0]) if plan else ([], [])
        for reason in plan.without_lane if plan else ():
            self._warn(reason)

    def _warn(self, text: str) -> None:
        if text != self._warning:
            self._ros.logwarn(text)
        self._warning = text


def same_things(a: Any, b: Any) -> bool:
    """Returns whether two sceneries have the same models on the same floor, moved or not."""
    if a is b or a is None or b is None:
        return a is b
    floors = list(a.floor) == list(b.floor) and a.grid_spacing == b.grid_spacing
    return floors and a.models == b.models and a.model_look == b.model_look and a.looks == b.looks
