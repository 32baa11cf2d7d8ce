# SPDX-License-Identifier: Apache-2.0
"""Subscribes to the topics from which a coordinator knows the warehouse."""

from typing import Any

import numpy as np
import rospy
from nav_msgs.msg import OccupancyGrid
from nav_msgs.srv import GetMap
from std_msgs.msg import Header

from warehouse_client.latest import News
from warehouse_client.message_check import fit, subscribe
from warehouse_client.unit_messages import unit_ids, unit_poses
from warehouse_fleet.transports.unit_map import UnitPoses
from warehouse_layout.floor import floor_markings
from warehouse_layout.floor.plan_reader import CONVEYOR, occupancy_of
from warehouse_msgs.msg import (
    Event,
    FleetState,
    People,
    Scenery,
    StationState,
    StationStates,
    UnitStates,
    WarehouseObjects,
)

# A vehicle that refuses is asked again after 30 s at most; and the answer takes a while [s].
REPEATED = 45.0


class WarehouseWatch:
    """The latest message of each topic, and the events since the last take.

    `news` is set by each FleetState, and by another floor: a warehouse may be built while time
    stands still, and no FleetState follows. `by_hand`: names of stations where a person works.
    """

    def __init__(self) -> None:
        self.news = News()
        self.fleet: Any = None  # FleetState
        self.scenery: Any = None  # Scenery
        self.objects: Any = None  # WarehouseObjects
        self.units: Any = None  # UnitStates
        self.people = People()
        self.by_hand: frozenset[str] = frozenset()
        self.collisions = 0
        self.reasons: dict[str, str] = {}  # why robots are broken, in their own words, by model
        self._refusals: dict[str, tuple[float, str]] = {}  # by model: when [s], and the words
        self._refused: list[str] = []
        self._rejected: list[tuple[int, int, str]] = []
        subscribe(rospy, "warehouse/scenery", Scenery, self._on_scenery, queue_size=1)
        subscribe(rospy, "warehouse/objects", WarehouseObjects, self._keep, "objects", queue_size=1)
        subscribe(rospy, "warehouse/unit_states", UnitStates, self._keep, "units", queue_size=1)
        subscribe(rospy, "warehouse/people", People, self._keep, "people", queue_size=1)
        subscribe(rospy, "warehouse/events", Event, self._on_event, queue_size=10000)
        subscribe(rospy, "warehouse/stations", StationStates, self._on_stations, queue_size=1)

    def begin(self) -> None:
        """Subscribes to the robots' reports; the warehouse can be controlled from then on."""
        subscribe(rospy, "warehouse/fleet", FleetState, self._on_fleet, queue_size=1)

    def _keep(self, message: Any, name: str) -> None:
        setattr(self, name, message)

    def _on_scenery(self, message: Scenery) -> None:
        """Keeps a scenery that has changed; it is sent again for each new subscriber."""
        message.header = Header()
        before = self.scenery
        if message == before:
            return
        self.scenery = message
        if before is not None and not is_same_floor(message, before):
            self.news.set()

    def _on_stations(self, message: StationStates) -> None:
        manual = [
            station.name for station in message.stations if station.mode == StationState.MANUAL
        ]
        self.by_hand = frozenset(manual)

    def _on_fleet(self, message: FleetState) -> None:
        self.fleet = message
        self.news.set()

    def _on_event(self, event: Event) -> None:
        if event.kind == Event.COLLISION:
            self.collisions += 1
        elif event.kind == Event.REFUSED and event.model.startswith("kiva"):
            self._on_refused(event)
        elif event.kind == Event.FAILED:
            self.reasons[event.model] = event.text
        elif event.kind in (Event.REPAIRED, Event.DELETED):
            self.reasons.pop(event.model, None)

    def _on_refused(self, event: Event) -> None:
        """Keeps what a robot refused: a unit that it can't carry (other), or its path."""
        unit = event.other.removeprefix("storage_unit")
        if unit != event.other and unit.isdecimal():
            kiva_id = int(event.model.removeprefix("kiva"))
            self._rejected.append((kiva_id, int(unit), event.text))
        else:
            self._refused.append(event.model)
            self._refusals[event.model] = event.header.stamp.to_sec(), event.text

    def refusals(self, now: float) -> dict[str, str]:
        """Returns why robots refused what they were sent a short time ago [s], in their own words,
        by model."""
        last = self._refusals.items()
        return {model: text for model, (when, text) in last if 0 <= now - when < REPEATED}

    def take_rejected(self) -> list[tuple[int, int, str]]:
        """Returns (kiva id, unit, reason) of robots that can't carry a unit, since the last
        call."""
        rejected, self._rejected = self._rejected, []
        return rejected

    def take_refused(self) -> list[str]:
        """Returns the models of robots that refused a path since the last call."""
        refused, self._refused = self._refused, []
        return refused

    def is_complete(self, timeline: int) -> bool:
        """Returns whether each message is there, of that timeline of the world."""
        if None in (self.scenery, self.objects, self.units):
            return False
        return self.units.timeline == timeline

    def unit_poses(self) -> UnitPoses | None:
        """Returns where the units stand; None while the two messages on them are of different
        revisions, one of them being on its way."""
        objects, units = self.objects, self.units  # either may come meanwhile
        if not fit(objects, units):
            return None
        x, y, yaw = unit_poses(units)
        carried = np.asarray(units.carrier) != 0
        stamp = units.header.stamp.to_sec()
        return UnitPoses(np.array(unit_ids(objects), int), x, y, yaw, carried, stamp)

    def look_at_map(self) -> np.ndarray | None:
        """Returns the world's map (h, w) uint8; None, and a warning, if there is no answer."""
        try:
            return occupancy_of(request_map())
        except rospy.ServiceException as error:
            rospy.logwarn(f"no map of the floor: {error}")
            return None


def request_map() -> OccupancyGrid:
    """Returns the world's map. Raises rospy.ServiceException."""
    return rospy.ServiceProxy("warehouse/map", GetMap)().map


def is_same_floor(scenery: Scenery, other: Scenery) -> bool:
    """Returns whether two sceneries differ at most in what comes and goes: people, boxes, ..."""
    return scenery is other or _floor_of(scenery) == _floor_of(other)


def _floor_of(scenery: Scenery) -> tuple:
    """The parts of a Scenery that a plan is made of: the floor, belts and markings."""
    poses = np.reshape(scenery.pose, (-1, 7)).tolist()
    fixed = [
        (name, scenery.looks[look] if floor_markings.is_name(name) else None, pose)
        for name, look, pose in zip(scenery.models, scenery.model_look, poses)
        if name.startswith(CONVEYOR) or floor_markings.is_name(name)
    ]
    return scenery.floor, scenery.grid_spacing, fixed
