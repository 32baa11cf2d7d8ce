# SPDX-License-Identifier: Apache-2.0
"""The floor plan that a world tells: what was laid out comes back from what is painted, stations
have lanes that work, and floors on which a fleet could come to a deadlock are refused."""

import re
from dataclasses import replace

import numpy as np
import pytest
from instance_file import write_hall_instance
from paths import ROOT

from kiva_plugin_cpp import World
from warehouse_fleet import Fleet, Rules, epibt
from warehouse_layout import FloorError
from warehouse_layout.convert.rawsim.instance import read_floor
from warehouse_layout.file import layout_file
from warehouse_layout.file.request import PRESETS, resolve
from warehouse_layout.floor import floor_markings, plan_reader
from warehouse_layout.generate import generated
from warehouse_layout.generate.generated import plan
from warehouse_layout.models import models
from warehouse_layout.models.world_file import insertable
from warehouse_layout.place import placement

STATIONED = [name for name, counts in PRESETS.items() if counts.belts]
REQUESTS = {name: resolve(name) for name in STATIONED} | {
    f"{robots} robots, {shelves} units": resolve("", robots=robots, shelves=shelves)
    for robots, shelves in ((0, 1), (1, 0), (3, 40), (130, 7), (10000, 40000))
}
TWO_FLOORS = ROOT / "tests/layouts/two_floors.layout.yaml"
ARRAYS = ("passable", "storage", "parking", "lane", "exits")


@pytest.fixture(scope="module", params=REQUESTS)
def laid_out(request):
    return REQUESTS[request.param], generated.plan(REQUESTS[request.param])


def same(first, other):
    stations = [(s.name, s.kind, s.service, s.belt, s.cells.tolist()) for s in first.stations] == [
        (s.name, s.kind, s.service, s.belt, s.cells.tolist()) for s in other.stations
    ]
    return stations and all(np.array_equal(getattr(first, a), getattr(other, a)) for a in ARRAYS)


def test_no_layout_can_come_to_a_deadlock(laid_out):
    laid_out[1].plan.check()


def test_a_belt_has_a_station_and_every_other_one_to_replenish(laid_out):
    request, layout = laid_out
    kinds = [station.kind for station in layout.plan.stations]
    assert kinds.count("PICK") == request.belts
    assert 1 <= kinds.count("REPLENISH") <= (request.belts + 1) // 2
    drops = layout.plan.cell_of(*layout.drops.T).tolist()
    assert [s.service_cell for s in layout.plan.stations if s.kind == "PICK"] == drops


def test_storage_places_are_filled_to_a_share(laid_out):
    request, layout = laid_out
    assert layout.plan.storage.sum() == len(layout.places) == -(-request.shelves * 20 // 17)
    assert layout.plan.storage.flat[layout.plan.cell_of(*layout.units.T)].all()
    assert layout.plan.parking.flat[layout.plan.cell_of(*layout.robots[:, :2].T)].all()


def test_lanes_are_driven_from_the_entry_to_the_exit_alone(laid_out):
    floor = laid_out[1].plan
    edges = floor.floor().edges()
    for station in floor.stations:
        assert len(station.queue) >= 5
        inside = set(station.cells.tolist())
        for cell, after in zip(station.cells, station.cells[1:]):
            assert [c for c in edges[cell] if c >= 0] == [after]
        into = [(c, t) for c in range(floor.passable.size) for t in edges[c] if t in inside]
        assert {t for c, t in into if c not in inside} == {station.cells[0]}
        assert inside.isdisjoint(edges[station.cells[-1]])
        # No robot turns where a unit is served.
        before, at, after = station.cells[station.service - 1 : station.service + 2]
        assert after - at == at - before
        if len(inside) > 1 and floor.passable.size > 3000:
            break  # one is like the other


def test_streets_of_neighbours_are_opposed():
    floor = plan(resolve("large")).plan
    edges = floor.floor().edges(loaded=True)
    streets = floor.passable & ~floor.storage & ~floor.parking & ~floor.lane
    one_way = sum(
        bool(a >= 0 and streets.flat[a] and c not in edges[a])
        for c in np.flatnonzero(streets)
        for a in edges[c]
    )
    ways = sum(bool(a >= 0 and streets.flat[a]) for c in np.flatnonzero(streets) for a in edges[c])
    assert one_way == ways


@pytest.mark.parametrize("preset", STATIONED)
def test_a_world_tells_its_floor_plan(preset):
    world = World.preset(preset)
    assert same(plan_reader.of_world(world), plan(resolve(preset)).plan)


def test_a_world_tells_its_elevators():
    """Names, cells and times, even or not."""
    file = layout_file.read(TWO_FLOORS)
    uneven = replace(file.elevators[0], name='up & "down"/2', seconds=((0.0, 12.5), (9.0, 0.0)))
    for elevators in (file.elevators, (uneven,)):
        laid = placement.place(replace(file, elevators=elevators))
        plan_there = plan_reader.of_world(World.of_layout(laid))
        assert plan_there.elevators == laid.plan.elevators
        assert np.array_equal(plan_there.tier, laid.plan.tier)
        assert plan_there.tier.max() == 1


@pytest.mark.parametrize(
    "label, cells",
    [
        ("elevator/lift/10", 1),
        ("elevator/lift/", 2),
        ("elevator/lift/-1", 2),
        ("elevator/lift/nan", 2),
        ("elevator/lift/1,2,3", 2),
        ("elevator/lift/fast", 3),
        ("elevator/", 2),
    ],
)
def test_a_marking_of_no_elevator_is_refused(label, cells):
    blank = plan(resolve("small")).plan
    x, y = blank.origin
    marks = [floor_markings.Mark(label, x + n, y, 1, 1) for n in range(cells)]
    with pytest.raises(FloorError, match=re.escape(f"'{label}' on {cells} cells: elevator/NAME/")):
        floor_markings.applied(blank, marks, {})


def test_a_restored_world_and_one_that_was_moved_tell_theirs():
    world, other = World.preset("small"), World()
    other.restore(world.checkpoint())
    known = plan_reader.of_world(world)
    assert same(plan_reader.of_world(other), known)

    marks = floor_markings.read(other.visuals("floor_markings1"), [3, -2, 0, 0, 0, 0, 1])
    assert {(m.x - 3, m.y + 2) for m in marks} == {
        (m.x, m.y)
        for m in floor_markings.read(other.visuals("floor_markings1"), [0, 0, 0, 0, 0, 0, 1])
    }


def test_markings_turn_with_what_they_mark():
    known = plan(resolve("small")).plan
    world = World()
    world.spawn(models.document([models.Part("marks", floor_markings.sdf(known))]))
    world.set_pose("floor_markings1", 0, 0, 0, np.pi / 2)
    turned = plan_reader.of_world(world)
    assert len(turned.stations) == len(known.stations)
    for was, now in zip(known.stations, turned.stations):
        x, y = known.point_of(was.cells)
        assert np.allclose(turned.point_of(now.cells), (-y, x))
    streets = np.flatnonzero(known.exits == 1)
    x, y = known.point_of(streets)
    assert (turned.exits.flat[turned.cell_of(-y, x)] == 2).all()


def with_short_cuts(folder):
    """The plan of an instance, on the grid of a world."""
    plan = read_floor(write_hall_instance(folder / "a.xinst")).plan
    return replace(plan, origin=(0.0, 0.0))


def test_short_cuts_are_painted_and_turn_with_the_rest(tmp_path):
    known = with_short_cuts(tmp_path)
    world = World()
    world.spawn(models.document([models.Part("marks", floor_markings.sdf(known))]))
    world.set_pose("floor_markings1", 0, 0, 0, np.pi / 2)
    turned = plan_reader.of_world(world)
    for was, now in zip(known.stations, turned.stations):
        x, y = known.point_of(np.array(was.short_cuts))
        there = turned.cell_of(-y, x).tolist()
        assert len(there) == 2 and sorted(now.short_cuts) == sorted(map(tuple, there))


@pytest.mark.parametrize("heading", ["+", "+z", "x"])
def test_a_painted_short_cut_without_a_heading_is_refused(tmp_path, heading):
    known = with_short_cuts(tmp_path)
    text = floor_markings.sdf(known)
    label = re.search(r"REPLENISH/replenish1/short_cut[-+]y", text)[0]
    text = text.replace(label, f"REPLENISH/replenish1/short_cut{heading}")
    world = World()
    world.spawn(models.document([models.Part("marks", text)]))
    with pytest.raises(FloorError, match="short_cut with one of .x, .y, -x, -y, to a cell of the"):
        plan_reader.of_world(world)


def test_a_warehouse_that_is_added_to_another_brings_its_floor_plan(tmp_path):
    """Adds a warehouse as insert_world does: under free numbers, its stations too."""
    marks = models.document([models.of_layout(plan(resolve("small")))[1]])
    world, file = World(), tmp_path / "more.sdf"
    world.spawn(marks)
    file.write_text(marks)
    world.spawn(insertable(file, world.names).xml)
    world.set_pose("floor_markings2", 30, 20)
    names = [station.name for station in plan_reader.of_world(world).stations]
    assert names == ["pick1", "pick2", "replenish1", "pick3", "pick4", "replenish2"]


def test_cells_and_points():
    floor = plan(resolve("small")).plan
    cells = np.arange(floor.passable.size)
    assert np.array_equal(floor.cell_of(*floor.point_of(cells)), cells)
    assert floor.cell_of(1e3, 0) == -1
    assert floor.cell_of(*floor.origin) == 0


def test_a_street_that_is_closed_is_named():
    world = World.preset("small")
    known = plan_reader.of_world(world)
    known.check()
    x, y = known.point_of(known.width * 3 + 4)  # on the street between two rows of blocks
    world.spawn_model("wall", "wall1", x, y)
    with pytest.raises(FloorError, match=r"no loaded robot .*\("):
        plan_reader.of_world(world).check()


def test_what_stands_in_a_lane_is_in_the_way_and_the_lane_stays():
    world = World.preset("small")
    known = plan_reader.of_world(world)
    cell = int(known.station("pick1").cells[2])
    world.spawn_model("person", "person1", *known.point_of(cell))
    plan = plan_reader.of_world(world)
    assert same(plan, known)
    assert plan.obstructed.flat[cell]
    plan.check(obstructed=False)
    with pytest.raises(FloorError, match="something stands at"):
        plan.check()


def unmarked(size, belt=(7, 7), taken=()):
    """A square floor with a belt on that cell and the next one along x, x and y from 0 on."""
    occupancy = np.zeros((size, size), np.uint8)
    x, y = belt
    occupancy[y, x : x + 2] = 99
    for i, j in taken:
        occupancy[j, i] = 100
    belts = {"conveyor_belt1": (x + 0.5, y)}
    return plan_reader.of_parts(0, 0, 1, occupancy, [], belts)


def test_a_belt_on_a_floor_without_markings_gets_a_lane():
    plan = unmarked(16, taken=[(0, 3), (1, 4), (5, 2)])
    (station,) = plan.stations
    assert (station.kind, station.belt, plan.without_lane) == ("PICK", "conveyor_belt1", ())
    x, y = plan.point_of(station.service_cell)
    assert abs(x - 7.5) + abs(y - 7) <= 2  # beside the belt
    plan.check()
    assert plan.parking.flat[plan.cell_of(0, 4)]  # in a niche without a way through


def test_a_belt_without_room_says_which_cells_a_lane_lacks():
    plan = unmarked(6, belt=(2, 2))
    assert plan.stations == ()
    (reason,) = plan.without_lane
    assert reason.startswith("conveyor_belt1 at (2.5, 2) has no lane: it would need (")


@pytest.mark.parametrize(
    ("link", "size", "at", "message"),
    [
        ("PICK/a/queue", "1 1", "0 0", "one cell of service"),
        ("canteen", "1 1", "0 0", "'canteen'"),
        ("storage", "3 1", "500 0", "off the floor"),
    ],
)
def test_wrong_markings_are_refused(link, size, at, message):
    world = World()
    world.spawn(
        f'<sdf version="1.9"><world name="w"><model name="floor_markings"><static>1</static>'
        f'<link name="{link}"><visual name="v"><pose>{at} 0 0 0 0</pose><geometry><box><size>{size}'
        " 0.01</size></box></geometry></visual></link></model></world></sdf>"
    )
    with pytest.raises(FloorError, match=message):
        plan_reader.of_world(world)


def test_a_fleet_delivers_to_every_station_and_waits_in_lanes_without_turning():
    """Loaded robots, four a station, drive through the lanes, are served for 10 ticks, and home."""
    floor, hold = plan(resolve("medium")).plan, 10
    homes = np.flatnonzero(floor.storage)[::7][: 4 * len(floor.stations)].astype(np.int32)
    services = np.tile([s.service_cell for s in floor.stations], 4).astype(np.int32)
    ahead = {
        int(cell): floor.floor().edges()[cell].tolist().index(after)
        for s in floor.stations
        for cell, after in zip(s.cells, s.cells[1:])
    }
    cell, heading, goal = homes.copy(), np.zeros(len(homes), np.uint8), services.copy()
    served, needless = np.zeros(len(homes), int), []
    planner = epibt(floor.floor(), Rules(following=False), seed=1)
    steps = np.array([1, floor.width, -1, -floor.width], np.int32)
    for _ in range(800):
        waits = np.where((cell == services) & (served > 0) & (served < hold), 0, 0xFF)
        fleet = Fleet(
            cell,
            heading,
            goal,
            loaded=np.ones(len(cell), np.uint8),
            home=homes,
            committed=np.repeat(waits[:, None], 4, axis=1).astype(np.uint8),
        )
        action = planner.plan(fleet)[:, 0]
        needless += [
            int(c) for c, h, a in zip(cell, heading, action) if a > 1 and ahead.get(int(c)) == h
        ]
        cell = np.where(action == 1, cell + steps[heading], cell).astype(np.int32)
        heading = ((heading + np.array([0, 0, 1, 3], np.uint8)[action]) & 3).astype(np.uint8)
        served += cell == services
        goal = np.where(served >= hold, homes, goal).astype(np.int32)
        if (served >= hold).all() and (cell == homes).all():
            break
    assert (cell == homes).all() and (served >= hold).all()
    assert needless == []


def test_a_floor_with_more_marks_than_a_model_holds_is_marked_by_several(monkeypatch):
    monkeypatch.setattr(floor_markings, "MOST_MARKS", 30)
    world = World.preset("small")
    assert [name for name in world.names if floor_markings.is_name(name)] == [
        f"floor_markings{n}" for n in (1, 2, 3)
    ]
    assert same(plan_reader.of_world(world), plan(resolve("small")).plan)
