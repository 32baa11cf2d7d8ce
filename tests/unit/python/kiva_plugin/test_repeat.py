# SPDX-License-Identifier: Apache-2.0
"""The same world, seed and commands at the same steps: the same states, bit by bit."""

import numpy as np

from kiva_plugin_cpp import COMMAND, EventKind, Kind, World

SIDE = 10  # robots along x and y
SPACING = 3  # [m]
MINUTES = 10
PAUSE = 4  # [s] between commands


def hall():
    """A hundred robots, far enough apart that they meet now and then; ten stand beneath a unit."""
    world = World(seed=7)
    for i in range(SIDE * SIDE):
        x, y = SPACING * (i % SIDE - SIDE / 2), SPACING * (i // SIDE - SIDE / 2)
        world.spawn_model("kiva", f"kiva{i + 1}", x, y)
        if i % (SIDE + 1) == 0:
            world.spawn_model("storage_unit", f"storage_unit{i // (SIDE + 1) + 1}", x, y)
    world.events()
    return world


def commands(random):
    """A random command for each robot; those that can't be are refused."""
    out = np.zeros(SIDE * SIDE, COMMAND)
    out["kiva_id"] = np.arange(len(out)) + 1
    kinds = [Kind.MOVE_X, Kind.MOVE_Y, Kind.ROTATE, Kind.LIFT]
    out["kind"] = random.choice(kinds, len(out), p=[0.4, 0.4, 0.1, 0.1])
    out["x"] = out["y"] = random.integers(-2, 3, len(out))
    out["direction"] = random.choice([-1, 1], len(out))
    out["lift"] = random.integers(0, 2, len(out))
    out["shelf_id"] = (out["kiva_id"] - 1) // (SIDE + 1) + 1  # the one it began beneath
    return out


def hashes():
    """Returns the hash of every second, and the count of events of each kind."""
    world, random = hall(), np.random.default_rng(7)
    out, counts = [], np.zeros(len(EventKind), int)
    for second in range(MINUTES * 60):
        if second % PAUSE == 0:
            world.post(commands(random))
        world.step(1000)
        out.append(world.state_hash())
        counts += np.bincount(world.events()["kind"], minlength=len(EventKind))
    return out, counts


def test_ten_minutes_of_a_hundred_robots_are_the_same_twice():
    first, counts = hashes()
    for kind in (EventKind.DONE, EventKind.BLOCKED, EventKind.LIFTED, EventKind.DROPPED):
        assert counts[kind] > 0, kind
    assert len(set(first)) == MINUTES * 60
    assert hashes()[0] == first
