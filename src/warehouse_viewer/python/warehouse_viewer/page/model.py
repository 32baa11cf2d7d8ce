# SPDX-License-Identifier: Apache-2.0
"""What the page shows, made from the newest messages: a scene that seldom changes, and tables."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection
from typing import TYPE_CHECKING, Any

import numpy as np

from warehouse_layout.floor import floor_markings, poses
from warehouse_viewer.json_text import dumps
from warehouse_viewer.page import paint, protocol
from warehouse_viewer.page.activities import activity
from warehouse_viewer.page.paint import short
from warehouse_viewer.page.table import Table

if TYPE_CHECKING:
    from warehouse_msgs.msg import FleetState, Look, Scenery, UnitStates, WarehouseObjects

TIME_GAP = 0.5  # between updates with nothing new but the time [s, wall]
STANDS = 1e-3  # a robot below these speeds stands still [m/s, rad/s]


class Model:
    """Tables by tick. One thread at a time."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self.tick, self.stamp, self.revision = 0, 0.0, 0
        self.changed_at = 0  # the last tick at which there was something to show
        self.robots, self.units = Table(protocol.ROBOT), Table(protocol.BODY)
        self.loose, self.scenery = Table(protocol.BODY), Table(protocol.BODY)
        self._objects: WarehouseObjects = None  # the newest messages, from the first update on
        self._states: UnitStates = None
        self._scenery: Scenery = None
        self._fleet: FleetState = None
        self._kiva_id = np.zeros(0, int)
        self._robot_of: dict[int, int] = {}
        self._solid = np.zeros(0, int)  # indices of models in a Scenery that are not paint
        self._scene_text: str | None = None
        self._sent_stamp, self._sent_at = (
            0.0,
            0.0,
        )  # the time in the last update, and when [s, wall]

    # --- messages in
    def is_same_scene(self, objects: WarehouseObjects, scenery: Scenery) -> bool:
        """Whether these messages name the same models as those of the last update()."""
        return objects is self._objects and _look_alike(scenery, self._scenery)

    def update(
        self,
        objects: WarehouseObjects,
        states: UnitStates,
        fleet: FleetState,
        scenery: Scenery,
        waiting: Collection[int] = (),
    ) -> bool:
        """Takes over the newest messages. `objects` and `states` must be of the same revision.

        `waiting` are the numbers of robots that wait for too long.

        Returns whether a page has something new to show.
        """
        self.tick += 1
        scene = self._take_scene(objects, fleet, scenery)
        moved = False
        if fleet is not self._fleet or scene:
            moved = self._take_fleet(fleet, waiting)
        self._fleet = fleet
        if states is not self._states or moved or scene:
            moved |= self._take_units(states)
            self._states = states
        if scenery is not self._scenery or scene:
            moved |= self.scenery.set(self.tick, pose=poses.rows(scenery.pose)[self._solid])
            self._scenery = scenery
        # Time alone is worth an update too, now and then: the page shows it.
        late = self._clock() - self._sent_at >= TIME_GAP
        if scene or moved or (late and self.stamp != self._sent_stamp):
            self.changed_at = self.tick
            self._sent_stamp, self._sent_at = self.stamp, self._clock()
        return self.changed_at == self.tick

    def _take_scene(self, objects: WarehouseObjects, fleet: FleetState, scenery: Scenery) -> bool:
        """True if things came or went, so that indices mean others."""
        ids = np.array(fleet.kiva_id, int)
        if self.is_same_scene(objects, scenery) and np.array_equal(ids, self._kiva_id):
            return False
        self.revision += 1
        self._objects, self._kiva_id = objects, ids
        self._robot_of = {number: i for i, number in enumerate(ids.tolist())}
        self.robots.resize(len(ids), self.tick)
        self.units.resize(len(objects.storage_units), self.tick)
        self.loose.resize(len(objects.items), self.tick)
        painted = [floor_markings.is_name(name) for name in scenery.models]
        self._solid = np.flatnonzero(np.logical_not(painted))
        self.scenery.resize(len(self._solid), self.tick)
        self._scenery, self._scene_text = scenery, None
        return True

    def _take_fleet(self, fleet: FleetState, waiting: Collection[int]) -> bool:
        self.stamp = fleet.stamp.to_sec()
        return self.robots.set(
            self.tick,
            x=fleet.x,
            y=fleet.y,
            yaw=fleet.yaw,
            shelf=fleet.shelf_id,
            activity=activity(fleet, waiting),
            state=np.frombuffer(bytes(fleet.state), np.uint8),
            charge=np.rint(100 * np.asarray(fleet.charge)),
            failures=np.frombuffer(bytes(fleet.failures), np.uint8),
            load_limit=_limits(fleet),
        )

    def _take_units(self, states: UnitStates) -> bool:
        self.stamp = max(self.stamp, states.header.stamp.to_sec())
        pose, carrier = poses.rows(states.pose).copy(), np.array(states.carrier, int)
        robot = np.array([self._robot_of.get(n, -1) for n in carrier.tolist()], int)
        carrier[robot < 0] = 0
        carried = np.flatnonzero(carrier)
        if len(carried):
            pose[carried] = self._on_carriers(carried, robot[carried], pose[carried])
        moved = self.units.set(self.tick, pose=pose, carrier=carrier)
        loose = self.loose.rows["pose"].copy()
        loose[list(states.loose_item)] = poses.rows(states.loose_pose)
        return self.loose.set(self.tick, pose=loose) or moved

    def _on_carriers(self, units: np.ndarray, robots: np.ndarray, pose: np.ndarray) -> np.ndarray:
        """Poses of carried units on their robots; they change only while the robot stands.

        So a unit costs nothing to send while it is driven about, and never lags behind its robot.
        """
        x, y, yaw = (np.asarray(c)[robots] for c in (self._fleet.x, self._fleet.y, self._fleet.yaw))
        inner = poses.compose(poses.inverse(_planar(x, y, yaw)), pose)
        drives = ~self._stands(robots)
        known = self.units.rows["carrier"][units] == self._kiva_id[robots]
        inner[drives & ~known] = _centred(inner[drives & ~known])
        inner[drives & known] = self.units.rows["pose"][units[drives & known]]
        return inner

    def _stands(self, robots: np.ndarray) -> np.ndarray:
        speeds = np.abs([self._fleet.vx, self._fleet.vy, self._fleet.yaw_rate])
        return speeds[:, robots].max(axis=0, initial=0) < STANDS

    # --- out to pages
    @property
    def tables(self) -> tuple[Table, Table, Table, Table]:
        """The tables in the order of an update."""
        return self.robots, self.units, self.loose, self.scenery

    def encode_update(self, since: int) -> bytes:
        """Returns the message for a page that has shown the tick `since`; see protocol.py."""
        rows = [table.since(since) for table in self.tables]
        return protocol.update(self.tick, self.stamp, self.revision, rows)

    def scene_text(self) -> str:
        """Returns the scene as JSON text, which is made once."""
        if self._scene_text is None:
            self._scene_text = dumps(self.scene())
        return self._scene_text

    def scene(self) -> dict[str, Any]:
        """Returns what the tables' indices mean, and the looks. Needs an update() before."""
        objects, scenery = self._objects, self._scenery
        return {
            "type": "scene",
            "protocol": protocol.VERSION,
            "revision": self.revision,
            "robots": self._kiva_id.tolist(),
            "units": list(objects.storage_units),
            "items": list(objects.items),
            "item_unit": list(map(int, objects.item_unit)),
            "item_pose": short(objects.item_pose),
            "fallen_item": list(map(int, objects.fallen_item)),
            "fallen_from": list(map(int, objects.fallen_from)),
            "floor": list(map(float, scenery.floor)),
            "grid": scenery.grid_spacing,
            **paint.of_scenery(scenery),
            "looks": self._looks(),
            "robot_look": scenery.kiva_look,
            "unit_look": scenery.storage_unit_look,
            "item_look": scenery.item_look,
            "scenery": [scenery.models[i] for i in self._solid],
            "scenery_look": [int(scenery.model_look[i]) for i in self._solid],
        }

    def _looks(self) -> list[Any]:
        """The looks of all but paint, which the page draws in its own colours."""
        scenery = self._scenery
        solid = {scenery.model_look[i] for i in self._solid}
        unseen = {*scenery.model_look} - solid
        return [[] if i in unseen else _look(look) for i, look in enumerate(scenery.looks)]


def _limits(fleet: FleetState) -> np.ndarray:
    """Largest acceleration of robots with loads [m/s²]; 0: not limited."""
    limits = np.asarray(fleet.load_limit, np.float32)
    return np.where(np.isfinite(limits), limits, 0) if len(limits) else np.zeros(len(fleet.kiva_id))


def _look_alike(a: Scenery | None, b: Scenery | None) -> bool:
    """Whether two sceneries differ only in poses."""
    if a is b or a is None or b is None:
        return a is b
    return a.models == b.models and a.model_look == b.model_look and a.looks == b.looks


def _planar(x: np.ndarray, y: np.ndarray, yaw: np.ndarray) -> np.ndarray:
    """(n, 7) of robots on the floor."""
    out = np.zeros((len(x), 7))
    out[:, 0], out[:, 1] = x, y
    out[:, 5], out[:, 6] = np.sin(np.asarray(yaw) / 2), np.cos(np.asarray(yaw) / 2)
    return out


def _centred(inner: np.ndarray) -> np.ndarray:
    """Corrects the pose of a unit first met under way: it may be older than its robot's.

    It sits over the robot's centre, turned by whole quarters.
    """
    quarter = np.round(poses.yaw(inner) / (np.pi / 2)) * (np.pi / 2)
    out = _planar(np.zeros(len(inner)), np.zeros(len(inner)), quarter)
    out[:, 2] = inner[:, 2]
    return out


def _look(look: Look) -> list[dict[str, Any]]:
    """A Look as a list of links, each with its shapes."""
    links = [
        {"name": name, "pose": pose, "shapes": []}
        for name, pose in zip(look.links, poses.rows(short(look.link_pose)).tolist())
    ]
    shape_pose = poses.rows(short(look.shape_pose)).tolist()
    size = np.reshape(short(look.shape_size), (-1, 3)).tolist()
    colour = np.reshape(short(look.shape_colour), (-1, 4)).tolist()
    for i, link in enumerate(look.shape_link):
        links[link]["shapes"].append(
            {
                "kind": bytes(look.shape_kind)[i],
                "pose": shape_pose[i],
                "size": size[i],
                "colour": colour[i],
            }
        )
    return links
