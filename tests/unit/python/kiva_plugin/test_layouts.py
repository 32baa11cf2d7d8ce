# SPDX-License-Identifier: Apache-2.0
"""Worlds of layout files: what was drawn stands there, and what can't be is refused."""

import numpy as np
import pytest
from paths import ROOT

from kiva_plugin_cpp import World
from warehouse_layout.file import layout_file
from warehouse_layout.file.request import PRESETS
from warehouse_layout.floor import plan_reader
from warehouse_layout.generate import generator
from warehouse_layout.place import placement

LAYOUTS = ROOT / "tests" / "layouts"
NORTH, IN_HALL = LAYOUTS / "north.layout.yaml", LAYOUTS / "in_hall.layout.yaml"


def changed(path, tmp_path, **values):
    """Returns another file with other values, a line each."""
    lines = path.read_text().splitlines()
    for key, value in values.items():
        lines = [f"{key}: {value}" if line.startswith(f"{key}:") else line for line in lines]
    copy = tmp_path / "changed.layout.yaml"
    copy.write_text("\n".join(lines) + "\n")
    return copy


@pytest.mark.parametrize("spacing", [1.0, 1.2, 2.5])
def test_the_world_has_the_floor_plan_of_the_drawing(spacing, tmp_path):
    path = changed(NORTH, tmp_path, spacing=spacing, items=40)
    world, drawn = World.layout(path), placement.place(layout_file.read(path)).plan
    plan = plan_reader.of_world(world)
    plan.check()
    assert world.grid_spacing == plan.spacing == spacing
    assert plan.origin == pytest.approx(drawn.origin)
    for area in ("passable", "storage", "parking", "exits", "obstructed"):
        assert np.array_equal(getattr(plan, area), getattr(drawn, area)), area
    assert [(s.name, s.belt, *s.cells) for s in plan.stations] == [
        (s.name, s.belt, *s.cells) for s in drawn.stations
    ]


def test_robots_drive_cells_of_the_drawing():
    world = World.layout(NORTH)
    x, y = float(world.fleet.x[0]), float(world.fleet.y[0])
    world.mov(kiva_id=1, x=x + 1.2, y=y)
    world.step(5000)
    assert world.fleet.x[0] == pytest.approx(x + 1.2, abs=1e-3)
    world.mov(kiva_id=1, x=x + 2.0, y=y)
    world.step(1)
    assert "off the grid of 1.2 m" in str(world.events())


def test_numbers_of_robots_and_seeds_vary_it():
    assert len(World.layout(NORTH, robots=9).fleet) == 9
    first, same, other = (World.layout(NORTH, seed=s).storage_units for s in (5, 5, 6))
    assert np.array_equal(first["x"], same["x"])
    assert not np.array_equal(first["x"], other["x"])


@pytest.mark.parametrize("name", ["small", "medium"])
@pytest.mark.parametrize("seed", [1, 4])
def test_a_preset_stands_the_same_by_both_names(name, seed):
    assert World.layout(name, seed=seed).state_hash() == World.preset(name, seed=seed).state_hash()


def test_the_file_of_a_preset_stands_as_the_preset(tmp_path):
    path = tmp_path / "small.layout.yaml"
    layout_file.write(generator.of_request(PRESETS["small"]), path)
    ours, theirs = World.layout(path), World.preset("small")
    for field in ("x", "y"):
        assert np.array_equal(getattr(ours.fleet, field), getattr(theirs.fleet, field))
        assert np.array_equal(ours.storage_units[field], theirs.storage_units[field])


def test_a_warehouse_stands_in_its_building():
    world = World.layout(IN_HALL)
    assert "wall_north" in world.names
    plan_reader.of_world(world).check()
    assert [s.name for s in plan_reader.of_world(world).stations] == ["pick1"]


@pytest.mark.parametrize(
    ("path", "values", "sentence"),
    [
        (NORTH, {"spacing": 0.5}, "spacing is 0.5 m; 0.97 m or more were expected"),
        (NORTH, {"robots": 100}, "100 robots, but there is room for 23: 3 on parking"),
        (NORTH, {"robots": "[[0, 0]]"}, "a robot is at [0, 0], where no robot can stand"),
        (NORTH, {"items": "{stock: no.csv}"}, "no.csv: No such file or directory"),
        (IN_HALL, {"at": "[-3, -5]"}, "something of hall stands at [9, 0], [10, 0]"),
        (IN_HALL, {"at": "[-4.5, -5]"}, "at is [-4.5, -5.0]; whole multiples of the spacing, 1 m"),
        (IN_HALL, {"building": "nowhere"}, "building: there is no world 'nowhere'; tried"),
    ],
)
def test_what_is_wrong_is_reported(path, values, sentence, tmp_path):
    with pytest.raises(ValueError) as error:
        World.layout(changed(path, tmp_path, **values))
    assert sentence in str(error.value)
    assert str(error.value).startswith(str(tmp_path / "changed.layout.yaml"))


def test_another_grid_than_that_of_the_building_is_reported(tmp_path):
    path = changed(IN_HALL, tmp_path, at="[-6, -6]\nspacing: 1.2")
    with pytest.raises(ValueError, match=r"spacing is 1\.2 m, but the grid of the world is 1 m"):
        World.layout(path)


def test_a_name_of_nothing_is_reported_with_the_presets():
    with pytest.raises(ValueError, match="not a preset; known are empty, small, medium"):
        World.layout("smal")
    with pytest.raises(ValueError, match="can't pass each other"):
        World.layout(LAYOUTS / "blocked.layout.yaml")


def test_a_floor_that_lanes_divide_is_reported():
    with pytest.raises(ValueError, match="loaded robots can't get from the streets at"):
        World.layout(LAYOUTS / "cut_by_lanes.layout.yaml")
