# SPDX-License-Identifier: Apache-2.0
"""A warehouse on the free cells of a foreign floor."""

import numpy as np
import pytest
from nav_msgs.msg import OccupancyGrid

from warehouse_layout.file.request import PRESETS, Request, RequestError, resolve
from warehouse_layout.floor.stations import STEPS
from warehouse_layout.generate.cells import Cells
from warehouse_layout.generate.fit import fit


def cells(width, height, taken=()):
    mask = np.zeros((width, height), bool)
    for i, j in taken:
        mask[i, j] = True
    return Cells(-(width // 2), -(height // 2), mask)


def crowded(seed, share, size=60):
    mask = np.random.default_rng(seed).random((size, size)) < share
    return Cells(-size // 2, -size // 2, mask)


def occupied(layout):
    """Cells of robots, units and belts."""
    belts = [(x + dx, y) for x, y, _ in layout.belts for dx in (-0.5, 0.5)]
    points = [tuple(p[:2]) for p in (*layout.robots, *layout.units, *belts)]
    return [(round(x), round(y)) for x, y in points]


def free(layout, floor):
    """Grid points that a loaded robot may pass."""
    xs = range(floor.x, floor.x + floor.taken.shape[0])
    ys = range(floor.y, floor.y + floor.taken.shape[1])
    return {(x, y) for x in xs for y in ys} - floor.points() - set(occupied(layout))


def reached(start, free):
    visited, queue = {start}, [start]
    for x, y in queue:
        new = ({(x + dx, y + dy) for dx, dy in STEPS} & free) - visited
        visited |= new
        queue += new
    return visited


@pytest.mark.parametrize("preset", ["small", "medium", "large"])
@pytest.mark.parametrize("seed", range(3))
def test_everything_stands_on_free_cells_and_is_reached_by_a_loaded_robot(preset, seed):
    floor = crowded(seed, share=0.08, size=90)
    layout = fit(PRESETS[preset], floor)
    assert len(layout.robots) == PRESETS[preset].robots
    assert len(layout.units) == PRESETS[preset].shelves
    assert len(layout.item_unit) == PRESETS[preset].items
    assert len(layout.belts) == PRESETS[preset].belts
    places = occupied(layout)
    assert len(set(places)) == len(places)
    assert floor.points().isdisjoint(places)
    way = free(layout, floor)
    drops = [(round(x), round(y)) for x, y in layout.drops]
    network = reached(drops[0], way)
    assert network.issuperset(drops)
    for x, y in layout.units:
        assert any((round(x) + dx, round(y) + dy) in network for dx, dy in STEPS)


@pytest.mark.parametrize("preset", ["small", "medium", "large"])
def test_belts_have_stations_where_a_fleet_can_not_come_to_a_deadlock(preset):
    floor = crowded(2, share=0.01, size=110)
    layout = fit(PRESETS[preset], floor)
    layout.plan.check()
    kinds = [station.kind for station in layout.plan.stations]
    belts = PRESETS[preset].belts
    assert (kinds.count("PICK"), kinds.count("REPLENISH")) == (belts, belts // 2)
    assert len(layout.places) == -(-PRESETS[preset].shelves * 20 // 17)
    taken = floor.points()
    assert taken.isdisjoint(
        (round(x), round(y))
        for station in layout.plan.stations
        for x, y in zip(*layout.plan.point_of(station.cells))
    )


def test_without_room_for_stations_belts_stand_at_streets():
    layout = fit(resolve("small"), crowded(0, share=0.25, size=40))
    assert layout.plan is None
    assert len(layout.belts) == 2


def test_robots_face_a_street():
    floor = crowded(1, share=0.05)
    layout = fit(resolve("small"), floor)
    way = free(layout, floor)
    for x, y, yaw in layout.robots:
        assert (round(x + np.cos(yaw)), round(y + np.sin(yaw))) in way


def test_an_empty_floor_keeps_its_bounds():
    layout = fit(resolve("small"), cells(40, 30))
    assert (layout.floor.min_x, layout.floor.max_x) == (-20.5, 19.5)
    assert (layout.floor.min_y, layout.floor.max_y) == (-15.5, 14.5)
    assert not layout.has_own_floor


def test_what_does_not_fit_is_refused_with_the_numbers():
    with pytest.raises(RequestError, match=r"24 storage units.* don't fit: of 36 free cells, \d+ "):
        fit(resolve("small"), cells(6, 6))


def test_nothing_fits_anywhere():
    layout = fit(Request(), cells(3, 3))
    assert len(layout.robots) == len(layout.units) == 0


def test_cut_off_corners_are_left_alone():
    wall = [(20, j) for j in range(60)]
    layout = fit(resolve("small"), cells(60, 60, wall))
    assert min(x for x, _ in occupied(layout)) > -10


def test_a_map_becomes_cells():
    grid = OccupancyGrid()
    grid.info.resolution = 1.0
    grid.info.width, grid.info.height = 3, 2
    grid.info.origin.position.x, grid.info.origin.position.y = -1.5, 3.5
    grid.data = [0, 100, 0, 0, 0, 100]
    cells = Cells.of_map(grid)
    assert cells.points() == {(0, 4), (1, 5)}
    assert (cells.floor.min_x, cells.floor.max_x) == (-1.5, 1.5)


def test_a_grid_of_another_spacing_is_refused():
    grid = OccupancyGrid()
    grid.info.resolution = 1.5
    with pytest.raises(RequestError, match=r"1\.5 m apart"):
        Cells.of_map(grid)


def test_a_seed_decides_who_stands_where_and_no_more():
    floor, small = crowded(0, 0.1), resolve("small")
    regular, other = fit(small, floor), fit(small, floor, seed=2)
    assert occupied(regular) != occupied(other)
    for field in ("places", "belts", "drops"):
        assert np.array_equal(getattr(regular, field), getattr(other, field))
    assert {*map(tuple, other.units)} <= {*map(tuple, other.places)}
    assert sorted(regular.robots[:, :2].tolist()) == sorted(other.robots[:, :2].tolist())
    assert occupied(other) == occupied(fit(small, floor, seed=2))
