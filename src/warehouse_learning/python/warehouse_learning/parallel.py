# SPDX-License-Identifier: Apache-2.0
"""Each robot an agent: PettingZoo's parallel environment."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import ArrayLike
from pettingzoo import AECEnv, ParallelEnv
from pettingzoo.utils import BaseWrapper, parallel_to_aec

from warehouse_learning import fields
from warehouse_learning.screen import FRAMES, RENDER_MODES
from warehouse_learning.spaces import robot_action_space
from warehouse_learning.stage import OneWarehouse
from warehouse_learning.warehouses import ActionError


class KivaParallelEnv(OneWarehouse, ParallelEnv):
    """Agents robot_1, robot_2 …; options as of warehouse_learning.Options.

    Observations are (size,) float32, as `fields` says; infos hold "action_mask", (5,) int8, but
    for wheels, and what happened to the robot. An action that is not possible now is a wait.
    state() is the whole warehouse, as `state_fields` says. Every episode is truncated after
    max_cycles decisions.
    """

    def __init__(self, render_mode: str | None = None, **options: object) -> None:
        self._set_up_one(render_mode, options)
        self.metadata = {
            "name": "kiva_warehouse_v0",
            "render_modes": RENDER_MODES,
            "render_fps": FRAMES,
            "is_parallelizable": True,
        }
        self.possible_agents = [f"robot_{i + 1}" for i in range(self.options.robots)]
        self.agents: list[str] = []
        self.max_cycles = self.options.max_cycles
        low, high = fields.bounds(self.fields)
        self.observation_spaces = {a: spaces.Box(low, high) for a in self.possible_agents}
        self.action_spaces = {a: robot_action_space(self.options) for a in self.possible_agents}
        self.state_space = spaces.Box(*fields.bounds(self.state_fields))
        self._random: np.random.Generator | None = None

    def observation_space(self, agent: str) -> spaces.Space:
        """Returns the space of an agent's observations."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Space:
        """Returns the space of an agent's actions."""
        return self.action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Begins an episode; the same seed begins the same one, without one the next begins.

        Returns (observations, infos) by agent.
        """
        if seed is not None or self._random is None:
            self._random = np.random.default_rng(seed)
        self.agents = self.possible_agents[:]
        self._begin(self._random.integers(2**62) if seed is None else seed)
        return self._observations(), self._infos({})

    def step(self, actions: Mapping[str, ArrayLike]) -> tuple[dict[str, Any], ...]:
        """Takes {agent: action}, one for each agent, and makes one decision.

        Returns observations, rewards, terminations, truncations and infos by agent. Raises
        ActionError that names the agent with an invalid action.
        """
        if not self.agents:
            return {}, {}, {}, {}, {}
        rewards, happened, ends = self._decide(self._chosen(actions))
        agents = self.agents
        if ends:
            self.agents = []
        return (
            self._observations(),
            dict(zip(agents, rewards.tolist())),
            dict.fromkeys(agents, False),
            dict.fromkeys(agents, ends),
            self._infos(happened),
        )

    def _chosen(self, actions: Mapping[str, ArrayLike]) -> np.ndarray:
        missing = [a for a in self.agents if a not in actions]
        if missing:
            raise ActionError(
                f"{missing[0]} has no action; one for each of {len(self.agents)} robots"
            )
        for agent in actions:
            if agent not in self.possible_agents:
                raise ActionError(f"there is no agent {agent!r}")
        for agent in self.agents:
            check_action(agent, actions[agent], self.action_spaces[agent])
        return np.array([actions[a] for a in self.agents])

    def _observations(self) -> dict[str, np.ndarray]:
        rows = self._see.observations()[0]
        return {a: rows[i].copy() for i, a in enumerate(self.possible_agents)}

    def _infos(self, happened: dict[str, np.ndarray]) -> dict[str, dict[str, Any]]:
        masks = self._masks()
        return {
            agent: {
                **{name: mask[0, i].copy() for name, mask in masks.items()},
                **{name: bool(events[i]) for name, events in happened.items()},
            }
            for i, agent in enumerate(self.possible_agents)
        }


class _Checked(BaseWrapper):
    """Refuses an action when it is given, and not when all have theirs."""

    def step(self, action: ArrayLike) -> None:
        agent = self.agent_selection
        if not (self.terminations[agent] or self.truncations[agent]):
            check_action(agent, action, self.action_space(agent))
        super().step(action)


def in_turns(env: ParallelEnv) -> AECEnv:
    """Returns the same for PettingZoo's other interface."""
    return _Checked(parallel_to_aec(env))


def check_action(agent: str, action: ArrayLike, space: spaces.Space) -> None:
    """Raises ActionError that names the agent, unless the action is one of the space."""
    values = np.asarray(action)
    if isinstance(space, spaces.Discrete):
        good = values.shape == () and values.dtype.kind in "iu" and 0 <= values < space.n
        expected = f"a whole number from 0 to {space.n - 1}"
    else:
        good = values.shape == space.shape and values.dtype.kind in "iuf"
        good = good and bool((np.isfinite(values) & (np.abs(values) <= 1)).all())
        expected = f"{space.shape[0]} numbers from -1 to 1"
    if not good:
        raise ActionError(f"{agent}: action {action!r}; {expected} was expected")
