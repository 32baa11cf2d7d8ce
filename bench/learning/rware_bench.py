#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Agent steps a second of RWARE as built in, beside the package itself, in turns of a second:
scripts/learning_packages; . devel/setup.bash; .venv/bin/python bench/learning/rware_bench.py

    [--worlds 64] [--seconds 5] [--json] [TASK ...]

A TASK is one that rware registers, without rware- and -v2. Both get the same random actions, drawn
before the clock starts. The same task where actions take time is `ideal` and, with robots of the
physics, `bodies`, on one thread. By CPU tells how many times the steps of one core are. Beside it
stands what is asked for and whether that is met; if any is not, it ends with 1.
"""

import argparse
import itertools
import json
import os

import gymnasium
import numpy as np
import rware
from learning_bench import Runner

import warehouse_learning.rware

REGISTERED = rware, warehouse_learning.rware  # importing them does that
TASKS = ("tiny-2ag", "tiny-4ag", "small-4ag", "medium-10ag")
DRAWN = 4096  # steps, again and again
LIMITS = {"alone": 30, "many": 150}  # times the package's agent steps, by CPU


def alone(name):
    """A Runner of one environment, which begins again when it ends."""
    env = gymnasium.make(name, disable_env_checker=True).unwrapped
    env.reset(seed=1)
    actions = itertools.cycle(drawn(env.n_agents).tolist())

    def step():
        if env.step(next(actions))[2]:
            env.reset()

    return Runner(step, env.n_agents)


def many(name, worlds, threads, physics="grid"):
    """A Runner of the vector environment."""
    envs = gymnasium.make_vec(name, num_envs=worlds, threads=threads, physics=physics)
    envs.reset(seed=1)
    agents = envs.single_action_space.shape[0]
    actions = itertools.cycle(drawn(worlds, agents, steps=64))
    return Runner(lambda: envs.step(next(actions)), worlds * agents)


def drawn(*shape, steps=DRAWN):
    return np.random.default_rng(1).integers(0, 5, (steps, *shape), np.int8)


def tell_text(task, runners):
    """Prints a line a case; returns whether all limits are met."""
    wall, cpu = runners["the package"].rates
    is_met = True
    for name, runner in runners.items():
        rates = runner.rates
        text = f"{task}, {name}: {rates[0]:,.0f} agent steps/s, {rates[0] / wall:.0f} x"
        times = rates[1] / cpu
        limit = LIMITS.get(name, LIMITS["many"] if " on " in name else 0)
        note = f" (asked {limit}: {'met' if times >= limit else 'not met'})" if limit else ""
        is_met &= times >= limit
        print(f"{text}; by CPU {rates[1]:,.0f}, {times:.0f} x{note}", flush=True)
    return is_met


def tell_json(task, runners):
    """Prints an object a case: agent steps a second of CPU, `times` those of the package."""
    package = runners["the package"].rates[1]
    for name, runner in runners.items():
        rate = runner.rates[1]
        row = {"task": task, "case": name, "steps_cpu": rate, "times": rate / package}
        print(json.dumps(row), flush=True)
    return True


def main():
    parser = argparse.ArgumentParser("rware_bench", description=__doc__)
    parser.add_argument("tasks", nargs="*", default=TASKS, metavar="TASK")
    parser.add_argument("--worlds", type=int, default=64)
    parser.add_argument("--seconds", type=int, default=5, help="of each case")
    parser.add_argument("--json", action="store_true", help="a line of JSON a case, for bench/run")
    options = parser.parse_args()
    if not options.json:
        print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    is_met = True
    for task in options.tasks:
        ours = f"kiva-rware-{task}-v2"
        runners = {
            "the package": alone(f"rware-{task}-v2"),
            "alone": alone(ours),
            f"{options.worlds} on one thread": many(ours, options.worlds, 1),
            f"{options.worlds} on all": many(ours, options.worlds, 0),
            "ideal": many(ours, options.worlds, 1, "ideal"),
            "bodies": many(ours, options.worlds, 1, "bodies"),
        }
        for _ in range(options.seconds):
            for runner in runners.values():
                runner.run(1.0)
        tell = tell_json if options.json else tell_text
        is_met &= tell(task, runners)
    raise SystemExit(not (is_met or options.json))


if __name__ == "__main__":
    main()
