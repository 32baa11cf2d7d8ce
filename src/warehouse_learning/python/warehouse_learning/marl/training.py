# SPDX-License-Identifier: Apache-2.0
"""IPPO and MAPPO: proximal policy optimisation (Schulman et al., 2017) of one network that all
robots share. In IPPO (de Witt et al., 2020) a critic judges by what its robot observes, in MAPPO
(Yu et al., 2022) by what all observe together; it has a value for each robot then."""

import json
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from warehouse_learning.marl.encoding import Encoder
from warehouse_learning.marl.imitation import imitate
from warehouse_learning.marl.mlp import Adam, Mlp
from warehouse_learning.marl.policy import ACTIONS, GridPolicy, drawn

ALGORITHMS = "ippo", "mappo"


@dataclass(frozen=True)
class Settings:
    """Of a training. `steps`: of each environment's clock, all environments together."""

    algorithm: str = "mappo"
    steps: int = 20_000_000
    environments: int = 128
    rollout: int = 16  # steps of each between two updates
    epochs: int = 3
    minibatches: int = 4
    rate: float = 2e-3  # of Adam; falls to a tenth
    discount: float = 0.98
    trace: float = 0.95  # lambda of the generalised advantage estimation
    clip: float = 0.2
    entropy: float = 0.01  # falls to a tenth
    hidden: int = 64
    imitation: int = 0  # steps of the planner that are imitated before
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
    """One training of one seed, on environments as RwareVectorEnv (autoreset SAME_STEP).

    `curve` has rows (steps so far, mean return of the episodes that ended since the last row); a
    return is the sum of all robots' rewards in an episode. `seconds`: of CPU so far.
    """

    def __init__(self, envs: Any, settings: Settings, seed: int, about: dict[str, Any]) -> None:
        self.settings, self.seed, self.about = settings, seed, about
        self.random = np.random.default_rng(seed)
        self._envs = envs
        height, width = envs.task.floor.grid_size
        agents = envs.task.n_agents
        self.encoder = encoder = Encoder(width, height, agents, envs.task.vector_size)
        hidden = settings.hidden
        self.actor = Mlp([encoder.size, hidden, hidden, ACTIONS], 0.01, self.random)
        seen, values = encoder.size, 1
        if settings.algorithm == "mappo":
            seen, values = agents * encoder.size, agents
        self.critic = Mlp([seen, hidden, hidden, values], 1.0, self.random)
        self._optimisers = Adam(self.actor.parameters), Adam(self.critic.parameters)
        self.done, self.seconds = 0, 0.0
        self.curve: list[tuple[int, float]] = []
        self._begin()

    def take(self, policy: GridPolicy) -> None:
        """Begins with what a policy of this task knows. Raises ValueError for another task's."""
        theirs = policy.network.parameters
        if [p.shape for p in theirs] != [p.shape for p in self.actor.parameters]:
            raise ValueError("the policy is of another task, or of a network of another size")
        for mine, other in zip(self.actor.parameters, theirs):
            mine[:] = other

    def _begin(self):
        """Episodes that begin at different times: a rollout has all parts of an episode in it."""
        observations, _ = self._envs.reset(seed=int(self.random.integers(2**31)))
        self._seen = self.encoder.encode(observations)
        n = self._envs.num_envs
        self._returns = np.zeros(n)
        self._starts = self.random.integers(0, self._envs.task.max_steps, n)
        self._clock = 0
        self._is_whole = np.zeros(n, bool)

    @property
    def policy(self) -> GridPolicy:
        """Returns what was learnt so far."""
        about = self.about | {
            "settings": asdict(self.settings),
            "seed": self.seed,
            "steps": self.done,
            "seconds_of_cpu": round(self.seconds),
        }
        return GridPolicy(self.actor, self.encoder, about)

    def run(
        self, minutes: float = float("inf"), report: Callable[[Any], Any] = lambda _: None
    ) -> bool:
        """Trains until the settings' steps are done or minutes of wall time have passed.

        report(self) is called about once in ten seconds. Returns whether the training is complete.
        """
        end = time.monotonic() + 60 * minutes
        told = time.monotonic()
        if self.settings.imitation and not self.done:
            begin = time.process_time()
            imitate(self.actor, self.encoder, self._envs.task, self.settings.imitation, self.seed)
            self.seconds += time.process_time() - begin
        while self.done < self.settings.steps and time.monotonic() < end:
            begin = time.process_time()
            self._update()
            self.seconds += time.process_time() - begin
            if time.monotonic() > told + 10:
                told = time.monotonic()
                report(self)
        return self.done >= self.settings.steps

    def _update(self):
        batch, finished = self._roll_out()
        self._improve(batch)
        self.done += self.settings.rollout * self._envs.num_envs
        if finished:
            self.curve.append((self.done, float(np.mean(finished))))

    def _values(self, seen):
        """(environments, agents) of (environments, agents, size)."""
        rows = self._critic_rows(seen)
        values, _ = self.critic.forward(rows)
        return values.reshape(seen.shape[:2])

    def _critic_rows(self, seen):
        joint = self.settings.algorithm == "mappo"
        return seen.reshape(len(seen), -1) if joint else seen.reshape(-1, seen.shape[-1])

    def _roll_out(self):
        """What happened in a rollout, arrays (rollout, environments, agents, …), and the returns of
        the episodes that ended."""
        settings, envs = self.settings, self._envs
        lead = settings.rollout, envs.num_envs, envs.task.n_agents
        batch = {
            "seen": np.empty((*lead, self.encoder.size), np.float32),
            "action": np.empty(lead, np.int8),
            "log": np.empty(lead, np.float32),
            "value": np.empty((lead[0] + 1, *lead[1:]), np.float32),
            "reward": np.empty(lead, np.float32),
            "end": np.empty(lead[:2], bool),
        }
        finished: list[float] = []
        for t in range(settings.rollout):
            seen = batch["seen"][t] = self._seen
            logits, _ = self.actor.forward(seen.reshape(-1, self.encoder.size))
            action = drawn(logits, self.random)
            batch["log"][t] = _logs(logits)[np.arange(len(action)), action].reshape(lead[1:])
            batch["action"][t] = action.reshape(lead[1:])
            batch["value"][t] = self._values(seen)
            batch["reward"][t], batch["end"][t] = self._step(batch["action"][t], finished)
        batch["value"][-1] = self._values(self._seen)
        return batch, finished

    def _step(self, actions, finished):
        """Rewards, with what would have come after an episode that was cut off, and who ended."""
        observations, rewards, ends, _, infos = self._envs.step(actions)
        self._returns += rewards.sum(1)
        earned = rewards.astype(np.float32)
        if ends.any():
            last = self.encoder.encode(infos["final_obs"][ends])
            earned[ends] += self.settings.discount * self._values(last)
            finished += self._returns[ends & self._is_whole].tolist()
            self._returns[ends] = 0
            self._is_whole |= ends
        late = self._starts == self._clock
        self._clock += 1
        if late.any():
            observations, _ = self._envs.reset(options={"reset_mask": late})
            self._returns[late] = 0
            self._is_whole |= late
            ends = ends | late
        self._seen = self.encoder.encode(observations)
        return earned, ends

    def _advantages(self, batch):
        """Generalised advantage estimation (Schulman et al., 2016): (rollout, n, agents)."""
        settings, value = self.settings, batch["value"]
        out = np.empty_like(batch["reward"])
        trace = np.zeros(out.shape[1:], np.float32)
        for t in reversed(range(len(out))):
            goes_on = ~batch["end"][t][:, None]
            error = batch["reward"][t] + settings.discount * value[t + 1] * goes_on - value[t]
            trace = error + settings.discount * settings.trace * goes_on * trace
            out[t] = trace
        return out

    def _improve(self, batch):
        settings = self.settings
        advantage = self._advantages(batch)
        target = advantage + batch["value"][:-1]
        advantage = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
        size = settings.rollout * self._envs.num_envs
        flat = {
            name: array.reshape(size, *array.shape[2:])
            for name, array in (
                ("seen", batch["seen"]),
                ("action", batch["action"]),
                ("log", batch["log"]),
                ("advantage", advantage),
                ("target", target),
            )
        }
        rate = settings.falling(settings.rate, self.done)
        per_update = settings.epochs * settings.minibatches
        for _ in range(settings.epochs):
            for rows in np.array_split(self.random.permutation(size), settings.minibatches):
                part = {name: array[rows] for name, array in flat.items()}
                if self._optimisers[1].steps >= settings.warm_up * per_update:
                    self._optimisers[0].step(self._actor_slopes(part), rate)
                self._optimisers[1].step(self._critic_slopes(part), rate)

    def _actor_slopes(self, part):
        settings = self.settings
        logits, kept = self.actor.forward(part["seen"].reshape(-1, self.encoder.size))
        action, advantage = part["action"].ravel(), part["advantage"].ravel()
        logs = _logs(logits)
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

    def _critic_slopes(self, part):
        values, kept = self.critic.forward(self._critic_rows(part["seen"]))
        error = values - part["target"].reshape(values.shape)
        error /= error.size
        return self.critic.backward(kept, error)

    def save(self, path: Path) -> None:
        """Writes a checkpoint, at once or not at all; restore() goes on from it."""
        arrays = {}
        for name, network, optimiser in zip(
            ("actor", "critic"), (self.actor, self.critic), self._optimisers
        ):
            for i, parts in enumerate(zip(network.parameters, optimiser.mean, optimiser.square)):
                for kind, array in zip(("weight", "mean", "square"), parts):
                    arrays[f"{name}_{kind}_{i}"] = array
        state = {
            "settings": asdict(self.settings),
            "seed": self.seed,
            "done": self.done,
            "seconds": self.seconds,
            "updates": [optimiser.steps for optimiser in self._optimisers],
            "curve": self.curve,
            "random": self.random.bit_generator.state,
        }
        half = path.with_suffix(".part.npz")
        np.savez(half, state=json.dumps(state), **arrays)
        half.replace(path)

    def restore(self, path: Path) -> None:
        """Goes on from a checkpoint; episodes begin again.

        Raises ValueError for that of another training.
        """
        with np.load(path, allow_pickle=False) as content:
            state = json.loads(str(content["state"]))
            ours = asdict(self.settings)
            for name, value in state["settings"].items():
                if ours[name] != value:
                    raise ValueError(f"{path}: its {name} is {value}, not {ours[name]}")
            for name, network, optimiser, steps in zip(
                ("actor", "critic"), (self.actor, self.critic), self._optimisers, state["updates"]
            ):
                parts = network.parameters, optimiser.mean, optimiser.square
                for kind, arrays in zip(("weight", "mean", "square"), parts):
                    for i, array in enumerate(arrays):
                        array[:] = content[f"{name}_{kind}_{i}"]
                optimiser.steps = steps
        self.done, self.seconds = state["done"], state["seconds"]
        self.curve = [tuple(row) for row in state["curve"]]
        self.random.bit_generator.state = state["random"]
        self._begin()


def _logs(logits):
    """Logarithms of chances, (m, 5)."""
    shifted = logits - logits.max(1, keepdims=True)
    return shifted - np.log(np.exp(shifted).sum(1, keepdims=True))
