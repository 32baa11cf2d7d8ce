# SPDX-License-Identifier: Apache-2.0
"""Estimates hold against samples that are of something else, and intervals hold what they say."""

import math

import numpy as np
import pytest

from warehouse_operations.calibrate import estimates
from warehouse_operations.calibrate.estimates import TooLittle
from warehouse_operations.calibrate.motion import both


def test_the_shortest_half_is_what_most_samples_agree_on():
    speeds = [1.2] * 12 + [0.3, 0.5, 0.9, 1.0, 1.1, 0.2, 0.7, 0.4, 0.6, 0.8]
    assert estimates.shorth(speeds) == pytest.approx(1.2)
    rng = np.random.default_rng(1)
    assert estimates.shorth(rng.normal(5.0, 0.1, 4000)) == pytest.approx(5.0, abs=0.02)
    assert estimates.shorth([3.0]) == 3.0


def test_outliers_are_edited():
    values = [*np.linspace(9.5, 10.5, 41), 60.0, 0.0]
    assert estimates.edited_mean(values) == pytest.approx(10.0)
    assert len(estimates.edited([])) == 0


def test_too_few_samples_say_nothing():
    estimate = estimates.resampled([1.0, 1.1], 8, "ramps")
    assert estimate == TooLittle(2, 8, "ramps")
    assert str(estimate) == "too little to say: 2 ramps, 8 were expected"


def held(make, truth, runs=200):
    """The share of estimates whose interval holds the truth."""
    rng = np.random.default_rng(5)
    made = [make(rng) for _ in range(runs)]
    return np.mean([each.low <= truth <= each.high for each in made])


def test_intervals_hold_the_truth_as_often_as_they_say():
    lifts = held(
        lambda r: estimates.resampled(r.normal(2, 0.1, 40), 8, of=estimates.edited_mean), 2.0
    )
    assert 0.88 < lifts <= 0.99
    assert held(lambda r: estimates.rate(r.poisson(12.0) or 1, 4.0, "failures"), 3.0) > 0.93
    repairs = held(lambda r: estimates.mean_duration(r.exponential(300.0, 9), 0.0, ""), 300.0)
    assert 0.9 < repairs <= 0.99


def test_repairs_that_are_not_over_count():
    estimate = estimates.mean_duration([100.0, 200.0], 300.0, "repairs")
    assert estimate.value == 300.0
    assert estimates.rate(0, 100.0, "failures") == TooLittle(0, 1, "failures")


def test_a_fit_leaves_pauses_out():
    rows = [(1, float(i % 4 == 0), 7.0 + 2.5 * (i % 4 == 0)) for i in range(60)]
    rows += [(1, 0.0, 300.0), (1, 1.0, 45.0)]
    coefficients, covariance, count = estimates.fitted(rows, 10, "pieces")
    assert coefficients == pytest.approx([7.0, 2.5]) and count == 60
    assert covariance == pytest.approx(np.zeros((2, 2)), abs=1e-12)


@pytest.mark.parametrize("way", [0.5, 1.0, 4.0, 20.0])
def test_one_acceleration_takes_the_place_of_two(way):
    top, up, down = 1.4, 0.8, 1.3

    def seconds(a, b):
        ramps = top**2 / 2 * (1 / a + 1 / b)
        if way > ramps:
            return way / top + top / 2 * (1 / a + 1 / b)
        return math.sqrt(2 * way * (1 / a + 1 / b))

    one_for_both = both(up, down)
    assert seconds(up, down) == pytest.approx(seconds(one_for_both, one_for_both))
