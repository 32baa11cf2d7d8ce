# SPDX-License-Identifier: Apache-2.0
"""A world of this process as the warehouse's page wants to hear of it: laid out as the messages
that warehouse_viewer gets under ROS, which define each field."""

from types import SimpleNamespace

import numpy as np

from warehouse_layout.models import FLOOR, kind_and_number

PLACES = ("x", "y", "yaw", "vx", "vy", "yaw_rate")
COLUMNS = (*PLACES, "kiva_id", "shelf_id", "status", "state", "last_end", "failures", "charge")
THINGS = {"kiva", "storage_unit", "item"}  # what else stands there is scenery


class Stamp(float):
    """Simulated time [s]."""

    def to_sec(self):
        return float(self)


class LiveWorld:
    """Of a kiva_plugin_cpp.World whose models stay the same, at a Pace. take() is for whoever steps
    the world; all else may be asked in another thread."""

    coordinator = None  # nobody coordinates

    def __init__(self, world, pace):
        self._world = world
        self._units = [f"storage_unit{n}" for n in world.storage_units["shelf_id"]]
        still = {"objects": self._objects(), "scenery": self._scenery()}
        self._now = {"performance": pace, **still}
        self.take()

    def take(self):
        """Takes in where everything is now."""
        world, stamp = self._world, Stamp(self._world.time)
        fleet = {name: np.array(getattr(world.fleet, name)) for name in COLUMNS}
        poses = [world.pose(name) for name in self._units]
        states = {
            "header": SimpleNamespace(stamp=stamp),
            "pose": np.concatenate([*poses, np.zeros(0)]),
            "carrier": world.storage_units["kiva_id"],
            "loose_item": [],
            "loose_pose": [],
        }
        news = {"fleet": {"stamp": stamp, "load_limit": [], **fleet}, "states": states}
        self._now = self._now | {name: SimpleNamespace(**of) for name, of in news.items()}

    # --- as viewer.Feed
    complete = True

    def __getitem__(self, name):
        return self._now.get(name)

    @property
    def units_and_objects(self):
        now = self._now
        return now["objects"], now["states"]

    def look(self):
        """It is heard always."""

    def rest(self):
        return False

    def want(self, paths, ways, scans):
        """None of these are to be had."""

    # --- what stays
    def _objects(self):
        return SimpleNamespace(
            storage_units=self._units,
            items=[],
            item_unit=[],
            item_pose=[],
            fallen_item=[],
            fallen_from=[],
            kiva_id=self._world.fleet.kiva_id.tolist(),
        )

    def _scenery(self):
        world, looks = self._world, _Looks(self._world)
        others = [n for n in world.names if kind_and_number(n)[0] not in THINGS and n != FLOOR]
        first = {
            "kiva_look": [f"kiva{n}" for n in world.fleet.kiva_id],
            "storage_unit_look": self._units,
            "item_look": [],
        }
        return SimpleNamespace(
            floor=world.floor,
            grid_spacing=world.grid_spacing,
            models=others,
            model_look=[looks.of(name) for name in others],
            pose=np.concatenate([*map(world.pose, others), np.zeros(0)]),
            **{name: looks.of(of[0]) if of else -1 for name, of in first.items()},
            looks=looks.all,
        )


class _Looks:
    """World.look() of models, each but once."""

    def __init__(self, world):
        self._world, self._known, self.all = world, {}, []

    def of(self, model):
        """Index into `all`."""
        look = self._world.look(model)
        key = repr([np.asarray(part).tolist() for part in look.values()])
        if key not in self._known:
            self._known[key] = len(self.all)
            self.all.append(SimpleNamespace(**look))
        return self._known[key]
