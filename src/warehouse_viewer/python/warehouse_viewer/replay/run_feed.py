# SPDX-License-Identifier: Apache-2.0
"""A world of this process as messages: goods on their units, people who walk, items that fall."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from warehouse_layout.floor import poses
from warehouse_viewer.page.world_source import COLUMNS, Looks, Stamp, scenery_of

if TYPE_CHECKING:
    from kiva_plugin_cpp import World


class RunFeed:
    """The messages that a Model needs, of a world whose robots and units stay the same.

    objects, states, fleet_state, scenery: laid out as the
    messages; see page.source.Feed.
    """

    def __init__(self, world: World) -> None:
        self._world = world
        self._units = [f"storage_unit{n}" for n in self._world.storage_units["shelf_id"]]
        self._people: list[str] = []
        self._fallen: list[int] = []
        self._loose: np.ndarray = np.zeros(0, int)
        self._looks = Looks(self._world)
        self.objects = self._objects()
        self.scenery = self._scenery()
        self.update()

    def update(self) -> None:
        """Takes over the world's present state."""
        world, stamp = self._world, Stamp(self._world.time)
        if world.fallen_items["item_id"].tolist() != self._fallen:
            self.objects = self._objects()
        if list(world.people) != self._people or self._people:
            self.scenery = self._scenery_now()
        columns = {name: np.array(getattr(world.fleet, name)) for name in COLUMNS}
        self.fleet_state = SimpleNamespace(stamp=stamp, load_limit=[], **columns)
        units = world.storage_units
        self.states = SimpleNamespace(
            header=SimpleNamespace(stamp=stamp),
            pose=_poses(units, units["yaw"]).ravel(),
            carrier=units["kiva_id"],
            loose_item=self._loose,
            loose_pose=_poses(world.items[self._loose]).ravel(),
        )

    # --- goods
    def _objects(self) -> SimpleNamespace:
        world = self._world
        items, units, fallen = world.items, world.storage_units, world.fallen_items
        index = {number: i for i, number in enumerate(units["shelf_id"].tolist())}
        on = np.array([index.get(number, -1) for number in items["shelf_id"].tolist()], int)
        self._fallen, self._loose = fallen["item_id"].tolist(), np.flatnonzero(on < 0)
        item_of = {number: i for i, number in enumerate(items["item_id"].tolist())}
        return SimpleNamespace(
            storage_units=self._units,
            items=[f"item{number}" for number in items["item_id"]],
            item_unit=on.tolist(),
            item_pose=_within(items, units, on).ravel(),
            fallen_item=[item_of[number] for number in self._fallen],
            fallen_from=[index.get(number, -1) for number in fallen["shelf_id"].tolist()],
            kiva_id=world.fleet.kiva_id.tolist(),
        )

    # --- what else stands there
    def _scenery_now(self) -> SimpleNamespace:
        """Returns the scenery with people where they are."""
        if list(self._world.people) != self._people:
            return self._scenery()
        rows = poses.rows(self.scenery.pose).copy()
        for name in self._people:
            rows[self.scenery.models.index(name)] = self._world.pose(name)
        return SimpleNamespace(**vars(self.scenery) | {"pose": rows.ravel()})

    def _scenery(self) -> SimpleNamespace:
        self._people = list(self._world.people)
        return scenery_of(self._world, self._looks, self._units, self.objects.items)


def _poses(rows: np.ndarray, yaw: ArrayLike = 0.0) -> np.ndarray:
    """Returns (n, 7) of rows with x, y, z [m], upright and turned by yaw [rad]."""
    out = np.zeros((len(rows), 7))
    out[:, 0], out[:, 1], out[:, 2] = rows["x"], rows["y"], rows["z"]
    out[:, 5], out[:, 6] = np.sin(np.asarray(yaw) / 2), np.cos(np.asarray(yaw) / 2)
    return out


def _within(items: np.ndarray, units: np.ndarray, on: np.ndarray) -> np.ndarray:
    """Returns the poses of items in their units' frames, (n, 7); of others in world."""
    out, carried = _poses(items), on >= 0
    under = units[on[carried]]
    frame = _poses(under, under["yaw"])
    out[carried] = poses.compose(poses.inverse(frame), out[carried])
    return out
