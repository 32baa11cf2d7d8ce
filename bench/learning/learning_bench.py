#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Agent steps a second of the vector environment with physics, beside RWARE where it is installed,
in turns of a second: scripts/learning_packages; .venv/bin/python bench/learning/learning_bench.py

    [--worlds 64] [--robots 10] [--seconds 10]; or --resets

An agent step is one decision of one robot, its observation and mask included. `tick` lets a
decision last 2/3 s, the time of a cell at top speed; `action` lasts until every robot has ended
what it does; without acceleration a tick is a whole cell, as RWARE's step is. Actions are drawn
among all, as RWARE's are: what is not possible is a wait; `possible`: only among those that are.

RWARE runs on one core, as it comes, this on all: by CPU tells how many times the steps of one core
are, by wall clock those of this machine, if nothing else runs on it. Before that: how long resets
take, and what many worlds gain on all cores.
"""

import argparse
import json
import os
import time

import gymnasium
import numpy as np

import warehouse_learning
from kiva_plugin_cpp import Worlds

TICK = 2 / 3  # [s]
CASES = {
    "tick": {"decision": TICK},
    "tick, possible": {"decision": TICK},
    "tick, possible, no acceleration": {"decision": TICK, "acceleration": 0.0},
    "action, possible": {},
}


class Runner:
    """Steps something, and counts agent steps, seconds and seconds of CPU."""

    def __init__(self, step, agents):
        self._step, self._agents = step, agents
        self._steps = self._wall = self._cpu = 0

    def run(self, seconds):
        begin, cpu = time.perf_counter(), time.process_time()
        while time.perf_counter() < begin + seconds:
            self._step()
            self._steps += self._agents
        self._wall += time.perf_counter() - begin
        self._cpu += time.process_time() - cpu

    @property
    def rates(self):
        """Agent steps a second, by wall clock and by CPU."""
        return self._steps / self._wall, self._steps / self._cpu


def kiva(worlds, robots, among_possible, **options):
    """A Runner of the vector environment."""
    shelves = 4 * robots
    sizes = {"num_envs": worlds, "robots": robots, "shelves": shelves, "max_cycles": 10**9}
    env = gymnasium.make_vec("KivaRobots-v0", **sizes, **options)
    random = np.random.default_rng(1)
    infos = env.reset(seed=1)[1]

    def step():
        nonlocal infos
        if among_possible:
            mask = infos["action_mask"]
            actions = (mask * random.random(mask.shape, np.float32)).argmax(-1)
        else:
            actions = random.integers(5, size=(worlds, robots))
        infos = env.step(actions)[-1]

    return Runner(step, worlds * robots)


def rware(robots):
    """A Runner of RWARE's own environment of its `tiny` floor; None without it."""
    try:
        from rware.warehouse import RewardType, Warehouse
    except ImportError:
        return None
    env = Warehouse(3, 8, 1, robots, 0, 1, robots, None, 10**9, RewardType.INDIVIDUAL)
    env.reset(seed=1)
    return Runner(lambda: env.step(env.action_space.sample()), robots)


def reset_time(size, times=100):
    """CPU time of a reset after five decisions [ms], median."""
    env = gymnasium.make(f"KivaRobots-{size}-v0").unwrapped
    env.reset(seed=0)
    env.action_space.seed(0)
    taken = []
    for seed in range(times):
        for _ in range(5):
            env.step(env.action_space.sample())
        begin = time.process_time()
        env.reset(seed=seed)
        taken.append(time.process_time() - begin)
    return 1e3 * np.median(taken)


def many_worlds(seconds):
    """(speed-up of 64 worlds of `small` on all cores over one thread, overhead of a call [ms])."""
    rate = {}
    for threads in (1, 0):
        worlds = Worlds(64, "small", threads=threads)
        worlds.drive(np.full((64, 4), 1.0), np.full((64, 4), -1.0))  # all turn on the spot
        worlds.step(100)
        steps, begin = 0, time.perf_counter()
        while time.perf_counter() < begin + seconds:
            worlds.step(100)
            steps += 100
        rate[threads] = steps / (time.perf_counter() - begin)
    idle = Worlds(64, "small")
    begin = time.perf_counter()
    for _ in range(200):
        idle.step(1)
    return rate[0] / rate[1], (time.perf_counter() - begin) / 200 * 1e3


def main():
    parser = argparse.ArgumentParser("learning_bench", description=__doc__)
    parser.add_argument("--worlds", type=int, default=64)
    parser.add_argument("--robots", type=int, default=10)
    parser.add_argument("--seconds", type=float, default=10, help="of each case")
    parser.add_argument(
        "--resets", action="store_true", help="a line of JSON a size, for bench/run"
    )
    asked = parser.parse_args()
    if asked.resets:
        for size in warehouse_learning.SIZES:
            print(json.dumps({"size": size, "ms_cpu": reset_time(size)}), flush=True)
        return
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    speed_up, overhead = many_worlds(asked.seconds / 2)
    print(f"64 worlds of small: {speed_up:.2f} x one thread; {overhead:.3f} ms a call at rest")
    for size in warehouse_learning.SIZES:
        print(f"a reset of {size}: {reset_time(size):.2f} ms of CPU")
    runners = {
        name: kiva(asked.worlds, asked.robots, "possible" in name, **options)
        for name, options in CASES.items()
    }
    theirs = rware(asked.robots)
    if theirs:
        runners = {f"RWARE, {asked.robots} robots, no physics": theirs} | runners
    for _ in range(max(1, round(asked.seconds))):
        for runner in runners.values():
            runner.run(1.0)
    for name, runner in runners.items():
        wall, cpu = runner.rates
        text = f"{name}: {wall:,.0f} agent steps/s; {cpu:,.0f} a second of CPU"
        if theirs and runner is not theirs:
            times = wall / theirs.rates[0], cpu / theirs.rates[1]
            text += f"; {times[0]:.1f} x RWARE, by CPU {times[1]:.1f} x"
        print(text)


if __name__ == "__main__":
    main()
