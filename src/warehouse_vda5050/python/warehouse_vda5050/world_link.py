# SPDX-License-Identifier: Apache-2.0
"""The running warehouse as its topics and services offer it to drivers of its robots."""

import contextlib
import threading
import time
from collections import deque
from collections.abc import Sequence
from typing import Any

import numpy as np
import rospy

from warehouse_client.commands import COMMANDS
from warehouse_client.message_check import wait_for
from warehouse_client.services import is_offered
from warehouse_client.unit_messages import unit_ids, unit_poses
from warehouse_layout.floor import plan_reader
from warehouse_layout.floor.floor_plan import FloorError
from warehouse_msgs.msg import (
    Event,
    FleetFollow,
    FleetState,
    FollowPath,
    Lift,
    LimitedPath,
    People,
    Scenery,
    UnitStates,
    WarehouseObjects,
)
from warehouse_msgs.srv import SetRobotMode
from warehouse_vda5050.driver import Point
from warehouse_vda5050.grid import Grid
from warehouse_vda5050.ros.floor import grid_of, read_map
from warehouse_vda5050.simulated_driver import Sighting

SET_MODE = "warehouse/set_robot_mode"
WAIT = 10.0  # timeout for the scenery of the floor [s]
SILENT = 3.0  # silence after which the world counts as ended or paused [s, wall]
TOWED = 0.02  # an idle lost robot that moves farther was moved by others [m]


class WorldLink:
    """Commands to the world, and its last messages. `floor` changes whenever it may have."""

    def __init__(self) -> None:
        self._fleet: Any = None
        self._heard_at = time.monotonic()
        self._people: frozenset[int] = frozenset()
        self._units: Any = None
        self._objects: Any = None
        self._refusals: deque[tuple[int, str]] = deque(maxlen=1000)
        self._lost: dict[int, tuple[float, float] | None] = {}
        self._lock = threading.Lock()
        self.chargers: frozenset[tuple[int, int]] = frozenset()
        self.grid: Grid | None = None
        self._floor_of: tuple[int, frozenset[int]] | None = None
        topics = ("warehouse/follow", "follow_limited", "lift", "cancel", "stop")
        self._topics = {
            topic: rospy.Publisher(topic, COMMANDS[topic], queue_size=1000) for topic in topics
        }
        self._taken: dict[str, int] = rospy.get_param("~taken", {})  # by an earlier run
        self._mode = rospy.ServiceProxy(SET_MODE, SetRobotMode)
        self._events = rospy.Publisher("warehouse/events", Event, queue_size=1000)
        follow = rospy.Subscriber
        follow("warehouse/events", Event, self._on_event, queue_size=10000)
        follow("warehouse/people", People, self._on_people, queue_size=1)
        follow("warehouse/unit_states", UnitStates, self._keep, "_units", queue_size=1)
        follow("warehouse/objects", WarehouseObjects, self._keep, "_objects", queue_size=1)
        follow("warehouse/fleet", FleetState, self._on_fleet, queue_size=1)

    def _keep(self, message: Any, name: str) -> None:
        setattr(self, name, message)

    def _on_fleet(self, message: FleetState) -> None:
        self._fleet, self._heard_at = message, time.monotonic()

    def _on_people(self, message: People) -> None:
        self._people = frozenset(message.stopped)

    def _on_event(self, event: Event) -> None:
        number = event.model.removeprefix("kiva")
        if number == event.model or not number.isdecimal():
            return
        with self._lock:
            if event.kind == Event.REFUSED:
                self._refusals.append((int(number), event.text))
            elif event.kind == Event.LOST:
                self._lost[int(number)] = None
            elif event.kind in (Event.ACCEPTED, Event.SPAWNED, Event.DELETED):
                self._lost.pop(int(number), None)

    # --- from the world

    @property
    def silence(self) -> str:
        """Why nothing is heard of the robots, '' as long as the world sends them."""
        silent = time.monotonic() - self._heard_at
        return f"the world has reported nothing for {SILENT:g} s" if silent > SILENT else ""

    def take_refusals(self) -> list[tuple[int, str]]:
        """Returns (robot, reason) of each refusal since the last call."""
        with self._lock:
            refusals = [*self._refusals]
            self._refusals.clear()
        return refusals

    def sightings(self) -> dict[int, Sighting]:
        """Returns the last report on each robot; {} before the first."""
        fleet = self._fleet
        if fleet is None:
            return {}
        columns = zip(
            fleet.kiva_id,
            zip(fleet.x, fleet.y, fleet.yaw, fleet.vx, fleet.vy, fleet.yaw_rate),
            zip(fleet.status, fleet.state, fleet.shelf_id, fleet.path_id, fleet.reached),
            zip(fleet.failures, fleet.charge, fleet.mode),
        )
        return {kiva_id: self._sighting(kiva_id, *parts) for kiva_id, *parts in columns}

    def _sighting(self, kiva_id: int, motion: Any, work: Any, health: Any) -> Sighting:
        x, y = motion[0], motion[1]
        at_charger = bool(self.grid and self.grid.cell_at(x, y) in self.chargers)
        lost = kiva_id in self._lost and not self._was_moved(kiva_id, x, y, work[0] == 0)
        values = [*motion, *work, *health, kiva_id in self._people, at_charger, lost]
        return Sighting(*values)

    def _was_moved(self, kiva_id: int, x: float, y: float, idle: bool) -> bool:
        """Returns whether a lost robot was moved by others, and knows its place since then."""
        with self._lock:
            where = self._lost.get(kiva_id)
            if where is None or not idle:
                self._lost[kiva_id] = (x, y)
                return False
            moved = max(abs(where[0] - x), abs(where[1] - y)) > TOWED
            if moved:
                del self._lost[kiva_id]
            return moved

    def unit_at(self, x: float, y: float) -> int:
        """Returns the number of the storage unit that stands there [m], 0 without one."""
        units, objects = self._units, self._objects
        if units is None or objects is None or units.revision != objects.revision:
            return 0
        xs, ys, _ = unit_poses(units)
        near = np.maximum(np.abs(np.asarray(xs) - x), np.abs(np.asarray(ys) - y)) < 0.3
        units_there = np.flatnonzero(near & (np.asarray(units.carrier) == 0))
        return int(unit_ids(objects)[units_there[0]]) if len(units_there) else 0

    def read_floor(self) -> bool:
        """Reads the map again if robots came or went, or the world was reset. Returns whether the
        grid is another one."""
        fleet = self._fleet
        if fleet is None:
            return False
        floor_of = (fleet.timeline, frozenset(fleet.kiva_id))
        if floor_of == self._floor_of and self.grid is not None:
            return False
        try:
            grid = read_map()
        except rospy.ServiceException:
            return False  # the world comes or goes; there is another time
        before, self.grid = self.grid, grid_of(grid)
        self.chargers = _chargers(grid)
        self._floor_of = floor_of
        return self.grid != before

    # --- to the world

    def follow(
        self,
        kiva_id: int,
        path_id: int,
        first: int,
        points: Sequence[Point],
        released: int,
        speeds: Sequence[float] = (),
    ) -> None:
        """Publishes on /warehouse/follow, and on /follow_limited with speeds."""
        x, y = zip(*points)
        if speeds:
            path = FollowPath(kiva_id, path_id, first, x, y, released)
            self._publish("follow_limited", LimitedPath(path, speeds))
            return
        message = FleetFollow([kiva_id], [path_id], [first], [len(x)], x, y, [released])
        self._publish("warehouse/follow", message)

    def lift(self, kiva_id: int, shelf_id: int, up: bool) -> None:
        """Publishes on /lift."""
        self._publish("lift", Lift.CARRY if up else Lift.DROP, kiva_id, shelf_id)

    def cancel(self, kiva_id: int) -> None:
        """Publishes on /cancel."""
        self._publish("cancel", kiva_id)

    def stop(self, kiva_id: int, stopped: bool) -> None:
        """Publishes on /stop."""
        self._publish("stop", kiva_id, stopped)

    def _publish(self, topic: str, *fields: Any) -> None:
        with contextlib.suppress(rospy.ROSException):  # the node is being shut down
            self._topics[topic].publish(*fields)

    def set_mode(self, kiva_id: int, mode: int) -> str:
        """Calls /warehouse/set_robot_mode; returns why not, '' if so or there is no coordinator."""
        try:
            if not is_offered(rospy, SET_MODE):
                return ""
            answer = self._mode(kiva_id, mode)
        except (rospy.ServiceException, rospy.ROSException, OSError):
            return ""  # it ends just now
        return "" if answer.success else f"the coordinator keeps the robot: {answer.message}"

    def happened(self, kiva_id: int, text: str, begins: bool) -> None:
        """Publishes the beginning or the end of a fault on demand on /warehouse/events."""
        message = Event(kind=Event.FAILED if begins else Event.REPAIRED, model=f"kiva{kiva_id}")
        message.header.stamp, message.text = rospy.Time.now(), text
        with contextlib.suppress(rospy.ROSException):
            self._events.publish(message)

    def note_taken(self, kiva_id: int, before: int | None) -> None:
        """Keeps as a parameter of this node, which outlives it, what mode a robot had before it was
        taken; None: it was given back."""
        with contextlib.suppress(KeyError, OSError, rospy.ROSException):
            if before is None:
                rospy.delete_param(f"~taken/kiva{kiva_id}")
            else:
                rospy.set_param(f"~taken/kiva{kiva_id}", int(before))

    def taken_before(self, kiva_id: int) -> int | None:
        """Returns what note_taken() kept."""
        return self._taken.get(f"kiva{kiva_id}")


def _chargers(message: Any) -> frozenset[tuple[int, int]]:
    """Returns the cells where robots are charged."""
    try:
        scenery = wait_for(rospy, "warehouse/scenery", Scenery, WAIT)
        plan = plan_reader.of_messages(message, scenery)
    except (rospy.ROSException, FloorError):
        return frozenset()
    return frozenset((int(cell) % plan.width, int(cell) // plan.width) for cell in plan.charging)
