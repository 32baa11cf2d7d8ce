#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Agent steps a second with physics, beside RWARE where it is installed, in one run.

    bench/learning_bench.py [--worlds 64] [--robots 10] [--seconds 10]

An agent step is one decision of one robot, its observation and mask included. `tick` lets a
decision last 2/3 s, the time of a cell at top speed; `action` lasts until every robot has ended
what it does; without acceleration (0) a tick is a whole cell, as RWARE's step is.
"""

import argparse
import os
import time

import numpy as np

from kiva_plugin_cpp import Worlds
from warehouse_learning.observing import Observer
from warehouse_learning.options import Options
from warehouse_learning.warehouses import Warehouses

TICK = 2 / 3  # [s]
CASES = {
    "tick": {"decision": TICK},
    "tick, no acceleration": {"decision": TICK, "acceleration": 0.0},
    "action": {},
}


def measure(worlds, robots, seconds, threads=0, **options):
    """(agent steps a second, milliseconds of physics a decision) by wall clock, and by CPU."""
    warehouses = Warehouses(
        worlds, Options.of({"robots": robots, "shelves": 4 * robots} | options), threads
    )
    observer = Observer(warehouses)
    random = np.random.default_rng(1)
    warehouses.reset(np.arange(worlds), range(worlds))
    masks, steps = warehouses.masks(), 0
    begin, cpu = time.perf_counter(), time.process_time()
    while time.perf_counter() < begin + seconds:
        warehouses.step((masks * random.random(masks.shape, np.float32)).argmax(-1))
        observer.observations()
        masks = warehouses.masks()
        steps += worlds * robots
    return steps / (time.perf_counter() - begin), steps / (time.process_time() - cpu)


def rware(robots, seconds):
    """Agent steps a second of RWARE's own environment of its `tiny` floor; None without it."""
    try:
        from rware.warehouse import RewardType, Warehouse
    except ImportError:
        return None
    env = Warehouse(3, 8, 1, robots, 0, 1, robots, None, 10**9, RewardType.INDIVIDUAL)
    env.reset(seed=1)
    steps, begin = 0, time.perf_counter()
    while time.perf_counter() < begin + seconds:
        env.step(env.action_space.sample())
        steps += robots
    return steps / (time.perf_counter() - begin)


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
        print(f"RWARE, {wanted.robots} robots, no physics: {theirs:,.0f} agent steps/s")
    for name, options in CASES.items():
        wall, cpu = measure(wanted.worlds, wanted.robots, wanted.seconds, **options)
        ratio = f", {wall / theirs:.1f} x RWARE" if theirs else ""
        print(f"{name}: {wall:,.0f} agent steps/s{ratio}; {cpu:,.0f} a second of CPU")


if __name__ == "__main__":
    main()
