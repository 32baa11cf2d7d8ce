# SPDX-License-Identifier: Apache-2.0
"""All robots of a warehouse under one policy: a Gymnasium environment, and many of it at once."""

from collections.abc import Iterable
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike

from warehouse_learning import fields
from warehouse_learning.options import Options
from warehouse_learning.screen import FRAMES, RENDER_MODES
from warehouse_learning.spaces import WHEELS, Seed, joint_action_space
from warehouse_learning.stage import OneWarehouse, Stage
from warehouse_learning.warehouses import ActionError


def _joint_space(robot_fields: Iterable[fields.Field], robots: int) -> spaces.Box:
    low, high = fields.bounds(robot_fields)
    return spaces.Box(np.tile(low, robots), np.tile(high, robots))


class KivaRobotsEnv(OneWarehouse, gymnasium.Env):
    """One policy moves every robot; options as of warehouse_learning.Options.

    Observations are those of the robots in a row, (robots * size,) float32; the reward is the sum
    of theirs, which info["rewards"] has one by one; info["action_mask"] is (robots, 5) int8; wheels
    have none.
    """

    metadata = {"render_modes": RENDER_MODES, "render_fps": FRAMES}

    def __init__(self, render_mode: str | None = None, **options: object) -> None:
        self._set_up_one(render_mode, options)
        self.observation_space = _joint_space(self.fields, self.options.robots)
        self.action_space = joint_action_space(self.options)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begins an episode; the same seed begins the same one. Returns (observation, info)."""
        super().reset(seed=seed)
        self._begin(self.np_random.integers(2**62) if seed is None else seed)
        return self._observation(), self._mask()

    def step(self, action: ArrayLike) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Makes one decision for every robot.

        Returns (observation, reward, terminated, truncated, info). Raises ActionError for an
        invalid action.
        """
        if self._seed is None:
            raise gymnasium.error.ResetNeeded("reset() begins the first episode")
        rewards, happened, ends = self._decide(_by_robot(action, (), self.options)[0])
        info = self._mask() | {"rewards": rewards} | happened
        return self._observation(), float(rewards.sum()), False, ends, info

    def action_masks(self) -> np.ndarray:
        """Returns (robots * 5,) bool, as sb3_contrib's MaskablePPO asks for."""
        return self._in.masks()[0].ravel()

    def _mask(self) -> dict[str, np.ndarray]:
        return {name: mask[0] for name, mask in self._masks().items()}

    def _observation(self) -> np.ndarray:
        return self._see.observations().reshape(-1)


class KivaRobotsVectorEnv(Stage, VectorEnv):
    """num_envs warehouses, stepped on all cores in one call.

    Options as of KivaRobotsEnv; `threads` as of kiva_plugin_cpp.Worlds. Observations are
    (num_envs, robots * size) float32, rewards (num_envs,); infos hold "rewards",
    (num_envs, robots), "action_mask", (num_envs, robots, 5), and what happened, each with its "_"
    mask.
    """

    def __init__(
        self,
        num_envs: int = 1,
        render_mode: str | None = None,
        threads: int = 0,
        autoreset_mode: AutoresetMode = AutoresetMode.NEXT_STEP,
        **options: object,
    ) -> None:
        self._set_up(num_envs, render_mode, options, threads)
        self.num_envs = num_envs
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.metadata = {**KivaRobotsEnv.metadata, "autoreset_mode": self.autoreset_mode}
        self.single_observation_space = _joint_space(self.fields, self.options.robots)
        self.single_action_space = joint_action_space(self.options)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._ended = np.zeros(num_envs, bool)
        self._begun = False

    def reset(
        self, *, seed: Seed = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """New episodes in all, or in those of options["reset_mask"], (num_envs,) bool.

        seed: a number, and environment i gets seed + i, or one for each; None: the next ones.
        """
        mask = (options or {}).get("reset_mask")
        which = np.arange(self.num_envs) if mask is None else np.flatnonzero(mask)
        if not self._begun and len(which) < self.num_envs:
            raise gymnasium.error.ResetNeeded("the first reset has to reset all environments")
        super().reset(seed=seed if isinstance(seed, int) else None)
        if seed is None:
            seeds = self._next_seeds(len(which))
        elif isinstance(seed, int):
            seeds = [seed + int(i) for i in which]
        else:
            asked = list(seed)
            if len(asked) != self.num_envs:
                raise ValueError(f"seed has {len(asked)} entries; {self.num_envs} were expected")
            seeds = [self._next_seeds(1)[0] if asked[i] is None else asked[i] for i in which]
        self._begin(which, seeds)
        self._begun = True
        self._screen.stepped()
        return self._observations(), self._infos(None, {})

    def step(self, actions: ArrayLike) -> tuple[Any, ...]:
        """Makes one decision in every environment.

        Returns observations, rewards, terminated, truncated and infos. Raises ActionError for an
        invalid action.
        """
        if not self._begun:
            raise gymnasium.error.ResetNeeded("reset() begins the first episodes")
        chosen = _by_robot(actions, (self.num_envs,), self.options)
        begins = np.zeros(self.num_envs, bool)
        if self.autoreset_mode == AutoresetMode.NEXT_STEP:
            begins = self._ended.copy()
        elif self.autoreset_mode == AutoresetMode.DISABLED and self._ended.any():
            ended = int(np.flatnonzero(self._ended)[0])
            raise gymnasium.error.ResetNeeded(f"environment {ended} has ended and was not reset")
        if begins.all():
            rewards = np.zeros((self.num_envs, self.options.robots), np.float32)
            happened: dict[str, Any] = {}
        else:
            rewards, happened = self._in.step(chosen)
        if begins.any():
            which = np.flatnonzero(begins)
            self._begin(which, self._next_seeds(len(which)))
            rewards[begins] = 0
        ends = self._ends() & ~begins
        self._ended = ends.copy()
        infos = self._infos(rewards, happened)
        observations = self._observations()
        if self.autoreset_mode == AutoresetMode.SAME_STEP and ends.any():
            observations, infos = self._begin_at_once(ends, observations, infos)
        self._screen.stepped()
        none = np.zeros(self.num_envs, bool)
        return observations, rewards.sum(1).astype(np.float64), none, ends, infos

    def state(self) -> np.ndarray:
        """Returns (num_envs, size) float32: each whole warehouse, as `state_fields` says."""
        return self._see.state()

    def render(self) -> tuple[np.ndarray] | None:
        """Returns the first one's picture."""
        picture = super().render()
        return None if picture is None else (picture,)

    def close_extras(self, **_: object) -> None:
        """Closes the page, if there is one (Gymnasium's hook)."""
        self._screen.close()

    def _next_seeds(self, count: int) -> list[int]:
        return self.np_random.integers(2**62, size=count).tolist()

    def _begin(self, which: np.ndarray, seeds: Iterable[int]) -> None:
        self._in.reset(which, seeds)
        self._ended[which] = False

    def _begin_at_once(
        self, ends: np.ndarray, observations: np.ndarray, infos: dict[str, Any]
    ) -> tuple[np.ndarray, dict[str, Any]]:
        which = np.flatnonzero(ends)
        final = np.full(self.num_envs, None, object)
        for i in which:
            final[i] = observations[i].copy()
        self._begin(which, self._next_seeds(len(which)))
        fresh = self._observations()
        infos = {
            **infos,
            "final_obs": final,
            "_final_obs": ends.copy(),
            "final_info": dict(infos),
            "_final_info": ends.copy(),
            **self._masks(),
        }
        return fresh, infos

    def _observations(self) -> np.ndarray:
        return self._see.observations().reshape(self.num_envs, -1)

    def _infos(self, rewards: np.ndarray | None, happened: dict[str, np.ndarray]) -> dict[str, Any]:
        infos = self._masks()
        if rewards is not None:
            infos["rewards"] = rewards.copy()
        infos |= happened
        everybody = np.ones(self.num_envs, bool)
        return infos | {f"_{name}": everybody for name in infos}


def _by_robot(actions: ArrayLike, lead: tuple[int, ...], options: Options) -> np.ndarray:
    """(n, robots) or, of wheels, (n, robots, 3), of actions whose shape begins with `lead`: (n,),
    or () for one; ActionError for another shape."""
    values = np.asarray(actions)
    expected = (*lead, options.robots * (WHEELS if options.continuous else 1))
    if values.shape != expected:
        raise ActionError(f"actions: shape {expected} was expected, not {values.shape}")
    return values.reshape(-1, options.robots, *([WHEELS] if options.continuous else []))
