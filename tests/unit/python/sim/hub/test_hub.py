# SPDX-License-Identifier: Apache-2.0
"""The hub launches real warehouses, passes their pages on, and leaves nothing behind."""

import json
import os
import re
import signal
import subprocess
import urllib.error
import urllib.request
from contextlib import suppress
from pathlib import Path
from unittest.mock import Mock

import pytest
from hub_process import Hub, until

from warehouse_sim.hub import simulation, sizing, wish
from warehouse_sim.hub.api import description, routes
from warehouse_sim.hub.process import MARK, descendants, free_port, marked, sweep
from warehouse_viewer.replay.file import NAME, FileRecording


@pytest.fixture
def hub(tmp_path):
    out = Hub(tmp_path, "--most", "2")
    yield out
    if out.process.poll() is None:
        out.end()


@pytest.fixture(scope="module")
def standing(tmp_path_factory):
    """A hub for requests that change nothing."""
    out = Hub(tmp_path_factory.mktemp("standing"))
    yield out
    out.end()


def living(numbers):
    return [n for n in numbers if Path(f"/proc/{n}").exists()]


def test_a_warehouse_from_request_to_end(hub):
    status, row = hub.ask("POST", "/api/v1/simulations", {"name": "one", "size": "small"})
    assert (status, row["state"], row["url"]) == (202, "STARTING", "/s/one/")
    row = hub.wait_for("one", "RUNNING")
    assert (row["state"], row["robots"]) == ("RUNNING", 4), row["reason"]

    # Everything of its HTTP API lies beneath its name.
    assert hub.ask("GET", "/s/one/api/v1/robots")[1]["robots"]
    assert hub.ask("POST", "/s/one/api/v1/simulation/pause", {})[0] == 200
    assert hub.wait_for("one", "PAUSED")["state"] == "PAUSED"

    # A taken name, and one too many.
    assert hub.ask("POST", "/api/v1/simulations", {"name": "one"})[0] == 409

    # A world is inserted whole where there is room, or not at all.
    path = "/api/v1/simulations/one/worlds"
    status, answer = hub.ask("POST", path, {"world": "paper", "x": 200, "y": 0})
    assert status == 201, answer
    assert "kiva1 as kiva5" in answer["message"]
    status, answer = hub.ask("POST", path, {"world": "paper", "x": 200, "y": 0})
    assert status == 409 and "would stand in" in answer["detail"], answer
    assert len(hub.ask("GET", "/s/one/api/v1/robots")[1]["robots"]) == 6
    status, answer = hub.ask("POST", path, {"world": "mars"})
    assert (status, answer["field"]) == (422, "world")

    # What stands there now is saved under a name, by which it is started and inserted.
    path = "/api/v1/simulations/one/save"
    status, answer = hub.ask("POST", path, {"world": "mine"})
    assert (status, answer["world"]) == (201, "mine"), answer
    assert re.search(r"saved \d+ models", answer["message"]) and "left out" not in answer["message"]
    status, answer = hub.ask("POST", path, {"world": "mine"})
    assert status == 409 and "replace: true" in answer["detail"]
    assert hub.ask("POST", path, {"world": "mine", "replace": True})[0] == 201
    status, answer = hub.ask("POST", path, {"world": "My Hall"})
    assert (status, answer["field"]) == (422, "world")
    assert hub.ask("POST", path, {"world": "paper"})[0] == 409
    names = [row["name"] for row in hub.ask("GET", "/api/v1/worlds")[1]["worlds"]]
    assert names[0] == "mine" and "paper" in names
    status, row = hub.ask("POST", "/api/v1/simulations", {"name": "two", "world": "mine"})
    assert status == 202, row
    row = hub.wait_for("two", "RUNNING")
    assert (row["robots"], row["storage_units"]) == (6, 27), row["reason"]
    status, answer = hub.ask("POST", "/api/v1/simulations/two/worlds", {"world": "mine"})
    assert status == 409 and "would stand in" in answer["detail"], answer
    body = {"world": "mine", "x": -300, "y": 0}
    assert hub.ask("POST", "/api/v1/simulations/two/worlds", body)[0] == 201
    hub.ask("DELETE", "/api/v1/simulations/two?forget=true")

    assert hub.ask("POST", "/s/one/api/v1/simulation/resume", {})[0] == 200
    path = "/s/one/recording/index"
    until(lambda: hub.ask("GET", path)[1]["end"] > hub.ask("GET", path)[1]["begin"], "it stands")

    below = descendants(hub.process.pid)
    status, row = hub.ask("DELETE", "/api/v1/simulations/one")
    assert (status, row["state"]) == (200, "STOPPED")
    until(lambda: not living(below), "processes are left")
    assert (hub.home / "warehouse/hub/one/log.txt").exists()
    assert hub.ask("GET", "/s/one/")[0] == 503

    # Its last hour plays without it, and the journal says who did all that.
    recordings = hub.ask("GET", "/api/v1/recordings")[1]["recordings"]
    (kept,) = (row for row in recordings if row["name"] == "one")
    assert kept["url"] == "/recordings/one/" and kept["seconds"] > 0, kept
    index = hub.ask("GET", "/recordings/one/recording/index")[1]
    assert index["chunks"] and not index["live"]
    entries = hub.ask("GET", "/api/v1/journal?simulation=one")[1]["entries"]
    actions = [entry["action"] for entry in entries]
    assert actions == ["start", "insert a world", "save the world", "save the world", "stop"]
    assert (
        entries[0]["who"].startswith("Python-urllib/")
        and '"size": "small"' in entries[0]["arguments"]
    )
    hub.ask("DELETE", "/api/v1/simulations/one?forget=true")
    assert not (hub.home / "warehouse/hub/one").exists()
    assert hub.ask("GET", "/api/v1/simulations/one")[0] == 404


@pytest.mark.long
def test_what_ends_with_the_hub_also_ends_with_its_kill(hub):
    hub.ask("POST", "/api/v1/simulations", {"name": "one", "empty": True})
    assert hub.wait_for("one", "RUNNING")["state"] == "RUNNING"
    below = hub.end(signal.SIGKILL)
    assert len(below) > 5
    until(lambda: not living(below), "processes outlive the hub")

    # A hub that is started again lists what there was, and starts it again on request.
    again = Hub(hub.home)
    (row,) = again.ask("GET", "/api/v1/simulations")[1]["simulations"]
    assert (row["name"], row["state"], row["arguments"]) == ("one", "STOPPED", {"empty": "true"})
    below = again.end()
    assert not living(below)


def test_a_simulation_that_dies_says_why(hub):
    hub.ask("POST", "/api/v1/simulations", {"name": "one", "empty": True})
    hub.wait_for("one", "RUNNING")
    below = descendants(hub.process.pid)
    (world,) = (
        n
        for n in below
        if "kiva_world_node" in Path(f"/proc/{n}/cmdline").read_text().split("\0")[0]
    )
    os.kill(world, signal.SIGKILL)
    row = hub.wait_for("one", "STOPPED")
    assert row["state"] == "FAILED"
    assert "gazebo" in row["reason"]
    until(lambda: not living(below), "processes are left")
    entry = hub.ask("GET", "/api/v1/journal?simulation=one")[1]["entries"][-1]
    assert (entry["kind"], entry["action"]) == ("hub", "end") and "gazebo" in entry["outcome"]


@pytest.mark.long
def test_what_a_warehouse_recorded_outlives_its_crash(tmp_path, monkeypatch):
    monkeypatch.setattr(simulation, "KEEPING", 0.0)
    warehouse = simulation.Simulation(
        wish.read({"name": "one", "size": "small"}, tmp_path), tmp_path
    )
    warehouse.start(dict(os.environ))
    try:
        until(lambda: warehouse.look(1 << 40) or (tmp_path / NAME).exists(), "nothing is recorded")
        for number in warehouse.process.tree():
            with suppress(ProcessLookupError):
                os.kill(number, signal.SIGKILL)
        until(lambda: warehouse.look(1 << 40) or not warehouse.lives, "it lives on")
    finally:
        warehouse.stop(keeps_recording=False)
    assert FileRecording(tmp_path / NAME).chunks


def test_what_is_kept_needs_no_simulation(hub):
    recordings = hub.ask("GET", "/api/v1/recordings")[1]["recordings"]
    assert [row["name"] for row in recordings] == ["at_work"]
    for path in ("/", "/layout", "/whatif", "/recordings/at_work/", "/whatif/scenarios"):
        with urllib.request.urlopen(hub.url + path) as answer:
            assert answer.status == 200, path
    for path in ("/recordings/none/", "/api/v1/worlds/none", "/s/none/"):
        assert hub.ask("GET", path)[0] == 404, path
    sdf = (
        '<sdf version="1.9"><world name="a"><model name="m"><link name="l"/></model></world></sdf>'
    )
    assert hub.ask("PUT", "/api/v1/worlds/mine", {"text": sdf})[0] == 201
    with urllib.request.urlopen(f"{hub.url}/api/v1/worlds/mine") as answer:
        assert answer.read().decode() == sdf
    assert hub.ask("DELETE", "/api/v1/worlds/mine")[0] == 200
    entries = hub.ask("GET", "/api/v1/journal")[1]["entries"]
    assert [entry["action"] for entry in entries] == ["save a world", "delete a world"]


@pytest.mark.parametrize(
    "method, path, body, status, reason",
    [
        ("PUT", "/api/v1/worlds/mine", {"text": "<robot/>"}, 422, "<world> was expected"),
        ("PUT", "/api/v1/worlds/mine", {"name": "x"}, 422, "text and replace were expected"),
        ("DELETE", "/api/v1/worlds/paper", None, 409, "comes with the warehouse"),
        ("POST", "/api/v1/simulations/none/save", {"world": "a"}, 404, "no simulation 'none'"),
        ("POST", "/api/v1/simulations/none/restart", {}, 404, "no simulation 'none'"),
        ("POST", "/api/v1/simulations/none/recording", {}, 404, "no simulation 'none'"),
        ("GET", "/api/v1/journal?since=-1", None, 422, "since: a whole number from 0"),
        ("GET", "/api/v1/journal?limit=all", None, 422, "limit: a whole number from 0"),
        ("POST", "/api/v1/journal", {"who": "x"}, 422, "action: a text was expected"),
        ("POST", "/api/v1/journal", {"who": "x", "action": "y", "z": 1}, 422, "z: "),
        ("POST", "/api/v1/journal", {"who": "x", "action": "y", "done": 1}, 422, "done: true or"),
    ],
)
def test_wrong_requests_name_what_is_wrong(standing, method, path, body, status, reason):
    answer = standing.ask(method, path, body)
    assert answer[0] == status and reason in answer[1]["detail"], answer


@pytest.mark.long
def test_a_restart_begins_again(hub):
    hub.ask("POST", "/api/v1/simulations", {"name": "one", "empty": True})
    hub.wait_for("one", "RUNNING")
    below = descendants(hub.process.pid)
    status, row = hub.ask("POST", "/api/v1/simulations/one/restart", {})
    assert (status, row["state"]) == (202, "STARTING")
    assert not living(below)
    assert hub.wait_for("one", "RUNNING")["state"] == "RUNNING"


def test_what_roslaunch_leaves_is_swept(tmp_path):
    """A node that starts while roslaunch ends has a session of its own, and no parent any more."""
    folder, other = tmp_path / "one", tmp_path / "one-more"
    programs = [
        subprocess.Popen(["sleep", "100"], env={MARK: str(at)}, start_new_session=True)
        for at in (folder, folder, other)
    ]
    # The system shows what a program was given a moment after it began.
    until(lambda: len(marked(tmp_path)) == 3, "the marks of three programs")
    assert sorted(marked(folder)) == sorted(p.pid for p in programs[:2])
    sweep(folder)
    assert [p.wait() for p in programs[:2]] == [-signal.SIGKILL] * 2
    assert programs[2].poll() is None
    sweep(tmp_path)
    assert programs[2].wait() == -signal.SIGKILL and not marked(tmp_path)


@pytest.mark.parametrize("body", ["{", "[]", '{"name": 3}', "null"])
def test_a_body_that_is_no_wish_is_refused(standing, body):
    address = f"{standing.url}/api/v1/simulations"
    request = urllib.request.Request(address, body.encode(), method="POST")
    with pytest.raises(urllib.error.HTTPError) as error:
        urllib.request.urlopen(request)
    assert error.value.code == 422
    assert json.loads(error.value.read())["field"] in ("body", "name")
    assert standing.ask("GET", "/api/v1/simulations")[1] == {"simulations": []}


def test_without_its_packages_the_assistant_says_what_lacks(standing):
    status, answer = standing.ask("POST", "/mcp", {})
    assert status == 503 and "make serve" in answer["detail"]


def test_its_description_has_each_request(hub):
    api = hub.ask("GET", description.OPENAPI)[1]
    served = {
        (route.path, method.lower())
        for route in routes.routes(*[Mock()] * 5)
        if route.path.startswith("/api/v1/") and route.path != description.OPENAPI
        for method in route.methods - {"HEAD"}
    }
    described = {(path, method) for path, does in api["paths"].items() for method in does}
    assert {row for row in described if not row[0].startswith("/whatif/")} == served
    assert ("/whatif/scenarios", "post") in described

    # What it answers has the fields that it says, and no others.
    row = hub.ask("POST", "/api/v1/simulations", {"name": "one", "empty": True})[1]
    entry = hub.ask("GET", "/api/v1/journal")[1]["entries"][0]
    recording = hub.ask("GET", "/api/v1/recordings")[1]["recordings"][0]
    argument = hub.ask("GET", "/api/v1/simulation-arguments")[1]["arguments"][0]
    fault = hub.ask("POST", "/api/v1/simulations", {"name": "Two!"})[1]
    answers = {
        "Simulation": row,
        "JournalEntry": entry,
        "Recording": recording,
        "Argument": argument,
        "Fault": fault,
    }
    for name, answer in answers.items():
        assert set(answer) == set(api["components"]["schemas"][name]["properties"]), name


@pytest.mark.long
def test_it_says_how_many_robots_a_warehouse_needs(hub):
    body = {"size": "small", "orders_per_hour": 100, "hours": 0.5, "late": 0.05}
    status, row = hub.ask("POST", "/api/v1/sizings", body)
    assert (status, row["id"], row["state"]) == (202, 1, "RUNNING")
    status, answer = hub.ask("POST", "/api/v1/sizings", body)
    assert status == 409 and "sizing 1 runs" in answer["detail"]
    until(lambda: hub.ask("GET", "/api/v1/sizings/1")[1]["state"] != "RUNNING", "it runs on")
    row = hub.ask("GET", "/api/v1/sizings/1")[1]
    assert (row["state"], row["url"]) == ("DONE", "/api/v1/sizings/1/report.html"), row
    meets = r"\d robots? and \d open picking stations? .* 100 orders an hour"
    assert re.match(meets, row["answer"])
    api = hub.ask("GET", description.OPENAPI)[1]
    assert set(row) == set(api["components"]["schemas"]["Sizing"]["properties"])

    # One that can't be met says so, one that runs ends with a request, and all are kept.
    hub.ask("POST", "/api/v1/sizings", {**body, "orders_per_hour": 100_000})
    until(lambda: hub.ask("GET", "/api/v1/sizings/2")[1]["state"] != "RUNNING", "it runs on")
    row = hub.ask("GET", "/api/v1/sizings/2")[1]
    assert row["state"] == "IMPOSSIBLE" and "162,750 are asked for" in row["answer"], row
    hub.ask("POST", "/api/v1/sizings", {**body, "size": "large", "hours": 8})
    assert hub.ask("DELETE", "/api/v1/sizings/3")[1]["state"] == "STOPPED"
    hub.end()
    again = Hub(hub.home)
    assert [row["id"] for row in again.ask("GET", "/api/v1/sizings")[1]["sizings"]] == [2, 1]
    again.end()


@pytest.mark.parametrize(
    "body, field",
    [
        ({"size": "small"}, "orders_per_hour"),
        ({"orders_per_hour": 10}, "size"),
        ({"size": "empty", "orders_per_hour": 10}, "size"),
        ({"size": "small", "orders_per_hour": 1e999}, "orders_per_hour"),
        ({"size": "small", "orders_per_hour": 10, "late": 0}, "late"),
        ({"size": "small", "orders_per_hour": 10, "hours": True}, "hours"),
        ({"size": "smal", "orders_per_hour": 10}, "size"),
        ({"layout": "kiva_layout: 1\nx", "orders_per_hour": 10}, "layout"),
        ({"size": "small", "orders_per_hour": 10, "realism": "rainy"}, "realism"),
        ({"size": "small", "orders_per_hour": 10, "robots": 3}, "robots"),
    ],
)
def test_a_question_that_is_wrong_names_its_field(body, field, tmp_path):
    with pytest.raises(wish.WishError) as error:
        sizing.read(body, tmp_path)
    assert error.value.field == field


def test_large_layouts_may_be_sent(standing):
    layout = "layout: 1\nfloor: |\n" + 500 * ("  " + 600 * "?" + "\n")
    status, answer = standing.ask("POST", "/api/v1/simulations", {"name": "one", "layout": layout})
    assert (status, answer.get("field")) == (422, "layout"), answer
    status, answer = standing.ask("POST", "/mcp", {"text": 100_000 * "x"})
    assert status == 413


@pytest.mark.parametrize(
    "limit, state, reason",
    [
        (("--memory", "100"), "FAILED", "100 MB at most were expected"),
        (("--idle", "0.0005"), "STOPPED", "its pages were not asked for in 0.0005 hours"),
    ],
)
def test_a_simulation_that_takes_too_much_is_ended(tmp_path, limit, state, reason):
    hub = Hub(tmp_path, *limit)
    hub.ask("POST", "/api/v1/simulations", {"name": "one", "empty": True})
    row = hub.wait_for("one", state)
    assert row["state"] == state and reason in row["reason"]
    entries = hub.ask("GET", "/api/v1/journal?simulation=one")[1]["entries"]
    assert [entry["action"] for entry in entries] == ["start", "end"]
    assert reason in entries[-1]["outcome"]
    assert not living(hub.end())


@pytest.mark.long
def test_a_warehouse_that_is_launched_beside_the_hub_shows_itself_there(hub, tmp_path):
    port = hub.url.rpartition(":")[2]
    command = ["roslaunch", "-p", str(free_port()), "warehouse_sim", "warehouse.launch"]
    environment = os.environ | {"ROS_HOME": str(tmp_path), "ROS_HOSTNAME": "localhost"}
    environment["ROS_MASTER_URI"] = f"http://localhost:{command[2]}"
    with subprocess.Popen(
        [*command, "size:=empty", f"viewer_port:={port}"], env=environment
    ) as run:
        try:
            rows = until(lambda: hub.ask("GET", "/api/v1/simulations")[1]["simulations"], "no row")
            name = rows[0]["name"]
            assert hub.wait_for(name, "RUNNING")["arguments"] == {"started": "elsewhere"}
            assert hub.ask("GET", f"/s/{name}/api/v1/robots")[1]["robots"] == []
            status, answer = hub.ask("DELETE", f"/api/v1/simulations/{name}")
            assert status == 409 and "end it there" in answer["detail"]
        finally:
            run.send_signal(signal.SIGINT)
    until(lambda: not hub.ask("GET", "/api/v1/simulations")[1]["simulations"], "it is still there")
