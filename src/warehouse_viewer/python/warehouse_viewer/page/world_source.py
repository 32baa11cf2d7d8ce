# SPDX-License-Identifier: Apache-2.0
"""A world of this process as a Source, without ROS."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np

from warehouse_layout.models.models import FLOOR, kind_and_number
from warehouse_viewer.page.journal import Journal
from warehouse_viewer.page.pace import Pace
from warehouse_viewer.page.source import Source

if TYPE_CHECKING:
    from kiva_plugin_cpp import World

PLACES = ("x", "y", "yaw", "vx", "vy", "yaw_rate")
COLUMNS = (*PLACES, "kiva_id", "shelf_id", "status", "state", "last_end", "failures", "charge")
TRACKED = {"kiva", "storage_unit", "item"}  # every other model is scenery
UNAVAILABLE = (
    "reset",
    "reset_poses",
    "checkpoint",
    "restore",
    "undo",
    "create",
    "person",
    "fail",
    "start_shift",
    "stop",
)
DECIDES = "the program that steps this warehouse decides that"


class Stamp(float):
    """Simulated time [s], with genpy.Time's conversion."""

    def to_sec(self) -> float:
        """Returns the time as a float [s]."""
        return float(self)


class WorldFeed:
    """The messages of a kiva_plugin_cpp.World whose models stay the same.

    The thread that steps the world calls update(); any other thread may read.
    """

    coordinator = None
    is_complete = True

    def __init__(self, world: World, pace: Pace) -> None:
        self._world = world
        self._units = [f"storage_unit{n}" for n in world.storage_units["shelf_id"]]
        self._scanned: Sequence[int] = ()
        fitted = zip(world.fleet.kiva_id.tolist(), world.fleet.lasers)
        self._lasers = {kiva_id: laser for kiva_id, laser in fitted if laser["rays"]}
        mounts = [_mount(kiva_id, laser) for kiva_id, laser in self._lasers.items()]
        still = {
            "objects": self._objects(),
            "scenery": self._scenery(),
            "frames": SimpleNamespace(transforms=mounts),
        }
        self._now: dict[str, Any] = {"performance": pace, **still}
        self.update()

    def request(self, units: Iterable[int]) -> None:
        """Sets which storage units are requested, by number."""
        self._now = self._now | {"requested": sorted(units)}

    def update(self) -> None:
        """Copies the world's present state."""
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
        new = {"fleet": {"stamp": stamp, "load_limit": [], **fleet}, "states": states}
        # One assignment: a reader in another thread sees the old or the new state, never a mixture.
        states = {name: SimpleNamespace(**of) for name, of in new.items()}
        self._now = self._now | states | self._scans_now()

    def _scans_now(self) -> dict[str, SimpleNamespace]:
        """Scans of the robots whose lasers a page shows."""
        if not self._scanned:
            return {}
        ranges = self._world.scans(np.array(self._scanned, np.int32))
        return {
            f"scan{kiva_id}": _scan(self._lasers[kiva_id], row)
            for kiva_id, row in zip(self._scanned, ranges)
        }

    def __getitem__(self, name: str) -> Any:
        return self._now.get(name)

    @property
    def objects_and_states(self) -> tuple[Any, Any]:
        """(WarehouseObjects, UnitStates)."""
        now = self._now
        return now["objects"], now["states"]

    def subscribe(self) -> None:
        """Does nothing: update() brings every state."""

    def unsubscribe_if_idle(self) -> bool:
        """Returns False: there is nothing to unsubscribe from."""
        return False

    def subscribe_extras(self, paths: bool, ways: bool, scans: Sequence[int]) -> None:
        """Asks for the scans of these robots with the next state; such a world has no paths."""
        self._scanned = [kiva_id for kiva_id in scans if kiva_id in self._lasers]

    def _objects(self) -> SimpleNamespace:
        return SimpleNamespace(
            storage_units=self._units,
            items=[],
            item_unit=[],
            item_pose=[],
            fallen_item=[],
            fallen_from=[],
            kiva_id=self._world.fleet.kiva_id.tolist(),
        )

    def _scenery(self) -> SimpleNamespace:
        return scenery_of(self._world, Looks(self._world), self._units, [])


def _scan(laser: np.void, ranges: np.ndarray) -> SimpleNamespace:
    """Laid out as a LaserScan; `ranges` may be longer than the laser has rays."""
    step = (laser["max_angle"] - laser["min_angle"]) / max(1, laser["rays"] - 1)
    return SimpleNamespace(
        angle_min=laser["min_angle"], angle_increment=step, ranges=ranges[: laser["rays"]].copy()
    )


def _mount(kiva_id: int, laser: np.void) -> SimpleNamespace:
    """Where the laser is on its robot, laid out as a transform of a TFMessage."""
    place = SimpleNamespace(
        translation=SimpleNamespace(x=laser["x"], y=0.0, z=laser["z"]),
        rotation=SimpleNamespace(x=0.0, y=0.0, z=0.0, w=1.0),
    )
    return SimpleNamespace(child_frame_id=f"kiva{kiva_id}/laser", transform=place)


def scenery_of(
    world: World, looks: Looks, units: Sequence[str], items: Sequence[str]
) -> SimpleNamespace:
    """Returns what stands in a kiva_plugin_cpp.World, laid out as warehouse_msgs/Scenery.

    `units` and `items` are the names of its storage units and items.
    """
    others = [n for n in world.names if kind_and_number(n)[0] not in TRACKED and n != FLOOR]
    first: dict[str, Sequence[str]] = {
        "kiva_look": [f"kiva{n}" for n in world.fleet.kiva_id[:1]],
        "storage_unit_look": units,
        "item_look": items,
    }
    return SimpleNamespace(
        floor=world.floor,
        grid_spacing=world.grid_spacing,
        models=others,
        model_look=[looks.index_of(name) for name in others],
        pose=np.concatenate([*map(world.pose, others), np.zeros(0)]),
        **{name: looks.index_of(of[0]) if of else -1 for name, of in first.items()},
        looks=looks.all,
    )


class WorldSimulation:
    """The control bar of a world of this process: it sets a Pace, the program does the rest."""

    def __init__(self, world: World, name: str, pace: Pace) -> None:
        self._step_size, self._name, self._pace = world.step_size, name, pace

    def offers(self) -> dict[str, str | None]:
        """Returns {command: why it is not available}."""
        return dict.fromkeys(UNAVAILABLE, DECIDES)

    def state(self) -> dict[str, Any]:
        """Returns `paused`, `target_factor` and `step_size` [s]."""
        pace = self._pace
        state = {"paused": pace.paused, "target_factor": pace.factor}
        return state | {"step_size": self._step_size}

    def warehouse(self) -> tuple[str, int]:
        """Returns the warehouse's name, and 0 for its id."""
        return self._name, 0

    def pause(self) -> str:
        """Stops simulated time."""
        self._pace.pause()
        return ""

    def resume(self) -> str:
        """Resumes simulated time."""
        self._pace.resume()
        return ""

    def step(self, steps: int) -> str:
        """Advances a paused world by a number of physics steps."""
        self._pace.step(steps * self._step_size)
        return ""

    def speed(self, factor: float) -> str:
        """Sets the target: simulated seconds per wall second, 0 for as fast as possible."""
        self._pace.run_at(max(0.0, factor))
        return ""


def source_of(world: World, name: str, pace: Pace) -> tuple[Source, WorldFeed]:
    """Returns a Source for a kiva_plugin_cpp.World, and its feed, to be updated with the world."""
    feed = WorldFeed(world, pace)
    return Source(feed, WorldSimulation(world, name, pace), Journal()), feed


class Looks:
    """World.look() of models, each different one once."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._known: dict[str, int] = {}
        self.all: list[SimpleNamespace] = []

    def index_of(self, model: str) -> int:
        """Returns the index in `all` of what a model looks like."""
        look = self._world.look(model)
        key = repr([np.asarray(part).tolist() for part in look.values()])
        if key not in self._known:
            self._known[key] = len(self.all)
            self.all.append(SimpleNamespace(**look))
        return self._known[key]
