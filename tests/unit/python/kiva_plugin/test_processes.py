# SPDX-License-Identifier: Apache-2.0
"""The same world and commands give the same states in any process, wherever memory lies."""

import os
import subprocess
import sys

from paths import ROOT

SCRIPT = """
import sys
import numpy as np
from kiva_plugin_cpp import World

ballast = [bytearray(n) for n in range(0, int(sys.argv[1]), 97)]
world = World.preset("small", seed=3, threads=int(sys.argv[2]))
world.spawn(open(sys.argv[3]).read(), "rover", (2.5, 2.5, 0.3, 0.4))
ball = (
    "<sdf version='1.9'><model name='ball'><link name='l'><collision name='c'><geometry>"
    "<sphere><radius>0.1</radius></sphere></geometry></collision></link></model></sdf>"
)
for i in range(20):
    world.spawn(ball, f"ball{i}", (3 + 0.05 * i, 3, 0.5 + 0.3 * i, 0))
for i in range(8):
    world.movx(world.fleet.kiva_id, 1 if i % 2 else -1)
    world.step(500)
    print(world.state_hash())
"""


def hashes(ballast, threads, **environment):
    rover = ROOT / "tests/worlds/robots/platform.urdf"
    run = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(ballast), str(threads), str(rover)],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=300,
        check=True,
    )
    return run.stdout.split()


def test_states_do_not_depend_on_the_process():
    first = hashes(0, 1, PYTHONHASHSEED="0")
    assert len(set(first)) == 8
    assert hashes(100_000, 2, PYTHONHASHSEED="7", MALLOC_PERTURB_="165") == first
