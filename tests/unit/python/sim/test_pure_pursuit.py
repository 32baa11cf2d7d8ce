# SPDX-License-Identifier: Apache-2.0
"""The example of pure pursuit, on a unicycle that follows speeds at limited accelerations."""

import math
import sys

import pytest
from paths import ROOT

sys.path.insert(0, str(ROOT / "examples" / "pure_pursuit"))

from pursuit import PurePursuit, turn_to

STEP = 0.05  # [s]


def run(points, pose=(0.0, 0.0, 0.0), seconds=120):
    """Returns (the end pose, the places on the way) of a robot that is driven along the points."""
    pursuit, (x, y, yaw), v, w, places = PurePursuit(points), pose, 0.0, 0.0, []
    for _ in range(round(seconds / STEP)):
        speed, rate = pursuit.command((x, y, yaw))
        v += max(-STEP, min(STEP, speed - v))  # 1 m/s²
        w += max(-4 * STEP, min(4 * STEP, rate - w))
        yaw += w * STEP
        x, y = x + v * math.cos(yaw) * STEP, y + v * math.sin(yaw) * STEP
        places.append((x, y))
        if pursuit.is_done and v == 0:
            return (x, y, yaw), places
    raise AssertionError(f"it did not arrive: {x}, {y}")


@pytest.mark.parametrize(
    "points",
    [
        [(0, 0), (3, 0)],
        [(0, 0), (3, 0), (3, 3), (6, 3)],
        [(0, 0), (-2, 0)],
        [(0, 0), (2, 1), (4, -1), (5, 5)],
        [(0, 0), (4, 0), (0, 0.5)],
    ],
)
def test_it_ends_within_two_centimetres_of_the_aim_and_stays_near_the_path(points):
    (x, y, _), places = run(points)
    assert math.dist((x, y), points[-1]) < 0.02
    for place in places:
        off = min(distance(place, begin, end) for begin, end in zip(points, points[1:]))
        assert off < 0.25, place


def distance(place, begin, end):
    dx, dy = end[0] - begin[0], end[1] - begin[1]
    share = ((place[0] - begin[0]) * dx + (place[1] - begin[1]) * dy) / (dx * dx + dy * dy)
    share = min(1, max(0, share))
    return math.dist(place, (begin[0] + share * dx, begin[1] + share * dy))


def test_it_turns_in_place_towards_a_path_behind_it():
    _, places = run([(0, 0), (-2, 0)])
    assert max(x for x, _ in places) < 0.05


def test_a_path_needs_two_different_points():
    for points in ([], [(1, 1)], [(1, 1), (1, 1)]):
        with pytest.raises(ValueError, match="two different points"):
            PurePursuit(points)


def test_a_turn_ends_within_half_a_degree_by_the_shorter_side():
    assert turn_to(math.radians(179), math.radians(-179)) < 0
    assert turn_to(1.0, 1.0 + math.radians(0.4)) == 0
    assert turn_to(1.0, 1.0 - math.radians(0.6)) > 0
