# SPDX-License-Identifier: Apache-2.0
"""Grid points that a command passes, and that a belt covers."""

import math

import pytest

from warehouse_client.routes import covered, elbow


def test_elbow_goes_back_as_well():
    assert elbow((2, 2), (1, 0)) == [(2, 2), (1, 2), (1, 1), (1, 0)]


@pytest.mark.parametrize(
    "yaw, cells",
    [
        (0, [(6, -3), (7, -3), (8, -3)]),
        (math.pi / 2, [(7, -4), (7, -3), (7, -2)]),
    ],
)
def test_cells_of_a_belt_on_a_grid_point(yaw, cells):
    assert covered(7, -3, yaw, 1.8, 0.8) == cells


def test_cells_of_a_belt_between_grid_points():
    assert covered(7.5, 2, 0, 1.8, 0.8) == [(7, 2), (8, 2)]


def test_a_cell_is_covered_where_only_a_little_reaches_into_it():
    assert covered(0, 0, 0, 1.1, 0.5) == [(-1, 0), (0, 0), (1, 0)]
    assert covered(0, 0, 0, 1.0, 0.5) == [(0, 0)]
