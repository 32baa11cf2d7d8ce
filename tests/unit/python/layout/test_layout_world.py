# SPDX-License-Identifier: Apache-2.0
"""A layout as an SDF world: everything stands in it, and it is read back as it was drawn."""

import re
from dataclasses import replace

import numpy as np
import pytest
from paths import ROOT

from kiva_plugin_cpp import World
from warehouse_layout.convert import from_world
from warehouse_layout.file import drawn_floor
from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.request import PRESETS, Request
from warehouse_layout.floor import plan_reader
from warehouse_layout.floor.plan_reader import BELT
from warehouse_layout.generate import compact, generator
from warehouse_layout.models import world_export
from warehouse_layout.place import placement

HALL = """layout: 1
name: north hall
floor: |
  ####################
  #pcp...............#
  #..................#
  #p.sss.sss.v<<....x#
  #c.sss.sss.v.^.....#
  #..........>>>....x#
  #..................#
  #---|..............#
  #............A==...#
  #..................#
  #..................#
  #..................#
  ####################
stations:
  A: {name: dock, kind: pick, queue: [[13, 2], [13, 3]], exit: [[13, 5]], capacity: 7}
  B: {name: refill, kind: replenish, service: [5, 3], queue: [[4, 3]], exit: [[6, 3]]}
robots: 3
items: 20
policies: {batching: {most: 2}}
"""
FILES = {
    "a hall": lambda: lf.parse(HALL),
    "a preset": lambda: generator.of_request(PRESETS["small"], "small"),
    "four sides": lambda: compact.of_request(
        Request(9, 80, 40, 6), 3, compact.Style(4, (2, 4)), "f"
    ),
    "two ways": lambda: compact.of_request(
        Request(9, 80, 40, 2), 1, compact.Style(2, (1, 5), False), "two ways"
    ),
    "half a metre more": lambda: replace(generator.of_request(PRESETS["small"], "s"), spacing=1.5),
    "elsewhere": lambda: replace(generator.of_request(PRESETS["small"], "s"), at=(3.0, -7.0)),
}


@pytest.fixture(params=FILES)
def file(request):
    return FILES[request.param]()


@pytest.fixture
def path(file, tmp_path):
    world_export.write(file, tmp_path / "w.sdf")
    return tmp_path / "w.sdf"


def without_text(path):
    """Removes the layout file from a world, as a program does that writes the world again."""
    text = re.sub("<warehouse:drawing>.*</warehouse:drawing>", "", path.read_text(), flags=re.S)
    path.write_text(text)
    return path


def test_everything_stands_in_the_world(file, path):
    layout = placement.place(file)
    world = World(world=str(path))
    names = world.names
    for kind, points in (("kiva", layout.robots), ("storage_unit", layout.units)):
        assert sum(re.fullmatch(rf"{kind}\d+", n) is not None for n in names) == len(points)
        for i, point in enumerate(points, start=1):
            np.testing.assert_allclose(world.pose(f"{kind}{i}")[:2], point[:2], atol=1e-6)
    assert sum(name.startswith("item") for name in names) == len(layout.item_unit)
    assert sum(name.startswith("conveyor_belt") for name in names) == len(layout.belts)


def test_fleets_find_the_floor_in_it_as_it_was_drawn(file, path):
    if (file.floor == lf.WALL).any():
        return  # beside walls the world's map leaves room to turn
    standing, drawn = plan_reader.of_world(World(world=str(path))), placement.place(file).plan
    column, row = np.round(np.subtract(drawn.origin, standing.origin) / drawn.spacing).astype(int)
    height, width = drawn.shape
    part = np.s_[row : row + height, column : column + width]
    for name in ("storage", "parking", "exits"):
        assert (getattr(standing, name)[part] == getattr(drawn, name)).all(), name
    assert [s.name for s in standing.stations] == [s.name for s in drawn.stations]


def test_it_is_read_as_it_was_drawn(file, path):
    again, notes = from_world.read(path)
    assert notes == []
    assert lf.text_of(again) == lf.text_of(file)


def test_it_means_the_same_without_the_text(file, path):
    again, _ = from_world.read(without_text(path))
    now, drawn = placement.place(again), placement.place(file)
    for name in ("passable", "storage", "parking"):
        assert (getattr(now.plan, name) == getattr(drawn.plan, name)).all(), name
    np.testing.assert_allclose(now.robots[:, :2], drawn.robots[:, :2], atol=1e-6)
    np.testing.assert_allclose(now.units, drawn.units, atol=1e-6)
    for station, other in zip(now.plan.stations, drawn.plan.stations, strict=True):
        assert (station.name, station.kind) == (other.name, other.kind)
        assert (station.cells == other.cells).all()
    for character in (lf.WALL, lf.BELT):
        assert ((again.floor == character) == (file.floor == character)).all()
    assert again.items == file.items


def test_a_robot_that_was_moved_is_where_it_is_now(tmp_path):
    file = FILES["a hall"]()
    world_export.write(file, tmp_path / "w.sdf")
    text = (tmp_path / "w.sdf").read_text()
    moved = re.sub("(<name>kiva1</name><pose>)[^<]*", r"\g<1>0 -4 0 0 0 0", text)
    (tmp_path / "w.sdf").write_text(moved)
    again, notes = from_world.read(tmp_path / "w.sdf")
    assert notes == []
    assert (again.robots[0], len(again.robots)) == ((9, 2), 3)
    assert (again.floor == file.floor).all()


def test_a_wall_that_was_added_is_drawn(tmp_path):
    file = FILES["a preset"]()
    world_export.write(replace(file, robots=0), tmp_path / "w.sdf")
    text = (tmp_path / "w.sdf").read_text()
    pillar = (
        "<include><uri>model://wall</uri><name>pillar</name><pose>{} {} 0 0 0 0</pose></include>"
    )
    x, y = placement.origin(file)
    column, row = next((c, r) for r, c in np.argwhere(file.floor == lf.NO_FLOOR))
    text = text.replace("</world>", pillar.format(x + column, y + row) + "</world>")
    (tmp_path / "w.sdf").write_text(text)
    again, _ = from_world.read(tmp_path / "w.sdf")
    assert again.floor[row, column] == lf.WALL


@pytest.mark.parametrize("name", ["paper", "hall", "obstacles", "empty"])
def test_a_world_without_markings_is_closed_where_its_map_is(name):
    path = ROOT / "worlds" / f"{name}.sdf"
    file, _ = from_world.read(path)
    x, y, spacing, occupancy = World(world=str(path)).occupancy()
    assert (placement.origin(file), file.spacing) == ((x, y), spacing)
    assert (drawn_floor.areas(file.floor).passable == (occupancy < BELT)).all()


def test_belts_of_a_world_without_markings_get_stations():
    file, _ = from_world.read(ROOT / "worlds" / "paper.sdf")
    assert [station.kind for station in file.stations] == ["pick", "pick"]
    assert (len(file.robots), len(file.storage_units)) == (2, 3)


def test_a_layout_stands_in_its_building(tmp_path):
    file = replace(
        lf.parse("layout: 1\nfloor: |\n  .....\n  .sss.\n  .....\n"),
        building=str(ROOT / "worlds" / "hall.sdf"),
        at=(-2.0, -1.0),
    )
    world_export.write(file, tmp_path / "w.sdf")
    names = World(world=str(tmp_path / "w.sdf")).names
    assert {"wall_north", "storage_unit1", "floor_markings1"} <= set(names)
    again, notes = from_world.read(tmp_path / "w.sdf")
    assert notes == []
    assert lf.text_of(again) == lf.text_of(file)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is not XML"),
        ("<sdf><model name='m'/></sdf>", "an <sdf> with a <world> was expected"),
        ("<sdf><world name='w'/></sdf>", "neither a floor nor anything solid"),
        (
            "<sdf><world name='w'><model name='m'><pose>0 0 x 0 0 0</pose></model></world></sdf>",
            "a pose is '0 0 x 0 0 0'; 6 numbers were expected",
        ),
    ],
)
def test_what_is_no_world_is_refused_in_one_sentence(tmp_path, text, message):
    path = tmp_path / "w.sdf"
    path.write_text(text)
    with pytest.raises(lf.LayoutFileError) as error:
        from_world.read(path)
    assert str(error.value).startswith(f"{path}: {message}")
