#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Agent steps a second of the vector environment with physics, beside RWARE where it is installed,
in one run: .venv/bin/pip install rware; .venv/bin/python bench/learning_bench.py

    [--worlds 64] [--robots 10] [--seconds 10]

An agent step is one decision of one robot, its observation and mask included. `tick` lets a
decision last 2/3 s, the time of a cell at top speed; `action` lasts until every robot has ended
what it does; without acceleration a tick is a whole cell, as RWARE's step is. Actions are drawn
among all, as RWARE's are: what is not possible is a wait; `possible`: only among those that are.
"""

import argparse
import os
import time

import gymnasium
import numpy as np

import warehouse_learning  # noqa: F401  registers the environments
from kiva_plugin_cpp import Worlds

TICK = 2 / 3  # [s]
CASES = {
    "tick": {"decision": TICK},
    "tick, possible": {"decision": TICK},
    "tick, possible, no acceleration": {"decision": TICK, "acceleration": 0.0},
    "action, possible": {},
}


def measure(worlds, robots, seconds, among_possible, **options):
    """Agent steps a second, by wall clock and by CPU."""
    env = gymnasium.make_vec(
        "KivaRobots-v0",
        num_envs=worlds,
        robots=robots,
        shelves=4 * robots,
        max_cycles=10**9,
        **options,
    )
    random = np.random.default_rng(1)
    _, infos = env.reset(seed=1)
    steps = 0
    begin, cpu = time.perf_counter(), time.process_time()
    while time.perf_counter() < begin + seconds:
        if among_possible:
            mask = infos["action_mask"]
            actions = (mask * random.random(mask.shape, np.float32)).argmax(-1)
        else:
            actions = random.integers(5, size=(worlds, robots))
        _, _, _, _, infos = env.step(actions)
        steps += worlds * robots
    rates = steps / (time.perf_counter() - begin), steps / (time.process_time() - cpu)
    env.close()
    return rates


def rware(robots, seconds):
    """The same of RWARE's own environment of its `tiny` floor; None without it."""
    try:
        from rware.warehouse import RewardType, Warehouse
    except ImportError:
        return None
    env = Warehouse(3, 8, 1, robots, 0, 1, robots, None, 10**9, RewardType.INDIVIDUAL)
    env.reset(seed=1)
    steps, begin, cpu = 0, time.perf_counter(), time.process_time()
    while time.perf_counter() < begin + seconds:
        env.step(env.action_space.sample())
        steps += robots
    return steps / (time.perf_counter() - begin), steps / (time.process_time() - cpu)


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
    wanted = parser.parse_args()
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    speed_up, overhead = many_worlds(wanted.seconds / 2)
    print(f"64 worlds of small: {speed_up:.2f} x one thread; {overhead:.3f} ms a call at rest")
    theirs = rware(wanted.robots, wanted.seconds)
    if theirs:
        wall, cpu = theirs
        text = f"{wall:,.0f} agent steps/s; {cpu:,.0f} a second of CPU"
        print(f"RWARE, {wanted.robots} robots, no physics: {text}")
    for name, options in CASES.items():
        among_possible = "possible" in name
        wall, cpu = measure(
            wanted.worlds, wanted.robots, wanted.seconds, among_possible, **options
        )
        text = f"{name}: {wall:,.0f} agent steps/s; {cpu:,.0f} a second of CPU"
        if theirs:
            text += f"; {wall / theirs[0]:.1f} x RWARE, by CPU {cpu / theirs[1]:.1f} x"
        print(text)


if __name__ == "__main__":
    main()
