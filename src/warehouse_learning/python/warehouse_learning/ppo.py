# SPDX-License-Identifier: Apache-2.0
"""Proximal policy optimisation (Schulman et al., 2017) in numpy: one network for all robots, small
enough to train on a CPU in minutes.

    python3 -m warehouse_learning.ppo --size tiny --seeds 5 --out curve.png
"""

import argparse
import json
import multiprocessing
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from warehouse_learning.observing import Observer
from warehouse_learning.options import Options
from warehouse_learning.warehouses import Warehouses

# What leads there; "delivered" alone is what counts.
REWARDS = {"lifted": 0.3, "dropped": -0.3, "stored": 0.3, "approached": 0.05, "step": -0.01}


@dataclass(frozen=True)
class Settings:
    """Of the training."""

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


class Adam:
    """Adam (Kingma and Ba, 2015) with clipped slopes; changes the parameters in place."""

    def __init__(self, parameters: list[np.ndarray]) -> None:
        self.parameters, self.steps = parameters, 0
        self.mean = [np.zeros_like(p) for p in parameters]
        self.square = [np.zeros_like(p) for p in parameters]

    def step(self, slopes: Sequence[np.ndarray], rate: float) -> None:
        """Moves the parameters against the slopes."""
        norm = np.sqrt(sum(float((g * g).sum()) for g in slopes))
        scale = min(1.0, 0.5 / (norm + 1e-8))
        self.steps += 1
        c1, c2 = 1 - 0.9**self.steps, 1 - 0.999**self.steps
        for i, slope in enumerate(slopes):
            scaled = slope * scale
            self.mean[i] += 0.1 * (scaled - self.mean[i])
            self.square[i] += 0.001 * (scaled * scaled - self.square[i])
            step = self.mean[i] / c1 / (np.sqrt(self.square[i] / c2) + 1e-8)
            self.parameters[i] -= rate * step


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
    settings: Settings = Settings(),
    report: Callable[..., Any] | None = None,
) -> tuple[Policy, np.ndarray]:  # noqa: B008
    """(Policy, curve): `decisions` of all robots together. The curve has rows (decisions so far,
    units delivered an episode). `report(row)` hears each."""
    random = np.random.default_rng(seed)
    n, rollout = settings.worlds, settings.rollout
    warehouses = Warehouses(n, options, settings.threads)
    observer = Observer(warehouses)
    robots = warehouses.robots
    network = Network(observer.size, 5, settings.hidden, random)
    adam = Adam(network.parameters)
    seeds = iter(random.integers(2**62, size=10**6).tolist())
    warehouses.reset(np.arange(n), [next(seeds) for _ in range(n)])
    # Episodes end at different times, so that a rollout has all of an episode's parts in it.
    warehouses.cycle[:] = random.integers(options.max_cycles, size=n)
    observations, masks = observer.observations(), warehouses.masks()
    updates = max(1, decisions // (n * robots * rollout))
    curve, done, finished = [], 0, []
    full = np.zeros(n, bool)  # episodes that began at their beginning
    for update in range(updates):
        rows: dict[str, list[Any]] = {
            name: [] for name in ("x", "mask", "action", "chance", "value", "reward", "end")
        }
        for _ in range(rollout):
            flat, mask = observations.reshape(n * robots, -1), masks.reshape(n * robots, -1)
            logits, value, _ = network.forward(flat)
            chances = probabilities(logits, mask)
            action = _drawn(chances, random)
            reward, _ = warehouses.step(action.reshape(n, robots))
            ends = warehouses.cycle >= options.max_cycles
            observations, masks = observer.observations(), warehouses.masks()
            reward = reward.ravel().astype(np.float32)
            if ends.any():
                # The task goes on; the episode was only cut off.
                last = network.forward(observations.reshape(n * robots, -1))[1]
                reward += settings.discount * last * np.repeat(ends, robots)
                finished += warehouses.delivered[ends & full].sum(1).tolist()
                full |= ends
                which = np.flatnonzero(ends)
                warehouses.reset(which, [next(seeds) for _ in which])
                observations, masks = observer.observations(), warehouses.masks()
            chosen = np.take_along_axis(chances, action[:, None], 1)[:, 0]
            step = (flat, mask, action, chosen, value, reward, np.repeat(ends, robots))
            for name, values in zip(rows, step):
                rows[name].append(values)
        batch = {name: np.array(values) for name, values in rows.items()}
        value = network.forward(observations.reshape(n * robots, -1))[1]
        batch["advantage"] = _advantages(batch, value, settings)
        batch["target"] = batch["advantage"] + batch["value"]
        rate = settings.rate * (1 - update / updates)
        _improve(network, adam, batch, rate, settings, random)
        done += n * robots * rollout
        if finished:
            curve.append((done, float(np.mean(finished))))
            finished = []
            if report:
                report(curve[-1])
    return Policy(network, seed), np.array(curve).reshape(-1, 2)


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
    wanted = parser.parse_args()
    options = Options.of({"size": wanted.size, "max_cycles": 200, "rewards": REWARDS})
    settings = Settings(threads=0 if wanted.jobs == 1 else 1)
    jobs = [(options, wanted.decisions, seed, settings) for seed in range(wanted.seeds)]
    if wanted.jobs == 1:
        curves = [_trained(job) for job in jobs]
    else:
        with multiprocessing.get_context("spawn").Pool(wanted.jobs) as pool:
            curves = pool.map(_trained, jobs, chunksize=1)
    if wanted.out:
        draw(wanted.out, options, curves)


def _trained(job):
    """The curve of a training, told as it grows."""
    options, decisions, seed, settings = job
    begin = time.process_time()

    def report(row):
        print(f"seed {seed}: {row[0]:9,.0f} decisions {row[1]:6.2f} units an episode", flush=True)

    _, curve = train(options, decisions, seed, settings, report)
    print(f"seed {seed}: {time.process_time() - begin:.0f} s of CPU", flush=True)
    return curve


def draw(path: Any, options: Options, curves: Sequence[np.ndarray]) -> None:
    """Draws the curves of several seeds beside what the other baselines deliver."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from warehouse_learning import baselines

    figure = Figure((8, 4.5), dpi=110)
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    at = curves[0][:, 0]
    values = np.array([np.interp(at, curve[:, 0], curve[:, 1]) for curve in curves])
    axes.fill_between(at, values.min(0), values.max(0), alpha=0.25, lw=0)
    axes.plot(at, values.mean(0), label=f"PPO, {len(curves)} seeds")
    others = {"random": baselines.random_policy(), "greedy": baselines.greedy_policy(options)}
    for style, (name, policy) in zip((":", "--"), others.items()):
        delivered = baselines.measure(policy, options, 16)[0].mean()
        axes.axhline(delivered, ls=style, color="0.3", label=f"{name}, {delivered:.1f}")
    axes.set_xlabel("decisions of all robots")
    axes.set_ylabel(f"units delivered in {options.max_cycles} decisions a robot")
    axes.legend(frameon=False)
    axes.set_title(f"{options.robots} robots, {options.shelves} storage units")
    figure.savefig(path)
    with open(path.rsplit(".", 1)[0] + ".json", "w", encoding="utf-8") as file:
        json.dump([curve.tolist() for curve in curves], file)


if __name__ == "__main__":
    main()
