# SPDX-License-Identifier: Apache-2.0
"""Files that a user names: a device, a pipe or a huge one is refused at once, by every reader."""

import os
import signal
from contextlib import contextmanager
from pathlib import Path

import pytest

from warehouse_fleet.league import league_plan, problem
from warehouse_fleet.planners import planner_plugins, scorer
from warehouse_layout.convert import common
from warehouse_layout.convert.maps import ros_map
from warehouse_layout.convert.rawsim import xml_fields as rawsim_xml
from warehouse_layout.file import csv_table, layout_file, user_file
from warehouse_layout.models import sdf_world, world_file
from warehouse_learning import episodes
from warehouse_learning.marl import policy
from warehouse_operations.stock import yaml_file
from warehouse_operations.store import engines
from warehouse_vda5050.master import robots_file
from warehouse_vda5050.mqtt import settings
from warehouse_viewer.drawing import recording
from warehouse_viewer.replay import bag, file
from warehouse_viewer.server import token

PATIENCE = 10  # [s]; a pipe would be waited for, a device read, for ever
HUGE = 2**42  # [byte], of which none is on the disk


def of_map(path):
    """The picture that a map.yaml names."""
    about = Path(path).parent / "map.yaml"
    about.write_text(f"image: {path}\nresolution: 0.05\norigin: [0, 0, 0]\n")
    ros_map.read(about, 1.0)


READERS = {
    "text": common.text_of,
    "picture": of_map,
    "layout": layout_file.read,
    "world": sdf_world.read,
    "insertion": lambda path: world_file.insertable(path, []),
    "instance": lambda path: rawsim_xml.read_root(path, "instance"),
    "table": lambda path: csv_table.CsvTable(path, ["sku"]),
    "policies": lambda path: yaml_file.read_yaml(path, ValueError),
    "planner": planner_plugins.read_spec,
    "problem": problem.read,
    "result": lambda path: league_plan._Result(Path(path)),
    "weights": lambda path: scorer.load(path, "orders", 3),
    "policy": policy.load,
    "episode": episodes.load,
    "robots": lambda path: robots_file.read(Path(path)),
    "password": settings._password,
    "token": lambda path: token.read(Path(path)),
    "database": engines.open_engine,
    "recording": lambda path: file.FileRecording(Path(path)),
    "bag": lambda path: bag.convert(Path(path), Path(path).with_name("out"), lambda _: None),
    "film": lambda path: next(recording.moments(str(path), 1.0)),
}


@contextmanager
def soon():
    """Interrupts what does not end."""

    def interrupt(*_):
        raise AssertionError("it is still read")

    before = signal.signal(signal.SIGALRM, interrupt)
    signal.alarm(PATIENCE)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def pipe(folder):
    os.mkfifo(folder / "pipe", 0o600)
    return folder / "pipe"


def huge(folder):
    path = folder / "huge"
    path.touch(0o600)
    os.truncate(path, HUGE)
    return path


@pytest.mark.parametrize("name", READERS)
def test_a_pipe_and_a_device_are_refused(tmp_path, name):
    for path in (pipe(tmp_path), Path("/dev/zero")):
        with soon(), pytest.raises(Exception, match="regular file|is not a file|no such") as error:
            READERS[name](path)
        assert not isinstance(error.value, AssertionError)


ANY_SIZE = {"token", "database", "recording", "bag", "film"}  # they read its beginning


@pytest.mark.parametrize("name", sorted(READERS.keys() - ANY_SIZE))
def test_a_huge_file_is_refused_by_its_size(tmp_path, name):
    with soon(), pytest.raises(Exception, match="MB") as error:
        READERS[name](huge(tmp_path))
    assert not isinstance(error.value, AssertionError)


def test_texts_are_read_as_before(tmp_path):
    path = tmp_path / "text"
    path.write_bytes("\ufeffä\r\nb\rc\n".encode())
    assert user_file.read_text(path, "utf-8-sig") == "ä\nb\nc\n"
    with pytest.raises(IsADirectoryError):
        user_file.read_text(tmp_path)
    with pytest.raises(FileNotFoundError):
        user_file.read_bytes(tmp_path / "none")
