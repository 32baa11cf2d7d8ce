# SPDX-License-Identifier: Apache-2.0
"""Whether a coordinator notices that simulated time runs away from it."""

import pytest

from warehouse_fleet.hosts.pace_watch import DECISIONS, PaceWatch


def warned(apart, wall=0.005, count=2 * DECISIONS):
    watch = PaceWatch()
    return [text for k in range(count) if (text := watch.decided(apart * k, wall * k))]


@pytest.mark.parametrize("apart", [0.1, 0.5])
def test_a_coordinator_that_keeps_up_says_nothing(apart):
    assert not warned(apart)


def test_time_that_runs_away_is_named_with_the_pace_that_would_do():
    (text,) = warned(3.0)  # once
    assert "3.0 s pass between two of its decisions" in text
    assert "start with rtf:=20 or less" in text  # a decision takes 5 ms


def test_a_single_jump_is_no_pace():
    watch = PaceWatch()
    times = [0.1 * k + 60 * (k > 30) for k in range(2 * DECISIONS)]
    assert not any(watch.decided(time, 0.005 * k) for k, time in enumerate(times))


def test_a_world_that_begins_again_counts_from_there():
    watch = PaceWatch()
    times = [3.0 * k for k in range(DECISIONS - 1)] + [0.1 * k for k in range(DECISIONS)]
    assert not any(watch.decided(time, 0.005 * k) for k, time in enumerate(times))
