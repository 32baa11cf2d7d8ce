# SPDX-License-Identifier: Apache-2.0
"""The program that drives a plan: its report, its recording, its end by Ctrl-C and by errors."""

import json
import signal
import subprocess
import sys

import numpy as np
import pytest
from paths import ROOT

from warehouse_fleet.league import problem
from warehouse_fleet.league.drive_report import WORDS
from warehouse_viewer.replay.file import NAME, FileRecording

DRIVE = ROOT / "src/warehouse_viewer/nodes/drive"
ROWS, COLUMNS = 4, 30


@pytest.fixture
def plan(tmp_path):
    """A plan of two robots that drive along a floor, and the path of its problem."""
    floor = problem.write_problem(
        tmp_path, "floor", np.ones((ROWS, COLUMNS), bool), [0, COLUMNS], [[0]]
    )
    path = tmp_path / "plan.json"
    along = ",".join(["F"] * (COLUMNS - 1))
    start = [[0, 0, "E"], [1, 0, "E"]]
    path.write_text(json.dumps({"teamSize": 2, "start": start, "actualPaths": [along, along]}))
    return path, floor


def command(*args):
    return [sys.executable, DRIVE, *map(str, args)]


def run(*args):
    return subprocess.run(command(*args), capture_output=True, check=False, text=True, timeout=120)


def test_a_drive_is_reported_and_recorded(plan, tmp_path):
    out = tmp_path / "out"
    done = run(*plan, "--out", out, "--record")
    assert done.returncode == 0, done.stderr
    report = json.loads((out / "drive.json").read_text())
    assert (report["robots"], report["at_their_ends"], report["contacts"]) == (2, 2, 0)
    assert 1.0 < report["executed_over_planned"] < 1.2, "nothing is in their way"
    assert sum(report["robot_seconds"].values()) == pytest.approx(
        2 * report["simulated_s"], abs=0.5
    )
    assert all(words in done.stdout for words in WORDS.values())
    assert "tick 29 of 29" in done.stderr
    assert (out / "drive.png").read_bytes().startswith(b"\x89PNG")
    recording = FileRecording(out / NAME)
    assert recording.about == {"name": "plan", "from": "drive"}
    assert not recording.cut


def test_ticks_drive_the_begin_of_a_plan(plan, tmp_path):
    done = run(*plan, "--out", tmp_path, "--ticks", 5)
    assert done.returncode == 0, done.stderr
    report = json.loads((tmp_path / "drive.json").read_text())
    assert (report["ticks"], report["cells"]) == (5, 10)


@pytest.mark.long
def test_ctrl_c_reports_what_was_driven(plan, tmp_path):
    long = json.loads(plan[0].read_text())
    there, back = ["F"] * (COLUMNS - 1), ["R", "R"]
    rounds = 4000  # more than it drives before it hears of the signal on a busy machine
    long["actualPaths"] = [",".join((there + back) * rounds)] * 2
    plan[0].write_text(json.dumps(long))
    with subprocess.Popen(
        command(*plan, "--out", tmp_path), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as driving:
        assert "tick" in driving.stderr.readline(), "it is under way"
        driving.send_signal(signal.SIGINT)
        out, err = driving.communicate(timeout=60)
    assert driving.returncode == 130
    assert "Traceback" not in err
    assert "executed over planned" in out
    report = json.loads((tmp_path / "drive.json").read_text())
    assert report["interrupted"]
    assert 0 < report["simulated_s"] < 29 * rounds
    assert 0 < report["cells"] < 2 * 29 * rounds
    assert 1.0 < report["executed_over_planned"] < 2.0, "as far as robots have come"


def test_a_damaged_plan_is_refused_in_a_sentence(plan, tmp_path):
    damaged = json.loads(plan[0].read_text())
    damaged["actualPaths"][1] = "C,F,F"
    plan[0].write_text(json.dumps(damaged))
    done = run(*plan, "--out", tmp_path)
    assert done.returncode == 1
    assert done.stderr.startswith(f"drive: {plan[0]}: actualPaths: robot ")
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("option", "reason"),
    [("--ticks 0", "--ticks: 0; a whole number from 1 was"), ("--threads 257", "from 1 to 256")],
)
def test_options_out_of_range_are_refused(plan, option, reason):
    done = run(*plan, *option.split())
    assert done.returncode == 2
    assert reason in done.stderr
