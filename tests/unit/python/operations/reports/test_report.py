# SPDX-License-Identifier: Apache-2.0
"""What simulate, report, check and sweep write and say."""

import base64
import contextlib
import csv
import json
import re
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from instance_file import write_instance
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from paths import ROOT

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_operations import Settings
from warehouse_operations.document import canvas
from warehouse_operations.reports import bar_charts, charts, comparison, report
from warehouse_operations.runs import run_files as runs
from warehouse_operations.runs import sweep
from warehouse_operations.runs.simulation import Description, simulate
from warehouse_operations.shift.kpis import upper_bound

SOURCES = ROOT / "src"
KPIS = re.findall(
    r"\w+",
    "simulated_s, wall_s, real_time_factor, robots, pick_stations, replenish_stations, "
    "items_picked, lines_picked, orders_completed, bundles_stored, item_throughput_per_hour, "
    "order_throughput_per_hour, item_upper_bound_per_hour, item_score, pile_on, "
    "station_idle_fraction, order_turnover_s, order_throughput_s, late_orders_fraction, "
    "distance_m, distance_per_item_m, trips, collisions, blocked, watchdog, plan_ms, "
    "executed_over_planned, state_hash ",
)


def program(name):
    package = "warehouse_viewer" if name == "simulate" else "warehouse_operations"
    return SOURCES / package / "nodes" / name


def node(name, *arguments, **options):
    return subprocess.run(
        [sys.executable, program(name), *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
        **options,
    )


@pytest.fixture
def instance(tmp_path):
    return write_instance(tmp_path / "small.xinst", bots=3, picking=1, replenishing=1, rows=3)


def test_the_upper_bound_of_a_station():
    assert upper_bound(3.0, Settings(), Kinematics()) == 360
    # p * 3600 / (in + turn + out + pick - transfer + p * transfer)
    quick = Settings(piece_s=4.0, pick_s=3.0)
    assert upper_bound(2.0, quick, Kinematics()) == pytest.approx(7200 / (4.625 - 1 + 8))
    # Slower than it accelerates: a cell takes more than two ramps.
    slow = Kinematics(speed=0.5)
    expected = 7200 / (2 * 2.5 + 0.625 - 1 + 8)
    assert upper_bound(2.0, quick, slow) == pytest.approx(expected)


def test_simulate_check_and_report(tmp_path, instance, monkeypatch):
    out = tmp_path / "out"
    common = ("--instance", instance, "--no-physics", "--minutes", 20)
    done = node("simulate", *common, "--seed", 7, "--out", out)
    assert done.returncode == 0, done.stderr
    assert "0:20:00 of 0:20:00" in done.stderr and "x real time" in done.stderr
    assert "Pieces picked an hour" in done.stdout
    figures = json.loads((out / "kpis.json").read_text())
    assert list(figures) == KPIS
    assert all(
        list(figures[k]) == ["p25", "median", "p75", "p95"] for k in KPIS if k.endswith("t_s")
    )
    assert figures["simulated_s"] == 1200 and figures["items_picked"] > 80
    page = (out / "report.html").read_text()
    assert page.count("<svg") >= 6 and not re.search(r'(src|href)="(?!#|data:)', page)
    again = node("simulate", *common, "--seed", 7, "--out", tmp_path / "again")
    assert again.returncode == 0
    assert (
        json.loads((tmp_path / "again" / "kpis.json").read_text())["state_hash"]
        == (figures["state_hash"])
    )

    assert node("check", out / "run.db").stdout.endswith("everything balances\n")
    with contextlib.closing(sqlite3.connect(out / "run.db")) as database:
        database.execute("UPDATE bin SET quantity = quantity + 1 WHERE id = 1")
        database.commit()
    checked = node("check", out / "run.db")
    assert checked.returncode == 1 and "its moves add up to" in checked.stderr

    compared = node("report", out, tmp_path / "again", "--out", tmp_path / "both.html")
    assert compared.returncode == 0 and (tmp_path / "both.html").exists()
    assert node("report", tmp_path / "nothing").stderr.startswith("report: ")

    # Without --out none of what is there is written over.
    path = tmp_path / "comparison.html"
    path.write_text("kept")
    compared = node("report", out, tmp_path / "again", cwd=tmp_path)
    assert compared.stdout.splitlines()[-1] == "comparison-2.html", compared.stderr
    assert "<svg" in (tmp_path / "comparison-2.html").read_text() and path.read_text() == "kept"
    monkeypatch.chdir(out)
    assert report.default_path([out, tmp_path / "again"]) == Path("comparison.html")
    assert (out / "report.html").read_text() == page


@pytest.mark.long
def test_without_a_folder_no_run_is_written_over(tmp_path, instance):
    common = ("--instance", instance, "--no-physics", "--minutes", 2)
    done = node("simulate", *common, cwd=tmp_path)
    assert done.returncode == 0 and "writes into" not in done.stderr, done.stderr
    before = {path: path.read_bytes() for path in (tmp_path / "shift").iterdir()}
    for name in ("shift-2", "shift-3"):
        done = node("simulate", *common, "--seed", 2, cwd=tmp_path)
        assert f"simulate: shift/ has a run; writes into {name}/\n" in done.stderr, done.stderr
        assert done.stdout.endswith(f"{name}/report.html\n")
        assert json.loads((tmp_path / name / "run.json").read_text())["seed"] == 2
    assert {path: path.read_bytes() for path in (tmp_path / "shift").iterdir()} == before
    (tmp_path / "shift-2" / "kpis.json").unlink()  # as of a shift that did not end
    done = node("simulate", *common, cwd=tmp_path)
    assert "simulate: shift/ has a run; writes into shift-4/\n" in done.stderr, done.stderr


def test_the_days_troubles_are_told_with_what_each_cost(tmp_path, instance):
    day = tmp_path / "day.yaml"
    day.write_text("failures: {per_robot_hour: 60, repair_time: 30}\nenergy: {capacity: 40}\n")
    out = tmp_path / "out"
    common = ("--instance", instance, "--realism", day, "--minutes", 3)
    assert node("simulate", *common, "--out", out).returncode == 0
    kpis, data = (json.loads((out / name).read_text()) for name in ("kpis.json", "run.json"))
    assert data["robot_h"] == pytest.approx(3 * 3 / 60, rel=0.01)
    down = sum(failure["down_h"] for failure in data["failures"])
    # Robots with two failures at once are down once.
    assert down >= (1 - kpis["availability"]) * data["robot_h"] > 0
    page = (out / "report.html").read_text()
    section = page[page.index("Troubles of the day") :]
    at_work = data["robot_h"] * (1 - kpis["charging_fraction"]) - down
    for failure in data["failures"]:
        pieces = kpis["items_picked"] * failure["down_h"] / at_work
        row = f">{failure['kind']}</th><td>{failure['count']}</td>.*?"
        row += f"<td>{failure['robot_h']:.2f}</td><td>{pieces:.0f}</td></tr>"
        assert re.search(row, section), row


def test_a_shift_that_goes_wrong_is_told(tmp_path, instance):
    for arguments, message in (
        (("--instance", tmp_path / "no.xinst"), "No such file"),
        (("--size", "vast", "--no-physics"), "'vast' is not a preset"),
        (("--instance", instance, "--no-physics", "--orders", "many"), "orders are 'many'"),
        (("--instance", instance, "--no-physics", "--policies", tmp_path / "p"), "No such file"),
    ):
        done = node("simulate", *arguments, "--minutes", 1, "--out", tmp_path / "out")
        assert done.returncode == 1 and message in done.stderr, done.stderr
        assert "Traceback" not in done.stderr


def test_a_shift_ends_early_with_its_report(tmp_path, instance):
    with subprocess.Popen(
        [
            sys.executable,
            program("simulate"),
            "--instance",
            instance,
            "--no-physics",
            "--hours",
            "900",
            "--out",
            tmp_path / "out",
        ],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    ) as running:
        database = tmp_path / "out" / "run.db"
        deadline = time.monotonic() + 60
        while not (database.exists() and database.stat().st_size > 100_000):
            assert time.monotonic() < deadline
            time.sleep(0.05)
        running.send_signal(signal.SIGINT)
        running.communicate(timeout=60)
    assert running.returncode == 130
    assert (tmp_path / "out" / "report.html").exists()


SWEEP = """
out: results
instance: small.xinst
minutes: 20
physics: false
seeds: 4
grid: {policies.orders: [random, pile-on]}
"""


@pytest.mark.long
def test_a_sweep_compares_and_goes_on_after_an_interruption(tmp_path, instance):
    (tmp_path / "sweep.yaml").write_text(SWEEP)
    shifts = sweep.read(tmp_path / "sweep.yaml")
    assert len(shifts.jobs) == 8
    simulate(*shifts.jobs[0])
    untouched = (shifts.jobs[0][1] / "run.json").stat().st_mtime_ns
    done = node("sweep", tmp_path / "sweep.yaml")
    assert done.returncode == 0, done.stderr
    assert "7 of 8 shifts" in done.stderr and "8 of 8 shifts" in done.stderr
    assert "1 of 8 shifts" not in done.stderr
    assert (shifts.jobs[0][1] / "run.json").stat().st_mtime_ns == untouched
    complete, left = shifts.done()
    assert len(complete) == 8 and not left
    first, second = comparison.grouped(complete)
    assert (first.label, second.label) == ("orders: random", "orders: pile-on")
    difference = comparison.difference(first, second, "item_throughput_per_hour")
    assert difference.significant and difference.paired and difference.relative > 0.05
    assert "orders: pile-on: +" in done.stdout and "(significant, p = " in done.stdout
    assert (tmp_path / "results" / "report.html").read_text().count("<svg") >= 10


def test_a_sweep_on_a_local_ray_cluster_is_the_same(tmp_path, instance):
    pytest.importorskip("ray", reason="it needs pip install ray 'pydantic>=2'")
    text = SWEEP.replace("seeds: 4", "seeds: 1").replace("minutes: 20", "minutes: 5")
    hashes = []
    for name, *options in (("here",), ("ray", "--ray")):
        (tmp_path / f"{name}.yaml").write_text(text.replace("results", name))
        done = node("sweep", tmp_path / f"{name}.yaml", *options)
        assert done.returncode == 0, done.stderr
        complete, left = sweep.read(tmp_path / f"{name}.yaml").done()
        assert len(complete) == 2 and not left
        hashes.append([run.kpis["state_hash"] for run in complete])
    assert hashes[0] == hashes[1]


@pytest.mark.parametrize(
    "text, message",
    [
        ("sizes: small", "'sizes' is unknown"),
        ("grid: {policies.luck: [random]}", "'policies.luck' can't be varied"),
        ("grid: {policies.orders: random}", "a list of values for each key was expected"),
        ("grid: {policies.orders: [best]}", "there is no 'best'"),
        ("seeds: none", "seeds is 'none'"),
        ("minutes: long", "minutes is 'long'; a number above 0 was expected"),
        ("[", "sweep.yaml"),
    ],
)
def test_a_wrong_sweep_is_told(tmp_path, text, message):
    (tmp_path / "sweep.yaml").write_text(text)
    with pytest.raises(sweep.SweepError, match=re.escape(message)):
        sweep.read(tmp_path / "sweep.yaml")


def fake(label, seed, value):
    kpis = dict.fromkeys(KPIS, 0.0) | {"item_throughput_per_hour": value}
    kpis["order_turnover_s"] = {"median": 60.0}
    intervals = {"seconds": 60.0, "picked": []}
    data = {"config": {"site": "x", "orders": label}, "seed": seed, "intervals": intervals}
    return runs.Run(Path(label), kpis, data)


@pytest.mark.parametrize("width", [canvas.WIDE, canvas.NARROW])
@pytest.mark.parametrize("slow", [1, 100])
def test_texts_of_the_times_of_orders_are_not_cut(width, slow):
    run = fake("a", 1, 1.0)
    run.data["turnover_s"] = [60.0 + 10 * i for i in range(30)] + [400.0 * slow] * 2
    chart = charts.turnover(comparison.grouped([run]))
    figure = Figure(figsize=(width / 72, 210 / 72))
    drawn = canvas.on(figure, (0, 0, width, 210), (48, 16, 30, 40))
    chart.draw(drawn)
    renderer = FigureCanvasAgg(figure).get_renderer()
    texts = [text.get_window_extent(renderer) for text in drawn.axes.texts]
    assert len(texts) == 2 and all(box.x0 >= 0 and box.x1 <= figure.bbox.x1 for box in texts)


def test_intervals_and_differences_are_students():
    a = [fake("a", seed, value) for seed, value in enumerate([10.0, 12.0, 14.0])]
    b = [fake("b", seed, value) for seed, value in enumerate([11.0, 13.0, 15.5])]
    first, second = comparison.grouped([*a, *b])
    estimate = first.estimate("item_throughput_per_hour")
    assert estimate.mean == 12 and estimate.half == pytest.approx(4.3027 * 2 / np.sqrt(3), rel=1e-4)
    difference = comparison.difference(first, second, "item_throughput_per_hour")
    assert difference.estimate.mean == pytest.approx(3.5 / 3) and difference.paired
    assert difference.p_value == pytest.approx(0.0198, abs=1e-3) and difference.significant
    assert comparison.difference(*comparison.grouped([a[0], b[0]]), "item_score") is None
    lines = list(report.verdicts(comparison.grouped([a[0], b[0]])))
    assert lines == [
        "orders: b: +10.0 % pieces an hour against orders: a"
        " (1 run: too few to exclude chance; simulate 3 seeds or more)"
    ]


def ticks(svg, count):
    """The numbers at a picture's first `count` ticks."""
    texts = re.findall(r"<text[^>]*>([^<]*)</text>", svg)
    return [float(text.replace("−", "-").replace(",", "")) for text in texts[:count]]


def test_axes_of_figures_side_by_side_begin_at_zero():
    runs_of_two = [
        fake(label, seed, value + seed / 10)
        for label, value in (("a", 1426.2), ("b", 1426.7))
        for seed in range(3)
    ]
    groups = comparison.grouped(runs_of_two)
    first, second, *_ = ticks(
        bar_charts.comparison(groups, "item_throughput_per_hour", "pieces").html(), 3
    )
    assert first == 0 and second >= 100
    # One run of each, and a figure that is zero in all.
    groups = comparison.grouped(runs_of_two[::3])
    assert ticks(bar_charts.comparison(groups, "pile_on", "pile-on").html(), 1) == [0]


def test_throughput_begins_with_the_shift():
    picked = [0] * 5 + [20] * 55  # pieces a minute
    run = fake("a", 1, 1100.0)
    run.data["intervals"] = {"seconds": 60.0, "picked": picked}
    hourly, minutes = charts._in_blocks(comparison.grouped([run])[0])
    assert minutes.tolist() == list(range(0, 65, 5))
    assert hourly.tolist() == [[0.0] + [1200.0] * 11]
    # The last block is shorter, and a shift may have no whole minute.
    run.data["intervals"]["picked"] = [10] * 25
    hourly, minutes = charts._in_blocks(comparison.grouped([run])[0])
    assert minutes.tolist() == [0, 3, 6, 9, 12, 15, 18, 21, 24, 25] and (hourly == 600).all()
    run.data["intervals"]["picked"] = []
    assert "<svg" in charts.throughput(comparison.grouped([run])).html()


def test_the_time_of_ideal_and_simulated_robots_is_counted_alike(tmp_path, instance):
    shares = []
    for physics in (True, False):
        described = Description(instance=str(instance), seconds=600, physics=physics)
        run, _ = simulate(described, tmp_path / str(physics))
        whole = run.kpis["robots"] * run.kpis["simulated_s"]
        assert sum(run.data["robots"].values()) == pytest.approx(whole)
        shares.append({name: value / whole for name, value in run.data["robots"].items()})
    simulated, ideal = shares
    assert list(simulated) == list(ideal)
    assert simulated["queue"] > 0.03 and simulated["lift"] > 0.01
    # Three robots do not hinder each other.
    assert simulated == pytest.approx(ideal, abs=0.03)


def test_what_ideal_robots_have_none_of_is_no_figure_of_theirs():
    ideal, simulated = fake("a", 1, 1.0), fake("b", 1, 1.0)
    ideal.data["config"]["physics"] = False
    simulated.data["config"]["physics"] = True
    for run in (ideal, simulated):
        run.kpis["order_turnover_s"] = run.kpis["order_throughput_s"] = {"median": 60, "p95": 90}
        run.kpis["plan_ms"] = {"p99": 1.5}
    row = next(line for line in report.table([ideal, simulated]).splitlines() if "Collis" in line)
    assert row.split() == ["Collisions", "–", "0"]


def test_ideal_and_simulated_robots_are_told_apart():
    with_physics, other = (Description(physics=physics).config for physics in (True, False))
    assert with_physics != other


@pytest.mark.parametrize(
    "robots, orders, limit",
    [
        (1, "fill", "the robots"),
        (12, "fill", "the picking stations"),
        (12, "poisson:60", "the orders and the stock"),
    ],
)
def test_the_report_begins_with_the_answer_and_what_limits_it(tmp_path, robots, orders, limit):
    path = write_instance(tmp_path / "a.xinst", bots=robots, picking=1, replenishing=1, rows=3)
    description = Description(instance=str(path), orders=orders, seconds=3600, physics=False)
    run, _ = simulate(description, tmp_path / "out", write_report=report.write)
    html = (tmp_path / "out" / "report.html").read_text()
    pieces = f"{run.kpis['item_throughput_per_hour']:,.0f}"
    with_robots = "1 robot" if robots == 1 else f"{robots} robots"
    answer = f"With {with_robots} and 1 picking station the warehouse picks {pieces} pieces and"
    assert html.index(answer) < html.index("pieces an hour over the shift")
    assert f"What limits it: {limit}<" in html
    assert html.index("Assumptions") < html.index("<h2>Figures")


def test_the_reports_figures_open_in_a_spreadsheet(tmp_path, instance):
    description = Description(instance=str(instance), seconds=600, physics=False)
    run, _ = simulate(description, tmp_path / "out", write_report=report.write)
    html = (tmp_path / "out" / "report.html").read_text()
    tables = dict(re.findall(r'download="([a-z.]+)" href="data:text/csv;base64,([^"]+)"', html))
    files = {
        name: list(csv.DictReader(base64.b64decode(content).decode().splitlines()))
        for name, content in tables.items()
    }
    (row,) = files["figures.csv"]
    assert float(row["item_throughput_per_hour"]) == run.kpis["item_throughput_per_hour"]
    picked = sum(int(row["pieces_picked"]) for row in files["throughput.csv"])
    assert picked == run.kpis["items_picked"]
    assert [row["name"] for row in files["stations.csv"]] == ["pick1", "replenish1"]
