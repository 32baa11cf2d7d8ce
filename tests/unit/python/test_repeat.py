# SPDX-License-Identifier: Apache-2.0
"""The same world, seed and commands at the same steps: the same states, bit by bit."""

import numpy as np

from kiva_plugin_cpp import COMMAND, EventKind, Kind, World

ROBOTS = 100
MINUTES = 10


def commands(random, world):
    """A random command for each robot; many are refused, and some drive robots together."""
    out = np.zeros(ROBOTS, COMMAND)
    out["kiva_id"] = world.fleet.kiva_id
    out["kind"] = random.choice(list(Kind), ROBOTS, p=[0.3, 0.2, 0.2, 0.1, 0.2])
    to_place = out["kind"] == Kind.MOVE_TO
    low_x, high_x, low_y, high_y = world.floor
    out["x"] = np.where(
        to_place,
        random.integers(int(low_x), int(high_x), ROBOTS),
        random.integers(-3, 4, ROBOTS),
    )
    out["y"] = np.where(
        to_place,
        random.integers(int(low_y), int(high_y), ROBOTS),
        random.integers(-3, 4, ROBOTS),
    )
    out["direction"] = random.choice([-1, 1], ROBOTS)
    out["lift"] = random.integers(0, 2, ROBOTS)
    # Whatever unit is nearest: the robot may well stand beneath it.
    units = world.storage_units
    dx = world.fleet.x[:, None] - units["x"]
    dy = world.fleet.y[:, None] - units["y"]
    out["shelf_id"] = units["shelf_id"][np.hypot(dx, dy).argmin(axis=1)]
    return out


def hashes(minutes):
    """Of every second, and how many events of each kind there were."""
    world, random = World.preset("large", seed=7), np.random.default_rng(7)
    out, counts = [], np.zeros(len(EventKind), int)
    for second in range(minutes * 60):
        if second % 2 == 0:
            world.post(commands(random, world))
        world.step(1000)
        out.append(world.state_hash())
        counts += np.bincount(world.events()["kind"], minlength=len(EventKind))
    return out, counts


def test_ten_minutes_of_a_hundred_robots_are_the_same_twice():
    first, counts = hashes(MINUTES)
    for kind in (EventKind.DONE, EventKind.BLOCKED, EventKind.LIFTED, EventKind.COLLISION):
        assert counts[kind] > 10, kind
    assert len(set(first)) == MINUTES * 60
    assert hashes(MINUTES)[0] == first
