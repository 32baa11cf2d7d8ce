# SPDX-License-Identifier: Apache-2.0
"""What a page draws on the floor."""

from types import SimpleNamespace

import numpy as np
import pytest

from warehouse_layout.floor import floor_markings
from warehouse_layout.floor.floor_markings import Mark
from warehouse_viewer.page import paint


@pytest.fixture
def scene_of(monkeypatch):
    """Returns what a page gets of Marks, on cells of 1 m."""

    def of(*marks):
        monkeypatch.setattr(floor_markings, "readable", lambda _: list(marks))
        return paint.of_scenery(SimpleNamespace(grid_spacing=1.0))

    return of


def rows(numbers):
    return sorted(map(tuple, np.reshape(numbers, (-1, 3)).tolist()))


def test_a_one_way_street_has_an_arrow_on_each_third_cell(scene_of):
    street = Mark("exits-x", 3.0, 2.0, 7.0, 1.0)
    assert rows(scene_of(street)["arrows"]) == [(1, 2, 3.1416), (4, 2, 3.1416)]


def test_where_one_may_choose_there_is_no_arrow(scene_of):
    assert scene_of(Mark("exits+x+y", 0.0, 0.0, 5.0, 5.0))["arrows"] == []


def test_a_lane_has_arrows_from_cell_to_cell_in_driving_order(scene_of):
    cells = [Mark("PICK/p1/queue", x, y, 0.9, 0.9) for x, y in ((0, 0), (1, 0), (1, 1))]
    other = Mark("PICK/p2/queue", 9.0, 9.0, 0.9, 0.9)
    assert rows(scene_of(*cells, other)["arrows"]) == [(0.5, 0, 0), (1, 0.5, 1.5708)]


def test_rectangles_come_by_kind_and_stations_by_name(scene_of):
    scene = scene_of(
        Mark("storage", 1.0, 2.0, 3.0, 4.0), Mark("PICK/p1/service", 5.0, 6.0, 0.9, 0.9)
    )
    assert scene["paint"] == {"storage": [1, 2, 3, 4], "service": [5, 6, 0.9, 0.9]}
    assert scene["stations"] == [{"name": "p1", "x": 5.0, "y": 6.0}]
