# SPDX-License-Identifier: Apache-2.0
"""The warehouse as a picture of few markers, sent again only where something moved."""

import time

import numpy as np
from visualization_msgs.msg import MarkerArray

from warehouse_msgs.msg import Event, FleetState, KivaStatus, UnitStates, WarehouseObjects
from warehouse_sim import markers, poses, survey, tracking
from warehouse_sim.engine import Engine, EngineError
from warehouse_sim.latest import LatestMessages, LazyPublisher
from warehouse_sim.shapes import ShapeArray

LOOK_EVERY = 1.0  # at what is neither robot, unit nor item [s, wall]
MARGIN = 2.0  # of a floor of unknown size, around what stands on it [m]


def fleet_shapes(fleet, blocked):
    """Markers of a FleetState; `blocked` names the robots whose last command ended so."""
    at = np.column_stack([fleet.x, fleet.y, fleet.yaw]).reshape(-1, 3)
    # rospy reads uint8[] as bytes.
    status = np.frombuffer(bytes(fleet.status), np.uint8).copy()
    status[[f"kiva{number}" in blocked for number in fleet.kiva_id]] = KivaStatus.STATUS_BLOCKED
    return markers.robots(at, status, np.array(fleet.shelf_id, int) > 0)


def load_shapes(objects, states):
    """Markers of units and items."""
    units = _upright(tracking.storage_units(objects, states).pose)
    items = _upright(tracking.items(objects, states).pose)
    return [
        *markers.straight_units(units[~_turned(units)]),
        *markers.turned_units(units[_turned(units)]),
        *markers.straight_items(items[~_turned(items)]),
        *markers.turned_items(items[_turned(items)]),
    ]


def _upright(rows):
    """x y z yaw of pose rows."""
    return np.column_stack([rows[:, :3], poses.yaw(rows)])


def _turned(things):
    """Which of (n, 4) x y z yaw are not in line with the axes."""
    return np.abs(np.sin(2 * things[:, 3])) > 0.01


def fixed_shapes(found, bounds):
    """Markers of what never moves by itself, in a survey.Survey on a floor of these bounds."""
    belts = np.reshape(list(found.conveyor_belt.values()), (-1, 3))
    bounds = bounds or _around(found)
    return [*markers.floor(bounds), *markers.belts(belts), *markers.others(found.others)]


def _around(found):
    groups = (found.kiva, found.storage_unit, found.conveyor_belt, found.others)
    at = [pose[:2] for group in groups for pose in group.values()] or [(0, 0)]
    low, high = np.floor(np.min(at, 0)), np.ceil(np.max(at, 0))
    x0, y0, x1, y1 = *(low - MARGIN - 0.5), *(high + MARGIN + 0.5)
    return x0, x1, y0, y1


class Picture:
    """Publishes /warehouse/markers. `ros` is rospy."""

    def __init__(self, ros):
        self._ros, self._shapes, self._news = ros, {}, []
        self._seen, self._next_look = None, 0.0
        self._blocked = set()
        ros.Subscriber("/warehouse/events", Event, self._note, queue_size=1000)
        self._newest = LatestMessages(
            ros,
            fleet=("/warehouse/fleet", FleetState),
            objects=("/warehouse/objects", WarehouseObjects),
            states=("/warehouse/unit_states", UnitStates),
        )
        self._topic = LazyPublisher(ros, "/warehouse/markers", MarkerArray, self._all, self._moved)

    def _note(self, event):
        """The status BLOCKED itself lasts but a moment; it shows until the next command."""
        if event.kind == Event.BLOCKED:
            self._blocked.add(event.model)
        elif event.kind == Event.ACCEPTED:
            self._blocked.discard(event.model)

    def _all(self):
        return ShapeArray(list(self._shapes.values()))

    def _moved(self):
        return ShapeArray(self._news)

    def turn(self, patience=0.5):
        """Waits for news, at most `patience` wall seconds, and shows them."""
        self._newest.wait(patience)
        fleet, fit = self._newest["fleet"], self._newest.units_and_objects
        shapes = fleet_shapes(fleet, self._blocked) if fleet else []
        if fit:
            shapes += load_shapes(*fit) + self._look(fit[0].revision)
        self._news = [s for s in shapes if not s.same_as(self._shapes.get(s.name))]
        self._shapes.update((s.name, s) for s in self._news)
        if self._news:
            self._topic.publish()

    def _look(self, revision):
        """Markers of what stands there besides, if that may have changed."""
        if revision == self._seen or time.monotonic() < self._next_look:
            return []
        self._next_look = time.monotonic() + LOOK_EVERY
        bounds = self._ros.get_param("/warehouse/floor", None)
        # Where the floor is known, nothing depends on what moves.
        without = ("kiva", "storage_unit", "item") if bounds else ("item",)
        try:
            with Engine(self._ros) as engine:
                found = survey.of_engine(engine, without)
        except EngineError:
            return []
        self._seen = revision
        return fixed_shapes(found, bounds)


def follow(ros):
    """Until shutdown; the body of the node."""
    picture = Picture(ros)
    while not ros.is_shutdown():
        picture.turn()
