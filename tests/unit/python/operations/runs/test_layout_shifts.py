# SPDX-License-Identifier: Apache-2.0
"""Shifts in warehouses of layout files: stations, policies and stock are those of the file."""

import threading
from dataclasses import replace
from pathlib import Path

import pytest
from paths import ROOT

from warehouse_layout.file import layout_file
from warehouse_layout.file.layout_file import LayoutFileError
from warehouse_layout.place import file_check
from warehouse_operations.runs import run_files as runs
from warehouse_operations.runs import simulation, sweep
from warehouse_operations.runs.rawsim import InstanceError
from warehouse_operations.runs.simulation import Description, open_operations, simulate
from warehouse_operations.runs.sweep import SweepError
from warehouse_operations.store.locks import InUseError

NORTH = str(ROOT / "tests" / "layouts" / "north.layout.yaml")


def opened(**options):
    return open_operations(Description(size="", physics=False, **options))


def test_the_file_says_how_stations_work():
    with opened(layout=NORTH, orders="none") as ops:
        pick, refill = (ops.shift.station(name) for name in ("pick1", "refill"))
        assert (pick.capacity, pick.seconds_a_piece, pick.pick_seconds) == (5, 4.0, 2.0)
        assert refill.seconds_a_bundle == 6.0


def test_a_station_of_both_kinds_has_pickers_and_hours(tmp_path):
    text = Path(NORTH).read_text(encoding="utf-8").replace("{stock: north.csv}", "40")
    settings = "name: pick1, kind: both, pickers: 2, seconds_a_line: 3, hours: [[0, 1.5]],"
    assert "name: pick1, kind: pick," in text
    path = tmp_path / "both.layout.yaml"
    path.write_text(text.replace("name: pick1, kind: pick,", settings), encoding="utf-8")
    with opened(layout=str(path), orders="none") as ops:
        station = ops.shift.station("pick1")
        assert (station.pickers, station.seconds_a_line) == (2, 3)
        assert station in ops.shift.picking.stations
        assert station in ops.shift.replenishing.stations
        ops.run(seconds=6000)
        assert not station.is_open


def test_the_stock_is_that_of_its_file():
    with opened(layout=NORTH, orders="none") as ops:
        bins = [(b.item, b.unit, b.sku, b.quantity) for b in ops.shift.inventory.bins.values()]
        assert bins == [
            ("item1", 1, "bolt", 20),
            ("item2", 2, "nut", 3),
            ("item3", 2, "nut", 30),
            ("item4", 3, "washer", 24),
            ("item5", 4, "screw", 24),
        ]
        assert ops.shift.inventory.available("nut") == 33
        assert ops.shift.assortment.skus == ("bolt", "nut", "washer", "screw")


def test_policies_that_are_told_win_over_those_of_the_file():
    assert Description(layout=NORTH).config["policies"]["orders"] == "random"
    policies = Description(layout=NORTH, policies={"orders": "pile-on"}).config["policies"]
    assert policies["orders"] == "pile-on"


def test_orders_are_picked_with_physics(tmp_path):
    description = Description(size="", layout=NORTH, seconds=300, orders="fill:20")
    run, faults = simulate(description, tmp_path)
    assert faults == []
    assert run.kpis["items_picked"] > 10 and run.kpis["robots"] == 3


def test_robots_and_open_stations_vary():
    with opened(layout="medium", robots=30, stations=2) as ops:
        picking = [station.is_open for station in ops.shift.picking.stations]
        assert picking == [True, True, False, False]
        ops.run(minutes=30)
        kpis = ops.kpis()
        assert (kpis["robots"], kpis["pick_stations"]) == (30, 2)
        assert kpis["items_picked"] > 100
        assert not any(s.visits for s in ops.shift.picking.stations[2:])
    for options, error, sentence in (
        ({"layout": NORTH, "robots": 99}, LayoutFileError, "99 robots, but there is room for 23"),
        ({"layout": NORTH, "stations": 2}, InstanceError, "stations is 2; north hall has 1"),
        ({"instance": "x", "robots": 2}, InstanceError, "robots: an instance has its own"),
        ({"layout": "nix.layout.yaml"}, LayoutFileError, "nix.layout.yaml: No such file"),
    ):
        with pytest.raises(error, match=sentence):
            opened(**options)


def test_a_sweep_varies_layouts_robots_and_stations(tmp_path):
    path = tmp_path / "sweep.yaml"
    text = (
        "physics: false\nminutes: 2\nseeds: 1\ngrid:\n"
        f"  layout: [{NORTH}, medium]\n  robots: [2, 4]\n  stations: [1]\n"
    )
    path.write_text(text)
    shifts = sweep.read(path)
    complete, failures = sweep.run_all(shifts, 2)
    assert failures == []
    assert [(r.config["site"], r.kpis["robots"], r.kpis["pick_stations"]) for r in complete] == [
        ("north hall", 2, 1),
        ("north hall", 4, 1),
        ("medium", 2, 1),
        ("medium", 4, 1),
    ]
    assert not shifts.done()[1]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("robots: 0", "robots is 0; a whole number above 0"),
        ("grid: {stations: [1.5]}", "stations is 1.5; a whole number above 0"),
        ("layout: nix.layout.yaml", "nix.layout.yaml: No such file"),
        ("layout: medium\nsize: small", "size and layout: only one of them was expected"),
    ],
)
def test_a_sweep_that_is_none_is_told(text, sentence, tmp_path):
    path = tmp_path / "sweep.yaml"
    path.write_text(text)
    with pytest.raises(SweepError, match=sentence):
        sweep.read(path)


def test_a_second_run_into_a_folder_leaves_the_first_alone(tmp_path):
    begun, end = threading.Event(), threading.Event()

    def progress(ops):
        begun.set()
        return end.wait(60)

    progress.end = lambda ops: None
    description = Description(size="", layout=NORTH, physics=False, seconds=36000)
    first = threading.Thread(target=simulate, args=(description, tmp_path, None, progress))
    first.start()
    assert begun.wait(60)
    with pytest.raises(InUseError, match=r"is in use by .* \(process \d+ on .*\), since \d+-"):
        simulate(description, tmp_path)
    end.set()
    first.join()
    assert runs.read(tmp_path).kpis["robots"] == 3
    assert InUseError in simulation.ERRORS


def test_a_step_from_which_robots_could_only_come_back_is_left_out(tmp_path):
    """What runs with bodies is what the check allows: it names the step."""
    text = Path(NORTH).read_text(encoding="utf-8").replace("{stock: north.csv}", "40")
    rows = text.rpartition("  #..................#\n")
    path = tmp_path / "one_way.layout.yaml"
    path.write_text(f"{rows[0]}  #^<<<<..<<<<.......#\n{rows[2]}", encoding="utf-8")
    assert file_check.faults(layout_file.read(path)) == []
    described = Description(size="", layout=str(path), seconds=600)
    (remark,) = simulation.remarks(described)
    assert remark.startswith(f"{path}: robots with bodies do not drive from [6, 1] to [7, 1], ")
    assert simulation.remarks(replace(described, physics=False)) == []
    with open_operations(described) as ops:
        assert ops.site.plan.exits[1, 6] & 1 and not ops.fleet.plan.exits[1, 6] & 1
    run, faults = simulate(described, tmp_path / "out")
    assert faults == [] and run.kpis["items_picked"] > 20
    assert [run.kpis[name] for name in ("collisions", "blocked", "watchdog")] == [0, 0, 0]


def test_ideal_robots_work_where_the_check_says_so(tmp_path):
    text = Path(NORTH).read_text(encoding="utf-8").replace("{stock: north.csv}", "40")
    path = tmp_path / "fine.layout.yaml"
    path.write_text(text.replace("spacing: 1.2", "spacing: 0.45"), encoding="utf-8")
    (fault,) = file_check.faults(layout_file.read(path))
    assert "Write 'spacing: 1.0', or simulate without physics: ideal robots work" in fault.text
    described = Description(size="", layout=str(path), physics=False, seconds=1800)
    assert simulation.remarks(described) == [f"{path}: {fault.text}"]
    run, _ = simulate(described, tmp_path / "out")
    assert run.kpis["items_picked"] > 50
    with pytest.raises(LayoutFileError, match="ideal robots work there as it is"):
        open_operations(Description(size="", layout=str(path), physics=True))
