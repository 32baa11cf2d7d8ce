# SPDX-License-Identifier: Apache-2.0
"""Trains the robots of Warehouses, one or many: IPPO in numpy alone, small enough for a CPU.

python3 -m warehouse_learning.marl.robots --size tiny --seeds 5 --out curve.png
"""

import argparse
import multiprocessing
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from warehouse_learning.marl.encoding import Unchanged
from warehouse_learning.marl.policy import Policy
from warehouse_learning.marl.training import Training, TrainingSettings
from warehouse_learning.observing import Observer
from warehouse_learning.options import Options
from warehouse_learning.warehouses import Warehouses

# What leads there; "delivered" alone is what counts.
REWARDS = {"lifted": 0.3, "dropped": -0.3, "stored": 0.3, "approached": 0.05, "step": -0.01}
SETTINGS = TrainingSettings(algorithm="ippo", environments=32, epochs=4, discount=0.98)


class RobotsEnv:
    """Warehouses as trainings drive environments. `observation_size`: numbers a robot observes."""

    def __init__(self, num_envs: int, options: Options, threads: int = 0) -> None:
        self._warehouses = Warehouses(num_envs, options, threads)
        self._observer = Observer(self._warehouses)
        self._random = np.random.default_rng()
        self.num_envs, self.agents = num_envs, self._warehouses.robots
        self.max_steps, self.observation_size = options.max_cycles, self._observer.size

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begins episodes in all, or in those of options["reset_mask"].

        Their seeds are drawn from a stream, which a seed begins. Returns observations and infos.
        """
        if seed is not None:
            self._random = np.random.default_rng(seed)
        self._begin((options or {}).get("reset_mask", np.ones(self.num_envs, bool)))
        return self._observer.observations(), {"action_mask": self._warehouses.masks()}

    def step(
        self, actions: ArrayLike
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Makes one decision of every robot.

        Returns observations, rewards, which episodes ended (what ended begins again), zeros, and
        infos: "action_mask", "delivered", and where an episode ended "final_obs".
        """
        rewards, happened = self._warehouses.step(actions)
        observations = self._observer.observations()
        infos: dict[str, Any] = {"delivered": happened["delivered"]}
        ends = self._warehouses.cycle >= self.max_steps
        if ends.any():
            infos["final_obs"] = observations
            self._begin(ends)
            observations = self._observer.observations()
        infos["action_mask"] = self._warehouses.masks()
        return observations, rewards, ends, np.zeros(self.num_envs, bool), infos

    def _begin(self, mask: np.ndarray) -> None:
        which = np.flatnonzero(mask)
        self._warehouses.reset(which, self._random.integers(2**62, size=len(which)).tolist())


def train(
    options: Options,
    decisions: int,
    seed: int = 0,
    settings: TrainingSettings = SETTINGS,
    threads: int = 0,
    report: Callable[[tuple[int, float]], object] = lambda _: None,
) -> tuple[Callable[[np.ndarray, np.ndarray], np.ndarray], np.ndarray]:
    """Trains for a number of decisions, those of all robots together.

    The settings' steps are replaced. `threads` step the worlds; 0: as many as there are cores.
    Returns a policy as baselines.measure takes it, and the curve, rows (decisions so far, units
    delivered an episode). report(row) is called for each.
    """
    envs = RobotsEnv(settings.environments, options, threads)
    update = settings.rollout * settings.environments
    steps = update * max(1, decisions // (update * envs.agents))
    settings = replace(settings, steps=steps)
    training = Training(envs, Unchanged(envs.observation_size), settings, seed)
    curve: list[tuple[int, float]] = []

    def take(now: Training) -> None:
        for done, delivered in now.curve[len(curve) :]:
            curve.append((done * envs.agents, delivered))
            report(curve[-1])

    training.run(report=take, report_every=0)
    policy, random = Policy(training.actor, training.encoder), np.random.default_rng(seed)
    act = lambda observations, masks: policy.act(observations, random, masks > 0)  # noqa: E731
    return act, np.array(curve).reshape(-1, 2)


def main() -> None:
    """Trains with several seeds, and prints and draws the curves."""
    parser = argparse.ArgumentParser(
        "python3 -m warehouse_learning.marl.robots", description=__doc__
    )
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
    jobs = [(options, args.decisions, seed, args.jobs) for seed in range(args.seeds)]
    if args.jobs == 1:
        curves = [_trained(job) for job in jobs]
    else:
        with multiprocessing.get_context("spawn").Pool(args.jobs) as pool:
            curves = pool.map(_trained, jobs, chunksize=1)
    if args.out:
        from warehouse_learning.curves import draw

        draw(args.out, options, curves)


def _trained(job: tuple[Options, int, int, int]) -> np.ndarray:
    """Returns the curve of a training, whose rows are printed as they come."""
    options, decisions, seed, jobs = job
    begin = time.process_time()

    def report(row: tuple[int, float]) -> None:
        print(f"seed {seed}: {row[0]:9,.0f} decisions {row[1]:6.2f} units an episode", flush=True)

    _, curve = train(options, decisions, seed, threads=0 if jobs == 1 else 1, report=report)
    print(f"seed {seed}: {time.process_time() - begin:.0f} s of CPU", flush=True)
    return curve


if __name__ == "__main__":
    main()
