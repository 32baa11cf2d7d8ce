# SPDX-License-Identifier: Apache-2.0
"""Searches for layouts in the folder of what-if: their settings, their runs, and their fronts."""

import csv
import json
import os
import re
import subprocess
import sys
import time

import pytest
from asgi import request
from designs import COSTS, SETTINGS, orders
from paths import ROOT

from warehouse_layout.file import layout_file
from warehouse_layout.place import file_check
from warehouse_operations.design import packages
from warehouse_viewer.server.access import AccessControl
from warehouse_viewer.whatif import description
from warehouse_viewer.whatif.design_settings import DesignError, DesignSettings
from warehouse_viewer.whatif.routes import routes
from warehouse_viewer.whatif.scenario import Scenario, ScenarioError
from warehouse_viewer.whatif.standalone import application
from warehouse_viewer.whatif.workshop import Workshop

DESIGN = ROOT / "src" / "warehouse_operations" / "nodes" / "design"
PATIENCE = 300.0  # runs yield to all else that the machine has to do [s, wall]


def until(holds, what):
    end = time.monotonic() + PATIENCE
    while not (value := holds()):
        assert time.monotonic() < end, f"waited in vain: {what}"
        time.sleep(0.02)
    return value


def shown(workshop, name="hall"):
    return next(each for each in workshop.scenarios()["designs"] if each["name"] == name)


def state(workshop, name="hall"):
    return shown(workshop, name)["state"]


def processes_of(folder):
    """The ids of processes that search in a folder."""
    done = subprocess.run(["pgrep", "-f", str(folder)], capture_output=True, text=True, check=False)
    return [int(pid) for pid in done.stdout.split()]


@pytest.fixture(name="needs_optuna")
def _needs_optuna():
    if lack := packages.lack_of_optuna():
        pytest.skip(lack)


def opened(folder):
    made = Workshop(folder, processes=1)
    made.open()
    made.add_orders("day.csv", orders())
    made.set_costs("costs.yaml", COSTS)
    return made


@pytest.fixture(name="workshop")
def _workshop(tmp_path):
    made = opened(tmp_path / "kept")
    yield made
    made.close()


@pytest.fixture(name="design", scope="module")
def _design(tmp_path_factory):
    """A workshop in which a search has ended, and the states that it had."""
    if lack := packages.lack_of_optuna():
        pytest.skip(lack)
    made, progress = opened(tmp_path_factory.mktemp("design") / "kept"), []
    assert made.designs.create("hall", SETTINGS) == {"name": "hall"}
    progress.append(shown(made))
    assert made.designs.run("hall") == {"runs": 1}

    def ended():
        progress.append(shown(made))
        return progress[-1]["state"] not in ("waits", "runs")

    until(ended, "its end")
    yield made, progress
    made.close()


def test_a_search_shows_its_progress(design):
    _, progress = design
    assert progress[0]["state"] == "none"
    running = [each for each in progress if each["state"] == "runs"]
    shares = [each["share"] for each in running]
    assert shares == sorted(shares) and all(0 <= share <= 1 for share in shares)
    assert all(each["left"] >= 0 for each in running)
    assert any(each["stage"].startswith("short shifts: ") for each in running)


def test_a_search_finds_a_front(design):
    workshop, progress = design
    done = progress[-1]
    assert done["state"] == "done"
    assert " days that the search did not see" in done["answer"]["text"]
    folder = workshop.folder.path / "designs" / "hall"
    rows = list(csv.DictReader((folder / "front.csv").read_text().splitlines()))
    assert [row["layout"] for row in done["front"]] == [row["layout"] for row in rows]
    best = done["front"][0]
    assert best["to_buy"] == best["robots"] * 20000 + best["stations"] * 40000
    assert best["late"] <= 5 and best["a_piece"] > 0 and best["contacts"] is None
    text = workshop.designs.layout("hall", "front-1.layout.yaml")
    assert not file_check.faults(layout_file.parse(text, "front-1.layout.yaml"))
    assert "<svg" in workshop.designs.drawing("hall", "front-1.layout.yaml")
    assert "The front" in workshop.designs.report("hall")
    assert workshop.designs.run("hall") == {"runs": 0}
    for name in ("../../../day.layout.yaml", "front-99.layout.yaml", "design.yaml"):
        with pytest.raises(ScenarioError):
            workshop.designs.layout("hall", name)


def test_a_search_is_what_the_program_does(design):
    """The command in design.yaml, run in its folder, finds the same front."""
    workshop, _ = design
    folder = workshop.folder.path / "designs" / "hall"
    front = (folder / "front.csv").read_text()
    command = (folder / "design.yaml").read_text().splitlines()[0].removeprefix("# rosrun ")
    command = command.replace("warehouse_operations design", f"{sys.executable} {DESIGN}")
    done = subprocess.run(
        command, shell=True, cwd=folder, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert " days that the search did not see" in done.stdout
    assert (folder / "front.csv").read_text() == front
    workshop.designs.delete("hall")
    assert workshop.scenarios()["designs"] == [] and not folder.exists()


def test_a_search_is_cancelled_and_goes_on(needs_optuna, workshop):
    workshop.designs.create("hall", SETTINGS | {"cpu_hours": 0.05})
    workshop.designs.run("hall")
    points = workshop.folder.path / "designs" / "hall" / "points"
    until(lambda: list(points.glob("*.json")), "its first shift")
    workshop.designs.cancel("hall")
    until(lambda: state(workshop) == "cancelled", "its end")
    until(lambda: not processes_of(points.parent), "its processes end")
    kept = len(list(points.glob("*.json")))
    workshop.designs.run("hall")
    until(lambda: len(list(points.glob("*.json"))) > kept, "it goes on")
    assert state(workshop) == "runs"
    workshop.close()
    until(lambda: not processes_of(points.parent), "its processes end with the server")
    again = Workshop(workshop.folder.path)
    again.open()
    assert state(again) == "cut"
    again.close()


def test_a_search_ends_with_its_server(needs_optuna, tmp_path):
    """However that ends: nothing goes on in the background."""
    program = (
        "import sys, time; from warehouse_viewer.whatif.workshop import Workshop\n"
        "from pathlib import Path\n"
        "made = Workshop(Path(sys.argv[1]), processes=1); made.open()\n"
        "made.add_orders('day.csv', sys.argv[2]); made.set_costs('costs.yaml', sys.argv[3])\n"
        f"made.designs.create('hall', {SETTINGS | {'cpu_hours': 0.05}!r})\n"
        "made.designs.run('hall'); time.sleep(600)"
    )
    kept = tmp_path / "kept"
    command = [sys.executable, "-c", program, kept, orders(), COSTS]
    with subprocess.Popen(command) as server:
        until(lambda: list(kept.glob("designs/hall/points/*.json")), "its first shift")
        server.kill()
    until(lambda: not processes_of(kept / "designs"), "its processes end")


@pytest.mark.parametrize(
    ("change", "field", "text"),
    [
        ({"building": "40 by 30"}, "building", "40x30, a preset"),
        ({"building": "2x90"}, "building", "edges of 8 to 1000 cells"),
        ({"building": "none.layout.yaml"}, "building", "layouts/none.layout.yaml"),
        ({"demand": ""}, "demand", "a file of orders"),
        ({"demand": "none.csv"}, "demand", "orders/none.csv"),
        ({"demand": "../day.csv"}, "demand", "FILE.csv or FILE.demand.yaml"),
        ({"demand": "day.csv*0"}, "demand", "FILE.csv or FILE.demand.yaml"),
        ({"late": 1.5}, "late", "above 0 and below 100 %"),
        ({"cpu_hours": 0}, "cpu_hours", "a number above 0, up to 1000"),
        ({"seed": -1}, "seed", "a whole number from 0"),
        ({"physics_hours": 99}, "physics_hours", "a number from 0, up to 24"),
        ({"robots": 3}, "", "a search with building"),
    ],
)
def test_what_is_wrong_is_refused_with_its_field(workshop, change, field, text):
    with pytest.raises(DesignError) as refusal:
        workshop.designs.create("hall", SETTINGS | change)
    assert refusal.value.field == field and text in str(refusal.value)
    assert str(workshop.folder.path) not in str(refusal.value)
    assert workshop.designs.all() == []


def test_a_search_needs_costs_and_a_name_of_its_own(workshop):
    workshop.designs.create("hall", SETTINGS)
    for name in ("hall", "a/b", "layouts"):
        with pytest.raises(DesignError) as refusal:
            workshop.designs.create(name, SETTINGS)
        assert refusal.value.field == "name"
    workshop.drop_costs()
    with pytest.raises(DesignError, match="open a costs.yaml") as refusal:
        workshop.designs.create("other", SETTINGS)
    assert refusal.value.field == "costs"
    # The search has the costs that were known when it was made.
    assert (workshop.folder.path / "designs" / "hall" / "costs.yaml").read_text() == COSTS


def test_without_optuna_it_says_how_to_install_it(workshop, monkeypatch):
    workshop.designs.create("hall", SETTINGS)
    monkeypatch.setattr(packages, "ENVIRONMENTS", ())
    monkeypatch.setattr(sys, "path", [])
    assert "scripts/learning_packages" in workshop.about()["lacks"]
    with pytest.raises(DesignError, match="needs Optuna.*scripts/learning_packages"):
        workshop.designs.run("hall")
    assert state(workshop) == "none"


def test_buildings_are_edges_presets_and_files(tmp_path):
    def task(building):
        return DesignSettings(building, "a.csv*1.3").task(tmp_path, tmp_path / "costs.yaml")

    assert task("40x30").building == "40x30"
    small = task("small").building
    assert small.replace("x", "").isdigit() and min(map(int, small.split("x"))) > 8
    assert task("own.layout.yaml").building == os.path.join(tmp_path, "layouts", "own.layout.yaml")
    assert task("small").demand == f"{tmp_path}/orders/a.csv*1.3"


def ask(app, path, body=None, method="POST"):
    sent = b"" if body is None else json.dumps(body).encode()
    headers = {"host": "localhost", "content-length": str(len(sent))}
    answer = request(AccessControl(app), path, method=method, headers=headers, body=[sent])
    return answer.status, json.loads(answer.body)


def test_the_page_asks_its_server(workshop):
    app, below = application(workshop), "/whatif/designs"
    wrong = {"name": "hall", "settings": SETTINGS | {"late": 2.0}}
    status, answer = ask(app, below, wrong)
    assert status == 409 and answer["field"] == "late"
    assert ask(app, below, wrong | {"settings": SETTINGS}) == (200, {"name": "hall"})
    assert ask(app, below, method="GET")[1]["designs"][0]["name"] == "hall"
    estimate = {"settings": SETTINGS | {"cpu_hours": 0.5}}
    result = {"seconds": 1800, "processes": 1}
    assert ask(app, f"{below}/estimate", estimate) == (200, result)
    layout = "layouts/front-1.layout.yaml"
    for path in ("report.html", layout, f"{layout}/plan.svg"):
        status, answer = ask(app, f"{below}/hall/{path}", method="GET")
        assert status == 409 and "there is no" in answer["detail"]
    assert ask(app, f"{below}/hall", method="DELETE")[0] == 200
    assert ask(app, below, method="GET")[1] == {"designs": []}


def test_the_apis_description_has_each_request(workshop):
    served = {
        (re.sub(r":\w+}", "}", route.path), method.lower())
        for route in routes(workshop)
        for method in route.methods - {"HEAD"}
    }
    described = {(path, method) for path, does in description.PATHS.items() for method in does}
    assert served == described
    assert set(description.SCHEMAS["DesignSettings"]["properties"]) == set(SETTINGS)
    assert set(description.SCHEMAS["ScenarioSettings"]["properties"]) == set(Scenario().to_json())
