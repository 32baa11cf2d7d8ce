# SPDX-License-Identifier: Apache-2.0
"""The warehouse world inside this process, without ROS.

    from kiva_plugin_cpp import World

    world = World.preset("small")
    world.mov(kiva_id=1, x=0, y=2)
    world.step(5000)
    print(world.fleet.x, world.events())

SI units, radians, x forward, y left, z up. One thread at a time uses a world.
"""

import os
import sys
from collections.abc import Iterable, Iterator, Sequence
from enum import IntEnum
from functools import lru_cache
from html import escape
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path
from typing import TYPE_CHECKING, Any

_SEARCHED = ("GAZEBO_MODEL_PATH", "ROS_PACKAGE_PATH", "GAZEBO_RESOURCE_PATH")
_built = [path.name.removeprefix("_core") for path in Path(__file__).parent.glob("_core.*.so")]
if _built and not set(_built) & set(EXTENSION_SUFFIXES):
    # ".cpython-311-x86_64-linux-gnu.so"
    _digits = _built[0].partition("cpython-")[2].partition("-")[0]
    raise ImportError(
        f"kiva_plugin_cpp is built for Python {_digits[:1]}.{_digits[1:]},"
        f" this is {sys.version_info.major}.{sys.version_info.minor}"
    )

import numpy
from numpy.typing import ArrayLike

from kiva_plugin_cpp import _core
from kiva_plugin_cpp._core import COMMAND, EVENT, CheckpointError, DescriptionError, Fleet
from warehouse_layout.message_enums import EventKind, FailureKind, State, Status

if TYPE_CHECKING:
    from warehouse_layout.file.layout_file import LayoutFile
    from warehouse_layout.place.layout import Layout

AnyPath = str | os.PathLike[str]

__all__ = [
    "COMMAND",
    "EVENT",
    "CheckpointError",
    "DescriptionError",
    "EventKind",
    "FailureKind",
    "Fleet",
    "Kind",
    "State",
    "Status",
    "World",
    "Worlds",
    "worlds_folder",
]


class Kind(IntEnum):
    """The kinds of commands: COMMAND's field `kind`."""

    MOVE_TO = 0
    MOVE_X = 1
    MOVE_Y = 2
    ROTATE = 3
    LIFT = 4
    CANCEL = 5
    STOP = 6
    GO_ON = 7


def worlds_folder() -> Path:
    """Returns the folder of world files and models: the installation's, else the source tree's."""
    package = Path(__file__).parent
    places = (
        package.parent / "warehouse_layout" / "share" / "worlds",  # of a wheel
        package.parents[3] / "share" / "warehouse_layout" / "worlds",
        package.joinpath("__init__.py").resolve().parents[4] / "worlds",
    )
    return next((place for place in places if place.is_dir()), places[-1])


def _ours(text: str) -> str:
    """Returns SDF that includes models of worlds/models, whatever else has their names."""
    return text.replace("model://", escape(f"file://{worlds_folder()}/models/", quote=False))


@lru_cache(maxsize=8)
def _theirs(*_values: str | None) -> tuple[str, ...]:
    """Returns folders of models that these values of the environment name.

    Packages are searched once for each set of values.
    """
    return tuple(_core.environment_model_paths())


def _find(world: AnyPath) -> Path:
    """Returns the file of a world by its path or its name in worlds/."""
    tried = [Path(world), worlds_folder() / world, worlds_folder() / f"{world}.sdf"]
    for path in tried:
        if path.is_file():
            return path
    raise FileNotFoundError(f"there is no world '{world}'; tried {', '.join(map(str, tried))}")


def _flat(path: str, value: Any) -> Iterator[tuple[str, str]]:
    """Yields sections and their numbers as the core reads them: texts by path."""
    if isinstance(value, dict) and (value or not path):
        for key, below in value.items():
            yield from _flat(f"{path}/{key}" if path else str(key), below)
    elif isinstance(value, bool | dict):
        yield path, "true" if value or isinstance(value, dict) else "false"
    else:
        yield path, str(value)


def _realism(settings: AnyPath | dict[str, Any] | None) -> tuple[dict[str, str] | None, str]:
    """Returns what the core takes: texts by path, or None, and where they come from."""
    if settings is None:
        return None, ""
    if isinstance(settings, dict):
        return dict(_flat("", settings)), "realism"
    presets = worlds_folder() / "realism"
    tried = [Path(settings), presets / f"{settings}.yaml"]
    file = next((path for path in tried if path.is_file()), None)
    if file is None:
        names = ", ".join(sorted(path.stem for path in presets.glob("*.yaml")))
        raise FileNotFoundError(f"there is no realism '{settings}'; a file or one of {names}")
    import yaml

    try:
        sections = yaml.safe_load(file.read_text(encoding="utf-8"))
    # ValueError: a file that is not text, or an impossible date.
    except (yaml.YAMLError, ValueError, OverflowError, RecursionError) as error:
        raise DescriptionError(f"{file}: {error}") from None
    if sections is not None and not isinstance(sections, dict):
        raise DescriptionError(f"{file}: sections with their numbers were expected")
    return dict(_flat("", sections or {})), str(file)


class World(_core.World):
    """A simulated warehouse, from an SDF world file: its path, or its name in worlds/.

    seed: seeds everything random. drive: "traction" or "jointed", overrides the robots' models.
    model_paths: folders searched for `model://` first; then follow, as in the node, those of
    GAZEBO_MODEL_PATH, of packages on ROS_PACKAGE_PATH, of GAZEBO_RESOURCE_PATH and around the file.
    threads: step a large fleet and its scans, with the same result for any number from 1 to 256.
    realism: how far robots, sensors and radio differ from the ideal: a preset ("ideal", "typical",
    "bad_day"), a YAML file, or a dict of its sections; None takes it from the robots' models.

    Faulty parts of a world are left out with a warning. Raises FileNotFoundError, and
    DescriptionError with file, line and cause where no world would be left, or with the path or
    key where the realism is wrong.
    """

    def __init__(
        self,
        world: AnyPath = "empty",
        *,
        seed: int = 1,
        drive: str = "",
        model_paths: Iterable[AnyPath] = (),
        threads: int = 1,
        realism: AnyPath | dict[str, Any] | None = None,
    ) -> None:
        file, ours = str(_find(world)), str(worlds_folder() / "models")
        own_paths, theirs = [*map(str, model_paths)], _theirs(*map(os.environ.get, _SEARCHED))
        # In the order of the node: a world's own models come first, ours in what is spawned.
        for_world = [*own_paths, *theirs, *_core.model_paths_around(file), ours]
        for_spawning = [*own_paths, ours, *theirs]
        super().__init__(
            file, False, for_world, for_spawning, seed, drive, threads, *_realism(realism)
        )

    @classmethod
    def preset(cls, name: str, **options: Any) -> "World":
        """Returns a warehouse as create_warehouse_models builds it.

        name: empty, small, medium, large or huge; ValueError for another one. Options as of World.
        """
        return cls.create(name, **options)

    @classmethod
    def create(
        cls, name: str = "", *, robots: int = 0, items: int = 0, shelves: int = 0, **options: Any
    ) -> "World":
        """Returns a warehouse with these counts of robots, items and units, placed by `seed`.

        ValueError if the items don't fit or a number is negative or beyond the limits.
        """
        from warehouse_layout.file import request
        from warehouse_layout.generate import generated
        from warehouse_layout.place import layout

        counts = request.resolve(name, robots=robots, items=items, shelves=shelves)
        plan = generated.plan(counts, options.get("seed", layout.SEED))
        return cls.of_layout(plan, own_models=True, **options)

    @classmethod
    def layout(
        cls, file: "AnyPath | LayoutFile", *, robots: int | None = None, **options: Any
    ) -> "World":
        """Returns the warehouse of a layout file, NAME.layout.yaml or read, or of a preset's name.

        `seed` places what the file gives as counts; `robots` overrides the file's count.
        Options as of World, without `world`: that is the file's building, or an empty floor. Raises
        ValueError, with a line for each fault that hinders a fleet there.
        """
        from kiva_plugin_cpp import layouts

        preset = layouts.preset_of(file)
        if preset and robots is None and "world" not in options:
            return cls.preset(preset, **options)
        with layouts.laid_out(file, robots, options) as (read, laid, of_hall):
            if not laid.has_own_floor:
                layouts.check_hall(cls(**of_hall), read, laid)
            return cls.of_layout(laid, own_models=True, **of_hall)

    @classmethod
    def of_layout(cls, laid: "Layout", *, own_models: bool = False, **options: Any) -> "World":
        """Builds what warehouse_layout.generate.generated.plan() laid out; options as of World.

        Models of robots and units in model_paths replace those of worlds/models, unless own_models.
        """
        from kiva_plugin_cpp import layouts
        from warehouse_layout.models import models

        world = cls(**options)
        if laid.has_own_floor:
            world.delete(models.FLOOR)
        else:
            layouts.clear(world)
        for text in models.documents(models.of_layout(laid)):
            world.spawn(_ours(text) if own_models else text)
        world.events()
        return world

    def follow(
        self,
        kiva_id: ArrayLike,
        path_id: ArrayLike,
        first: ArrayLike = 0,
        points: ArrayLike | None = None,
        x: ArrayLike = (),
        y: ArrayLike = (),
        released: ArrayLike | None = None,
        max_speed: ArrayLike = (),
    ) -> None:
        """Gives robots paths, of which they drive the released part, or changes their paths.

        For one robot: numbers, and arrays x, y of grid points in world [m], the first of which is
        point number `first` of the path; neighbours differ along one axis. Point 0 is where the
        robot stands or, off the grid, a free grid point near it, to which it returns first.
        `released` counts points of the whole path; None releases all. For many robots: arrays of
        shape (n,), where `points` says how many consecutive entries of x and y each robot has.
        `max_speed`: as many as x, the highest speed on the way to each point from the one before
        [m/s]; inf = as fast as the robot is. Without, known points keep theirs and new ones have no
        limit.

        The path_id of the path under way changes that path: points beyond the released ones are
        replaced from `first` on, or kept if none are given; `released` may shrink as far as the
        robot can still stop. Another path_id is a new command. An event refuses what can't be
        granted; a granted change causes no event. Errors as of mov(); all are posted or none.
        """
        if points is None:
            points = len(numpy.asarray(x))
        if released is None:
            released = numpy.add(first, points)
        super().follow(kiva_id, path_id, first, points, x, y, released, max_speed)

    def spawn_model(
        self, model: str, name: str, x: float, y: float, z: float = 0.0, yaw: float = 0.0
    ) -> str:
        """Adds a model of worlds/models ("kiva", "storage_unit" …) at a place in world [m, rad].

        Returns its name. DescriptionError if there is no such model, or the name is taken.
        """
        include = f"<include><uri>model://{model}</uri><name>{name}</name></include>"
        text = f'<sdf version="1.9"><world name="models">{include}</world></sdf>'
        return self.spawn(_ours(text), name, (x, y, z, yaw))[0]

    def carry(self, kiva_id: ArrayLike, shelf_id: ArrayLike) -> None:
        """Orders a robot to lift and carry that storage unit. Arguments and errors as of mov()."""
        self.lift(kiva_id, 1, shelf_id)

    def drop(self, kiva_id: ArrayLike, shelf_id: ArrayLike = 0) -> None:
        """Orders a robot to put down that storage unit; 0 means the one that it carries.

        Arguments and errors as of mov().
        """
        self.lift(kiva_id, 0, shelf_id)


class Worlds(_core.Worlds):
    """Many worlds with the same number of robots, stepped on all cores in one call.

    worlds = Worlds(64, "small")
    worlds.post(world=[0, 5], commands=rows)
    worlds.step(100)
    worlds.x  # (64, 4)

    Arrays have a leading dimension n and are read-only views of memory that step(), restore() and
    place() fill; reading them copies nothing. worlds[i] is a World; its changes show in the arrays
    after the next step(). Threads sleep between calls.
    """

    def __init__(
        self, n: int, name: str = "", *, threads: int = 0, seed: int = 1, **options: Any
    ) -> None:
        """Builds n worlds as World.create(name, seed=seed + i, **options) builds them.

        threads: how many step them, the caller's among them; 0: as many as there are cores.
        """
        if n < 1:
            raise ValueError(f"n is {n}; 1 or more")
        self._adopt([World.create(name, seed=seed + i, **options) for i in range(n)], threads)

    @classmethod
    def of(cls, worlds: Iterable[World], threads: int = 0) -> "Worlds":
        """Returns existing worlds as one. ValueError unless they have equally many robots."""
        self = cls.__new__(cls)
        self._adopt(list(worlds), threads)
        return self

    def _adopt(self, worlds: Sequence[World], threads: int) -> None:
        if threads < 0:
            raise ValueError(f"threads is {threads}; 0 or more")
        super().__init__(worlds, threads)
        self._worlds = worlds

    def __getitem__(self, i: int) -> World:
        return self._worlds[i]
