# SPDX-License-Identifier: Apache-2.0
"""What happens while a network drives robots, in arrays: to learn from, without its values."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from warehouse_learning.marl.encoding import Encoder
from warehouse_learning.marl.mlp import Mlp, log_softmax
from warehouse_learning.marl.policy import drawn


@dataclass
class Rollout:
    """Arrays (steps, environments, agents, …): what was seen before each step and after the last,
    what was done, with which logarithm of its chance, and what it earned. end: (steps,
    environments), after which steps another episode began. cut: (step, environments, what was seen
    last), of those ends. finished: returns of the whole episodes among them."""

    observations: np.ndarray  # one step more than the others
    action: np.ndarray
    log: np.ndarray
    reward: np.ndarray
    end: np.ndarray
    cut: list[tuple[int, np.ndarray, np.ndarray]] = field(default_factory=list)
    finished: list[float] = field(default_factory=list)


class Rollouts:
    """Drives environments as RwareVectorEnv (autoreset SAME_STEP), on and on."""

    def __init__(self, envs: Any, encoder: Encoder, random: np.random.Generator) -> None:
        self._envs, self._encoder, self._random = envs, encoder, random
        self.begin()

    def begin(self) -> None:
        """Begins episodes, of different lengths: a rollout has all parts of an episode in it."""
        observations, _ = self._envs.reset(seed=int(self._random.integers(2**31)))
        self._observations = self._encoder.encode(observations)
        n = self._envs.num_envs
        self._returns = np.zeros(n)
        self._starts = self._random.integers(0, self._envs.task.max_steps, n)
        self._clock = 0
        self._is_whole = np.zeros(n, bool)

    def collect(self, actor: Mlp, steps: int) -> Rollout:
        """Returns what comes of so many steps, in which actions are drawn by an actor's logits."""
        lead = steps, self._envs.num_envs, self._envs.task.n_agents
        size = self._encoder.size
        out = Rollout(
            observations=np.empty((steps + 1, *lead[1:], size), np.float32),
            action=np.empty(lead, np.int8),
            log=np.empty(lead, np.float32),
            reward=np.empty(lead, np.float32),
            end=np.empty(lead[:2], bool),
        )
        for t in range(steps):
            out.observations[t] = self._observations
            logits, _ = actor.forward(self._observations.reshape(-1, size))
            action = drawn(logits, self._random)
            out.action[t] = action.reshape(lead[1:])
            logs = log_softmax(logits)
            out.log[t] = logs[np.arange(len(action)), action].reshape(lead[1:])
            self._step(out, t)
        out.observations[steps] = self._observations
        return out

    def _step(self, out, t):
        observations, rewards, ends, _, infos = self._envs.step(out.action[t])
        self._returns += rewards.sum(1)
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
            observations, _ = self._envs.reset(options={"reset_mask": late})
            self._returns[late] = 0
            self._is_whole |= late
        out.end[t] = ends | late
        self._observations = self._encoder.encode(observations)
