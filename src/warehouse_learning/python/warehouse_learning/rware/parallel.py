# SPDX-License-Identifier: Apache-2.0
"""RWARE for PettingZoo: each robot an agent."""

from collections.abc import Iterable, Mapping
from typing import Any, TypeVar

import numpy as np
from gymnasium import spaces
from pettingzoo import ParallelEnv

from warehouse_learning.rware.env import RENDERING, Warehouse

T = TypeVar("T")


class RwareParallelEnv(ParallelEnv):
    """A Warehouse whose agents are "agent_0", "agent_1", …; options as of it."""

    metadata = {**RENDERING, "name": "kiva_rware_v2", "is_parallelizable": True}

    def __init__(self, render_mode: str | None = None, **options: Any) -> None:
        self._env = Warehouse(render_mode=render_mode, **options)
        self.render_mode = render_mode
        self.possible_agents = [f"agent_{i}" for i in range(self._env.n_agents)]
        self.agents: list[str] = []
        self.observation_spaces = self._each(self._env.observation_space)
        self.action_spaces = self._each(self._env.action_space)

    def observation_space(self, agent: str) -> spaces.Space:
        """Returns the space of an agent's observations."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Space:
        """Returns the space of an agent's actions."""
        return self.action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Begins an episode; see Warehouse.reset."""
        observations, infos = self._env.reset(seed=seed, options=options)
        self.agents = list(self.possible_agents)
        return self._each(observations), self._by_agent(infos)

    def step(self, actions: Mapping[str, Any]) -> tuple[dict[str, Any], ...]:
        """Takes {agent: action}; returns observations, rewards, ends, truncations and infos."""
        chosen = [actions[agent] for agent in self.possible_agents]
        observations, rewards, ends, _, infos = self._env.step(chosen)
        agents = self.agents
        if ends:
            self.agents = []
        return (
            self._each(observations),
            self._each(map(float, rewards)),
            dict.fromkeys(agents, ends),
            dict.fromkeys(agents, False),
            self._by_agent(infos),
        )

    def render(self) -> np.ndarray | None:
        """Returns the picture as Warehouse.render does."""
        return self._env.render()

    def close(self) -> None:
        """Does nothing: there is no window."""

    def _by_agent(self, values: dict[str, Any]) -> dict[str, dict[str, Any]]:
        """Splits the infos by agent: arrays by their first axis; scalars are shared."""
        return {
            agent: {
                name: value[i].item() if np.ndim(value) else value for name, value in values.items()
            }
            for i, agent in enumerate(self.possible_agents)
        }

    def _each(self, values: Iterable[T]) -> dict[str, T]:
        return dict(zip(self.possible_agents, values))
