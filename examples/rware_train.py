#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Trains robots in RWARE's task, several seeds: IPPO or MAPPO, numpy alone, on one core each.

examples/rware_train.py tiny-4ag                                # MAPPO, 20 million steps, seed 0
examples/rware_train.py small-4ag --algorithm ippo --seeds 5 --out results
examples/rware_train.py tiny-2ag --minutes 10                   # a part; the same command goes on
examples/rware_train.py tiny-4ag --imitate 20000                # from the planner's example

Each seed writes OUT/TASK-ALGORITHM-SEED.npz, a policy that warehouse_learning.watch shows, a
.checkpoint.npz, from which the same command goes on, and .json, its learning curve.
examples/rware_results.py draws the curves and measures the policies.
"""

import argparse
import json
from dataclasses import replace
from pathlib import Path

import gymnasium
from gymnasium.vector import AutoresetMode

import warehouse_learning.rware  # noqa: F401  registers the tasks
from warehouse_learning.marl.training import ALGORITHMS, Settings, Training


def main():
    wanted = arguments()
    out = Path(wanted.out)
    out.mkdir(parents=True, exist_ok=True)
    settings = Settings(algorithm=wanted.algorithm, steps=wanted.steps)
    if wanted.imitate:
        # Gently: what was imitated is soon unlearnt.
        gentle = {"imitation": wanted.imitate, "warm_up": 30, "rate": 7e-4, "entropy": 0.003}
        settings = replace(settings, **gentle)
    for seed in range(wanted.first_seed, wanted.first_seed + wanted.seeds):
        train(wanted.task, settings, seed, out, wanted.minutes)


def arguments():
    parser = argparse.ArgumentParser(
        "rware_train", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("task", help="as RWARE registers it, without rware- and -v2: tiny-4ag")
    parser.add_argument("--algorithm", choices=ALGORITHMS, default="mappo")
    parser.add_argument(
        "--steps", type=int, default=Settings.steps, help="of all environments (%(default)s)"
    )
    parser.add_argument(
        "--imitate",
        type=int,
        default=0,
        metavar="STEPS",
        help="begin by imitating the fleet's planner (DAgger) in so many steps; 20000 will do",
    )
    parser.add_argument("--seeds", type=int, default=1, help="how many (1)")
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument(
        "--minutes", type=float, default=float("inf"), help="after which a seed stops for now"
    )
    parser.add_argument("--out", default="results", help="folder (results)")
    return parser.parse_args()


def train(task, settings, seed, out, minutes):
    """One seed, from its checkpoint if there is one."""
    envs = gymnasium.make_vec(
        f"kiva-rware-{task}-v2",
        num_envs=settings.environments,
        threads=1,
        autoreset_mode=AutoresetMode.SAME_STEP,
    )
    about = {"task": task}
    training = Training(envs, settings, seed, about)
    name = f"{task}-{settings.algorithm}-{seed}"
    checkpoint = out / f"{name}.checkpoint.npz"
    if checkpoint.is_file():
        training.restore(checkpoint)
    saved = [0.0]

    def keep():
        training.save(checkpoint)
        training.policy.save(out / f"{name}.npz")
        record = training.policy.about | {"curve": training.curve}
        (out / f"{name}.json").write_text(json.dumps(record))

    def report(now):
        last = now.curve[-1][1] if now.curve else 0
        rate = now.done / now.seconds
        print(f"{name}: {now.done:,} steps, return {last:.1f}; {rate:,.0f} a second", flush=True)
        if now.seconds > saved[0] + 60:
            saved[0] = now.seconds
            keep()

    try:
        training.run(minutes, report)
    except KeyboardInterrupt:
        print(f"{name}: stopped; the same command goes on from {checkpoint}")
        raise SystemExit(130) from None
    finally:
        keep()


if __name__ == "__main__":
    main()
