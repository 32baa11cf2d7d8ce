# SPDX-License-Identifier: Apache-2.0
"""The program design: floors within buildings, its search, and what it writes."""

import csv
import subprocess
import sys

import numpy as np
import pytest
from paths import ROOT

from warehouse_layout.file import layout_file
from warehouse_layout.place import file_check
from warehouse_operations.design.building import Building, BuildingError, largest_rectangle
from warehouse_operations.design.plans import POLICIES, Space
from warehouse_operations.design.search import Candidate, front
from warehouse_operations.sizing.costs import Bill
from warehouse_operations.sizing.day import Day
from warehouse_operations.stock.orders_text import DayText

DESIGN = ROOT / "src" / "warehouse_operations" / "nodes" / "design"
CHOSEN = {
    "stations": 1, "robots": 2, "replenish": 1, "units": 14, "sides": 1, "depth": 2, "length": 4,
    "one_way": True, "policies": {"orders": "pile-on", "storage": "nearest"},
}  # fmt: skip


def space(building):
    return Space(building, Day(DayText("day", "x.csv"), [60.0, 120.0], 1.0), 12, POLICIES)


def building_of(lines):
    floor = layout_file.rows_of(lines)
    return Building(layout_file.LayoutFile(floor=floor, name="hall"))


def test_the_largest_rectangle():
    free = np.ones((6, 8), bool)
    free[:2, 3:] = False
    assert largest_rectangle(free) == (0, 2, 8, 4)
    assert largest_rectangle(np.zeros((2, 2), bool))[2] == 0


def test_a_floor_in_a_hall_passes_the_check():
    building = Building.read("36x26")
    file = space(building).file_of(CHOSEN)
    assert file is not None and not file_check.faults(file)
    assert file.floor.shape == (26, 36) and file.policies == CHOSEN["policies"]


def test_walls_and_pillars_stay():
    lines = ["#" * 40] + ["#" + "." * 38 + "#" for _ in range(28)] + ["#" * 40]
    lines[5] = "#" + "." * 15 + "#" + "." * 22 + "#"
    lines[9] = "#" * 12 + lines[9][12:]
    building = building_of(lines)
    file = space(building).file_of(CHOSEN)
    assert file is not None and not file_check.faults(file)
    walls = building.file.floor == "#"
    assert (file.floor[walls] == "#").all() and ((file.floor == "#") == walls).all()


def test_what_has_no_room_is_none():
    assert space(Building.read("10x10")).file_of(CHOSEN) is None
    with pytest.raises(BuildingError, match="WIDTHxHEIGHT"):
        Building.read("nowhere")
    with pytest.raises(BuildingError, match="edges of 8"):
        Building.read("2x90")


def test_the_front_has_what_nothing_beats():
    def candidate(number, late, buy, piece):
        return Candidate(number, CHOSEN, None, late, Bill(buy, 0, 0, piece, None, ""))

    judged = [
        candidate(1, 0.0, 100, 0.3), candidate(2, 0.0, 90, 0.4), candidate(3, 0.0, 110, 0.35),
        candidate(4, 0.5, 10, 0.1),
    ]  # fmt: skip
    assert [each.number for each in front(judged, 0.01)] == [1, 2]
    assert [each.number for each in front(judged[3:], 0.01)] == [4]


def test_design_finds_a_layout_and_goes_on(tmp_path):
    sys.path.append(str(ROOT / ".venv/lib" / f"python3.{sys.version_info.minor}" / "site-packages"))
    pytest.importorskip("optuna", reason="run scripts/learning_packages")
    rng = np.random.default_rng(1)
    rows = [f"o{i},part-{rng.integers(12)},1,{rng.integers(3600)}," for i in range(40)]
    day, money = tmp_path / "day.csv", tmp_path / "costs.yaml"
    day.write_text("reference,sku,quantity,at,due\n" + "\n".join(rows) + "\n")
    money.write_text("robot: {price: 20000}\nstation: {price: 40000}\nperson_hour: 28\n")
    command = [sys.executable, DESIGN, "--building", "36x26", "--demand", day, "--costs", money]
    command += ["--late", "5%", "--cpu-hours", "0.003", "--out", tmp_path / "out"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    text = (tmp_path / "out" / "front.csv").read_text()
    rows = list(csv.DictReader(text.splitlines()))
    assert rows and float(rows[0]["late %"]) <= 5
    for name in ["best.layout.yaml", *(row["layout"] for row in rows)]:
        assert not file_check.faults(layout_file.read(tmp_path / "out" / name))
    assert "<svg" in (tmp_path / "out" / "report.html").read_text()
    again = subprocess.run(
        [*command, "--processes", "1"], capture_output=True, text=True, check=False
    )
    assert " 0 of them simulated in this run" in again.stdout
    assert (tmp_path / "out" / "front.csv").read_text() == text
    wrong = subprocess.run(
        [*command, "--building", "x"], capture_output=True, text=True, check=False
    )
    assert wrong.returncode == 1 and "WIDTHxHEIGHT" in wrong.stderr
