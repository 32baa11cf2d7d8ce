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
from enum import IntEnum
from functools import lru_cache
from html import escape
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

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

# Left there by a build with a pybind11 that does not know numpy 2.
_only_numpy_1 = Path(__file__).with_name("only_numpy_1").exists()
if _only_numpy_1 and int(numpy.__version__.split(".")[0]) > 1:
    raise ImportError(
        f"kiva_plugin_cpp is built for numpy 1, not {numpy.__version__}: pip install 'numpy<2'"
    )

from kiva_plugin_cpp import _core
from kiva_plugin_cpp._core import COMMAND, EVENT, CheckpointError, DescriptionError, Fleet

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
    """Of a command, in COMMAND's field `kind`."""

    MOVE_TO = 0
    MOVE_X = 1
    MOVE_Y = 2
    ROTATE = 3
    LIFT = 4
    CANCEL = 5
    STOP = 6
    GO_ON = 7


class Status(IntEnum):
    """Of a robot, in Fleet.status."""

    IDLE = 0
    BUSY = 1
    BLOCKED = 2


class State(IntEnum):
    """What a robot does, in Fleet.state."""

    IDLE = 0
    MOVING_X = 1
    MOVING_Y = 2
    ROTATING = 3
    LIFTING = 4
    BLOCKED = 5
    WAITING = 6


class EventKind(IntEnum):
    """In EVENT's field `kind`."""

    ACCEPTED = 0
    REFUSED = 1
    DONE = 2
    BLOCKED = 3
    LIFTED = 4
    DROPPED = 5
    COLLISION = 6
    SPAWNED = 7
    DELETED = 8
    LOST = 9
    FAILED = 10
    REPAIRED = 11
    TIPPED = 12
    FELL = 13
    PICKED_UP = 14


class FailureKind(IntEnum):
    """What breaks in a robot; warehouse_msgs/Fail says what that means."""

    REPAIRED = 0
    MOTOR = 1
    LIFT_STUCK = 2
    LASER_BLIND = 3
    RADIO_LOST = 4
    WHEEL_SLIPS = 5


def worlds_folder():
    """The folder of world files and models: of the installation, else of the source tree."""
    package = Path(__file__).parent
    places = (
        package.parent / "warehouse_layout" / "share" / "worlds",  # of a wheel
        package.parents[3] / "share" / "warehouse_layout" / "worlds",
        package.joinpath("__init__.py").resolve().parents[4] / "worlds",
    )
    return next((place for place in places if place.is_dir()), places[-1])


def _ours(text):
    """SDF that includes models of worlds/models, whatever else is called like them."""
    return text.replace("model://", escape(f"file://{worlds_folder()}/models/", quote=False))


@lru_cache(maxsize=8)
def _theirs(*_values):
    """Folders of models that these values of the environment name: packages are searched once."""
    return tuple(_core.environment_model_paths())


def _find(world):
    tried = [Path(world), worlds_folder() / world, worlds_folder() / f"{world}.sdf"]
    for path in tried:
        if path.is_file():
            return path
    raise FileNotFoundError(f"there is no world '{world}'; tried {', '.join(map(str, tried))}")


def _flat(path, value):
    """Sections and their numbers as the core reads them: texts by path, `lasers/range_noise`."""
    if isinstance(value, dict) and (value or not path):
        for key, below in value.items():
            yield from _flat(f"{path}/{key}" if path else str(key), below)
    elif isinstance(value, bool | dict):
        yield path, "true" if value or isinstance(value, dict) else "false"
    else:
        yield path, str(value)


def _realism(given):
    """What the core takes: texts by path, or None, and where they come from."""
    if given is None:
        return None, ""
    if isinstance(given, dict):
        return dict(_flat("", given)), "realism"
    presets = worlds_folder() / "realism"
    tried = [Path(given), presets / f"{given}.yaml"]
    file = next((path for path in tried if path.is_file()), None)
    if file is None:
        names = ", ".join(sorted(path.stem for path in presets.glob("*.yaml")))
        raise FileNotFoundError(f"there is no realism '{given}'; a file or one of {names}")
    import yaml

    try:
        sections = yaml.safe_load(file.read_text(encoding="utf-8"))
    # ValueError: what is no text, or a date that there is not.
    except (yaml.YAMLError, ValueError, OverflowError, RecursionError) as error:
        raise DescriptionError(f"{file}: {error}") from None
    if sections is not None and not isinstance(sections, dict):
        raise DescriptionError(f"{file}: sections with their numbers were expected")
    return dict(_flat("", sections or {})), str(file)


class World(_core.World):
    """A simulated warehouse, from an SDF world file: its path, or its name in worlds/.

    seed: of everything random. drive: "traction" or "jointed" instead of what the robots' models
    say. model_paths: folders in which to look for `model://` first; then, as the node does, those
    of GAZEBO_MODEL_PATH, of packages on ROS_PACKAGE_PATH, of GAZEBO_RESOURCE_PATH and around the
    file. threads: on which a large fleet is stepped and scans, with the same result; 1 to 256.
    realism: how far robots, sensors and radio differ from the ideal: a preset ("ideal", "typical",
    "bad_day"), a YAML file, or a dict of its sections; None: what the robots' models say. Of a
    preset or a file the path, of a dict the key is named where it is wrong, in a DescriptionError.
    What is faulty in it is left out with a warning. FileNotFoundError, or DescriptionError that
    names file, line and what is wrong where no world would be left.
    """

    def __init__(self, world="empty", *, seed=1, drive="", model_paths=(), threads=1, realism=None):
        file, ours = str(_find(world)), str(worlds_folder() / "models")
        given, theirs = [*map(str, model_paths)], _theirs(*map(os.environ.get, _SEARCHED))
        # As the node has them: a world's own models come first, ours in what is spawned.
        for_world = [*given, *theirs, *_core.model_paths_around(file), ours]
        for_spawning = [*given, ours, *theirs]
        super().__init__(
            file, False, for_world, for_spawning, seed, drive, threads, *_realism(realism)
        )

    @classmethod
    def preset(cls, name, **options):
        """A warehouse as create_warehouse_models builds it: empty, small, medium, large or huge.

        Options as of World. ValueError for an unknown name.
        """
        return cls.create(name, **options)

    @classmethod
    def create(cls, name="", *, robots=0, items=0, shelves=0, **options):
        """A warehouse of so many robots, items and storage units; `seed` decides who stands where.

        ValueError if items find no room or a number is negative or beyond the limits.
        """
        from warehouse_layout import layout, request

        wanted = request.resolve(name, robots=robots, items=items, shelves=shelves)
        plan = layout.plan(wanted, options.get("seed", layout.SEED))
        return cls.of_layout(plan, own_models=True, **options)

    @classmethod
    def of_layout(cls, laid, *, own_models=False, **options):
        """A warehouse as warehouse_layout.layout.plan() lays it out; options as of World.

        Robots and units are those that model_paths have, if they have some, unless own_models.
        """
        from warehouse_layout import models

        world = cls(**options)
        if laid.has_own_floor:
            world.delete(models.FLOOR)
        text = models.document(models.of_layout(laid))
        world.spawn(_ours(text) if own_models else text)
        world.events()
        return world

    def follow(self, kiva_id, path_id, first=0, points=None, x=(), y=(), released=None):
        """Gives robots paths to drive as far as they are released, or changes those under way.

        For one robot: numbers, and arrays x, y of grid points in world [m], of which the first is
        point number `first` of the path; neighbours differ along one axis, point 0 is where the
        robot stands, or off the grid a free grid point near it, to which it returns first.
        `released` counts points of the whole path; all, unless it is told. For many: arrays of
        shape (n,), `points` says how many entries of x and y each of them has, in a row.

        The path_id of a path under way changes it: points beyond the released ones are replaced
        from `first` on, or none if there are none here; `released` may shrink as far as the robot
        can still stop. Another one is a command like any other. What can't be granted is refused by
        an event; a change that is granted makes none. Errors as of mov(), all or none.
        """
        if points is None:
            points = len(x)
        if released is None:
            released = numpy.add(first, points)
        super().follow(kiva_id, path_id, first, points, x, y, released)

    def spawn_model(self, model, name, x, y, z=0.0, yaw=0.0):
        """Adds a model of worlds/models ("kiva", "storage_unit" …) at a place in world [m, rad].

        DescriptionError if there is none, or the name is taken.
        """
        include = f"<include><uri>model://{model}</uri><name>{name}</name></include>"
        text = f'<sdf version="1.9"><world name="models">{include}</world></sdf>'
        return self.spawn(_ours(text), name, (x, y, z, yaw))[0]

    def carry(self, kiva_id, shelf_id):
        """Carry that storage unit. Arguments and errors as of mov()."""
        self.lift(kiva_id, 1, shelf_id)

    def drop(self, kiva_id, shelf_id=0):
        """Drop it, or whichever unit it carries. Arguments and errors as of mov()."""
        self.lift(kiva_id, 0, shelf_id)


class Worlds(_core.Worlds):
    """Many worlds of equally many robots that are stepped on all cores in one call.

    worlds = Worlds(64, "small")
    worlds.post(world=[0, 5], commands=rows)
    worlds.step(100)
    worlds.x  # (64, 4)

    Arrays have a leading dimension n and are read-only views of memory that step(), restore() and
    place() fill; nothing is copied to look at them. worlds[i] is a World: what it is told shows in
    the arrays after the next step(). Threads sleep between calls.
    """

    def __init__(self, n, name="", *, threads=0, seed=1, **options):
        """n worlds as World.create(name, seed=seed + i, **options) builds them.

        threads: how many step them, the caller among them; 0: as many as there are cores.
        """
        if n < 1:
            raise ValueError(f"n is {n}; 1 or more")
        self._adopt([World.create(name, seed=seed + i, **options) for i in range(n)], threads)

    @classmethod
    def of(cls, worlds, threads=0):
        """Of Worlds that there are. ValueError unless they have equally many robots."""
        self = cls.__new__(cls)
        self._adopt(list(worlds), threads)
        return self

    def _adopt(self, worlds, threads):
        if threads < 0:
            raise ValueError(f"threads is {threads}; 0 or more")
        super().__init__(worlds, threads)
        self._worlds = worlds

    def __getitem__(self, i):
        return self._worlds[i]
