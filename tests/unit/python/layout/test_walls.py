# SPDX-License-Identifier: Apache-2.0
"""Walls fill what is drawn, but leave room to turn beside them."""

import numpy as np
import pytest

from warehouse_layout.file import walls


def drawn(*lines):
    return np.array([[c == "#" for c in line] for line in lines[::-1]])


def covers(boxes, x, y):
    return any(abs(x - cx) <= w / 2 and abs(y - cy) <= h / 2 for cx, cy, w, h in boxes.tolist())


@pytest.mark.parametrize(("spacing", "free"), [(1.0, 0.58), (1.2, 0.6)])
def test_cells_are_walled_as_far_as_a_unit_can_turn_beside_them(spacing, free):
    mask = drawn("####", "#..#", "#.##", "####")
    boxes = walls.boxes(mask, spacing)
    for row, column in np.argwhere(mask):
        assert covers(boxes, column * spacing, row * spacing)
    for row, column in np.argwhere(~mask):
        x, y = column * spacing, row * spacing
        for dx, dy in ((1, 0), (0, 1), (-1, 0), (0, -1)):
            assert not covers(boxes, x + dx * (free - 1e-6), y + dy * (free - 1e-6))


def test_walls_that_join_have_no_gap():
    boxes = walls.boxes(drawn("##", "#.", "#."), 1.0)
    assert all(covers(boxes, 0, y) for y in np.arange(0, 2, 0.05))
    assert all(covers(boxes, x, 2) for x in np.arange(0, 1, 0.05))


def test_a_pillar_at_a_wall_is_solid():
    boxes = walls.boxes(drawn(".##.", "####", "####"), 1.0)
    for x, y in np.mgrid[1:2:0.1, 0:2:0.1].reshape(2, -1).T:
        assert covers(boxes, x, y), (x, y)
