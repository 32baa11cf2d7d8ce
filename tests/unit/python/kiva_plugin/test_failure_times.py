# SPDX-License-Identifier: Apache-2.0
"""Gaps between failures and times of repair are distributed as doc/explanation/realism.md says."""

import numpy as np
import pytest
from scipy import stats

from kiva_plugin_cpp import EventKind, World

ROBOTS, SECONDS, REPAIR = 40, 8000, 0.2
GAP = 1.0  # mean of the fleet's [s]; a robot seldom has the same failure twice at a time


@pytest.fixture(scope="module")
def recorded():
    """Returns all events of a fleet that stands, while things break and are mended."""
    settings = {"per_robot_hour": 3600 / GAP / ROBOTS, "repair_time": REPAIR}
    world = World(seed=5, realism={"failures": settings})
    for i in range(ROBOTS):
        world.spawn_model("kiva", f"kiva{i + 1}", 2 * (i % 8), 2 * (i // 8))
    begin, events = world.time, []
    while world.time < begin + SECONDS:
        world.step(1000)
        events.append(world.events().copy())
    return np.concatenate(events), begin


def test_gaps_are_exponential_in_hours_of_all_robots(recorded):
    events, begin = recorded
    stamps = events["time"][events["kind"] == EventKind.FAILED]
    gaps = np.diff(stamps, prepend=begin)
    assert stats.kstest(gaps, "expon", args=(0, GAP)).pvalue > 0.01
    assert gaps.mean() == pytest.approx(GAP, rel=3 / np.sqrt(len(gaps)))


def test_repairs_take_exponential_times(recorded):
    events, _ = recorded
    since, took = {}, []
    for event in events:
        if event["kind"] == EventKind.FAILED:
            since[event["model"]] = event["time"]
        elif event["kind"] == EventKind.REPAIRED and event["model"] in since:
            took.append(event["time"] - since.pop(event["model"]))
    # Those that are not over at the end are left out: a handful of REPAIR in SECONDS.
    assert stats.kstest(took, "expon", args=(0, REPAIR)).pvalue > 0.01
    assert np.mean(took) == pytest.approx(REPAIR, rel=3 / np.sqrt(len(took)))


def failures_after(checkpoint, number):
    """Returns when robots failed in a minute after a checkpoint, with failures of that number."""
    world = World()
    world.restore(checkpoint)
    world.draw_failures_anew(number)
    world.step(60_000)
    events = world.events()
    return events["time"][events["kind"] == EventKind.FAILED].tolist()


def test_worlds_of_a_checkpoint_fail_differently_by_number():
    world = World(realism={"failures": {"per_robot_hour": 3600 / GAP, "repair_time": REPAIR}})
    world.spawn_model("kiva", "kiva1", 0, 0)
    world.step(5000)
    world.events()
    saved = world.checkpoint()
    world.step(60_000)
    events = world.events()
    went_on = events["time"][events["kind"] == EventKind.FAILED].tolist()
    same, first, again, second = (failures_after(saved, number) for number in (0, 1, 1, 2))
    assert same == went_on and len(same) > 20
    assert first == again and len(first) > 20
    assert not set(first) & set(same) and not set(first) & set(second)
