# SPDX-License-Identifier: Apache-2.0
"""Each robot an agent: PettingZoo's parallel environment."""

import numpy as np
from gymnasium import spaces
from pettingzoo import ParallelEnv

from warehouse_learning import episodes, fields
from warehouse_learning.observing import Observer
from warehouse_learning.options import Options
from warehouse_learning.picture import Picture
from warehouse_learning.screen import RENDER_MODES, Screen
from warehouse_learning.spaces import robot_action_space
from warehouse_learning.warehouses import ActionError, Warehouses

FRAMES = 4  # a second


class KivaParallelEnv(ParallelEnv):
    """Agents robot_1, robot_2 …; options as of warehouse_learning.Options.

    Observations are (size,) float32, as `fields` says; infos hold "action_mask", (5,) int8, and
    what happened to the robot. An action that is not possible now is a wait. state() is the whole
    warehouse, as `state_fields` says. Every episode is truncated after max_cycles decisions.
    """

    def __init__(self, render_mode=None, **options):
        self.options = Options.of(options)
        self.metadata = {
            "name": "kiva_warehouse_v0",
            "render_modes": RENDER_MODES,
            "render_fps": FRAMES,
            "is_parallelizable": True,
        }
        self._in = Warehouses(1, self.options, threads=1)
        self._see = Observer(self._in)
        self.fields, self.state_fields = self._see.fields, self._see.state_fields
        self.possible_agents = [f"robot_{i + 1}" for i in range(self.options.robots)]
        self.agents = []
        self.max_cycles = self.options.max_cycles
        low, high = fields.bounds(self.fields)
        self.observation_spaces = {a: spaces.Box(low, high) for a in self.possible_agents}
        self.action_spaces = {a: robot_action_space(self.options) for a in self.possible_agents}
        self.state_space = spaces.Box(*fields.bounds(self.state_fields))
        self._screen = Screen(render_mode, lambda: Picture(self._in))
        self._random = None
        self._seed, self._actions = None, []

    @property
    def render_mode(self):
        return self._screen.mode

    def observation_space(self, agent):
        return self.observation_spaces[agent]

    def action_space(self, agent):
        return self.action_spaces[agent]

    def reset(self, seed=None, options=None):
        """A new episode: the same seed, the same episode. Without one, the next of the last."""
        if seed is not None or self._random is None:
            self._random = np.random.default_rng(seed)
        self._seed = int(self._random.integers(2**62)) if seed is None else int(seed)
        self._actions = []
        self.agents = self.possible_agents[:]
        self._in.reset([0], [self._seed])
        self._screen.stepped()
        return self._observations(), self._infos({})

    def step(self, actions):
        """{agent: action}, one for each agent. ActionError names the agent whose is none."""
        if not self.agents:
            return {}, {}, {}, {}, {}
        chosen = self._chosen(actions)
        self._actions.append(chosen)
        rewards, happened = self._in.step(chosen[None])
        ends = bool(self._in.cycle[0] >= self.max_cycles)
        agents = self.agents
        out = (
            self._observations(),
            {a: float(rewards[0, i]) for i, a in enumerate(agents)},
            dict.fromkeys(agents, False),
            dict.fromkeys(agents, ends),
            self._infos(happened),
        )
        if ends:
            self.agents = []
        self._screen.stepped()
        return out

    def state(self):
        """(size,) float32: the whole warehouse, for centralised critics."""
        return self._see.state()[0]

    def render(self):
        return self._screen.render()

    def close(self):
        self._screen.close()

    def save_episode(self, path):
        """The episode up to now as a file; `python3 -m warehouse_learning.watch` plays it."""
        if self._seed is None:
            raise ValueError("there is no episode yet: reset() begins one")
        episodes.save(path, self.options, self._seed, self._actions)

    @property
    def unit_deliveries(self):
        """(robots,) units that each has delivered in this episode."""
        return self._in.delivered[0].copy()

    def _chosen(self, actions):
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

    def _observations(self):
        rows = self._see.observations()[0]
        return {a: rows[i].copy() for i, a in enumerate(self.possible_agents)}

    def _infos(self, happened):
        masks = self._in.masks()[0].astype(np.int8)
        return {
            agent: {
                "action_mask": masks[i].copy(),
                **{name: bool(events[0, i]) for name, events in happened.items()},
            }
            for i, agent in enumerate(self.possible_agents)
        }


def check_action(agent, action, space):
    """ActionError that names the agent, unless the action is one of the space."""
    given = np.asarray(action)
    if isinstance(space, spaces.Discrete):
        good = given.shape == () and given.dtype.kind in "iu" and 0 <= given < space.n
        expected = f"a whole number from 0 to {space.n - 1}"
    else:
        good = given.shape == space.shape and given.dtype.kind in "iuf"
        good = good and bool((np.isfinite(given) & (np.abs(given) <= 1)).all())
        expected = f"{space.shape[0]} numbers from -1 to 1"
    if not good:
        raise ActionError(f"{agent}: action {action!r}; {expected} was expected")
