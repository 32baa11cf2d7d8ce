#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""RWARE's task in PufferLib's vectoriser, each robot a row: pip install pufferlib-core psutil

examples/puffer_vector.py [TASK] [STEPS]     tiny-4ag, 2,000 steps of 16 environments

Beside it the same in gymnasium.make_vec, which steps all in one call.
"""

import sys
import time

import gymnasium
import numpy as np
import pufferlib.emulation
import pufferlib.vector

import warehouse_learning.rware

ENVIRONMENTS = 16


def main():
    task = sys.argv[1] if len(sys.argv) > 1 else "tiny-4ag"
    steps = int(sys.argv[2]) if len(sys.argv) > 2 else 2000

    def make(buf=None, seed=0, **_):
        return pufferlib.emulation.PettingZooPufferEnv(
            env_creator=warehouse_learning.rware.parallel_env,
            env_args=[f"rware-{task}-v2"],
            buf=buf,
            seed=seed,
        )

    puffer = pufferlib.vector.make(
        make, num_envs=ENVIRONMENTS, backend=pufferlib.vector.Serial, seed=1
    )
    puffer.reset(seed=1)
    report("PufferLib", puffer.step, (puffer.num_agents,), steps)
    envs = gymnasium.make_vec(f"kiva-rware-{task}-v2", num_envs=ENVIRONMENTS)
    envs.reset(seed=1)
    report("make_vec", envs.step, envs.action_space.shape, steps)


def report(name, step, shape, steps):
    """Prints how many agent steps a second of CPU there are, by actions that chance takes."""
    random, rewards, begin = np.random.default_rng(1), 0.0, time.process_time()
    for _ in range(steps):
        rewards += np.sum(step(random.integers(5, size=shape))[1])
    rate = steps * np.prod(shape) / (time.process_time() - begin)
    print(f"{name}: {rate:,.0f} agent steps a second of CPU; rewards {rewards:g}")


if __name__ == "__main__":
    main()
