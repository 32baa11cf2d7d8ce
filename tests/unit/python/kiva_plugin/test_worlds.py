# SPDX-License-Identifier: Apache-2.0
"""Many worlds stepped at once are each what it would be alone."""

import multiprocessing
import os
import threading

import numpy as np
import pytest

from kiva_plugin_cpp import COMMAND, EventKind, Kind, World, Worlds

SEEDS = (1, 2, 3)


def turns(count):
    rows = np.zeros(count, COMMAND)
    rows["kind"], rows["kiva_id"], rows["direction"] = Kind.ROTATE, 1, 1
    return rows


def test_each_goes_its_own_way_as_it_would_alone():
    worlds = Worlds(len(SEEDS), "small", seed=SEEDS[0], threads=2)
    worlds.post([0, 2], turns(2))
    worlds.step(800)
    alone = [World.preset("small", seed=seed) for seed in SEEDS]
    for world in (alone[0], alone[2]):
        world.rot(1, 1)
    for world in alone:
        world.step(800)
    assert worlds.state_hash().tolist() == [world.state_hash() for world in alone]
    np.testing.assert_array_equal(worlds.x, [world.fleet.x for world in alone])
    np.testing.assert_array_equal(worlds.yaw, [world.fleet.yaw for world in alone])
    done = worlds.counts[:, 0, EventKind.DONE]
    assert done.tolist() == [1, 0, 1]


def test_arrays_are_views_that_follow():
    worlds = Worlds(2, "small")
    yaw = worlds.yaw
    before = yaw.copy()
    worlds.post(1, turns(1))
    worlds.step(800)
    assert yaw[1, 0] - before[1, 0] == pytest.approx(np.pi / 2)
    assert (yaw[0] == before[0]).all()
    with pytest.raises(ValueError, match="read-only"):
        yaw[0, 0] = 0


def test_until_idle_ends_each_world_when_its_robots_have_ended():
    worlds = Worlds(2, "small")
    worlds.post(1, turns(1))
    made = worlds.step(5000, until_idle=True)
    assert made[0] == 1
    assert 600 < made[1] < 700
    assert worlds.status.max() == 0


def test_restored_worlds_are_those_that_were_saved():
    worlds = Worlds(2, "small")
    saved = [worlds[i].checkpoint() for i in range(2)]
    before = worlds.state_hash()
    worlds.post([0, 1], turns(2))
    worlds.step(300)
    assert (worlds.state_hash() != before).all()
    worlds.restore([0, 1], saved)
    assert (worlds.state_hash() == before).all()
    np.testing.assert_array_equal(worlds.yaw[0], worlds[0].fleet.yaw)


def test_wheels_that_are_driven_turn_the_robot_and_a_command_takes_over():
    worlds = Worlds(1, "small")
    worlds.place([0], [1], [0.0], [0.0], [0.0])
    speeds = np.zeros((1, 4))
    left, right = speeds.copy(), speeds.copy()
    left[0, 0] = right[0, 0] = 5.0
    assert worlds.drive(left, right).all()
    worlds.step(1000)
    assert worlds.vx[0, 0] == pytest.approx(0.5, rel=0.01)
    assert worlds.x[0, 0] == pytest.approx(0.5, rel=0.1)
    worlds.drive(speeds, speeds)
    worlds.step(500)
    assert worlds.vx[0, 0] == 0
    worlds.post(0, turns(1))
    worlds.step(1)
    assert not worlds.drive(left, right)[0, 0]


def test_wrong_arguments_are_reported():
    worlds = Worlds(2, "small")
    with pytest.raises(IndexError, match="world is 2"):
        worlds.post(2, turns(1))
    with pytest.raises(ValueError, match="there is no robot kiva99"):
        rows = turns(2)
        rows["kiva_id"][1] = 99
        worlds.post([0, 1], rows)
    with pytest.raises(ValueError, match="world has 2 entries and commands has 3"):
        worlds.post([0, 1], turns(3))
    with pytest.raises(ValueError, match="world 1 has 3 robots"):
        Worlds.of([World.preset("small"), World.create(robots=3, shelves=12)])
    with pytest.raises(ValueError, match="robot 1 in world 0 is not a finite"):
        worlds.drive(np.array([[0, np.nan, 0, 0]] * 2), np.zeros((2, 4)))
    with pytest.raises(ValueError, match="checkpoint"):
        worlds.restore(0, b"nonsense")
    worlds.step(1)
    assert worlds.counts.sum() == 0


def test_other_threads_run_meanwhile_and_may_not_use_the_worlds():
    worlds = Worlds(2, "medium")
    refusals = []

    def look():
        # Without the GIL held by step(), this thread comes to run while it is under way.
        while not refusals:
            try:
                worlds.step(1)
            except RuntimeError as error:
                refusals.append(str(error))

    thread = threading.Thread(target=look)
    thread.start()
    while thread.is_alive():
        try:
            worlds.step(200)
        except RuntimeError as error:
            refusals.append(str(error))
    thread.join()
    assert "in use by another thread" in refusals[0]


def _child(queue, worlds):
    worlds.step(5)
    queue.put(int(worlds[0].steps))


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
def test_a_forked_child_steps_them_too():
    worlds = Worlds(2, "small", threads=2)
    worlds.step(5)
    context = multiprocessing.get_context("fork")
    queue = context.Queue()
    child = context.Process(target=_child, args=(queue, worlds))
    child.start()
    assert queue.get(timeout=60) == 10
    child.join()
