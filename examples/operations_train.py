#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Learns to dispatch a shift, in KivaOperations-v0: first to score candidates as the default policy
takes them, then better, by the cross-entropy method (Rubinstein, 1999), which asks for nothing but
what a shift comes to.

examples/operations_train.py --decides orders --size medium --robots 8 --out orders.npz

Then in a policy file, of simulate or a running warehouse:

    orders: {name: learned, file: orders.npz}

In the end it is measured beside the default policy, on shifts that it was not trained on.
"""

import argparse
import time

import numpy as np

from warehouse_fleet.planners.scorer import linear
from warehouse_learning.operations_env import KivaOperationsEnv, run_shift, usual
from warehouse_operations.policies.decisions import FEATURES, SHORTLIST
from warehouse_operations.policies.learned import best_of

ELITE = 0.25  # of a generation, from which the next is drawn
WIDTH = 0.5  # of the first generation, as a share of the weights
IMITATION, RATE = 3000, 0.5  # steps of the regression
HELD_OUT = 10_000  # first seed of the shifts that results are measured on


def main():
    settings = arguments()
    options = {"size": settings.size, "robots": settings.robots, "minutes": settings.minutes}
    env = KivaOperationsEnv(decides=(settings.decides,), **options)
    try:
        weights = trained(env, settings, imitated(env, settings.imitated))
        print(
            f"{settings.out} is written; {settings.tests} shifts it was not trained on:", flush=True
        )
        compare(env, weights, settings.tests)
    except KeyboardInterrupt:
        raise SystemExit(130) from None
    finally:
        env.close()


def arguments():
    parser = argparse.ArgumentParser(
        "operations_train",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--decides", choices=("orders", "units", "robots"), default="orders")
    parser.add_argument("--size", default="medium")
    parser.add_argument("--robots", type=int, default=0, help="0: as many as the size has")
    parser.add_argument("--minutes", type=float, default=10, help="of a shift (10)")
    parser.add_argument("--imitated", type=int, default=4, help="shifts of the default policy (4)")
    parser.add_argument("--generations", type=int, default=12)
    parser.add_argument("--population", type=int, default=16)
    parser.add_argument("--shifts", type=int, default=2, help="that each is tried on (2)")
    parser.add_argument("--tests", type=int, default=10, help="shifts of the comparison (10)")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", default="learned.npz")
    return parser.parse_args()


def imitated(env, shifts):
    """(FEATURES,) weights that make the default policy's choices likely: logistic regression."""
    rows, chosen = [], []

    def watch(decision):
        padded = np.full((SHORTLIST, FEATURES), np.nan)
        padded[: len(decision.keys)] = decision.rows
        rows.append(padded)
        chosen.append(decision.usual)
        return decision.usual

    returns(env, watch, range(HELD_OUT - shifts, HELD_OUT))
    there = ~np.isnan(np.array(rows)[..., :1])
    x, picked = np.nan_to_num(np.array(rows)), np.array(chosen)
    weights = np.zeros(FEATURES)
    for _ in range(IMITATION):
        chances = np.exp(np.clip(x @ weights, -30, 30)) * there[..., 0]
        chances /= chances.sum(1, keepdims=True)
        likely = (x * chances[..., None]).sum(1)
        weights += RATE * (x[np.arange(len(x)), picked] - likely).mean(0)
    agrees = np.where(there[..., 0], x @ weights, -np.inf).argmax(1) == picked
    print(f"after {len(x)} decisions {agrees.mean():.0%} are the default policy's", flush=True)
    return weights


def trained(env, settings, mean):
    """(FEATURES,) weights: the mean of the last generation, which is kept in the file."""
    random = np.random.default_rng(settings.seed)
    deviation = WIDTH * (np.abs(mean) + 1)
    save(mean, settings)
    for generation in range(settings.generations):
        begin = time.process_time()
        seeds = random.integers(HELD_OUT, size=settings.shifts).tolist()
        drawn = mean + deviation * random.standard_normal((settings.population, FEATURES))
        drawn[0] = mean
        pieces = [np.mean(returns(env, best_of(linear(weights)), seeds)) for weights in drawn]
        best = drawn[np.argsort(pieces)[::-1][: round(ELITE * settings.population)]]
        mean = best.mean(0)
        # Some of the old width stays, or it narrows before it has found the way.
        deviation = 0.7 * best.std(0) + 0.3 * deviation
        save(mean, settings)
        print(
            f"generation {generation}: {np.mean(pieces):.1f} pieces a shift, best"
            f" {max(pieces):.1f}; {time.process_time() - begin:.0f} s of CPU",
            flush=True,
        )
    return mean


def save(weights, settings):
    linear(weights).save(settings.out, settings.decides, about=repr(vars(settings)))


def returns(env, choose, seeds):
    return [run_shift(env, choose, seed)["return"] for seed in seeds]


def compare(env, weights, count):
    """Prints pieces a shift of the default policy, of chance, and of what was learnt."""
    seeds = range(HELD_OUT, HELD_OUT + count)
    random = np.random.default_rng(0)
    policies = {
        "default": usual,
        "chance": lambda decision: int(random.integers(len(decision.keys))),
        "learnt": best_of(linear(weights)),
    }
    of = {name: np.array(returns(env, choose, seeds)) for name, choose in policies.items()}
    for name, pieces in of.items():
        gain = pieces - of["default"]
        error = gain.std(ddof=1) / np.sqrt(count) if count > 1 else 0.0
        print(
            f"{name:8} {pieces.mean():7.1f} pieces; {gain.mean():+.1f} ± {error:.1f} to the default"
        )


if __name__ == "__main__":
    main()
