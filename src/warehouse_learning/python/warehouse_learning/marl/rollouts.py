# SPDX-License-Identifier: Apache-2.0
"""What happens while a network drives robots, in arrays: to learn from, without its values."""

from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from warehouse_learning.marl.encoding import Encoding
from warehouse_learning.marl.mlp import Mlp, log_softmax
from warehouse_learning.marl.policy import ACTIONS, drawn, masked


class Environments(Protocol):
    """What trainings drive: RwareVectorEnv (autoreset SAME_STEP), or marl.robots.RobotsEnv.

    Observations are (num_envs, agents, width), actions and rewards (num_envs, agents). Infos may
    hold "action_mask", (num_envs, agents, 5), of the actions that are possible next, and
    "delivered", (num_envs, agents), which replaces rewards in returns.
    """

    num_envs: int
    agents: int
    max_steps: int  # of an episode

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begins episodes in all, or in those of options["reset_mask"].

        Returns observations and infos.
        """
        ...

    def step(
        self, actions: ArrayLike
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Returns observations, rewards, which episodes ended, an array without a use, and infos.

        Episodes that ended begin again; infos["final_obs"] has their last observations.
        """
        ...


@dataclass
class Rollout:
    """Arrays (steps, environments, agents, …): what was seen before each step and after the last,
    which actions were possible (None: all), what was done, with which logarithm of its chance, and
    what it earned. end: (steps, environments), after which steps another episode began. cut: (step,
    environments, what was seen last), of those ends. finished: returns of the whole episodes among
    them."""

    observations: np.ndarray  # one step more than the others
    possible: np.ndarray | None
    action: np.ndarray
    log: np.ndarray
    reward: np.ndarray
    end: np.ndarray
    cut: list[tuple[int, np.ndarray, np.ndarray]] = field(default_factory=list)
    finished: list[float] = field(default_factory=list)


class Rollouts:
    """Drives environments, on and on."""

    def __init__(self, envs: Environments, encoder: Encoding, random: np.random.Generator) -> None:
        self._envs, self._encoder, self._random = envs, encoder, random
        self.begin()

    def begin(self) -> None:
        """Begins episodes, of different lengths: a rollout has all parts of an episode in it."""
        observations, infos = self._envs.reset(seed=int(self._random.integers(2**31)))
        self._see(observations, infos)
        n = self._envs.num_envs
        self._returns = np.zeros(n)
        self._starts = self._random.integers(0, self._envs.max_steps, n)
        self._clock = 0
        self._is_whole = np.zeros(n, bool)

    def _see(self, observations: np.ndarray, infos: dict[str, Any]) -> None:
        self._observations = self._encoder.encode(observations)
        mask = infos.get("action_mask")
        self._possible = None if mask is None else np.array(mask, bool)

    def collect(self, actor: Mlp, steps: int) -> Rollout:
        """Returns the rollout of `steps` steps with actions sampled from an actor's logits."""
        lead = steps, self._envs.num_envs, self._envs.agents
        size = self._encoder.size
        out = Rollout(
            observations=np.empty((steps + 1, *lead[1:], size), np.float32),
            possible=None if self._possible is None else np.empty((*lead, ACTIONS), bool),
            action=np.empty(lead, np.int8),
            log=np.empty(lead, np.float32),
            reward=np.empty(lead, np.float32),
            end=np.empty(lead[:2], bool),
        )
        for t in range(steps):
            out.observations[t] = self._observations
            logits, _ = actor.forward(self._observations.reshape(-1, size))
            if out.possible is not None:
                out.possible[t] = self._possible
                logits = masked(logits, out.possible[t].reshape(logits.shape))
            action = drawn(logits, self._random)
            out.action[t] = action.reshape(lead[1:])
            logs = log_softmax(logits)
            out.log[t] = logs[np.arange(len(action)), action].reshape(lead[1:])
            self._step(out, t)
        out.observations[steps] = self._observations
        return out

    def _step(self, out: Rollout, t: int) -> None:
        observations, rewards, ends, _, infos = self._envs.step(out.action[t])
        self._returns += infos.get("delivered", rewards).sum(1)
        out.reward[t] = rewards
        if ends.any():
            out.cut.append((t, ends, self._encoder.encode(infos["final_obs"][ends])))
            out.finished += self._returns[ends & self._is_whole].tolist()
            self._returns[ends] = 0
            self._is_whole |= ends
        late = (self._starts == self._clock) & ~ends
        self._clock += 1
        if late.any():
            out.cut.append((t, late, self._encoder.encode(observations[late])))
            observations, infos = self._envs.reset(options={"reset_mask": late})
            self._returns[late] = 0
            self._is_whole |= late
        out.end[t] = ends | late
        self._see(observations, infos)
