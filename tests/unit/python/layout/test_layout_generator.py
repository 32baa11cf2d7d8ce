# SPDX-License-Identifier: Apache-2.0
"""Generated layout files: the presets stand as they always did, and compact floors are safe."""

import random
import re

import numpy as np
import pytest

from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.request import PRESETS, Request, RequestError, resolve
from warehouse_layout.generate import compact, generated, generator
from warehouse_layout.place import file_check, placement

ARRAYS = ("robots", "units", "places", "item_unit", "item_place", "belts", "drops")
PLAN = ("passable", "storage", "parking", "exits")


def through_text(file):
    return lf.parse(lf.text_of(file))


def assert_same(laid, expected):
    for name in ARRAYS:
        np.testing.assert_allclose(getattr(laid, name), getattr(expected, name), atol=1e-9)
    for name in PLAN:
        assert (getattr(laid.plan, name) == getattr(expected.plan, name)).all(), name
    assert laid.plan.origin == expected.plan.origin
    assert laid.floor == expected.floor
    assert list(laid.plan.charging) == list(expected.plan.charging)
    for station, other in zip(laid.plan.stations, expected.plan.stations, strict=True):
        assert (station.name, station.kind, station.service) == (
            other.name,
            other.kind,
            other.service,
        )
        assert (station.cells == other.cells).all()
        assert station.belt == other.belt


@pytest.mark.parametrize("preset", ["small", "medium", "large"])
def test_a_preset_stands_the_same_through_its_file(preset):
    request = PRESETS[preset]
    file = through_text(generator.of_request(request, preset))
    assert_same(placement.place(file), generated.plan(request))


@pytest.mark.parametrize("seed", range(8))
def test_so_do_other_counts(seed):
    rng = random.Random(seed)
    request = resolve("", rng.randrange(1, 60), rng.randrange(0, 200), rng.randrange(5, 400))
    file = through_text(generator.of_request(request))
    assert_same(placement.place(file), generated.plan(request))
    assert file_check.faults(file) == []


def random_style(rng):
    block = rng.choice([(1, rng.randint(1, 9)), (2, rng.randint(1, 9)), (rng.randint(1, 6), 2)])
    return compact.Style(rng.randint(1, 4), block, is_one_way=rng.random() < 0.6)


@pytest.mark.parametrize("seed", range(120))
def test_fleets_can_work_on_every_compact_floor(seed):
    rng = random.Random(seed)
    style, replenish = random_style(rng), rng.randrange(5)
    request = Request(rng.randrange(30), rng.randrange(1, 150), 0, rng.randrange(9))
    file = through_text(compact.of_request(request, replenish, style))
    assert file_check.faults(file) == [], (request, replenish, style)
    layout = placement.place(file)
    assert (len(layout.robots), len(layout.units)) == (request.robots, request.shelves)
    kinds = [station.kind for station in file.stations]
    assert (kinds.count("pick"), kinds.count("replenish")) == (request.belts, replenish)
    assert len(layout.belts) == request.belts


def outward(station):
    (ax, ay), (bx, by) = station.queue[-2:]
    return bx - ax, by - ay


@pytest.mark.parametrize("sides", [1, 2, 3, 4])
def test_stations_are_on_as_many_sides_as_asked(sides):
    file = compact.of_request(Request(4, 40, 0, 6), 2, compact.Style(sides))
    directions = [(1, 0), (-1, 0), (0, 1), (0, -1)][:sides]
    assert {outward(station) for station in file.stations} == set(directions)


def test_storage_lies_by_the_stations_of_all_sides_around_a_hole():
    file = compact.of_request(Request(20, 200, 0, 80), 0, compact.Style(4))
    y, x = np.nonzero(file.floor == lf.STORAGE)
    for station in file.stations:
        assert np.hypot(*np.subtract(station.queue[0], np.stack([x, y], axis=-1)).T).min() < 10
    height, width = file.shape
    middle = file.floor[height // 2 - 5 : height // 2 + 5, width // 2 - 5 : width // 2 + 5]
    assert (middle == lf.NO_FLOOR).all()
    assert file_check.faults(file) == []


def test_blocks_are_as_deep_and_long_as_asked():
    file = compact.of_request(Request(0, 120, 0, 0), 0, compact.Style(1, (1, 5), True))
    storage = file.floor == lf.STORAGE
    assert not (storage[1:] & storage[:-1]).any()
    assert max(len(run) for row in lf.lines_of(file.floor) for run in re.findall("s+", row)) == 5


def test_two_way_streets_have_no_arrows():
    file = compact.of_request(Request(4, 40, 0, 2), 1, compact.Style(2, (2, 4), False))
    assert not np.isin(file.floor, list(lf.ONE_WAY)).any()


@pytest.mark.parametrize(
    ("style", "message"),
    [
        (compact.Style(5), "sides is 5"),
        (compact.Style(0), "sides is 0"),
        (compact.Style(1, (3, 4)), "3x4 places has some without a street"),
        (compact.Style(1, (0, 4)), "0x4"),
        (compact.Style(1, (2, 999)), "2x999"),
    ],
)
def test_what_makes_no_floor_is_refused(style, message):
    with pytest.raises(RequestError, match=message):
        compact.of_request(Request(1, 1, 0, 1), 0, style)
