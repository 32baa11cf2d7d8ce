# SPDX-License-Identifier: Apache-2.0
"""RWARE as a Gymnasium environment of all agents."""

from collections.abc import Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

from warehouse_learning.rware.motion import motion_of
from warehouse_learning.rware.observations import Observer
from warehouse_learning.rware.picture import picture
from warehouse_learning.rware.spaces import of_actions, of_observations
from warehouse_learning.rware.task import Task, seed_of

RENDERING = {"render_modes": ["rgb_array"], "render_fps": 10}
ALL = np.ones(1, bool)


class Warehouse(gymnasium.Env):
    """RWARE's Warehouse: same arguments, spaces and results (see Task), many times as fast.

    Observations are a tuple of one an agent, rewards a list, `terminated` says that the episode is
    over, infos are empty, all as RWARE has it. render_mode may be "rgb_array".

    physics: "grid", RWARE itself; "ideal", actions take time; "bodies", robots of the warehouse's
    physics do them (see warehouse_learning.rware.motion). Then infos hold `time` [s], `busy`,
    true for each agent at an action, and with bodies `collisions`, a count for each agent.
    decision, where actions take time: "action", a step lasts until every agent has ended its
    action, or a number of seconds.
    """

    metadata = RENDERING

    def __init__(
        self,
        *arguments: Any,
        render_mode: str | None = None,
        physics: str = "grid",
        decision: float | str = "action",
        **options: Any,
    ) -> None:
        self.task = Task(*arguments, **options)
        self.render_mode = render_mode
        self.warehouses = self.task.warehouses(1)
        self.motion = motion_of(physics, self.task, self.warehouses, 1, decision)
        self._observer = Observer(self.task, self.warehouses, 1)
        agents = self.task.n_agents
        self.observation_space = spaces.Tuple(agents * (of_observations(self.task),))
        self.action_space = spaces.Tuple(agents * (of_actions(self.task),))
        self._rewards = np.zeros((1, agents))
        self._no_rewards = list(self._rewards[0])
        self._is_seeded = self._has_begun = False

    @property
    def n_agents(self) -> int:
        """How many agents there are."""
        return self.task.n_agents

    @property
    def requested(self) -> list[int]:
        """The storage units that are requested, numbered from 1 in the order of storage places."""
        return [shelf + 1 for shelf in self.warehouses.requests(0)]

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begins an episode. Without a seed the random stream goes on, as RWARE's does."""
        super().reset(seed=seed)
        if seed is not None or not self._is_seeded:
            self.warehouses.seed(0, *seed_of(seed))
        self._is_seeded = self._has_begun = True
        self.warehouses.reset(ALL)
        if self.motion:
            self.motion.reset(ALL)
        return self._observer.of_first(), self._infos()

    def step(self, actions: Sequence[Any]) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """actions: an Action an agent, or with messages [Action, bit, …] an agent.

        Raises ValueError for what is not an action, or not one an agent.
        """
        if not self._has_begun:
            raise gymnasium.error.ResetNeeded("reset() begins the first episode")
        if self.task.msg_bits or self.motion:
            ends, is_paid = self._step_in_arrays(np.asarray(actions)), True
        else:
            ends, is_paid = self.warehouses.step_one(actions, self._rewards)
        rewards = list(self._rewards[0]) if is_paid else self._no_rewards.copy()
        return self._observer.of_first(), rewards, ends, False, self._infos()

    def _step_in_arrays(self, actions: np.ndarray) -> bool:
        bits, agents = self.task.msg_bits, self.task.n_agents
        expected = (agents, 1 + bits) if bits else (agents,)
        if actions.shape != expected:
            raise ValueError(f"actions: shape {expected} was expected, not {actions.shape}")
        rows = actions.reshape(1, agents, 1 + bits)
        messages = np.ascontiguousarray(rows[:, :, 1:], np.float32)
        chosen = np.ascontiguousarray(rows[:, :, 0], np.int8)
        if self.motion:
            chosen = self.motion.pass_time(ALL, chosen)
        ends = np.empty(1, bool)
        self.warehouses.step(ALL, chosen, messages, self._rewards, ends)
        return bool(ends[0])

    def _infos(self) -> dict[str, Any]:
        if not self.motion:
            return {}
        return {name: values[0] for name, values in self.motion.infos().items()}

    def render(self) -> np.ndarray | None:
        """Returns (height, width, 3) uint8 with render_mode "rgb_array", else None."""
        if self.render_mode != "rgb_array" or not self._has_begun:
            return None
        return picture(self.task, self.warehouses, 0)
