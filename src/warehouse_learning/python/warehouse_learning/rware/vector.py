# SPDX-License-Identifier: Apache-2.0
"""Many warehouses of RWARE in arrays, stepped on all cores in one call."""

from dataclasses import fields
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike

from warehouse_learning.rware.env import RENDERING
from warehouse_learning.rware.motion import motion_of
from warehouse_learning.rware.observations import Observer
from warehouse_learning.rware.picture import picture
from warehouse_learning.rware.task import FEATURES, Action, ObservationType, Task, seed_of
from warehouse_learning.spaces import Seed


class RwareVectorEnv(VectorEnv):
    """num_envs warehouses of one Task, on `threads` threads (0: as many as there are cores).

    Observations are (num_envs, agents, …) float32, or with IMAGE_DICT a dictionary of two such;
    DICT is not an array, and is refused. Rewards are (num_envs, agents) float64, actions
    (num_envs, agents) or, with messages, (num_envs, agents, 1 + msg_bits). Each warehouse draws
    from its own stream: environment i with seed s gives what a Warehouse with seed s + i does.
    physics, decision: as of Warehouse; infos hold arrays then, (num_envs,) and (num_envs, agents).
    """

    def __init__(
        self,
        num_envs: int = 1,
        render_mode: str | None = None,
        threads: int = 0,
        autoreset_mode: AutoresetMode = AutoresetMode.NEXT_STEP,
        physics: str = "grid",
        decision: float | str = "action",
        **options: Any,
    ) -> None:
        self.task = task = Task(**options)
        if task.observation_type is ObservationType.DICT:
            raise ValueError("observation_type DICT has no arrays; FLATTENED has the same content")
        self.num_envs, self.render_mode = num_envs, render_mode
        self.agents, self.max_steps = task.n_agents, task.max_steps
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.metadata = {**RENDERING, "autoreset_mode": self.autoreset_mode}
        self.single_observation_space = _observation_space(task)
        self.single_action_space = _action_space(task)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.warehouses = task.warehouses(num_envs, threads)
        self.motion = motion_of(physics, task, self.warehouses, num_envs, decision, threads)
        self._observer = Observer(task, self.warehouses, num_envs)
        self._messages = np.zeros((num_envs, task.n_agents, task.msg_bits), np.float32)
        self._ended = np.zeros(num_envs, bool)
        self._is_seeded = np.zeros(num_envs, bool)

    @classmethod
    def of_task(cls, num_envs: int, task: Task, **options: Any) -> "RwareVectorEnv":
        """Returns environments of a Task; options as of the class, but for the task's."""
        known = {f.name: getattr(task, f.name) for f in fields(task) if f.init}
        return cls(num_envs, **known, **options)

    def reset(
        self, *, seed: Seed = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begins episodes in all, or in those of options["reset_mask"], (num_envs,) bool.

        seed: a number, and environment i gets seed + i, or one for each, None = its stream goes on.
        """
        mask = (options or {}).get("reset_mask")
        which = np.ones(self.num_envs, bool) if mask is None else np.array(mask, bool)
        seeds = seed if isinstance(seed, (list, tuple, np.ndarray)) else [seed] * self.num_envs
        if len(seeds) != self.num_envs:
            raise ValueError(f"seed has {len(seeds)} entries; {self.num_envs} were expected")
        for i in np.flatnonzero(which).tolist():
            number = seeds[i] if seeds is seed or seed is None else seed + i
            if number is not None or not self._is_seeded[i]:
                self.warehouses.seed(i, *seed_of(None if number is None else int(number)))
        self._is_seeded |= which
        if not self._is_seeded.all():
            raise gymnasium.error.ResetNeeded("the first reset has to reset all environments")
        self._begin(which)
        return self._observer.arrays(), self._infos()

    def step(self, actions: ArrayLike) -> tuple[Any, ...]:
        """Observations, rewards, terminated, truncated (never), infos; see the class.

        What ended begins again by autoreset_mode; with SAME_STEP infos["final_obs"] has the last
        observations of those in infos["_final_obs"].
        """
        if not self._is_seeded.all():
            raise gymnasium.error.ResetNeeded("reset() begins the first episodes")
        begins = self._beginning()
        rewards = np.empty((self.num_envs, self.task.n_agents))
        ends = np.empty(self.num_envs, bool)
        chosen = self._chosen(actions)
        if self.motion:
            chosen = self.motion.pass_time(~begins, chosen)
        self.warehouses.step(~begins, chosen, self._messages, rewards, ends)
        if begins.any():
            self._begin(begins)
        self._ended = ends.copy()
        observations, infos = self._observer.arrays(), self._infos()
        if self.autoreset_mode == AutoresetMode.SAME_STEP and ends.any():
            infos |= {"final_obs": observations, "_final_obs": ends.copy()}
            self._begin(ends)
            observations = self._observer.arrays()
        return observations, rewards, ends, np.zeros(self.num_envs, bool), infos

    def render(self) -> tuple[np.ndarray] | None:
        """Returns the first one's picture with render_mode "rgb_array"."""
        if self.render_mode != "rgb_array" or not self._is_seeded.all():
            return None
        return (picture(self.task, self.warehouses, 0),)

    def _beginning(self) -> np.ndarray:
        if self.autoreset_mode == AutoresetMode.NEXT_STEP:
            return self._ended.copy()
        if self.autoreset_mode == AutoresetMode.DISABLED and self._ended.any():
            ended = int(np.flatnonzero(self._ended)[0])
            raise gymnasium.error.ResetNeeded(f"environment {ended} has ended and was not reset")
        return np.zeros(self.num_envs, bool)

    def _begin(self, which: np.ndarray) -> None:
        self._messages[which] = 0
        self.warehouses.reset(which)
        if self.motion:
            self.motion.reset(which)
        self._ended[which] = False

    def _infos(self) -> dict[str, Any]:
        return self.motion.infos() if self.motion else {}

    def _chosen(self, actions: ArrayLike) -> np.ndarray:
        values = np.asarray(actions)
        if self.task.msg_bits and values.ndim == 3:
            self._messages[:] = values[:, :, 1:]
            values = values[:, :, 0]
        return np.ascontiguousarray(values, np.int8)


def _observation_space(task: Task) -> spaces.Space:
    lead = (task.n_agents,)
    unbounded = -np.inf, np.inf
    if task.observation_type is ObservationType.FLATTENED:
        return spaces.Box(*unbounded, (*lead, task.vector_size), np.float32)
    images = spaces.Box(0, 4, (*lead, *task.image_shape), np.float32)
    if task.observation_type is ObservationType.IMAGE:
        return images
    features = spaces.Box(*unbounded, (*lead, FEATURES), np.float32)
    return spaces.Dict({"image": images, "features": features})


def _action_space(task: Task) -> spaces.MultiDiscrete:
    counts = [len(Action), *task.msg_bits * (2,)]
    if not task.msg_bits:
        return spaces.MultiDiscrete(task.n_agents * counts)
    return spaces.MultiDiscrete(np.array(task.n_agents * [counts]))
