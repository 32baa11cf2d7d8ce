# SPDX-License-Identifier: Apache-2.0
"""Halls of others: the warehouse stands inside, all of it is reached, and its fleet works."""

import numpy as np
import pytest
from paths import WORLDS

from kiva_plugin_cpp import World
from warehouse_fleet.hosts.fleet_driver import FleetDriver
from warehouse_fleet.hosts.random_transports import RandomTransports
from warehouse_layout.file.request import RequestError, resolve
from warehouse_layout.generate import rooms
from warehouse_layout.generate.cells import Cells
from warehouse_layout.generate.fit import fit, fit_largest
from warehouse_operations import Operations

# Where the walls are: x from, to, y from, to [m].
HALLS = {
    "hall_with_door": (8, 32, -6, 12),
    "hall_with_pillars": (-30, -6, -20, 4),
    "hall_of_two_rooms": (-20, 20, -3, 15),
    "narrow_room": (-40.7, -35.3, 20.3, 27.7),
}
SECONDS = 180.0


def file_of(hall):
    return WORLDS / f"{hall}.world"


def cells_of(hall):
    x, y, _, occupancy = World(file_of(hall)).occupancy()
    return Cells(round(x), round(y), np.asarray(occupancy).T >= 100)


def stands_inside(layout, hall):
    x0, x1, y0, y1 = HALLS[hall]
    points = np.concatenate([layout.robots[:, :2], layout.units, layout.belts[:, :2]])
    x, y = points.T
    return bool(((x > x0) & (x < x1) & (y > y0) & (y < y1)).all())


def laid_out(hall, size):
    cells = cells_of(hall)
    return fit_largest(cells)[1] if size == "fit" else fit(resolve(size), cells)


FITTING = [(hall, "fit") for hall in HALLS] + [(h, "small") for h in HALLS if h != "narrow_room"]


@pytest.mark.parametrize(("hall", "size"), FITTING)
def test_the_fleet_works_in_it_without_contact(hall, size):
    layout = laid_out(hall, size)
    assert stands_inside(layout, hall), layout.where
    assert "in the room of" in layout.where
    layout.plan.check()
    driver = FleetDriver(World.of_layout(layout, world=file_of(hall)))
    work = RandomTransports(driver.transports)
    while driver.time < SECONDS:
        driver.step()
        work.advance(driver.time, driver.transports.take_events())
    driver.close()
    totals = driver.transports.totals
    stations = sum(station.kind == "PICK" for station in layout.plan.stations)
    assert totals.delivered >= 2 * stations
    assert (totals.failed, driver.collisions, driver.refusals) == (0, 0, [])
    assert driver.watchdog == 0


WALL = '<collision name="{name}"><pose>{x} {y} 1.5 0 0 {yaw}</pose><geometry><box>\
<size>{length} 0.2 3</size></box></geometry></collision>'


def walls_with_gates(yaw, gap):
    """A hall of 34 x 26 m around (5, 3), turned by yaw [rad], with a gate in each wall."""
    walls = []
    for quarter, (far, length) in enumerate([(13, 34), (17, 26)] * 2):
        half = (length - gap) / 2
        for along in ((gap + half) / 2, -(gap + half) / 2):
            turn = yaw + quarter * np.pi / 2
            x = 5 + along * np.cos(turn) - far * np.sin(turn)
            y = 3 + along * np.sin(turn) + far * np.cos(turn)
            name = f"wall{len(walls)}"
            walls.append(WALL.format(name=name, x=x, y=y, yaw=turn, length=half))
    return f"""<sdf version="1.6"><world name="default">
      <include><uri>model://ground_plane</uri></include>
      <model name="hall"><static>true</static><link name="link">{"".join(walls)}</link></model>
    </world></sdf>"""


@pytest.mark.parametrize("yaw", [0.0, 0.3, 0.785, 1.2])
@pytest.mark.parametrize("gap", [2.0, 2.5])
def test_a_hall_with_gates_is_a_room_however_it_is_turned(tmp_path, yaw, gap):
    path = tmp_path / "hall.world"
    path.write_text(walls_with_gates(yaw, gap))
    x, y, _, occupancy = World(path).occupancy()
    layout = fit(resolve("small"), Cells(round(x), round(y), np.asarray(occupancy).T >= 100))
    points = np.concatenate([layout.robots[:, :2], layout.units, layout.belts[:, :2]]) - (5, 3)
    along = points @ (np.cos(yaw), np.sin(yaw))
    across = points @ (-np.sin(yaw), np.cos(yaw))
    assert (abs(along) < 17).all() and (abs(across) < 13).all(), layout.where


@pytest.mark.parametrize("hall", HALLS)
def test_a_shift_works_in_it(hall):
    world = World.of_layout(laid_out(hall, "fit"), world=file_of(hall))
    with Operations(world, orders="fill", seed=1) as operations:
        operations.run(seconds=SECONDS)
        assert operations.kpis()["items_picked"] > 0
        assert operations.kpis()["collisions"] == 0
        assert operations.fleet.stuck == 0


def test_what_does_not_fit_is_refused_with_what_does():
    with pytest.raises(RequestError) as refused:
        laid_out("narrow_room", "small")
    largest, _ = fit_largest(cells_of("narrow_room"))
    assert (largest.robots, largest.belts) == (3, 1)
    assert largest.shelves >= 10
    assert "in the room of 34 free cells from (-40, 21) to (-36, 27)" in str(refused.value)
    offer = f"{largest.robots} robots, {largest.shelves} storage units fit: size:=fit takes that"
    assert offer in str(refused.value)


def test_its_stations_have_no_queue_where_there_is_no_room_for_one():
    layout = laid_out("narrow_room", "fit")
    assert [len(station.queue) for station in layout.plan.stations] == [0, 0]
    assert [station.kind for station in layout.plan.stations] == ["PICK", "REPLENISH"]


@pytest.mark.parametrize("hall", HALLS)
def test_a_point_outside_is_the_plain(hall):
    layout = fit(resolve("small"), cells_of(hall), at=(-5, 30))
    middle = layout.units.mean(0)
    assert not stands_inside(layout, hall)
    assert np.hypot(*(middle - (-5, 30))) < 5
    assert "on the open floor" in layout.where


def test_a_point_is_in_the_room_that_it_is_near():
    layout = fit(resolve("small"), cells_of("hall_with_door"), at=(8, 0))  # in the wall
    assert stands_inside(layout, "hall_with_door") == ("in the room" in layout.where)
    with pytest.raises(RequestError, match=r"at:=300,0: no cell is free within 5 m of it"):
        fit(resolve("small"), cells_of("hall_with_door"), at=(300, 0))


def walled(size, x0, x1, y0, y1, doors=()):
    """Free cells of a plain with a building of thin walls."""
    free = np.ones((size, size), bool)
    free[x0, y0 : y1 + 1] = free[x1, y0 : y1 + 1] = False
    free[x0 : x1 + 1, y0] = free[x0 : x1 + 1, y1] = False
    for door in doors:
        free[door] = True
    return free


@pytest.mark.parametrize("width", [0, 1, 2, 3])
def test_doors_do_not_make_a_room_outside(width):
    free = walled(80, 20, 50, 30, 50, [(slice(40, 40 + width), 30)])
    (room,) = rooms.find(free)
    assert 29 * 19 <= room.sum() <= 29 * 19 + width
    assert room[21:50, 31:50].all()


def test_where_a_side_is_open_is_no_room():
    assert rooms.find(walled(80, 20, 50, 30, 50, [(slice(21, 50), 30)])) == []
    assert rooms.find(np.ones((30, 30), bool)) == []


def test_pillars_alone_make_no_room():
    free = np.ones((60, 60), bool)
    free[4::4, 4::4] = False
    assert rooms.find(free) == []
    crowd = np.random.default_rng(1).random((90, 90)) > 0.08
    assert rooms.find(crowd) == []


def test_the_largest_of_two_buildings_comes_first():
    free = walled(80, 20, 50, 30, 50, [(40, 30)]) & walled(80, 60, 70, 5, 20, [(60, 10)])
    large, less = rooms.find(free)
    assert large.sum() > less.sum() >= 9 * 14
    assert not (large & less).any()
