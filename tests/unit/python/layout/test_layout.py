# SPDX-License-Identifier: Apache-2.0
"""The floor plan: nothing overlaps, and whatever a robot may want to reach it can."""

import hashlib
import itertools
import math
import random

import numpy as np
import pytest
from grid import Grid

from warehouse_client.routes import covered, point
from warehouse_layout.file.items import BOARDS, CAPACITY, PLACES, spread
from warehouse_layout.file.request import LIMITS, MOST_STATIONS, PRESETS, resolve
from warehouse_layout.generate.generated import plan

BELT = (1.8, 0.8)  # length and width of models/conveyor_belt [m]


def random_counts(seed):
    draw = random.Random(seed)
    shelves = draw.choice([0, 1, 2, 3, 7, 25, 130, 777])
    items = draw.randint(0, shelves * CAPACITY)
    return {"robots": draw.choice([0, 1, 2, 5, 33, 210]), "shelves": shelves, "items": items}


REQUESTS = {name: resolve(name) for name in PRESETS} | {
    f"random{seed}": resolve("", **random_counts(seed))
    for seed in range(40)
    if any(random_counts(seed).values())
}


SEEDED = [(name, seed) for name in ("small", "medium", "random3", "random8") for seed in (0, 2, 7)]


@pytest.fixture(
    scope="module", params=[*((name, 1) for name in REQUESTS), *SEEDED], ids="{0[0]}-{0[1]}".format
)
def case(request):
    name, seed = request.param
    return REQUESTS[name], plan(REQUESTS[name], seed)


def belt_cells(layout):
    return [p for belt in layout.belts for p in covered(*belt, *BELT)]


def all_cells(layout):
    """Cells in which something stands or is put down; none may be taken twice."""
    return [
        *map(point, layout.robots),
        *map(point, layout.units),
        *map(point, layout.drops),
        *belt_cells(layout),
    ]


def reachable(grid, starts):
    """All grid points reached from `starts` (which themselves need not be free)."""
    queue = [point(p) for p in starts]
    visited = set(queue)
    for here in queue:
        new = [q for q in grid.neighbours(here) if q not in visited]
        visited.update(new)
        queue += new
    return visited


def test_counts(case):
    request, layout = case
    assert len(layout.robots) == request.robots
    assert len(layout.units) == request.shelves
    assert len(layout.item_place) == len(layout.item_unit) == request.items
    assert len(layout.belts) == len(layout.drops) == request.belts


def test_robots_units_and_drop_points_stand_on_the_grid(case):
    for points in (case[1].robots[:, :2], case[1].units, case[1].drops):
        assert np.array_equal(points, np.round(points))


def test_floor_holds_whole_cells_about_the_origin(case):
    floor = case[1].floor
    edges = np.array([floor.min_x, floor.max_x, floor.min_y, floor.max_y])
    assert np.array_equal((edges - 0.5) % 1, np.zeros(4))
    assert max(map(abs, floor.centre)) <= 0.5


def test_everything_stands_on_the_floor(case):
    grid = Grid(case[1].floor)
    assert [p for p in all_cells(case[1]) if not grid.free(p)] == []


def test_no_cell_is_taken_twice(case):
    cells = all_cells(case[1])
    assert len(set(cells)) == len(cells)


def test_belts_begin_a_hands_width_beyond_the_drop_points_cell(case):
    layout = case[1]
    start = layout.belts[:, 0] - BELT[0] / 2
    assert start == pytest.approx(layout.drops[:, 0] + 0.5 + 0.1)
    assert np.array_equal(layout.belts[:, 1], layout.drops[:, 1])


def test_parked_robots_face_a_street(case):
    layout = case[1]
    grid = Grid(layout.floor, all_cells(layout))
    ahead = [point((x, y + math.copysign(1, yaw))) for x, y, yaw in layout.robots]
    assert all(grid.free(p) and len(grid.neighbours(p)) >= 2 for p in ahead)
    assert set(np.abs(layout.robots[:, 2])) <= {math.pi / 2}


def test_a_robot_without_load_reaches_every_unit_and_drop_point(case):
    layout = case[1]
    grid = Grid(layout.floor, belt_cells(layout) + list(layout.robots))
    goals = {*map(point, layout.units), *map(point, layout.drops)}
    for robot in layout.robots[:: max(1, len(layout.robots) // 5)]:
        assert goals <= reachable(grid, [robot])


def test_a_loaded_robot_reaches_every_drop_point_from_every_unit(case):
    layout = case[1]
    blocked = belt_cells(layout) + list(layout.robots) + list(layout.units)
    grid = Grid(layout.floor, blocked)
    for drop in layout.drops[:3]:
        from_drop = reachable(grid, [drop])
        assert set(map(point, layout.drops)) <= from_drop
        for unit in layout.units:
            assert any(q in from_drop for q in grid.neighbours(point(unit)))


def test_items_lie_clear_of_each_other_and_the_posts(case):
    layout = case[1]
    places = {(u, *np.round(p, 3)) for u, p in zip(layout.item_unit, layout.item_place)}
    assert len(places) == len(layout.item_place)
    assert set(layout.item_place[:, 2]) <= set(BOARDS)
    assert np.all(np.abs(layout.item_place[:, :2]) + (0.10, 0.075) < 0.36)


def test_places_on_a_board_are_wider_apart_than_an_item():
    for a, b in itertools.combinations(PLACES, 2):
        assert abs(a[0] - b[0]) > 0.20 or abs(a[1] - b[1]) > 0.15


def test_items_spread_evenly():
    unit, _ = spread(100, 24)
    counts = np.bincount(unit, minlength=24)
    assert counts.max() - counts.min() <= 1


def test_a_full_unit_uses_every_place():
    _, place = spread(CAPACITY, 1)
    assert len({tuple(p) for p in place}) == CAPACITY


def test_the_largest_warehouse_is_planned():
    layout = plan(resolve("", **LIMITS))
    assert (len(layout.robots), len(layout.units)) == (LIMITS["robots"], LIMITS["shelves"])
    assert len(layout.belts) == MOST_STATIONS
    assert max(layout.floor.size) / min(layout.floor.size) < 2


def test_stations_beyond_one_side_lie_on_all_sides():
    regular, compact = (resolve("", robots=25 * n, shelves=6000) for n in (60, 100))
    assert len(set(plan(regular).drops[:, 0])) == 1
    drops = plan(compact).drops
    (west, south), (east, north) = drops.min(axis=0), drops.max(axis=0)
    for x, y in ((west, None), (east, None), (None, south), (None, north)):
        on_side = (drops[:, 0] == x) if y is None else (drops[:, 1] == y)
        assert on_side.sum() >= 25


# --- what a seed decides


def same(a, b):
    fields = ("robots", "units", "item_unit", "item_place", "belts", "drops", "places")
    return {f for f in fields if np.array_equal(getattr(a, f), getattr(b, f))}


def test_equal_seeds_give_equal_layouts():
    small = resolve("small")
    assert len(same(plan(small, 5), plan(small, 5))) == 7


def test_seeds_move_robots_units_and_items_and_nothing_else():
    medium = resolve("medium")
    for seed in (0, 2, 3):
        assert same(plan(medium, seed), plan(medium)) == {"belts", "drops", "places"}
        assert plan(medium, seed).floor == plan(medium).floor
    assert same(plan(medium, 2), plan(medium, 3)) == {"belts", "drops", "places"}


def test_items_are_spread_evenly_whatever_the_seed():
    counts = np.bincount(plan(resolve("", shelves=7, items=31), 4).item_unit, minlength=7)
    assert sorted(counts) == [4, 4, 4, 4, 5, 5, 5]


@pytest.mark.parametrize(
    ("name", "digest"),
    [("small", "fb9ce28eb501e20c"), ("medium", "ad8fc014682d5471"), ("huge", "b10215e6eae9e028")],
)
def test_the_presets_stay_as_they_are_known(name, digest):
    layout = plan(resolve(name))
    known = hashlib.sha256()
    for field in ("robots", "units", "item_unit", "item_place", "belts", "drops", "places"):
        known.update(np.ascontiguousarray(getattr(layout, field), float) + 0.0)
    assert known.hexdigest()[:16] == digest
