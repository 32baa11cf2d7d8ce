# SPDX-License-Identifier: Apache-2.0
"""The program design: floors within buildings, its search, and what it writes."""

import csv
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from paths import ROOT

from warehouse_layout.file import layout_file
from warehouse_layout.place import file_check
from warehouse_operations.design.building import Building, BuildingError, rectangles
from warehouse_operations.design.candidate import Candidate, Judge, front
from warehouse_operations.design.plans import OUTLINE, POLICIES, Space
from warehouse_operations.design.search import HOPELESS, UNSEEN, Search, _mixed
from warehouse_operations.sizing.costs import Bill, Costs, Thing
from warehouse_operations.sizing.day import Day
from warehouse_operations.stock.orders_text import DayText

DESIGN = ROOT / "src" / "warehouse_operations" / "nodes" / "design"
DAY = Day(DayText("day", "x.csv"), [60.0, 120.0], 1.0)


def space(building):
    return Space(building, DAY, 12, POLICIES)


def chosen(building, **parameters):
    usual = space(building).usual()
    return (
        usual | {"stations": 1, "robots": 2, "replenish": 1, "units": 14, "length": 4} | parameters
    )


def building_of(lines):
    floor = layout_file.rows_of(lines)
    return Building(layout_file.LayoutFile(floor=floor, name="hall"))


def an_l():
    lines = ["#" * 50] + ["#" + "." * 26 + "#" * 23] * 18 + ["#" + "." * 48 + "#"] * 18 + ["#" * 50]
    return building_of(lines)


def test_rectangles_of_free_cells():
    free = np.ones((6, 8), bool)
    free[:2, 3:] = False
    assert {(0, 2, 8, 4), (0, 0, 3, 6)} <= rectangles(free)
    assert max(width * height for _, _, width, height in rectangles(free)) == 32
    assert not any(width * height for _, _, width, height in rectangles(np.zeros((2, 2), bool)))


def test_an_l_has_a_room_in_each_arm():
    assert sorted(an_l().rooms) == [(1, 1, 26, 36), (1, 1, 48, 18)]
    assert Building.read("36x26").rooms == [(0, 0, 36, 26)]


def test_a_floor_in_a_hall_passes_the_check():
    building = Building.read("36x26")
    file = space(building).file_of(chosen(building))
    assert file is not None and not file_check.faults(file)
    assert file.floor.shape == (26, 36)
    assert file.policies["orders"] == "pile-on" and set(file.policies) == set(POLICIES)


@pytest.mark.parametrize("shift", [0, 5, 13])
def test_streets_follow_an_outline(shift):
    building = an_l()
    file = space(building).file_of(chosen(building, plan=OUTLINE, shift=shift))
    assert file is not None and not file_check.faults(file)
    walls = building.file.floor == "#"
    assert ((file.floor == "#") == walls).all()
    streets = np.argwhere(file.floor == ".")
    assert streets[:, 1].max() > 27 and streets[:, 0].max() > 19, "they are in one arm alone"


def test_stations_that_replenish_are_none_where_picking_ones_put_in():
    building = Building.read("40x30")
    for plan in ("blocks", OUTLINE):
        both = space(building).file_of(chosen(building, plan=plan, replenish=0, stations=2))
        assert [station.kind for station in both.stations] == ["both"] * 2
        apart = space(building).file_of(chosen(building, plan=plan))
        assert sorted(station.kind for station in apart.stations) == ["pick", "replenish"]
        assert (both.floor == "=").sum() == 4 and (apart.floor == "=").sum() == 2


def test_side_lane_parking_and_aspect_are_varied():
    building = Building.read("60x60")

    def of(**parameters):
        file = space(building).file_of(chosen(building, robots=6, **parameters))
        assert file is not None and not file_check.faults(file)
        return file

    def far(file, character):
        belt = np.argwhere(file.floor == "=").mean(0)
        return np.abs(np.argwhere(np.isin(file.floor, list(character))) - belt).sum(1).mean()

    usual = of()
    rows, columns = np.nonzero(usual.floor == "=")
    assert columns.mean() > np.nonzero(usual.floor == "s")[1].max()
    above = of(first_side=1)
    assert np.nonzero(above.floor == "=")[0].mean() > np.nonzero(above.floor == "s")[0].max()
    queue = len(usual.stations[0].queue)
    assert len(of(more_queue=-2).stations[0].queue) == queue - 2
    assert len(of(more_queue=2).stations[0].queue) == queue + 2
    near = of(parking="near")
    assert far(near, "pc") < far(usual, "pc") and far(near, "s") > far(usual, "s")
    wide, tall = of(aspect="wide", units=40), of(aspect="tall", units=40)
    used = [np.ptp(np.argwhere(file.floor != "x"), axis=0) for file in (wide, tall)]
    assert used[0][1] / used[0][0] > used[1][1] / used[1][0]


@pytest.mark.parametrize("plan", ["blocks", OUTLINE])
def test_walls_and_pillars_stay(plan):
    lines = ["#" * 40] + ["#" + "." * 38 + "#" for _ in range(28)] + ["#" * 40]
    lines[5] = "#" + "." * 15 + "#" + "." * 22 + "#"
    lines[9] = "#" * 12 + lines[9][12:]
    building = building_of(lines)
    file = space(building).file_of(chosen(building, plan=plan))
    assert file is not None and not file_check.faults(file)
    walls = building.file.floor == "#"
    assert (file.floor[walls] == "#").all() and ((file.floor == "#") == walls).all()


def test_neighbours_cost_less_or_more():
    building, rng = Building.read("40x30"), np.random.default_rng(1)
    near = space(building)
    middle = chosen(building, stations=2, robots=10, units=20)
    for cheaper, side in ((True, -1), (False, 1)):
        for _ in range(50):
            other = near.neighbour(middle, rng, cheaper)
            counts = [other[name] - middle[name] for name in ("stations", "replenish", "units")]
            robots = other["robots"] - middle["robots"]
            assert all(side * delta >= 0 for delta in counts)
            assert side * robots >= 0 or counts[0] == -1
            changed = [name for name in other if other[name] != middle[name]]
            assert len(changed) <= 4
            for name, value in other.items():
                assert value in near.parameters[name]


def test_parameters_without_effect_are_the_same_layout():
    near = space(an_l())
    outline = chosen(an_l(), plan=OUTLINE)
    assert near.known_as(outline) == near.known_as(outline | {"sides": 3, "length": 9})
    assert near.known_as(outline) != near.known_as(outline | {"shift": 3})
    blocks = chosen(an_l())
    assert near.known_as(blocks) == near.known_as(blocks | {"shift": 3})


def test_whole_days_are_for_stations_that_can_do():
    def candidate(number, stations, robots, late=0.0, **policies):
        parts = chosen(
            hall, stations=stations, replenish=0, robots=robots, units=20 + number, **policies
        )
        return Candidate(number, parts, None, late, Bill(number, 0, 0, number, None, ""))

    hall = Building.read("40x30")
    search = Search(space(hall), Costs(), 0.01, None, None)
    queue = [candidate(i, 1, 4 + i) for i in range(5)] + [candidate(9, 2, 4)]
    assert [each.number for each in _mixed(queue)] == [0, 1, 9]

    def judged(*days):
        search._days = {str(each.chosen): each for each in days}
        return [each.number for each in queue if search._is_able(each)]

    assert judged() == [0, 1, 2, 3, 4, 9]
    assert judged(candidate(11, 1, 5, 0.5)) == [2, 3, 4, 9], "as few robots as were late"
    assert judged(candidate(11, 1, 6, 0.5), candidate(12, 1, 7)) == [0, 1, 2, 3, 4, 9]
    other = candidate(11, 1, 8, 0.5, policy_orders="due date")
    assert judged(other) == [0, 1, 2, 3, 4, 9], "these have other policies"
    late = [candidate(11 + i, 1, 3, 0.5) for i in range(HOPELESS)]
    assert judged(*late) == [9]


def test_bills_have_the_layouts_stations_and_the_buildings_floor():
    building = Building.read("40x30")
    things = {"robot": Thing(10.0), "station": Thing(100.0), "replenish_station": Thing(1000.0)}
    judge = Judge(Costs(things), DAY, 0.01, building.file)
    apart = judge.bill(space(building).file_of(chosen(building)))
    both = judge.bill(space(building).file_of(chosen(building, replenish=0)))
    assert (apart.to_buy, both.to_buy) == (1120.0, 120.0)
    assert both.a_piece < apart.a_piece < judge.bill(
        space(building).file_of(chosen(building)), late=0.5
    ).a_piece  # fmt: skip


def test_what_has_no_room_is_none():
    small = Building.read("10x10")
    for plan in ("blocks", OUTLINE):
        assert space(small).file_of(chosen(small, plan=plan)) is None
    with pytest.raises(BuildingError, match="WIDTHxHEIGHT"):
        Building.read("nowhere")
    with pytest.raises(BuildingError, match="edges of 8"):
        Building.read("2x90")


def test_the_front_has_what_nothing_beats():
    def candidate(number, late, buy, piece):
        return Candidate(number, {}, None, late, Bill(buy, 0, 0, piece, None, ""))

    judged = [
        candidate(1, 0.0, 100, 0.3), candidate(2, 0.0, 90, 0.4), candidate(3, 0.0, 110, 0.35),
        candidate(4, 0.5, 10, 0.1),
    ]  # fmt: skip
    assert [each.number for each in front(judged, 0.01)] == [1, 2]
    assert [each.number for each in front(judged[3:], 0.01)] == [4]


@pytest.fixture(name="command")
def _command(tmp_path):
    """The program with a building, a small day and what it costs; without --out."""
    sys.path.append(str(ROOT / ".venv/lib" / f"python3.{sys.version_info.minor}" / "site-packages"))
    pytest.importorskip("optuna", reason="run scripts/learning_packages")
    rng = np.random.default_rng(1)
    rows = [f"o{i},part-{rng.integers(12)},1,{rng.integers(3600)}," for i in range(40)]
    day, money = tmp_path / "day.csv", tmp_path / "costs.yaml"
    day.write_text("reference,sku,quantity,at,due\n" + "\n".join(rows) + "\n")
    money.write_text("robot: {price: 20000}\nstation: {price: 40000}\nperson_hour: 28\n")
    command = [sys.executable, DESIGN, "--building", "36x26", "--demand", day, "--costs", money]
    return [*command, "--late", "5%", "--cpu-hours", "0.0002"]


def run(command, *more):
    return subprocess.run([*command, *more], capture_output=True, text=True, check=False)


def rows_of(folder):
    return list(csv.DictReader((folder / "front.csv").read_text().splitlines()))


def test_design_finds_a_layout_and_goes_on(command, tmp_path):
    out = tmp_path / "out"
    done = run(command, "--physics", "0.02", "--out", out)
    assert done.returncode == 0, done.stderr
    assert f"On {len(UNSEEN)} days that the search did not see" in done.stdout
    assert "Simulated robots have 0 contacts" in done.stdout
    rows = rows_of(out)
    assert rows and float(rows[0]["late %"]) <= 5 and float(rows[0]["± cost"]) >= 0
    assert all(row["contacts"] == "0" for row in rows)
    for name in ["best.layout.yaml", *(row["layout"] for row in rows)]:
        assert not file_check.faults(layout_file.read(out / name))
    assert "<svg" in (out / "report.html").read_text()
    text = (out / "front.csv").read_text()
    again = run(command, "--physics", "0.02", "--processes", "1", "--out", out)
    assert " 0 of them simulated in this run" in again.stdout
    assert (out / "front.csv").read_text() == text
    wrong = run(command, "--building", "x", "--out", out)
    assert wrong.returncode == 1 and "WIDTHxHEIGHT" in wrong.stderr


@pytest.mark.parametrize("method", [[], ["--random"]])
def test_one_process_and_two_find_the_same_front(command, tmp_path, method):
    for processes in ("1", "2"):
        out = tmp_path / processes
        done = run(command, *method, "--no-physics", "--processes", processes, "--out", out)
        assert done.returncode == 0, done.stderr
    first, second = ((tmp_path / processes / "front.csv").read_text() for processes in ("1", "2"))
    assert first == second
    assert all(row["contacts"] == "" for row in rows_of(tmp_path / "1"))


def test_ray_finds_the_same_front(command, tmp_path):
    pytest.importorskip("ray", reason="pip install ray")
    for name, more in (("ray", ["--ray"]), ("here", ["--processes", "1"])):
        done = run(command, "--no-physics", *more, "--out", tmp_path / name)
        assert done.returncode == 0, done.stderr
    texts = [(tmp_path / name / "front.csv").read_text() for name in ("ray", "here")]
    assert texts[0] == texts[1]


def test_ctrl_c_ends_it_and_it_goes_on(command, tmp_path):
    out = tmp_path / "out"
    more = ["--no-physics", "--cpu-hours", "0.1", "--processes", "1", "--out", out]
    program = subprocess.Popen([*command, *more], stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 120
    while not list(out.glob("points/*.json")) and time.monotonic() < deadline:
        time.sleep(0.1)
    program.send_signal(signal.SIGINT)
    _, said = program.communicate(timeout=60)
    assert program.returncode == 130
    assert "it goes on from" in said and "Traceback" not in said
