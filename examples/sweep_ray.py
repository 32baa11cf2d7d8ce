#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Trains with several learning rates and seeds at once, by Ray Tune: pip install "ray[tune]"

examples/sweep_ray.py [decisions] [--address auto]

Workers need the wheel and nothing else.
"""

import argparse
from pathlib import Path

import ray
from ray import tune


def train(settings):
    """One trial: reports units delivered an episode as it learns, and what it delivers at last."""
    from dataclasses import replace

    from warehouse_learning import Options
    from warehouse_learning.baselines import measure
    from warehouse_learning.marl import robots

    options = Options.of({"size": "tiny", "max_cycles": 200, "rewards": robots.REWARDS})
    policy, _ = robots.train(
        options,
        settings["decisions"],
        settings["seed"],
        replace(robots.SETTINGS, rate=settings["rate"]),
        threads=1,
        report=lambda row: tune.report({"decisions": row[0], "delivered": row[1]}),
    )
    delivered, _ = measure(policy, options, episodes=8, seed=1000, threads=1)
    tune.report({"decisions": settings["decisions"], "delivered": float(delivered.mean())})


def main():
    parser = argparse.ArgumentParser("sweep_ray", description=__doc__)
    parser.add_argument("decisions", type=int, nargs="?", default=200_000)
    parser.add_argument("--address", help="of a cluster; none: this machine's cores")
    parser.add_argument("--rates", type=float, nargs="+", default=[3e-4, 1e-3, 3e-3])
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--storage", default="sweep", help="folder of what was tried (./sweep)")
    options = parser.parse_args()
    ray.init(address=options.address)
    tuner = tune.Tuner(
        tune.with_resources(train, {"cpu": 1}),
        param_space={
            "decisions": options.decisions,
            "rate": tune.grid_search(options.rates),
            "seed": tune.grid_search(list(range(options.seeds))),
        },
        tune_config=tune.TuneConfig(metric="delivered", mode="max"),
        run_config=tune.RunConfig(name="kiva", storage_path=str(Path(options.storage).resolve())),
    )
    results = tuner.fit()
    if results.errors:
        raise SystemExit(f"{len(results.errors)} trials failed: {results.errors[0]}")
    for result in results:
        settings, delivered = result.config, result.metrics["delivered"]
        print(
            f"rate {settings['rate']:g}, seed {settings['seed']}: {delivered:.2f} units an episode"
        )
    best = results.get_best_result().config
    print(f"best: rate {best['rate']:g}")
    ray.shutdown()


if __name__ == "__main__":
    main()
