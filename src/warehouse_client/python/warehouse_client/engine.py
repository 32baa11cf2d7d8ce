# SPDX-License-Identifier: Apache-2.0
"""A client of the running world: adds and deletes models, pauses physics."""

from collections.abc import Iterable
from typing import Any

from geometry_msgs.msg import Pose
from nav_msgs.srv import GetMap
from std_srvs.srv import Empty

from gazebo_msgs.srv import (
    DeleteModel,
    GetModelState,
    GetPhysicsProperties,
    GetWorldProperties,
    SpawnModel,
)
from warehouse_layout.floor import poses
from warehouse_msgs.srv import ReplaceModels, WorldSources

WAIT = 30.0  # for the world to come up [s, wall]


class EngineError(RuntimeError):
    """Raised for a refusal of the world, with its message and the model's name."""


class UnchangedError(EngineError):
    """Raised where the world refused a request for several models as a whole."""


class UndoneError(EngineError):
    """Raised where the world refused one of several models, after others were removed."""


class Engine:
    """A client of the world with persistent connections: one thread at a time uses it, and closes
    it.

    `ros` is rospy, or what stands in for it in a test. patience: for the world to come up [s,
    wall].
    """

    def __init__(self, ros: Any, patience: float = WAIT) -> None:
        self._ros, self._patience = ros, patience
        self._proxies: dict[str, Any] = {}

    def __enter__(self) -> "Engine":
        try:
            self._ros.wait_for_service("gazebo/spawn_sdf_model", self._patience)
        except self._ros.ROSException as error:
            raise EngineError(f"the world does not answer: {error}") from error
        return self

    def __exit__(self, *_: object) -> None:
        for proxy in self._proxies.values():
            proxy.close()

    def _call(self, service: str, kind: Any, *args: Any) -> Any:
        if service not in self._proxies:
            name = service if "/" in service else f"gazebo/{service}"
            self._proxies[service] = self._ros.ServiceProxy(name, kind, persistent=True)
        try:
            return self._proxies[service](*args)
        except self._ros.ServiceException as error:
            raise EngineError(f"{service}: {error}") from error

    def names(self) -> list[str]:
        """Returns the names of all models in the world."""
        return self._call("get_world_properties", GetWorldProperties).model_names

    def time(self) -> float:
        """Returns the simulated time [s]."""
        return self._call("get_world_properties", GetWorldProperties).sim_time

    def pose(self, name: str) -> tuple[float, float, float]:
        """Returns (x, y, yaw) of a model in world [m, rad]. Raises EngineError."""
        answer = self._call("get_model_state", GetModelState, name, "world")
        if not answer.success:
            raise EngineError(f"{name}: {answer.status_message}")
        return tuple(poses.planar_of([answer.pose])[0])

    def map(self) -> Any:
        """Returns the nav_msgs/OccupancyGrid of the floor, a cell for each grid point: cells of
        other models are occupied."""
        return self._call("warehouse/map", GetMap).map

    def sources(self) -> Any:
        """Returns the WorldSourcesResponse: texts of all models, and where these stand. Raises
        EngineError."""
        answer = self._call("warehouse/sources", WorldSources)
        if not answer.success:
            raise EngineError(answer.message)
        return answer

    def spawn(self, xml: str, name: str = "") -> None:
        """Adds all models of an SDF text, or none. Raises EngineError.

        They keep their names in the text; a single model gets `name`, which may be left out for the
        text of a world.
        """
        answer = self._call("spawn_sdf_model", SpawnModel, name, xml, "", Pose(), "world")
        if not answer.success:
            raise EngineError(answer.status_message)

    def replace(self, kinds: Iterable[str], names: Iterable[str], documents: Iterable[str]) -> None:
        """Takes away the models of these kinds and names, and adds those of the SDF texts.

        Physics has to be paused. Raises UnchangedError for a request with a fault that can be seen
        beforehand; UndoneError where a model was refused later, and all models of `kinds` were
        taken away.
        """
        asked = (list(kinds), list(names), list(documents))
        answer = self._call("replace_models", ReplaceModels, *asked)
        if not answer.success:
            raise (UndoneError if answer.changed else UnchangedError)(answer.message)

    def delete(self, name: str) -> None:
        """Deletes a model. Raises EngineError."""
        answer = self._call("delete_model", DeleteModel, name)
        if not answer.success:
            raise EngineError(f"{name}: {answer.status_message}")

    def is_paused(self) -> bool:
        """Returns whether physics is paused."""
        return self._call("get_physics_properties", GetPhysicsProperties).pause

    def pause(self) -> None:
        """Pauses physics."""
        self._call("pause_physics", Empty)

    def resume(self) -> None:
        """Resumes physics."""
        self._call("unpause_physics", Empty)
