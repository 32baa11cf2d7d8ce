# SPDX-License-Identifier: Apache-2.0
"""The program layout, run as a person runs it: sentences, exit codes, files."""

import os
import re
import signal
import struct
import subprocess
import time
import xml.etree.ElementTree as ElementTree

import pytest
from paths import ROOT

from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.request import PRESETS
from warehouse_layout.generate import generator

PROGRAM = ROOT / "src" / "warehouse_layout" / "nodes" / "layout"

GOOD = """layout: 1
name: north & hall
floor: |
  ###############
  #p............#
  #c.sss.sss.>..#
  #x............#
  ###############
storage_units: 3
robots: 2
"""


@pytest.fixture
def run(tmp_path):
    def started(*arguments):
        return subprocess.run(
            [PROGRAM, *map(str, arguments)],
            check=False,
            cwd=tmp_path,
            env={k: v for k, v in os.environ.items() if k != "ROS_MASTER_URI"},
            capture_output=True,
            text=True,
            timeout=60,
        )

    return started


@pytest.fixture
def good(tmp_path):
    path = tmp_path / "north.layout.yaml"
    path.write_text(GOOD)
    return path


def test_check_tells_that_a_fleet_can_work_there(run, good):
    done = run("check", good)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == (
        f"{good}: a fleet can work on it: 2 robots, 3 storage units, 0 picking stations,"
        " 0 replenishment stations on 15 x 5 cells of 1 m\n"
        f"{good}: no order can be picked: there is no picking station\n"
    )


def test_check_refuses_a_floor_without_work(run, good):
    good.write_text(GOOD.replace("storage_units: 3", "storage_units: 0").replace("robots: 2", ""))
    done = run("check", good)
    assert done.returncode == 1
    assert done.stdout == (
        f"{good}: there are no robots: draw parking 'p', and say how many in robots\n"
        f"{good}: there are no storage units: draw places 's', and say how many in storage_units\n"
    )


def test_a_plan_has_the_scale_of_a_ruler(run, good, tmp_path):
    run("draw", good, "--out", "plan.svg")
    (ratio,) = re.findall(r"1 : (\d+) on", (tmp_path / "plan.svg").read_text())
    assert ratio == "100"
    assert run("new", "medium", "--out", "m.layout.yaml").returncode == 0
    run("draw", "m.layout.yaml", "--out", "plan.svg")
    (ratio,) = re.findall(r"1 : (\d+) on", (tmp_path / "plan.svg").read_text())
    assert ratio in ("100", "200", "500")


def test_check_tells_each_fault_with_its_cells(run, good):
    good.write_text(
        GOOD.replace("#x............#", "#x####.########").replace("robots: 2", "robots: 9")
    )
    done = run("check", good)
    assert done.returncode == 1
    lines = done.stdout.splitlines()
    assert all(line.startswith(f"{good}: ") for line in lines)
    assert any("[6, 1]" in line and "can't pass each other" in line for line in lines)
    assert any("9 robots, but there is room for" in line for line in lines)


@pytest.mark.parametrize("command", ["check", "draw", "world"])
def test_a_wrong_file_is_one_sentence(run, good, tmp_path, command):
    good.write_text(GOOD.replace("#p....", "#p?..."))
    out = {"check": [], "draw": ["--out", "a.svg"], "world": ["--out", "a.sdf"]}[command]
    done = run(command, good, *out)
    assert done.returncode == 1
    assert done.stderr.startswith(f"layout: {good}:5:5: '?' is not a cell of a drawing")
    assert done.stderr.count("\n") == 1
    assert not list(tmp_path.glob("a.*"))


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["chek"],
        ["check"],
        ["draw", "f", "--out", "f.pdf"],
        ["world", "f", "--out", "f.txt"],
        ["convert", "one"],
        ["new", "--out", "a.layout.yaml"],
        ["new", "gigantic", "--out", "a.layout.yaml"],
        ["new", "small", "--out", "a.txt"],
        ["new", "--robots", "2", "--units", "-4", "--out", "a.layout.yaml"],
        ["new", "--robots", "0", "--units", "0", "--out", "a.layout.yaml"],
        ["new", "--robots", "2", "--units", "9", "--block", "3x4", "--out", "a.layout.yaml"],
        ["new", "--robots", "2", "--units", "9", "--block", "2by4", "--out", "a.layout.yaml"],
        ["new", "--robots", "2", "--units", "9", "--sides", "5", "--out", "a.layout.yaml"],
        ["new", "small", "--depth", "1", "--block", "2x4", "--out", "a.layout.yaml"],
        ["new", "small", "--replenish", "-1", "--out", "a.layout.yaml"],
        ["new", "small", "--stations", "9999", "--out", "a.layout.yaml"],
    ],
)
def test_wrong_usage_ends_with_2(run, tmp_path, arguments):
    done = run(*arguments)
    assert done.returncode == 2
    assert "layout" in done.stderr
    assert "Traceback" not in done.stderr
    assert not list(tmp_path.iterdir())


def test_help_names_the_commands(run):
    done = run("--help")
    assert done.returncode == 0
    for command in ("check", "draw", "world", "convert", "new"):
        assert f"    {command} " in done.stdout
        assert run(command, "--help").returncode == 0


def test_a_drawing_keeps_its_words(run, good, tmp_path):
    assert run("draw", good, "--out", "north.svg").returncode == 0
    root = ElementTree.parse(tmp_path / "north.svg").getroot()
    words = {"".join(e.itertext()).strip() for e in root.iter("{http://www.w3.org/2000/svg}text")}
    assert {"north & hall", "15 m", "5 m", "Legend", "one-way street", "robot (2)"} <= words
    assert "conveyor belt" not in words  # there is none


def test_a_drawing_names_stations(run, tmp_path):
    assert run("new", "small", "--out", "s.layout.yaml").returncode == 0
    assert run("draw", "s.layout.yaml", "--out", "s.svg").returncode == 0
    text = (tmp_path / "s.svg").read_text()
    assert all(f">{name}<" in text for name in ("pick1", "pick2", "replenish1"))


def test_a_picture_is_as_large_as_its_floor_is(run, good, tmp_path):
    assert run("draw", good, "--out", "north.png").returncode == 0
    width, height = struct.unpack(">II", (tmp_path / "north.png").read_bytes()[16:24])
    assert width > height > 500


def test_what_does_not_fit_is_drawn_and_reported(run, good, tmp_path):
    good.write_text(GOOD.replace("robots: 2", "robots: 200"))
    assert run("draw", good, "--out", "north.svg").returncode == 0
    assert "200 robots, but there is room for" in (tmp_path / "north.svg").read_text()


def test_a_folder_that_is_none_is_reported(run, good):
    for command, out in (("draw", "no/a.svg"), ("world", "no/a.sdf")):
        done = run(command, good, "--out", out)
        assert done.returncode == 1
        assert done.stderr == f"layout: {out}: No such file or directory\n"


def test_new_writes_a_preset(run, tmp_path):
    done = run("new", "medium", "--out", "medium.layout.yaml")
    assert done.returncode == 0
    expected = generator.of_request(PRESETS["medium"], "medium")
    assert (tmp_path / "medium.layout.yaml").read_text() == lf.text_of(expected)
    assert run("check", "medium.layout.yaml").returncode == 0


def test_new_takes_counts(run, tmp_path):
    counts = ["--robots", 5, "--units", 30, "--stations", 3]
    assert run("new", *counts, "--out", "a.layout.yaml").returncode == 0
    style = ["--replenish", 4, "--sides", 3, "--aisles", "two-way", "--block", "2x4"]
    assert run("new", *counts, *style, "--out", "b.layout.yaml").returncode == 0
    for name, replenish in (("a", 2), ("b", 4)):
        assert (
            f"5 robots, 30 storage units, 3 picking stations, {replenish} replenishment"
            in run("check", f"{name}.layout.yaml").stdout
        )


def test_convert_goes_by_the_names(run, good, tmp_path):
    assert run("convert", good, "north.sdf").returncode == 0
    done = run("convert", "north.sdf", "again.layout.yaml")
    assert (done.returncode, done.stdout) == (0, "")
    assert (tmp_path / "again.layout.yaml").read_text() == lf.text_of(lf.read(good))


def test_convert_tells_what_is_lost(run, tmp_path):
    (tmp_path / "w.sdf").write_text(
        '<sdf version="1.9"><world name="w"><model name="ground_plane"><link name="l">'
        '<collision name="c"><geometry><plane><size>9 9</size></plane></geometry></collision>'
        "</link></model><include><uri>model://no_such_model</uri></include></world></sdf>"
    )
    for extra, code in (([], 1), (["--lenient"], 0)):
        done = run("convert", "w.sdf", "w.layout.yaml", *extra)
        assert done.returncode == code
        assert done.stdout.startswith("no_such_model (model://no_such_model): its model was not")
        assert lf.read(tmp_path / "w.layout.yaml").shape == (9, 9)


def test_convert_divides_a_map_into_cells_as_told(run, tmp_path):
    wall = b"\x00" * 40
    rows = [wall, *[b"\x00" + b"\xff" * 38 + b"\x00"] * 38, wall]
    (tmp_path / "room.pgm").write_bytes(b"P5 40 40 255\n" + b"".join(rows))
    (tmp_path / "map.yaml").write_text(
        "image: room.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.2\n"
    )
    widths = []
    for spacing in ("1", "0.5"):
        done = run(
            "convert",
            "map.yaml",
            "m.layout.yaml",
            "--lenient",
            "--spacing",
            spacing,
            "--angle",
            "0",
        )
        assert done.returncode == 0, done.stderr
        widths.append(lf.read(tmp_path / "m.layout.yaml").floor.shape[1])
    assert abs(widths[1] - 2 * widths[0]) <= 2 and widths[1] > widths[0]
    assert run("convert", "map.yaml", "m.layout.yaml", "--spacing", "-1").returncode == 2


def test_convert_names_the_formats_that_it_knows(run, good):
    done = run("convert", good, "north.docx")
    assert done.returncode == 1
    assert ".layout.yaml" in done.stderr


def test_ctrl_c_ends_it_without_a_traceback(tmp_path):
    program = subprocess.Popen(
        [PROGRAM, "new", "--robots", "9000", "--units", "40000", "--items", "0", "--block", "1x1",
         "--out", tmp_path / "a.layout.yaml"],
        stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    deadline = time.monotonic() + 20
    while not has_read(program.pid, "numpy"):
        assert time.monotonic() < deadline
    program.send_signal(signal.SIGINT)
    _, errors = program.communicate(timeout=20)
    assert program.returncode in (0, -signal.SIGINT)  # it may have been quicker
    assert "Traceback" not in errors


def has_read(pid, library):
    """Tells whether a program has a library in its memory."""
    with open(f"/proc/{pid}/maps") as maps:
        return any(library in line for line in maps)
