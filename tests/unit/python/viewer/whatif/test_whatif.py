# SPDX-License-Identifier: Apache-2.0
"""Scenarios in their folder, their runs in processes, and how they compare."""

import json
import os
import re
import subprocess
import sys
import time
from dataclasses import replace

import pytest
from asgi import request
from paths import ROOT

from warehouse_layout.file import layout_file
from warehouse_layout.file.layout_file import LayoutFileError
from warehouse_layout.file.request import PRESETS
from warehouse_layout.generate import generator, layout_choice
from warehouse_operations.runs import early_check, sweep
from warehouse_operations.runs import run_files as runs
from warehouse_operations.runs.run_files import Run
from warehouse_viewer.server.access import AccessControl
from warehouse_viewer.whatif import figures
from warehouse_viewer.whatif.estimate import Done, Pace
from warehouse_viewer.whatif.queue import MOST_WAITING, Job, Queue, QueueError
from warehouse_viewer.whatif.scenario import Scenario, ScenarioError
from warehouse_viewer.whatif.standalone import application
from warehouse_viewer.whatif.workshop import Workshop

PATIENCE = 300.0  # runs yield to all else that the machine has to do [s, wall]
SHORT = {"layout": "small", "minutes": 2, "seeds": 2}
SMALL = layout_file.text_of(generator.of_request(PRESETS["small"], "own"))
# Stands for a run: tells its progress, and goes on until its input ends.
WAITS = [sys.executable, "-c", 'import sys; print(\'{"time": 60, "of": 120}\', flush=True);']
WAITS[2] += " sys.stdin.read()"
FAILS = [sys.executable, "-c", 'print("Traceback"); raise SystemExit(3)']


def until(holds, what):
    end = time.monotonic() + PATIENCE
    while not (value := holds()):
        assert time.monotonic() < end, f"waited in vain: {what}"
        time.sleep(0.02)
    return value


def states(workshop, name):
    row = next(
        scenario for scenario in workshop.scenarios()["scenarios"] if scenario["name"] == name
    )
    return row["state"], [run["state"] for run in row["runs"]]


@pytest.fixture
def workshop(tmp_path):
    made = Workshop(tmp_path / "kept", processes=1, command=WAITS)
    made.open()
    yield made
    made.close()


@pytest.fixture(scope="module")
def compared(tmp_path_factory):
    """The folder of two scenarios that have run."""
    folder = tmp_path_factory.mktemp("whatif")
    workshop = Workshop(folder, processes=2)
    workshop.open()
    workshop.create("four", SHORT)
    workshop.create("two robots", SHORT | {"robots": 2, "orders": "mix:900:1.55x1.05"})
    workshop.run("four")
    workshop.run("two robots")
    until(
        lambda: all(s["state"] == "done" for s in workshop.scenarios()["scenarios"]),
        "two runs each",
    )
    workshop.close()
    return folder


def test_runs_are_what_simulate_writes_and_sweep_reads(compared):
    assert {item.name for item in (compared / "four" / "seed-1").iterdir()} == {
        "kpis.json",
        "run.json",
        "run.db",
        "report.html",
        "report.xlsx",
    }
    again = sweep.read(compared / "two robots" / "scenario.yaml")
    complete, left = again.done()
    assert len(complete) == 2 and not left
    assert complete[0].kpis["robots"] == 2
    command = [sys.executable, ROOT / "src/warehouse_operations/nodes/report", compared]
    command += ["--out", compared / "all.html"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert "Pieces picked an hour" in done.stdout


def test_scenarios_are_compared(compared):
    workshop = Workshop(compared)
    result = workshop.compare(["four", "two robots"])
    pieces = result["rows"][0]
    assert result["names"] == ["four", "two robots"] and pieces["key"] == "pieces"
    kpis = [runs.read(compared / "four" / f"seed-{n}").kpis for n in (1, 2)]
    mean = sum(each["item_throughput_per_hour"] for each in kpis) / 2
    assert pieces["cells"][0]["mean"] == pytest.approx(mean)
    assert pieces["cells"][0]["count"] == 2 and "verdict" not in pieces["cells"][0]
    # Two runs have no interval, and tell no difference from chance.
    assert "difference" not in pieces["cells"][1] and pieces["cells"][0]["half"] is None
    assert pieces["cells"][1]["mean"] < mean and len(result["limits"]) == 2
    shown = workshop.scenarios()["scenarios"][0]
    assert shown["summary"]["figures"]["pieces"]["mean"] == pytest.approx(mean)
    assert shown["site"] == {"name": "small", "robots": 4, "stations": 2}
    assert "<html" in workshop.report(["four", "two robots"]).lower()
    assert "<html" in workshop.report_of("four", 2).lower()
    for names in (["four"], ["four", "four"], ["four", "none"]):
        with pytest.raises(ScenarioError):
            workshop.compare(names)


def test_a_change_keeps_the_runs_that_are_still_its_own(compared):
    workshop = Workshop(compared)
    workshop.duplicate("four")
    assert states(workshop, "four 2") == ("none", ["none", "none"])
    workshop.delete("four 2")
    workshop.rename("two robots", "two")
    assert states(workshop, "two") == ("done", ["done", "done"])
    workshop.rename("two", "two robots")
    workshop.change("four", SHORT | {"seeds": 3})
    assert states(workshop, "four") == ("part", ["done", "done", "none"])
    workshop.change("four", SHORT | {"minutes": 3})
    assert states(workshop, "four") == ("none", ["none", "none"])
    assert not list((compared / "four").glob("seed-*"))


def test_runs_wait_go_on_and_are_cancelled(workshop):
    workshop.create("a", SHORT)
    workshop.create("b", SHORT)
    assert workshop.run("a") == {"runs": 2} and workshop.run("a") == {"runs": 0}
    workshop.run("b")
    result = until(lambda: _half_way(workshop), "progress")
    assert result["runs"][1]["state"] == "waits"
    for refused in (lambda: workshop.change("a", SHORT), lambda: workshop.rename("a", "c")):
        with pytest.raises(ScenarioError, match="'a' runs; cancel that first"):
            refused()
    workshop.cancel("a")
    assert states(workshop, "a") == ("cancelled", ["cancelled", "cancelled"])
    until(lambda: states(workshop, "b")[1] == ["runs", "waits"], "the next scenario runs")
    workshop.delete("b")
    assert [scenario["name"] for scenario in workshop.scenarios()["scenarios"]] == ["a"]


def _half_way(workshop):
    scenario = workshop.scenarios()["scenarios"][0]
    return scenario if scenario["runs"][0].get("share") == 0.5 else None


def test_what_was_cut_off_is_told_and_runs_again(tmp_path, workshop):
    workshop.create("a", SHORT)
    workshop.run("a")
    until(lambda: _half_way(workshop), "progress")
    other = Workshop(workshop.folder.path)
    with pytest.raises(ScenarioError, match="is in use by"):
        other.open()
    workshop.close()
    later = Workshop(workshop.folder.path, command=FAILS)
    later.open()
    assert states(later, "a") == ("cut", ["cut", "cut"])
    later.run("a")
    until(lambda: states(later, "a") == ("failed", ["failed", "failed"]), "both fail")
    text = later.scenarios()["scenarios"][0]["runs"][0]["text"]
    assert text == "the run ended early (exit code 3): Traceback"
    later.close()


def test_a_run_ends_with_its_server(tmp_path):
    """However that ends: the input of a run is closed then."""
    workshop = Workshop(tmp_path)
    workshop.create("long", SHORT | {"layout": "large", "minutes": 1000})
    command = [sys.executable, "-m", "warehouse_viewer.whatif.run"]
    file = tmp_path / "long" / "scenario.yaml"
    pipe = subprocess.PIPE
    with subprocess.Popen([*command, file, "1"], stdin=pipe, stdout=pipe, text=True) as process:
        result = json.loads(process.stdout.readline())
        assert result["of"] == 60000 and result["time"] < result["of"]
        process.stdin.close()
        assert process.wait(PATIENCE) == 3
    assert not (tmp_path / "long" / "seed-1" / "kpis.json").exists()


def test_an_error_of_a_run_is_told_in_its_words(tmp_path, monkeypatch):
    """The file of orders changes once it is checked."""
    monkeypatch.setattr(early_check, "check", lambda _: None)
    workshop = Workshop(tmp_path)
    workshop.open()
    rows = "reference,sku,quantity\nA-1,sku-999999,1\n"
    name = workshop.add_orders("monday.csv", rows)["name"]
    assert workshop.add_orders("monday.csv", rows)["name"] == name
    assert workshop.add_orders("monday.csv", rows + "A-2,b,1\n")["name"] == "monday-2.csv"
    workshop.create("a", SHORT | {"orders": name, "seeds": 1})
    workshop.run("a")
    until(lambda: states(workshop, "a")[0] == "failed", "the run fails")
    text = workshop.scenarios()["scenarios"][0]["runs"][0]["text"]
    assert "orders/monday.csv:2: " in text and "sku-999999" in text
    assert str(tmp_path) not in text
    assert not (tmp_path / "a" / "seed-1").exists()
    workshop.close()


def test_a_layout_with_its_stock_is_taken(tmp_path):
    workshop = Workshop(tmp_path)
    workshop.open()
    text = layout_file.text_of(layout_choice.chosen("small"))
    text = re.sub(r"items: \d+", "items: {stock: own.csv}", text)
    with pytest.raises(LayoutFileError, match="the stock own.csv is not here yet"):
        workshop.add_layout("own.layout.yaml", text)
    with pytest.raises(LayoutFileError, match="the name of a CSV file was expected"):
        workshop.add_layout("own.layout.yaml", text.replace("own.csv", "../own.csv"))
    with pytest.raises(LayoutFileError, match="own.csv:2: column quantity"):
        workshop.add_stock("own.csv", "sku,quantity,storage_unit\nbolt,x,1\n")
    rows = "sku,quantity,storage_unit\nbolt,20,1\nnut,20,2\n"
    assert workshop.add_stock("own.csv", rows)["name"] == "own.csv"
    assert workshop.add_stock("own.csv", rows)["name"] == "own.csv"
    with pytest.raises(ScenarioError, match="own.csv is there already and says something else"):
        workshop.add_stock("own.csv", rows + "nail,2,3\n")
    name = workshop.add_layout("own.layout.yaml", text)["name"]
    orders = workshop.add_orders("o.csv", "reference,sku,quantity\nA,bolt,2\nB,nut,1\n")["name"]
    workshop.create("a", SHORT | {"layout": name, "orders": orders, "minutes": 5, "seeds": 1})
    workshop.run("a")
    until(lambda: states(workshop, "a")[0] == "done", "the run ends")
    assert runs.read(tmp_path / "a" / "seed-1").kpis["items_picked"] == 3
    workshop.close()


def test_the_queue_is_bounded(tmp_path):
    ended = []
    queue = Queue(lambda *end: ended.append(end), 1, WAITS)
    jobs = [Job("a", seed, tmp_path) for seed in range(MOST_WAITING + 1)]
    with pytest.raises(QueueError, match=f"{MOST_WAITING} runs wait at most"):
        queue.add(jobs)
    queue.add(jobs[:2])
    until(lambda: len(queue.waiting()) == 1, "one runs")
    queue.close()
    assert not queue.active() and not ended


@pytest.mark.parametrize(
    ("settings", "reason"),
    [
        ({"layout": "../secret"}, "layout is '../secret'; a preset, or the name of a .layout"),
        ({"layout": "none.layout.yaml"}, "layouts/none.layout.yaml: No such file"),
        ({"layout": "small", "robots": 900}, "small: 900 robots, but there is room for 31"),
        ({"robots": True}, "robots is True; a whole number from 0 to 20000 was expected"),
        ({"layout": "small", "stations": 3}, "3 picking stations open; small has 2"),
        ({"orders": "fill:x"}, "orders are 'fill:x'; a number above 0"),
        ({"orders": "mix:1:/etc/x.csv"}, "orders is 'mix:1:/etc/x.csv'; fill,"),
        ({"orders": "none.csv"}, "orders/none.csv: No such file"),
        ({"minutes": float("nan")}, "minutes is nan; a number above 0, up to 1440, was expected"),
        ({"seeds": 51}, "seeds is 51; a whole number from 1 to 50 was expected"),
        ({"policies": {"orders": "os:system"}}, "policies is {'orders': 'os:system'}; a known"),
        ({"realism": "typical"}, "realism: ideal robots have none"),
        ({"physics": True, "realism": "/etc/x"}, "realism is '/etc/x'; one of ideal, typical"),
        ({"out": "/tmp"}, "a scenario with events, layout, minutes,"),
        ([], "a scenario with"),
    ],
)
def test_a_wrong_scenario_is_refused(workshop, settings, reason):
    with pytest.raises(ScenarioError) as error:
        workshop.create("a", settings)
    assert str(error.value).startswith(reason), error.value
    assert workshop.scenarios()["scenarios"] == []


@pytest.mark.parametrize("name", ["", "..", "a/b", ".a", "layouts", "a.", "x" * 61, 3, "a\0"])
def test_names_stay_in_the_folder(workshop, name):
    with pytest.raises(ScenarioError, match="the name is .* were expected"):
        workshop.create(name, SHORT)


def test_no_way_leads_out_of_the_folder(workshop, tmp_path):
    outside = tmp_path / "outside"
    outside.mkdir()
    (outside / "scenario.yaml").write_text("out: .\n")
    os.symlink(outside, workshop.folder.path / "linked")
    for name in ("linked", "../outside", "none"):
        with pytest.raises(ScenarioError):
            workshop.delete(name)
    assert (outside / "scenario.yaml").exists()


def test_layouts_are_kept_and_must_name_no_files_elsewhere(workshop):
    assert workshop.add_layout("north.layout.yaml", SMALL) == {"name": "north.layout.yaml"}
    workshop.create("north", SHORT | {"layout": "north.layout.yaml"})
    assert workshop.scenarios()["scenarios"][0]["site"]["name"] == "own"
    stock = SMALL.replace("items: 96", "items: {stock: /etc/passwd}")
    for text, reason in (
        (stock, "items: stock is ./etc/passwd.; the name of a CSV file"),
        (SMALL + "building: /etc/passwd\n", "building: the name of a world"),
        ("layout: 1\n", "x.layout.yaml"),
    ):
        with pytest.raises(ValueError, match=reason):
            workshop.add_layout("x.layout.yaml", text)
    with pytest.raises(ScenarioError, match="NAME.layout.yaml was expected"):
        workshop.add_layout("../x.layout.yaml", SMALL)


@pytest.mark.parametrize(
    ("event", "fault"),
    [
        ({"close": "pick9"}, r"events\[0\]: close is pick9; there are pick1, pick2"),
        ({"picker": {"station": "pick9", "pickers": 2}}, r"events\[0\]: picker is pick9"),
        ({"fail": "robot 99"}, r"events\[0\]: fail is robot 99; there are 1 to 4"),
        ({"sku_out": "green"}, r"events\[0\]: sku_out is green; the stock has no such SKU"),
    ],
)
def test_events_of_what_does_not_exist_are_refused_by_the_form(workshop, event, fault):
    settings = SHORT | {"events": [{"at": 60, **event}]}
    for ask_for in (workshop.estimate, lambda chosen: workshop.create("x", chosen)):
        with pytest.raises(ScenarioError, match=fault):
            ask_for(settings)
    assert workshop.scenarios()["scenarios"] == []


def test_orders_of_skus_that_the_stock_lacks_are_refused_by_the_form(workshop):
    workshop.add_stock("stock.csv", "sku,quantity,storage_unit\nred,20,1\n")
    file = replace(generator.of_request(PRESETS["small"], "own"), items=0, stock="stock.csv")
    layout = workshop.add_layout("own.layout.yaml", layout_file.text_of(file))["name"]
    for sku, orders in (("green", "bad.csv"), ("red", "good.csv")):
        workshop.add_orders(orders, f"reference,sku,quantity\na,{sku},1\n")
    settings = SHORT | {"layout": layout}
    with pytest.raises(ScenarioError, match="orders/bad.csv.*green"):
        workshop.estimate(settings | {"orders": "bad.csv"})
    assert workshop.estimate(settings | {"orders": "good.csv"})["robots"] == 4


def test_a_damaged_file_is_told_and_hinders_no_other(workshop):
    workshop.create("good", SHORT)
    bad = workshop.folder.path / "bad"
    bad.mkdir()
    (bad / "scenario.yaml").write_text("out: .\nminutes: long\n")
    (bad / "state.json").write_text("{")
    result = {scenario["name"]: scenario for scenario in workshop.scenarios()["scenarios"]}
    assert result["bad"]["state"] == "wrong"
    assert result["bad"]["error"].startswith("bad/scenario.yaml: minutes is 'long'")
    assert result["good"]["state"] == "none"


def test_a_scenario_is_what_its_file_says(tmp_path):
    policies = {"orders": "random", "idle": "park"}
    for scenario in (
        Scenario(),
        Scenario("north.layout.yaml", 3, 1, "monday.csv", 12.5, 7, True, "bad_day", policies),
    ):
        scenario.write(tmp_path)
        assert Scenario.read(tmp_path) == scenario
    (tmp_path / "scenario.yaml").write_text("grid: {orders: [fill]}\nout: .\n")
    with pytest.raises(ScenarioError, match="without a grid"):
        Scenario.read(tmp_path)


def run(seed, pieces, robots=10, wall_s=5.0):
    """A run that picked so many pieces a minute."""
    count = len(pieces)
    kpis = {
        "item_upper_bound_per_hour": 1440.0,
        "order_throughput_per_hour": 300.0,
        "late_orders_fraction": 0.1,
        "robots": robots,
        "simulated_s": 60.0 * count,
        "wall_s": wall_s,
    }
    data = {
        "config": {"physics": False},
        "seed": seed,
        "intervals": {"seconds": 60.0, "picked": pieces},
        "driven_m": [100.0] * count,
        "completed_s": [],
        "turnover_s": [],
        "robots": {"idle": 25.0, "queue": 50.0, "back": 25.0},
    }
    return Run(None, kpis, data)


def test_differences_are_told_where_they_are_above_chance():
    first = [run(seed, [10] * 30) for seed in (1, 2, 3)]
    more = [run(seed, [12 + 0.01 * seed] * 30) for seed in (1, 2, 3)]
    wild = [run(seed, [pieces] * 30) for seed, pieces in ((1, 5), (2, 12), (3, 15))]
    result = figures.comparison({"first": first, "more": more, "wild": wild, "again": first})
    row = {item["key"]: item["cells"] for item in result["rows"]}
    verdicts = [cell["verdict"] for cell in row["pieces"][1:]]
    assert verdicts == ["better", "no difference shown", "no difference shown"]
    assert row["pieces"][1]["relative"] == pytest.approx(0.202)
    assert row["metres"][1]["verdict"] == "better" and row["waiting"][1]["mean"] == 50
    # The interval of a difference leaves out 0 where it is shown, and nowhere else.
    for cell in (cell for cells in row.values() for cell in cells[1:]):
        difference = cell.get("difference")
        if difference and difference["half"] is not None and difference["mean"]:
            is_apart = abs(difference["mean"]) > difference["half"]
            assert is_apart == (cell["verdict"] != "no difference shown"), cell
    # Stations that are busy all the time pick as much in each run: there is no deviation to test.
    busy = figures.comparison({"first": first, "double": [run(s, [20] * 30) for s in (1, 2, 3)]})
    picked = busy["rows"][0]["cells"][1]
    assert (picked["verdict"], picked["alike"], picked["relative"]) == ("better", 3, 1.0)
    assert row["pieces"][3]["alike"] == 0
    assert result["limits"][0] == {"what": "the orders and the stock", "when": ""}
    turned = figures.comparison({"more": more, "first": first})
    assert turned["rows"][0]["cells"][1]["verdict"] == "worse"
    for count in (1, 2):
        few = figures.comparison({"first": first[:count], "more": more[:count]})
        alone = few["rows"][0]["cells"]
        assert "verdict" not in alone[1] and alone[0]["half"] is None


def test_figures_come_after_the_warm_up():
    slow = [run(seed, [0] * 10 + [10 + seed % 2, 10] * 10) for seed in (1, 2)]
    result = figures.summary(slow)
    assert result["warm_up"] == 10 and result["figures"]["pieces"]["mean"] > 600


def test_the_time_that_runs_took_tells_how_long_others_take():
    usual = Pace().seconds(10, 1800, False)
    slow = Pace([Done(run(1, [10] * 30, 10, 90.0), 100.0)] * 3)
    assert slow.seconds(20, 1800, False) == pytest.approx(10 + 180)
    assert slow.seconds(10, 1800, True) > usual


def ask(app, path, body=None, method="POST", query=""):
    sent = b"" if body is None else json.dumps(body).encode()
    headers = {"host": "localhost", "content-length": str(len(sent))}
    app = AccessControl(app)
    answer = request(app, path, query, method=method, headers=headers, body=[sent])
    return answer.status, answer


def test_the_page_asks_its_server(workshop):
    app = application(workshop)
    assert ask(app, "/whatif", method="GET")[0] == 200
    about = json.loads(ask(app, "/whatif/about", method="GET")[1].body)
    assert about["presets"]["small"]["robots"] == 4 and "pile-on" in about["policies"]["orders"]
    made = {"name": "a b", "settings": SHORT}
    assert ask(app, "/whatif/scenarios", made)[0] == 200
    assert ask(app, "/whatif/scenarios", made)[0] == 409
    for wrong in (None, [], {"name": 3, "settings": {}}, {"name": "x"}):
        assert ask(app, "/whatif/scenarios", wrong)[0] == 422
    assert ask(app, "/whatif/scenarios/a b/duplicate")[0] == 200
    assert ask(app, "/whatif/scenarios/none/run")[0] == 409
    assert ask(app, "/whatif/compare", method="GET", query="name=a")[0] == 409
    large = {"name": "x.csv", "text": "x" * 100_000}
    assert ask(app, "/whatif/orders", large)[0] == 409
    answer = ask(app, "/whatif/scenarios/a b", method="DELETE")[1]
    assert json.loads(answer.body) == {"name": "a b"}


def test_a_report_may_show_itself_and_reach_nothing(workshop):
    workshop.create("a", SHORT)
    below = workshop.folder.path / "a" / "seed-1"
    below.mkdir()
    (below / "report.html").write_text("<html>told</html>")
    status, answer = ask(application(workshop), "/whatif/report.html", method="GET")
    assert status == 409 and b"a scenario's name was expected" in answer.body
    _, answer = ask(application(workshop), "/whatif/scenarios/a/seeds/1/report.html", method="GET")
    assert answer.status == 200 and b"told" in answer.body
    content = answer.headers["content-security-policy"]
    assert content.startswith("sandbox ") and "default-src 'none'" in content
    assert "allow-same-origin" not in content
    assert answer.headers["x-content-type-options"] == "nosniff"
