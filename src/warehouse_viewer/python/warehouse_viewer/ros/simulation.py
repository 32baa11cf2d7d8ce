# SPDX-License-Identifier: Apache-2.0
"""The simulation as its services offer it: pause, step, speed, checkpoints; build a warehouse."""

import importlib
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import count
from types import ModuleType
from typing import Any

from gazebo_msgs.srv import GetPhysicsProperties, GetPhysicsPropertiesResponse, GetWorldProperties
from warehouse_client import identity, placing, services
from warehouse_client.build_transaction import is_building
from warehouse_client.engine import Engine, EngineError
from warehouse_layout.message_enums import FailureKind
from warehouse_layout.models import models
from warehouse_viewer.page.source import AwayError, RefusedError

# What is offered under which service; types by name, since not every engine has them all.
SERVICES = {
    "pause": ("gazebo/pause_physics", "std_srvs", "Empty"),
    "resume": ("gazebo/unpause_physics", "std_srvs", "Empty"),
    "reset": ("gazebo/reset_simulation", "std_srvs", "Empty"),
    "reset_poses": ("gazebo/reset_world", "std_srvs", "Empty"),
    "step": ("gazebo/step", "warehouse_msgs", "Step"),
    "speed": ("gazebo/set_physics_properties", "gazebo_msgs", "SetPhysicsProperties"),
    "checkpoint": ("warehouse/checkpoint", "warehouse_msgs", "Checkpoint"),
    "restore": ("warehouse/restore", "warehouse_msgs", "Checkpoint"),
    "undo": ("warehouse/undo", "warehouse_msgs", "Undo"),
    "create": ("warehouse/create_warehouse_models", "warehouse_msgs", "CreateWarehouse"),
    "person": ("warehouse/person", "warehouse_msgs", "Person"),
    "pick_up": ("warehouse/pick_up", "warehouse_msgs", "PickUp"),
    "fail": ("warehouse/fail", "warehouse_msgs", "Fail"),
    "start_shift": ("warehouse/start_shift", "std_srvs", "Trigger"),
}
OF_A_SHIFT = "warehouse/find_orders"  # a service that shows that one runs


@dataclass(frozen=True)
class Standing:
    """The `names` of all robots, storage units, items and belts at a simulated `time` [s]."""

    names: set
    time: float
    is_paused: bool


class Simulation:
    """One client of those services; calls block. `ros` is rospy."""

    def __init__(self, ros: ModuleType) -> None:
        self._ros, self._placing = ros, threading.Lock()

    # --- what can be done
    def offers(self) -> dict[str, str | None]:
        """Returns {action: the reason why it is not available, or None}."""
        return {action: self._lack(action) for action in SERVICES}

    def _lack(self, action: str) -> str | None:
        name, package, kind = SERVICES[action]
        if _type(package, kind) is None:
            return f"this version knows no {package}/{kind}"
        try:
            offered = is_offered(self._ros, name)
            if action == "start_shift" and is_offered(self._ros, OF_A_SHIFT):
                return "a shift runs already"
        except AwayError as error:
            return str(error)
        if action == "undo" and not self._ros.get_param("gazebo/autosave", 0):
            return "nothing is saved for it: start with autosave:=60, say"
        return None if offered else f"the engine offers no {name}"

    def state(self) -> dict[str, Any]:
        """Returns `paused`, `target_factor` (0: as fast as possible) and `step_size` [s]."""
        now = self._physics()
        return {
            "paused": now.pause,
            "target_factor": now.max_update_rate * now.time_step,
            "step_size": now.time_step,
        }

    def warehouse(self) -> tuple[str, int]:
        """Returns (name, id) of the warehouse; empty and 0 if no service has built it."""
        return identity.read(self._ros)

    def standing(self) -> Standing:
        """Returns the models that exist now."""
        world = self._call("gazebo/get_world_properties", GetWorldProperties, {})
        names = {n for n in world.model_names if models.kind_and_number(n)[0] in models.KINDS}
        return Standing(names, world.sim_time, self._physics().pause)

    # --- doing it; each returns what the world says of it. Raises RefusedError, AwayError.
    def pause(self) -> str:
        """Stops simulated time."""
        return self._do("pause")

    def resume(self) -> str:
        """Resumes simulated time."""
        return self._do("resume")

    def reset(self, time_too: bool = True) -> str:
        """Puts all models back to their start, and the time to 0 unless `time_too` is false."""
        return self._do("reset" if time_too else "reset_poses")

    def step(self, steps: int) -> str:
        """Advances a paused simulation by a number of physics steps."""
        return self._do("step", steps=steps)

    def speed(self, factor: float) -> str:
        """Sets the target: simulated seconds per wall second, 0 for as fast as possible."""
        now = self._physics()
        return self._do(
            "speed",
            time_step=now.time_step,
            max_update_rate=factor / now.time_step,
            gravity=now.gravity,
            ode_config=now.ode_config,
        )

    def checkpoint(self, name: str) -> str:
        """Saves a checkpoint."""
        return self._do("checkpoint", name=name)

    def restore(self, name: str) -> str:
        """Restores a checkpoint."""
        return self._do("restore", name=name)

    def undo(self, seconds: float) -> str:
        """Goes back by a number of simulated seconds."""
        return self._do("undo", seconds=seconds)

    def create(self, name: str, number: int, robots: int, items: int, shelves: int) -> str:
        """Builds a warehouse in place of the present one."""
        fields = {"robots": robots, "items": items, "shelves": shelves}
        return self._do("create", warehouse_name=name, warehouse_id=number, **fields)

    def add_robot(self, x: float, y: float, heading: float) -> int:
        """Adds a robot on a grid point [m], turned by quarters [rad]. Returns its number."""
        with self._placing, self._engine() as engine:
            return placing.add_robot(engine, x, y, heading)

    def walk(
        self, name: str, x: Sequence[float], y: Sequence[float], speed: float, loop: bool
    ) -> str:
        """Has a person walk to those places [m]; an empty name adds a person. Returns the name."""
        with self._placing:
            name = name or self._new_person()
            self._do("person", name=name, x=x, y=y, speed=speed, loop=loop)
        return name

    def pick_up(self, number: int) -> str:
        """Puts an item that fell back on its storage unit."""
        return self._do("pick_up", item=f"item{number}")

    def fail(self, number: int, kind: str, repair_time: float) -> str:
        """Breaks something in a robot, by the name of its FailureKind, until `repair_time` [s] is
        over; 0: until it is repaired."""
        return self._do("fail", kiva_id=number, kind=FailureKind[kind], repair_time=repair_time)

    def repair(self, number: int) -> str:
        """Repairs all that is broken in a robot."""
        return self.fail(number, FailureKind.REPAIRED.name, 0.0)

    def start_shift(self) -> str:
        """Starts a coordinator, if none runs, and a shift."""
        return self._do("start_shift")

    def _new_person(self) -> str:
        names = self._call("gazebo/get_world_properties", GetWorldProperties, {}).model_names
        return next(name for n in count(1) if (name := f"person{n}") not in names)

    def remove_robot(self, number: int) -> str:
        """Removes a robot."""
        with self._engine() as engine:
            engine.delete(f"kiva{number}")
        return f"kiva{number} is gone"

    @contextmanager
    def _engine(self) -> Iterator[Engine]:
        if is_building(self._ros):
            raise RefusedError("a warehouse is being built; ask again")
        try:
            with Engine(self._ros) as engine:
                yield engine
        except (EngineError, placing.PlaceError) as error:
            raise RefusedError(str(error)) from error

    def _physics(self) -> GetPhysicsPropertiesResponse:
        return self._call("gazebo/get_physics_properties", GetPhysicsProperties, {})

    def _do(self, action: str, **fields: Any) -> str:
        lack = self._lack(action)
        if lack:
            raise RefusedError(lack)
        name, package, kind = SERVICES[action]
        answer = self._call(name, _type(package, kind), fields)
        message = getattr(answer, "message", getattr(answer, "status_message", ""))
        if not getattr(answer, "success", True):
            raise RefusedError(message or f"{name} failed and says no more")
        return message

    def _call(self, name: str, kind: type | None, fields: dict[str, Any]) -> Any:
        return request(self._ros, name, kind, fields)


def is_offered(ros: ModuleType, name: str) -> bool:
    """Returns whether a node offers the service. Raises AwayError."""
    try:
        return services.is_offered(ros, name)
    except OSError as error:
        raise AwayError(f"the ROS master does not answer: {error}") from error


def request(ros: ModuleType, name: str, kind: type | None, fields: dict[str, Any]) -> Any:
    """Calls a service and returns its response. Raises AwayError."""
    try:
        return ros.ServiceProxy(name, kind)(**fields)
    except (ros.ServiceException, ros.ROSException, OSError) as error:
        raise AwayError(f"{name}: {error}") from error


def _type(package: str, kind: str) -> type | None:
    """The service type, or None if this installation has none such."""
    try:
        return getattr(importlib.import_module(f"{package}.srv"), kind, None)
    except ImportError:
        return None
