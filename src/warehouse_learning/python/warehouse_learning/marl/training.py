# SPDX-License-Identifier: Apache-2.0
"""IPPO and MAPPO: proximal policy optimisation (Schulman et al., 2017) of one network that all
robots share. In IPPO (de Witt et al., 2020) a critic judges by what its robot observes, in MAPPO
(Yu et al., 2022) by what all observe together; it has a value for each robot then."""

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from warehouse_learning.marl import checkpoint
from warehouse_learning.marl.encoding import Encoding
from warehouse_learning.marl.mlp import Adam, Mlp, log_softmax
from warehouse_learning.marl.policy import ACTIONS, Policy, masked
from warehouse_learning.marl.rollouts import Environments, Rollout, Rollouts

ALGORITHMS = "ippo", "mappo"


@dataclass(frozen=True)
class TrainingSettings:
    """Hyperparameters of a training. `steps`: of each environment's clock, all environments
    together."""

    algorithm: str = "mappo"
    steps: int = 20_000_000
    environments: int = 64
    rollout: int = 64  # steps of each between two updates
    epochs: int = 3
    minibatches: int = 4
    rate: float = 1e-3  # of Adam; falls to a tenth
    discount: float = 0.99
    trace: float = 0.95  # lambda of the generalised advantage estimation
    clip: float = 0.2
    spread: float = 0.02  # least standard deviation by which advantages are divided
    entropy: float = 0.01  # falls to a tenth
    hidden: int = 64
    imitation: int = 0  # steps of the planner to imitate before; see imitation
    warm_up: int = 0  # updates in which the critic alone learns

    def __post_init__(self) -> None:
        if self.algorithm not in ALGORITHMS:
            raise ValueError(
                f"algorithm is {self.algorithm!r}; one of {', '.join(ALGORITHMS)} was expected"
            )

    def falling(self, value: float, done: int) -> float:
        """Returns what is left of a value after `done` steps: a tenth at the end."""
        return value * (1 - 0.9 * min(done / self.steps, 1))


class Training:
    """One training of one seed, in environments whose observations an encoder prepares.

    `curve` has rows (steps so far, mean return of the episodes that ended since the last row); a
    return is the sum of all robots' rewards in an episode, or of what they delivered where
    environments say so. `seconds`: of CPU so far.
    """

    def __init__(
        self, envs: Environments, encoder: Encoding, settings: TrainingSettings, seed: int
    ) -> None:
        self.settings, self.seed = settings, seed
        self.random = np.random.default_rng(seed)
        self._envs, self.encoder, agents = envs, encoder, envs.agents
        hidden = settings.hidden
        self.actor = Mlp([encoder.size, hidden, hidden, ACTIONS], 0.01, self.random)
        inputs, values = encoder.size, 1
        if settings.algorithm == "mappo":
            inputs, values = agents * encoder.size, agents
        self.critic = Mlp([inputs, hidden, hidden, values], 0.01, self.random)
        self._optimisers = Adam(self.actor.parameters), Adam(self.critic.parameters)
        self.done, self.seconds = 0, 0.0
        self.curve: list[tuple[int, float]] = []
        self._rollouts = Rollouts(envs, encoder, self.random)

    def take(self, policy: Policy) -> None:
        """Begins with what a policy of this task knows. Raises ValueError for another task's."""
        theirs = policy.network.parameters
        if [p.shape for p in theirs] != [p.shape for p in self.actor.parameters]:
            raise ValueError("the policy is of another task, or of a network of another size")
        for mine, other in zip(self.actor.parameters, theirs):
            mine[:] = other

    @property
    def record(self) -> dict[str, Any]:
        """Returns how the actor was trained so far."""
        return {
            "settings": asdict(self.settings),
            "seed": self.seed,
            "steps": self.done,
            "seconds_of_cpu": round(self.seconds),
        }

    def run(
        self,
        minutes: float = float("inf"),
        report: Callable[["Training"], object] = lambda _: None,
        report_every: float = 10,
    ) -> bool:
        """Trains until the settings' steps are done or minutes of wall time have passed.

        report(self) is called after an update, at least report_every seconds after the last time.
        Returns whether the training is complete.
        """
        end = time.monotonic() + 60 * minutes
        reported_at = time.monotonic()
        while self.done < self.settings.steps and time.monotonic() < end:
            begin = time.process_time()
            self._update()
            self.seconds += time.process_time() - begin
            if time.monotonic() >= reported_at + report_every:
                reported_at = time.monotonic()
                report(self)
        return self.done >= self.settings.steps

    def _update(self) -> None:
        rollout = self._rollouts.collect(self.actor, self.settings.rollout)
        self._improve(rollout)
        self.done += self.settings.rollout * self._envs.num_envs
        if rollout.finished:
            self.curve.append((self.done, float(np.mean(rollout.finished))))

    def _values(self, observations: np.ndarray) -> np.ndarray:
        """(…, agents) of (…, agents, size)."""
        return self.critic.forward(self._critic_rows(observations))[0].reshape(
            observations.shape[:-1]
        )

    def _critic_rows(self, observations: np.ndarray) -> np.ndarray:
        width = observations.shape[-1]
        is_joint = self.settings.algorithm == "mappo"
        return observations.reshape(-1, observations.shape[-2] * width if is_joint else width)

    def _advantages(self, rollout: Rollout) -> tuple[np.ndarray, np.ndarray]:
        """Generalised advantage estimation (Schulman et al., 2016), and the values that it begins
        from: (rollout, n, agents) each."""
        settings, value = self.settings, self._values(rollout.observations)
        reward = rollout.reward
        # Time cuts episodes off: what would have come after counts.
        for t, which, observations in rollout.cut:
            reward[t, which] += settings.discount * self._values(observations)
        out = np.empty_like(reward)
        trace = np.zeros(out.shape[1:], np.float32)
        for t in reversed(range(len(out))):
            goes_on = ~rollout.end[t][:, None]
            error = reward[t] + settings.discount * value[t + 1] * goes_on - value[t]
            trace = error + settings.discount * settings.trace * goes_on * trace
            out[t] = trace
        return out, value[:-1]

    def _improve(self, rollout: Rollout) -> None:
        settings = self.settings
        advantage, value = self._advantages(rollout)
        target = advantage + value
        spread = max(advantage.std(), settings.spread, 1e-8)
        size = settings.rollout * self._envs.num_envs
        flat = {
            name: array.reshape(size, *array.shape[2:])
            for name, array in (
                ("observations", rollout.observations[:-1]),
                ("possible", rollout.possible),
                ("action", rollout.action),
                ("log", rollout.log),
                ("advantage", (advantage - advantage.mean()) / spread),
                ("target", target),
            )
            if array is not None
        }
        rate = settings.falling(settings.rate, self.done)
        per_update = settings.epochs * settings.minibatches
        for _ in range(settings.epochs):
            for rows in np.array_split(self.random.permutation(size), settings.minibatches):
                part = {name: array[rows] for name, array in flat.items()}
                if self._optimisers[1].steps >= settings.warm_up * per_update:
                    self._optimisers[0].step(self._actor_slopes(part), rate)
                self._optimisers[1].step(self._critic_slopes(part), rate)

    def _actor_slopes(self, part: dict[str, np.ndarray]) -> list[np.ndarray]:
        settings = self.settings
        logits, kept = self.actor.forward(part["observations"].reshape(-1, self.encoder.size))
        if "possible" in part:
            logits = masked(logits, part["possible"].reshape(logits.shape))
        action, advantage = part["action"].ravel(), part["advantage"].ravel()
        logs = log_softmax(logits)
        chances = np.exp(logs)
        picked = np.arange(len(action)), action
        ratio = np.exp(logs[picked] - part["log"].ravel())
        # Beyond the clip nothing is gained by going on.
        clipped = np.where(advantage > 0, ratio > 1 + settings.clip, ratio < 1 - settings.clip)
        by_log = -advantage * ratio * ~clipped
        slopes = -chances * by_log[:, None]
        slopes[picked] += by_log
        entropy = -(chances * logs).sum(1, keepdims=True)
        weight = np.float32(settings.falling(settings.entropy, self.done))
        slopes += weight * chances * (logs + entropy)
        slopes /= len(action)
        return self.actor.backward(kept, slopes)

    def _critic_slopes(self, part: dict[str, np.ndarray]) -> list[np.ndarray]:
        values, kept = self.critic.forward(self._critic_rows(part["observations"]))
        error = values - part["target"].reshape(values.shape)
        error /= error.size
        return self.critic.backward(kept, error)

    def save(self, path: Path) -> None:
        """Writes a checkpoint, atomically; restore() resumes from it."""
        state = {
            "settings": asdict(self.settings),
            "seed": self.seed,
            "done": self.done,
            "seconds": self.seconds,
            "curve": self.curve,
            "random": self.random.bit_generator.state,
        }
        checkpoint.save(path, state, self._optimisers)

    def restore(self, path: Path) -> None:
        """Resumes from a checkpoint; episodes begin again.

        Raises ValueError for that of another training.
        """
        state = checkpoint.load(path, asdict(self.settings), self._optimisers)
        self.done, self.seconds = state["done"], state["seconds"]
        self.curve = [tuple(row) for row in state["curve"]]
        self.random.bit_generator.state = state["random"]
        self._rollouts.begin()
