# SPDX-License-Identifier: Apache-2.0
"""The competition's problems, run by the program, and their results looked at by themselves."""

import json
import os
import pty
import re
import signal
import subprocess
import sys
from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest
from paths import ROOT

from warehouse_fleet import Rules
from warehouse_fleet.league import delays, generator, problem, result_check

PLAN = ROOT / "src/warehouse_fleet/nodes/plan"
STEPS = {0: (0, 1), 1: (1, 0), 2: (0, -1), 3: (-1, 0)}  # east, south, west, north: row, column
STEPS_MADE = 150


@pytest.fixture(scope="module")
def floor():
    return generator.warehouse(blocks=(5, 4))


@pytest.fixture
def made(floor, tmp_path):
    """Writes a problem: made(robots, …) is the path of its file."""

    def make(robots, round_robin=True, tasks=None, seed=1):
        rng = np.random.default_rng(seed)
        agents = generator.starts(floor, robots, rng)
        if tasks is None:
            tasks = [[task] for task in generator.tasks(floor, 40 * robots, rng)]
        return problem.write_problem(
            tmp_path, "small", floor.walls(), agents, tasks, round_robin, reveal=1.5
        )

    return make


def run(*args, **kwargs):
    return subprocess.run(
        [sys.executable, PLAN, *map(str, args)],
        capture_output=True,
        check=False,
        text=True,
        timeout=120,
        **kwargs,
    )


def planned(path, *args):
    out = path.with_name("result.json")
    done = run(path, "--steps", STEPS_MADE, "--out", out, *args)
    assert done.returncode == 0, done.stderr
    result = json.loads(out.read_text())
    assert f"numTaskFinished: {result['numTaskFinished']}\n" in done.stdout
    assert "step [ms]: median " in done.stdout
    return result


def drive(source, result):
    """Drives actualPaths and looks at each tick; the places of all robots by tick."""
    passable = source.passable
    at = [tuple(place[:2]) for place in result["start"]]
    assert [row * passable.shape[1] + column for row, column in at] == source.agents.tolist()
    heading, history = [0] * len(at), [at]
    paths = [path.split(",") for path in result["actualPaths"]]
    assert {len(path) for path in paths} == {result["makespan"]}
    for actions in zip(*paths):
        then = []
        for robot, action in enumerate(actions):
            row, column = at[robot]
            if action == "F":
                row, column = row + STEPS[heading[robot]][0], column + STEPS[heading[robot]][1]
                assert 0 <= row < passable.shape[0] and 0 <= column < passable.shape[1]
                assert passable[row, column], f"robot {robot} in a wall"
            heading[robot] = (heading[robot] + {"R": 1, "C": 3}.get(action, 0)) % 4
            then.append((row, column))
        assert len(set(then)) == len(then), "two in a cell"
        moved = {(cell, other) for cell, other in zip(at, then) if cell != other}
        assert not moved & {(other, cell) for cell, other in moved}, "a swap"
        at = then
        history.append(at)
    return history


def count(source, history):
    """Tasks finished when task k belongs to robot k mod robots."""
    robots, finished = len(source.agents), 0
    for robot in range(robots):
        task, errand = robot, 0
        for at in history[1:]:
            if task >= len(source.tasks):
                break
            goal = divmod(source.tasks[task][errand], source.passable.shape[1])
            if at[robot] != goal:
                continue
            errand += 1
            if errand == len(source.tasks[task]):
                task, errand, finished = task + robots, 0, finished + 1
    return finished


def test_it_says_how_many_robots_a_gate_lets_drive(tmp_path):
    rooms = np.ones((20, 41), bool)
    rooms[:, 20] = False
    rooms[10, 20] = True  # a door
    cells = np.flatnonzero(rooms)
    tasks = np.random.default_rng(0).choice(cells, (500, 2)).tolist()
    path = problem.write_problem(tmp_path, "rooms", rooms, cells[:200], tasks, False)
    done = run(path, "--steps", 1, "--threads", 1)
    assert re.search(r"plan: \d\d of 200 robots drive at a time", done.stderr), done.stderr
    (tmp_path / "all.yaml").write_text("planner: epibt\noptions: {pursuing: 0.5}\n")
    done = run(path, "--steps", 1, "--threads", 1, "--planner", tmp_path / "all.yaml")
    assert "at a time" not in done.stderr


@pytest.mark.parametrize("robots,seed", [(10, 1), (60, 2), (60, 3), (100, 4)])
def test_round_robin(made, robots, seed):
    path = made(robots, seed=seed)
    source, result = problem.read(path), planned(path, "--attempts", 20)
    assert count(source, drive(source, result)) == result["numTaskFinished"] > robots * 2


def test_following_forbidden(made):
    path = made(40)
    source, result = problem.read(path), planned(path, "--no-following")
    history = drive(source, result)
    assert count(source, history) == result["numTaskFinished"] > 40
    for at, then in zip(history, history[1:]):
        before = {place: robot for robot, place in enumerate(at)}
        assert all(before.get(place, robot) == robot for robot, place in enumerate(then))


def test_planner_chooses(made, floor):
    rng = np.random.default_rng(8)
    pairs = generator.tasks(floor, 1000, rng).reshape(-1, 2).tolist()
    path = made(30, round_robin=False, tasks=pairs)
    source, result = problem.read(path), planned(path)
    history = drive(source, result)
    done = 0
    for tick, robot, task, errand in result["events"]:
        goal = source.tasks[task][errand - 1]
        assert history[tick][robot] == divmod(goal, source.passable.shape[1])
        done += errand == len(source.tasks[task])
    assert done == result["numTaskFinished"] > 30
    out = path.with_name("result.json")
    assert result_check.check(source, out, Rules(rings=True)).faults == []
    fewer = replace(source, reveal=0.1)
    assert "was not revealed yet" in result_check.check(fewer, out, Rules(rings=True)).faults[0]
    assert len({task for _, _, task, errand in result["events"] if errand == 2}) == done


def test_same_seed_same_plan(made):
    path = made(50)
    first, second = planned(path, "--attempts", 60), planned(path, "--attempts", 60)
    assert first["actualPaths"] == second["actualPaths"]


def test_round_trip(made):
    path = made(12)
    kept = problem.read(path)
    again = problem.read(
        problem.write_problem(
            path.parent / "again",
            "copy",
            kept.passable,
            kept.agents,
            kept.tasks,
            kept.round_robin,
        )
    )
    assert (again.passable == kept.passable).all() and (again.agents == kept.agents).all()
    assert again.tasks == kept.tasks and again.round_robin


def test_comments_and_letters_of_the_competition(made):
    path = made(3)
    map_file = path.with_suffix(".map")
    map_file.write_text(map_file.read_text().replace(".", "S", 3).replace(".", "E", 1))
    agents = path.with_suffix(".agents")
    agents.write_text("# version for LoRR 2024\n" + agents.read_text())
    assert len(problem.read(path).agents) == 3


@pytest.mark.parametrize(
    "ending,change,expected",
    [
        (".json", lambda text: text[:-5], "small.json:7: Unterminated string"),
        (".json", lambda text: text.replace("mapFile", "map"), "small.json: there is no 'mapFile'"),
        (".json", lambda text: text.replace('"teamSize": 5', '"teamSize": 9'),
         "small.json: teamSize is 9; 1 to 5, the robots of"),
        (".json", lambda text: text.replace("roundrobin", "random"),
         "taskAssignmentStrategy is 'random'; roundrobin, roundrobin-fixed"),
        (".json", lambda text: text.replace("small.tasks", "gone.tasks"),
         "gone.tasks: No such file or directory"),
        (".map", lambda text: text.replace("width", "breadth"), "small.map:3: a line 'width …'"),
        (".map", lambda text: text.replace("@", "x", 1), "'x' in column"),
        (".map", lambda text: text.replace("....", "...", 1), "small.map:5:"),
        (".map", lambda text: text[:-60], "rows were expected"),
        (".agents", lambda text: text.replace("\n", "\n-1\n", 1), "small.agents:2: '-1'"),
        (".agents", lambda text: text.replace("\n", "\n99999\n", 1),
         "small.agents:2: location 99999; 0 to"),
        (".agents", lambda text: "2\n0\n0\n", "small.agents:3: location 0 has a robot already"),
        (".agents", lambda text: "7\n0\n", "7 lines were announced, 1 are there"),
        (".tasks", lambda text: text.replace("\n", "\nx\n", 1), "small.tasks:2: 'x'"),
        (".tasks", lambda text: "", "small.tasks:1: the number of lines"),
        (".tasks", lambda text: "0\n", "small.tasks: 0 tasks; 1 or more was expected"),
    ],
)  # fmt: skip
def test_bad_files(made, ending, change, expected):
    path = made(5)
    file = path.with_suffix(ending)
    text = file.read_text()
    file.write_text(change(text))
    assert file.read_text() != text
    with pytest.raises(problem.ProblemError) as error:
        if ending == ".agents" and expected.endswith("already"):
            path.write_text(path.read_text().replace('"teamSize": 5', '"teamSize": 2'))
        problem.read(path)
    assert expected in str(error.value)


def test_the_program_says_what_is_wrong(made):
    path = made(5)
    path.with_suffix(".map").unlink()
    done = run(path, "--steps", 5)
    assert done.returncode == 1
    assert done.stderr == f"plan: {path.with_suffix('.map')}: No such file or directory\n"
    assert run("--help").returncode == 0
    assert "a whole number from 1" in run(path, "--steps", 0).stderr


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_it_shows_its_progress_and_interrupted_writes_what_it_has(made, number):
    path = made(60)
    out = path.with_name("result.json")
    command = [sys.executable, PLAN, path, "--steps", "1000000", "--step-ms", "1", "--out", out]
    terminal, ours = pty.openpty()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=ours)
    os.close(ours)
    shown = ""
    while "of 1,000,000 ticks" not in shown:
        shown += os.read(terminal, 4096).decode()
    process.send_signal(number)
    assert process.wait(timeout=60) == 128 + number
    errors = ""
    with open(terminal, encoding="utf-8") as rest, suppress(OSError):  # EIO, at a terminal's end
        for line in rest:
            errors += line
    assert "interrupted after" in errors and "Traceback" not in errors
    assert len(json.loads(out.read_text())["start"]) == 60


VALIDATE = ROOT / "src/warehouse_fleet/nodes/validate"


def with_fields(path, **fields):
    """Adds fields to the JSON file of a problem."""
    path.write_text(json.dumps({**json.loads(path.read_text()), **fields}))
    return path


@pytest.fixture(scope="module")
def solved(floor, tmp_path_factory):
    """The path of a problem, and of its result."""
    rng = np.random.default_rng(1)
    agents = generator.starts(floor, 20, rng)
    tasks = [[task] for task in generator.tasks(floor, 800, rng)]
    folder = tmp_path_factory.mktemp("solved")
    path = problem.write_problem(folder, "small", floor.walls(), agents, tasks)
    planned(path)
    return path, path.with_name("result.json")


def test_validates_a_result(solved):
    command = [sys.executable, VALIDATE, *solved, "--threads", "2"]
    done = subprocess.run(command, capture_output=True, check=False, text=True)
    assert done.stdout.startswith(f"valid: 20 robots, {STEPS_MADE} ticks, numTaskFinished ")
    assert done.returncode == 0
    assert result_check.check(problem.read(solved[0]), solved[1], Rules(rings=True), 1).faults == []


@pytest.mark.parametrize(
    "change,expected",
    [
        (lambda out: out.update(numTaskFinished=1), "numTaskFinished is 1; "),
        (lambda out: out["start"].__setitem__(3, [0, 0, "E"]), "robot 3 starts at [0, 0, 'E']; "),
        (lambda out: out["events"][0].__setitem__(0, 0), "tick 0: errand 1 of task"),
        (lambda out: out["actualPaths"].__setitem__(2, "F" + ",F" * (STEPS_MADE - 1)), "tick "),
        (lambda out: out["actualPaths"].__setitem__(2, "X"), "actualPaths[2] has 'X'; F, R, C"),
        (lambda out: out["actualPaths"].__setitem__(2, "F"), "actualPaths[2] has 1 actions; "),
        (lambda out: out["actualPaths"].pop(), "a path for each of 20 robots was expected"),
    ],
)  # fmt: skip
def test_sees_what_is_wrong_with_a_result(solved, tmp_path, change, expected):
    path, out = solved
    result = json.loads(out.read_text())
    change(result)
    changed = tmp_path / "changed.json"
    changed.write_text(json.dumps(result))
    try:
        faults = result_check.check(problem.read(path), changed, Rules(rings=True)).faults
    except problem.ProblemError as error:
        faults = [str(error)]
    assert expected in faults[0]


def test_tasks_of_2023_come_again(made):
    path = made(6, tasks=[[0]] * 6)
    assert problem.read(path).repeats
    assert problem.read(path).errands(8) == [0]
    assert not problem.read(with_fields(path, taskAssignmentStrategy="roundrobin-fixed")).repeats


DELAYS = {
    "seed": 3, "minDelay": 2, "maxDelay": 5, "eventModel": "bernoulli", "pDelay": 0.05,
    "durationModel": "uniform",
}  # fmt: skip


@pytest.mark.parametrize("events", delays.EVENTS)
@pytest.mark.parametrize("durations", delays.DURATIONS)
def test_delays_are_as_long_and_as_frequent_as_asked(events, durations):
    model = delays.DelayModel(1, 2, 8, events, 0.05, durations, action_ticks=1)
    drawn = delays.Delays(model, 500)
    stands = np.array([drawn.step() for _ in range(200)])
    # 5 of every 5 + 20 ticks of each; or 5 ticks for 5 % of all robots a tick.
    expected = {"bernoulli": 0.2, "poisson": 0.25}[events]
    assert abs(stands.mean() - expected) < 0.025
    starts = (stands[1:] & ~stands[:-1]).sum()
    assert 4.5 < stands[1:].sum() / starts < 6.5  # some begin where another ends


def test_delayed_robots_stand(made):
    path = made(30)
    free = planned(path)
    result = planned(with_fields(path, delayConfig=DELAYS, agentCounter=1))
    out = path.with_name("result.json")
    assert result_check.check(problem.read(path), out, Rules(rings=True)).faults == []
    assert 0 < result["numTaskFinished"] < free["numTaskFinished"]


@pytest.mark.parametrize(
    "fields,expected",
    [
        ({"delayConfig": {**DELAYS, "maxDelay": 1}}, "maxDelay is 1; at least minDelay, 2, was"),
        ({"delayConfig": {**DELAYS, "eventModel": "never"}}, "eventModel is 'never'; bernoulli or"),
        ({"delayConfig": 3}, "delayConfig is 3; an object was expected"),
        ({"delayConfig": DELAYS, "agentCounter": 0}, "agentCounter is 0; 1 or more was expected"),
    ],
)
def test_wrong_delays(made, fields, expected):
    with pytest.raises(problem.ProblemError, match=expected):
        problem.read(with_fields(made(5), **fields))


def test_share_of_the_best_known(made):
    path = made(100)
    for name in ("MR23-I-04.json", "other.json"):
        path.with_name(name).write_text(path.read_text())
    path.unlink()
    done = run(path.parent, "--steps", 20)
    lines = done.stdout.splitlines()
    assert lines[1].split()[-4:] == ["share", "first", "median", "p99"]
    assert lines[2].split()[:3] == ["MR23-I-04", "100", "20"]
    assert lines[3].startswith("other") and lines[3].endswith("no result is known")
    assert lines[4].startswith("share of the best known, mean of 1: ")


def test_tables_are_kept_in_a_file(made):
    path = made(10)
    spec, file = path.with_name("small.yaml"), path.with_name("small.tables")
    spec.write_text("options: {whole_up_to: 0}")
    plans = [
        planned(path, "--planner", spec, "--tables", file, "--threads", threads, "--attempts", 9)
        for threads in (1, 2)
    ]
    assert plans[0]["actualPaths"] == plans[1]["actualPaths"]
    file.write_text("something else")
    done = run(path, "--steps", 5, "--planner", spec, "--tables", file)
    assert done.returncode == 1
    assert f"plan: {file}: 'something else'; 'distance tables, version 2: " in done.stderr
