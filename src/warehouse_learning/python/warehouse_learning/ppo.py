# SPDX-License-Identifier: Apache-2.0
"""Proximal policy optimisation (Schulman et al., 2017) in numpy: one network for all robots, small
enough to train on a CPU in minutes.

    python3 -m warehouse_learning.ppo --size tiny --seeds 5 --out curve.png
"""

import argparse
import multiprocessing
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from warehouse_learning.marl.mlp import Adam
from warehouse_learning.observing import Observer
from warehouse_learning.options import Options
from warehouse_learning.warehouses import Warehouses

# What leads there; "delivered" alone is what counts.
REWARDS = {"lifted": 0.3, "dropped": -0.3, "stored": 0.3, "approached": 0.05, "step": -0.01}


@dataclass(frozen=True)
class PpoSettings:
    """Training hyperparameters."""

    worlds: int = 32
    rollout: int = 64  # decisions between two updates
    epochs: int = 4
    minibatches: int = 4
    rate: float = 1e-3  # of Adam; falls to zero
    discount: float = 0.98
    trace: float = 0.95  # lambda of the generalised advantage estimation
    clip: float = 0.2
    entropy: float = 0.01
    value: float = 0.5
    hidden: int = 64
    threads: int = 0  # that step the worlds; 0: as many as there are cores


class Network:
    """Observations → logits of the actions and a value, by two layers of tanh."""

    def __init__(self, size: int, actions: int, hidden: int, random: np.random.Generator) -> None:
        def layer(rows, columns, gain):
            q, _ = np.linalg.qr(random.standard_normal((max(rows, columns), min(rows, columns))))
            return (gain * (q if rows >= columns else q.T)).astype(np.float32)

        zeros = lambda n: np.zeros(n, np.float32)  # noqa: E731
        self.parameters = [
            layer(size, hidden, 2**0.5),
            zeros(hidden),
            layer(hidden, hidden, 2**0.5),
            zeros(hidden),
            np.column_stack([layer(hidden, actions, 0.01), layer(hidden, 1, 1.0)]),
            zeros(actions + 1),
        ]

    def forward(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, Any]:
        """Returns (logits, value, what backward needs)."""
        w1, b1, w2, b2, w3, b3 = self.parameters
        h1 = np.tanh(x @ w1 + b1)
        h2 = np.tanh(h1 @ w2 + b2)
        out = h2 @ w3 + b3
        return out[:, :-1], out[:, -1], (x, h1, h2)

    def backward(self, kept: Any, d_logits: np.ndarray, d_value: np.ndarray) -> list[np.ndarray]:
        """Returns the loss's slopes by all parameters."""
        x, h1, h2 = kept
        _, _, w2, _, w3, _ = self.parameters
        d_out = np.column_stack([d_logits, d_value]).astype(np.float32)
        d2 = (d_out @ w3.T) * (1 - h2 * h2)
        d1 = (d2 @ w2.T) * (1 - h1 * h1)
        return [x.T @ d1, d1.sum(0), h1.T @ d2, d2.sum(0), h2.T @ d_out, d_out.sum(0)]


def probabilities(logits: np.ndarray, masks: np.ndarray) -> np.ndarray:
    """Returns (m, 5), 0 where the mask is."""
    logits = np.where(masks, logits, -1e9)
    logits = logits - logits.max(1, keepdims=True)
    out = np.exp(logits) * masks
    return out / out.sum(1, keepdims=True)


class Policy:
    """A trained network as baselines.measure takes it; `seed` of its choices."""

    def __init__(self, network: Network, seed: int = 0) -> None:
        self.network, self._random = network, np.random.default_rng(seed)

    def __call__(self, observations: np.ndarray, masks: np.ndarray) -> np.ndarray:
        rows = observations.reshape(-1, observations.shape[-1])
        logits, _, _ = self.network.forward(rows)
        return _drawn(probabilities(logits, masks.reshape(len(rows), -1)), self._random).reshape(
            masks.shape[:-1]
        )


def _drawn(chances, random):
    """One column a row, (m,)."""
    sums = chances.cumsum(1)
    return (sums < random.random((len(chances), 1)) * sums[:, -1:]).sum(1).clip(0, 4)


def train(
    options: Options,
    decisions: int,
    seed: int = 0,
    settings: PpoSettings = PpoSettings(),
    report: Callable[..., Any] | None = None,
) -> tuple[Policy, np.ndarray]:  # noqa: B008
    """(Policy, curve): `decisions` of all robots together. The curve has rows (decisions so far,
    units delivered an episode). `report(row)` hears each."""
    random = np.random.default_rng(seed)
    run = _Run(options, settings, random)
    adam = Adam(run.network.parameters)
    updates = max(1, decisions // (run.rows * settings.rollout))
    curve = []
    for update in range(updates):
        batch = run.collect()
        rate = settings.rate * (1 - update / updates)
        _improve(run.network, adam, batch, rate, settings, random)
        if run.finished:
            curve.append(((update + 1) * run.rows * settings.rollout, float(np.mean(run.finished))))
            run.finished = []
            if report:
                report(curve[-1])
    return Policy(run.network, seed), np.array(curve).reshape(-1, 2)


class _Run:
    """Warehouses in which a network acts. `rows`: robots of all; `finished`: units delivered in the
    episodes that ended, to be taken."""

    def __init__(self, options, settings, random):
        self._settings, self._random, n = settings, random, settings.worlds
        self._warehouses = Warehouses(n, options, settings.threads)
        self._observer = Observer(self._warehouses)
        self.rows = n * self._warehouses.robots
        self.network = Network(self._observer.size, 5, settings.hidden, random)
        self._seeds = iter(random.integers(2**62, size=10**6).tolist())
        self._reset(np.arange(n))
        # Episodes end at different times, so that a rollout has all of an episode's parts in it.
        self._longest = options.max_cycles
        self._warehouses.cycle[:] = random.integers(self._longest, size=n)
        self._is_full = np.zeros(n, bool)  # episodes that began at their beginning
        self.finished = []

    def _reset(self, which):
        self._warehouses.reset(which, [next(self._seeds) for _ in which])

    def _seen(self):
        return self._observer.observations().reshape(self.rows, -1)

    def collect(self):
        """The batch of a rollout: arrays (rollout, rows, …) by name."""
        steps = [self._step() for _ in range(self._settings.rollout)]
        batch = {name: np.array([step[name] for step in steps]) for name in steps[0]}
        value = self.network.forward(self._seen())[1]
        batch["advantage"] = _advantages(batch, value, self._settings)
        batch["target"] = batch["advantage"] + batch["value"]
        return batch

    def _step(self):
        observations, mask = self._seen(), self._warehouses.masks().reshape(self.rows, -1)
        logits, value, _ = self.network.forward(observations)
        chances = probabilities(logits, mask)
        action = _drawn(chances, self._random)
        reward, _ = self._warehouses.step(action.reshape(self._settings.worlds, -1))
        reward = reward.ravel().astype(np.float32)
        ends = self._warehouses.cycle >= self._longest
        if ends.any():
            reward += self._cut(ends)
        return {
            "x": observations,
            "mask": mask,
            "action": action,
            "chance": np.take_along_axis(chances, action[:, None], 1)[:, 0],
            "value": value,
            "reward": reward,
            "end": self._by_robot(ends),
        }

    def _cut(self, ends):
        """Begins new episodes. Returns what would have come after those that time cuts off."""
        last = self.network.forward(self._seen())[1]
        self.finished += self._warehouses.delivered[ends & self._is_full].sum(1).tolist()
        self._is_full |= ends
        self._reset(np.flatnonzero(ends))
        return self._settings.discount * last * self._by_robot(ends)

    def _by_robot(self, ends):
        return np.repeat(ends, self._warehouses.robots)


def _advantages(batch, last, settings):
    """Generalised advantage estimation (Schulman et al., 2016): (rollout, robots)."""
    out = np.zeros_like(batch["reward"])
    trace, ahead = 0.0, last
    for t in reversed(range(len(out))):
        goes_on = ~batch["end"][t]
        error = batch["reward"][t] + settings.discount * ahead * goes_on - batch["value"][t]
        trace = error + settings.discount * settings.trace * goes_on * trace
        out[t], ahead = trace, batch["value"][t]
    return out


def _improve(network, adam, batch, rate, settings, random):
    flat = {name: values.reshape(-1, *values.shape[2:]) for name, values in batch.items()}
    count = len(flat["action"])
    for _ in range(settings.epochs):
        for rows in np.array_split(random.permutation(count), settings.minibatches):
            part = {name: values[rows] for name, values in flat.items()}
            adam.step(_slopes(network, part, settings), rate)


def _slopes(network, part, settings):
    m = len(part["action"])
    logits, value, kept = network.forward(part["x"])
    chances = probabilities(logits, part["mask"])
    picked = np.arange(m), part["action"]
    ratio = chances[picked] / part["chance"]
    advantage = part["advantage"]
    advantage = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
    # Beyond the clip nothing is gained by going on.
    clipped = np.where(advantage > 0, ratio > 1 + settings.clip, ratio < 1 - settings.clip)
    by_log = -advantage * ratio * ~clipped / m
    d_logits = -chances * by_log[:, None]
    d_logits[picked] += by_log
    logs = np.log(chances + 1e-8)
    entropy = -(chances * logs).sum(1, keepdims=True)
    d_logits += settings.entropy / m * chances * (logs + entropy)
    d_value = settings.value * (value - part["target"]) / m
    return network.backward(kept, d_logits, d_value)


def main() -> None:
    """Trains with several seeds, and prints and draws the curves."""
    parser = argparse.ArgumentParser("python3 -m warehouse_learning.ppo", description=__doc__)
    parser.add_argument("--size", default="tiny")
    parser.add_argument(
        "--decisions", type=int, default=600_000, help="steps of all robots together (600,000)"
    )
    parser.add_argument(
        "--seeds", type=int, default=1, help="number of trainings, with seeds from 0"
    )
    parser.add_argument("--jobs", type=int, default=1, help="trainings in parallel (1)")
    parser.add_argument(
        "--out",
        default="",
        help="PNG file for the learning curves; a JSON file is written beside it",
    )
    args = parser.parse_args()
    options = Options.of({"size": args.size, "max_cycles": 200, "rewards": REWARDS})
    settings = PpoSettings(threads=0 if args.jobs == 1 else 1)
    jobs = [(options, args.decisions, seed, settings) for seed in range(args.seeds)]
    if args.jobs == 1:
        curves = [_trained(job) for job in jobs]
    else:
        with multiprocessing.get_context("spawn").Pool(args.jobs) as pool:
            curves = pool.map(_trained, jobs, chunksize=1)
    if args.out:
        from warehouse_learning.curves import draw

        draw(args.out, options, curves)


def _trained(job):
    """The curve of a training, told as it grows."""
    options, decisions, seed, settings = job
    begin = time.process_time()

    def report(row):
        print(f"seed {seed}: {row[0]:9,.0f} decisions {row[1]:6.2f} units an episode", flush=True)

    _, curve = train(options, decisions, seed, settings, report)
    print(f"seed {seed}: {time.process_time() - begin:.0f} s of CPU", flush=True)
    return curve


if __name__ == "__main__":
    main()
