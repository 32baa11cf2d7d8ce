# SPDX-License-Identifier: Apache-2.0
"""The places of storage units and items, from the world's messages.

`objects` is a WarehouseObjects message, `states` a UnitStates message of the same revision.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from geometry_msgs.msg import Point, Pose, Quaternion

from warehouse_layout.floor import poses
from warehouse_msgs.msg import TrackedObject


@dataclass
class Tracked:
    """Objects of one kind; entry i of everything belongs to object i."""

    names: list = field(default_factory=list)
    pose: np.ndarray = field(default_factory=lambda: np.zeros((0, 7)))  # in world
    carrier: np.ndarray = field(default_factory=lambda: np.zeros(0, int))  # kiva id, 0 = none
    unit: list = field(default_factory=list)  # name of the unit beneath it, or ""

    def message(self, i: int) -> TrackedObject:
        """Returns the message of object i."""
        carrier = f"kiva{self.carrier[i]}" if self.carrier[i] else ""
        return TrackedObject(self.names[i], message(self.pose[i]), self.unit[i], carrier)


def message(row: np.ndarray) -> Pose:
    """Returns the geometry_msgs/Pose of a row of poses."""
    x, y, z, qx, qy, qz, qw = row.tolist()
    return Pose(Point(x, y, z), Quaternion(qx, qy, qz, qw))


class StorageUnits:
    """The storage units of one WarehouseObjects message."""

    def __init__(self, objects: Any) -> None:
        self._names, self._unit = objects.storage_units, [""] * len(objects.storage_units)

    def at(self, states: Any) -> Tracked:
        """Returns the units as Tracked, by a UnitStates message."""
        carrier = np.array(states.carrier, int)
        return Tracked(self._names, poses.rows(states.pose), carrier, self._unit)


class Items:
    """The items of one WarehouseObjects message: those on a unit go where it goes.

    Later calls compute the items on moved units alone.
    """

    def __init__(self, objects: Any) -> None:
        self._names = objects.items
        self._unit = np.array(objects.item_unit, int)
        self._lies = np.flatnonzero(self._unit >= 0)
        self._inner = poses.rows(objects.item_pose)
        self._units = [objects.storage_units[u] if u >= 0 else "" for u in self._unit]
        self._pose = self._inner.copy()  # in world, of the items on units
        # The poses of units by which the last poses of items were computed.
        self._unit_pose = np.full((len(objects.storage_units), 7), np.nan)

    def at(self, states: Any) -> Tracked:
        """Returns the items as Tracked, by a UnitStates message."""
        unit_pose = poses.rows(states.pose)
        went = (unit_pose != self._unit_pose).any(axis=1)
        rows = self._lies[went[self._unit[self._lies]]]
        self._pose[rows] = poses.compose(unit_pose[self._unit[rows]], self._inner[rows])
        self._unit_pose = unit_pose
        pose, carrier = self._pose.copy(), np.zeros(len(self._unit), int)
        carrier[self._lies] = np.array(states.carrier, int)[self._unit[self._lies]]
        pose[list(states.loose_item)] = poses.rows(states.loose_pose)
        return Tracked(self._names, pose, carrier, self._units)


def storage_units(objects: Any, states: Any) -> Tracked:
    """Returns the storage units as Tracked."""
    return StorageUnits(objects).at(states)


def items(objects: Any, states: Any) -> Tracked:
    """Returns the items as Tracked."""
    return Items(objects).at(states)


def moved(old: Tracked, new: Tracked) -> np.ndarray:
    """Returns which objects are new or have moved: (n,) bool."""
    if old.names == new.names:
        return (old.pose != new.pose).any(axis=1)
    row = {name: i for i, name in enumerate(old.names)}
    before = np.array([row.get(name, -1) for name in new.names], int)
    known = before >= 0
    out = np.ones(len(new.names), bool)
    out[known] = np.any(old.pose[before[known]] != new.pose[known], axis=1)
    return out


def changed(old: Tracked, new: Tracked) -> np.ndarray:
    """Returns the same, with a new carrier as a move; all True after a change of objects."""
    if old.names != new.names or old.unit != new.unit:
        return np.ones(len(new.names), bool)
    return (old.pose != new.pose).any(axis=1) | (old.carrier != new.carrier)
