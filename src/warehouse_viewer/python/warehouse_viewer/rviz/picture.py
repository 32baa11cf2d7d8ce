# SPDX-License-Identifier: Apache-2.0
"""The warehouse as a picture of few markers, sent again only where something moved."""

from collections.abc import Mapping, Sequence
from types import ModuleType
from typing import Any

import numpy as np
from visualization_msgs.msg import MarkerArray

from warehouse_client import tracking
from warehouse_client.latest import LatestMessages, LazyPublisher
from warehouse_layout.floor import floor_markings, poses
from warehouse_msgs.msg import (
    CoordinatorPaths,
    FleetPaths,
    FleetState,
    Scenery,
    UnitStates,
    WarehouseObjects,
)
from warehouse_viewer.drawing import looks, markers
from warehouse_viewer.drawing.shapes import Shape, ShapeArray
from warehouse_viewer.page.activities import Activity, activity
from warehouse_viewer.rviz import fleet_ways
from warehouse_viewer.rviz.chosen import Chosen
from warehouse_viewer.rviz.paths import PathTopics, ways


def fleet_shapes(
    scenery: Scenery, fleet: FleetState, heights: Mapping[int, float], chosen: int
) -> list[Any]:
    """Returns the markers of a FleetState.

    `heights` [m] are those of carried units by robot's number, `chosen` is a robot's number or 0.
    """
    at = np.column_stack([fleet.x, fleet.y, fleet.yaw]).reshape(-1, 3)
    numbers = list(map(int, fleet.kiva_id))
    does = activity(fleet)
    look = looks.named(scenery, "kiva")
    trouble = {n for n, d in zip(numbers, does) if d == Activity.NEEDS_HELP}
    lift = np.array([heights.get(n, 0.0) for n in numbers])
    where = at[numbers.index(chosen), :2] if chosen in numbers else None
    return [
        *markers.robots(look, at, does, lift),
        *markers.names(look, numbers, at, trouble | {chosen}),
        *markers.chosen(where),
    ]


def load_shapes(scenery: Scenery, objects: WarehouseObjects, states: UnitStates) -> list[Any]:
    """Returns the markers of units and items; of units without their shelves, no items."""
    units = tracking.storage_units(objects, states).pose
    look = looks.named(scenery, "storage_unit")
    shown = markers.things("units", look, _upright(units))
    if markers.are_thinned(look, len(units)):
        return shown
    items = tracking.items(objects, states).pose
    return [*shown, *markers.things("items", looks.named(scenery, "item"), _upright(items))]


SILENT = 2.0  # after which a coordinator counts as gone [s, simulated]


def way_shapes(
    fleet: FleetState, paths: FleetPaths | None, coordinated: CoordinatorPaths | None
) -> list[Any]:
    """Returns the markers of where robots go."""
    if coordinated is None or (fleet.stamp - coordinated.stamp).to_sec() > SILENT:
        coordinated = CoordinatorPaths()
    others = [w for number, w in ways(fleet, paths) if number not in set(coordinated.kiva_id)]
    where = dict(zip(fleet.kiva_id, zip(fleet.x, fleet.y)))
    return [
        *markers.paths(others),
        *markers.fleet_ways(
            *fleet_ways.released_and_planned(coordinated), fleet_ways.ties(coordinated, where)
        ),
    ]


def _upright(rows: np.ndarray) -> np.ndarray:
    """x y z yaw of pose rows."""
    return np.column_stack([rows[:, :3], poses.yaw(rows)])


class Picture:
    """Publishes /warehouse/markers, and what RViz wants of robots. `ros` is rospy."""

    def __init__(self, ros: ModuleType) -> None:
        self._shapes: dict[Any, Any] = {}
        self._news: list[Any] = []
        self._scenery: Scenery | None = None
        self._fixed: list[Any] = []
        self._newest = LatestMessages(
            ros,
            fleet=("warehouse/fleet", FleetState),
            objects=("warehouse/objects", WarehouseObjects),
            states=("warehouse/unit_states", UnitStates),
            scenery=("warehouse/scenery", Scenery),
            paths=("warehouse/paths", FleetPaths),
            coordinated=("warehouse/coordinator_paths", CoordinatorPaths),
        )
        self._topic = LazyPublisher(ros, "warehouse/markers", MarkerArray, self._all, self._moved)
        self._chosen, self._paths = Chosen(ros), PathTopics(ros)

    def _all(self) -> ShapeArray:
        return ShapeArray(list(self._shapes.values()))

    def _moved(self) -> ShapeArray:
        return ShapeArray(self._news)

    def turn(self, patience: float = 0.5) -> None:
        """Waits at most `patience` [s, wall] for new messages, and publishes what changed."""
        self._newest.wait(patience)
        fleet, scenery = self._newest["fleet"], self._newest["scenery"]
        fit = self._newest.units_and_objects
        if not (fleet and scenery and fit):
            return
        self._chosen.take(fleet, scenery.grid_spacing or 1.0)
        self._paths.turn(fleet, self._newest["paths"])
        self._show(self._make(scenery, fleet, *fit))

    def _make(
        self, scenery: Scenery, fleet: FleetState, objects: WarehouseObjects, states: UnitStates
    ) -> list[Shape]:
        carried = zip(map(int, states.carrier), poses.rows(states.pose)[:, 2])
        heights = {robot: max(0.0, z) for robot, z in carried if robot}
        floor = looks.floor(scenery, fleet, states)
        return [
            *markers.floor(floor, scenery.grid_spacing or 1.0),
            *fleet_shapes(scenery, fleet, heights, self._chosen.number),
            *way_shapes(fleet, self._newest["paths"], self._newest["coordinated"]),
            *load_shapes(scenery, objects, states),
            *self._of_scenery(scenery),
        ]

    def _of_scenery(self, scenery: Scenery) -> list[Shape]:
        """Made once, as long as it is the same message."""
        if scenery is not self._scenery:
            self._scenery = scenery
            marks = floor_markings.readable(scenery)
            self._fixed = [*markers.paint(marks), *markers.scenery(scenery)]
        return self._fixed

    def _show(self, made: Sequence[Shape]) -> None:
        """Sends what differs from what was shown, and takes back what is gone."""
        shown = {shape.name: shape for shape in made}
        gone = [shape.gone() for name, shape in self._shapes.items() if name not in shown]
        changed = [s for s in made if not s.same_as(self._shapes.get(s.name))]
        self._shapes, self._news = shown, [*gone, *changed]
        if self._news:
            self._topic.publish()


def follow(ros: ModuleType) -> None:
    """Publishes until shutdown: the body of the node."""
    picture = Picture(ros)
    while not ros.is_shutdown():
        picture.turn()
