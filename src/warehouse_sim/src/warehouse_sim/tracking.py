# SPDX-License-Identifier: Apache-2.0
"""Where storage units and items are, from what the world publishes about them.

`objects` is a WarehouseObjects message, `states` a UnitStates message of the same revision.
"""

from dataclasses import dataclass, field

import numpy as np

from warehouse_msgs.msg import TrackedObject
from warehouse_sim import poses


@dataclass
class Tracked:
    """Objects of one kind; entry i of everything belongs to object i."""

    names: list = field(default_factory=list)
    pose: np.ndarray = field(default_factory=lambda: np.zeros((0, 7)))  # in world
    carrier: np.ndarray = field(default_factory=lambda: np.zeros(0, int))  # kiva id, 0 = none
    unit: list = field(default_factory=list)  # name of the unit it lies on, or ""

    def message(self, i):
        carrier = f"kiva{self.carrier[i]}" if self.carrier[i] else ""
        return TrackedObject(self.names[i], poses.message(self.pose[i]), self.unit[i], carrier)


def storage_units(objects, states):
    """The storage units as Tracked."""
    names = objects.storage_units
    return Tracked(names, poses.rows(states.pose), np.array(states.carrier, int), [""] * len(names))


def items(objects, states):
    """The items as Tracked: those on a unit go where it goes."""
    unit, pose = np.array(objects.item_unit, int), poses.rows(objects.item_pose).copy()
    carrier = np.zeros(len(unit), int)
    lies = unit >= 0
    pose[lies] = poses.compose(poses.rows(states.pose)[unit[lies]], pose[lies])
    carrier[lies] = np.array(states.carrier, int)[unit[lies]]
    pose[list(states.loose_item)] = poses.rows(states.loose_pose)
    names = [objects.storage_units[u] if u >= 0 else "" for u in unit]
    return Tracked(objects.items, pose, carrier, names)


def moved(old, new):
    """Which of the new objects stand elsewhere than they did, or were not there: (n,) booleans."""
    if old.names == new.names:
        return np.any(old.pose != new.pose, axis=1)
    row = {name: i for i, name in enumerate(old.names)}
    before = np.array([row.get(name, -1) for name in new.names], int)
    known = before >= 0
    out = np.ones(len(new.names), bool)
    out[known] = np.any(old.pose[before[known]] != new.pose[known], axis=1)
    return out


def changed(old, new):
    """Like moved, but true for all if other objects are there, and where the carrier is another."""
    if old.names != new.names or old.unit != new.unit:
        return np.ones(len(new.names), bool)
    return np.any(old.pose != new.pose, axis=1) | (old.carrier != new.carrier)
