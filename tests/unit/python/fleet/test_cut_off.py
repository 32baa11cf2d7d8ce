# SPDX-License-Identifier: Apache-2.0
"""What cuts a robot off from its goal, on small floors."""

import numpy as np

from warehouse_fleet.traffic.cut_off import CutOff
from warehouse_layout import Floor

EAST, NORTH, WEST, SOUTH = 1, 2, 4, 8  # bits of exits


def one_way(length):
    """A street of cells that leads to the east alone."""
    return CutOff(Floor(np.ones((1, length), bool), exits=np.full((1, length), EAST, np.uint8)))


def test_the_obstacle_ahead_cuts_off_and_one_behind_does_not():
    cut = one_way(6)
    cut.set_obstacles(np.array([0, 3]), 6)
    assert cut.obstacles(1, 5, False).tolist() == [3]
    assert cut.obstacles(1, 2, False).tolist() == []


def test_obstacles_that_have_gone_are_forgotten():
    cut = one_way(4)
    cut.set_obstacles(np.array([2]), 4)
    assert cut.obstacles(0, 3, False).tolist() == [2]
    cut.set_obstacles(np.array([], int), 4)
    assert cut.obstacles(0, 3, False).tolist() == []


def test_of_several_obstacles_the_one_that_bars_the_way_is_told():
    """Two rows: the lower leads east and up at its end, the upper is a blind alley."""
    exits = np.array([[EAST | NORTH, EAST, EAST, NORTH], [EAST, 0, 0, 0]], np.uint8)
    cut = CutOff(Floor(np.ones((2, 4), bool), exits=exits))
    cut.set_obstacles(np.array([2, 5]), 8)
    assert cut.obstacles(0, 7, False).tolist() == [2]
    cut.set_obstacles(np.array([1, 2, 5]), 8)
    assert cut.obstacles(0, 7, False).tolist() == [1, 5], "neither alone"
