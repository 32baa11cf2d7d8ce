# SPDX-License-Identifier: Apache-2.0
"""What is checked before a launch: the arguments, and which master is about to be used."""

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

from warehouse_layout.file import files
from warehouse_sim import launch_arguments, launching
from warehouse_sim.launching import Caller, LaunchError, master_of

ROSLAUNCH = ["/usr/bin/python3", "/usr/bin/roslaunch"]
LAUNCH = launching.SHARE / "launch"


def caller(*words, program=ROSLAUNCH, cwd="/"):
    return Caller([*program, *words], cwd, launching.SHARE)


@pytest.fixture
def place(tmp_path):
    return launch_arguments.Place(tmp_path, files.worlds())


@pytest.mark.parametrize("port", [["-p", "4711"], ["-p4711"], ["--port", "4711"], ["--port=4711"]])
def test_the_port_that_roslaunch_was_given(port):
    line = caller("warehouse_sim", "warehouse.launch", *port, "size:=large")
    assert master_of(line, {"ROS_MASTER_URI": "http://robots:11311"}) == "http://localhost:4711"


def test_else_that_of_the_environment():
    line = caller("warehouse_sim", "warehouse.launch", "--pid=x")
    assert master_of(line, {"ROS_MASTER_URI": "http://robots:1"}) == "http://robots:1"
    assert master_of(line, {}) == "http://localhost:11311"


def test_the_namespace_is_that_of_the_command_line_or_the_environment():
    assert caller("warehouse_sim", "warehouse.launch").namespace({}) == "/"
    assert caller("warehouse_sim", "x.launch").namespace({"ROS_NAMESPACE": "sim1"}) == "/sim1/"
    named = caller("warehouse_sim", "x.launch", "__ns:=sim2")
    assert named.namespace({"ROS_NAMESPACE": "sim1"}) == "/sim2/"


def test_rostest_brings_a_master_of_its_own():
    rostest = ["/usr/bin/python3", "/usr/bin/rostest"]
    assert master_of(caller("roslaunch.test", program=rostest), {}) is None


@pytest.mark.parametrize(
    ("environment", "open_"),
    [
        ({}, True),
        ({"ROS_MASTER_URI": "http://127.0.0.1:11312"}, True),
        ({"ROS_HOSTNAME": "localhost"}, False),
        ({"ROS_IP": "10.0.0.1"}, False),
        ({"ROS_MASTER_URI": "http://robots:11311"}, False),
    ],
)
def test_a_launch_that_other_machines_reach_is_told(environment, open_):
    warning = launching.openness(caller("warehouse_sim", "warehouse.launch"), environment)
    assert ("ROS_HOSTNAME=localhost" in warning) == open_


def of_ours():
    return sorted(LAUNCH.glob("*.launch"))


@pytest.mark.parametrize("path", of_ours(), ids=lambda path: path.name)
def test_every_argument_of_a_launch_file_has_a_check(path):
    assert launching.known_arguments(path, launching.SHARE) <= launch_arguments.ARGUMENTS.keys()


def test_what_a_launch_file_is_given_by_another_is_checked_too():
    root = ElementTree.parse(LAUNCH / "warehouse.launch").getroot()
    handed_on = root.find("param").get("command").split()
    names = {arg.get("name") for arg in root.findall("arg") if "value" not in arg.attrib}
    assert {word.split(":=")[0] for word in handed_on if ":=" in word} == names


@pytest.mark.parametrize("path", of_ours(), ids=lambda path: path.name)
def test_defaults_are_right(path, place):
    for arg in ElementTree.parse(path).getroot().findall("arg"):
        if "value" in arg.attrib:
            continue
        default = arg.get("default", "")
        if "$" not in default:
            assert not launch_arguments.faults({arg.get("name"): default}, place)


@pytest.mark.parametrize(
    ("name", "wrong", "expected"),
    [
        ("size", "smal", "none, empty, small, .* (did you mean 'small'?)"),
        ("rtf", "-1", "a factor above 0, or 0"),
        ("rtf", "nan", "a factor above 0, or 0"),
        ("rtf", "fast", "a factor above 0, or 0"),
        ("seed", "abc", "a whole number from 0 to 2147483647"),
        ("seed", "-1", "a whole number from 0"),
        ("seed", "1.5", "a whole number from 0"),
        ("seed", "99999999999", "a whole number from 0"),
        ("drive", "foo", "nothing, traction, jointed"),
        ("drive", "tracton", "did you mean 'traction'?"),
        ("threads", "-3", "a whole number from 0 to 256"),
        ("threads", "257", "a whole number from 0 to 256"),
        ("autosave", "often", "a whole number from 0 to 100000"),
        ("viewer_port", "99999", "a whole number from 0 to 65535"),
        ("viewer", "yes", "true or false"),
        ("rviz", "", "true or false"),
        ("realism", "typcal", "bad_day, ideal, typical .*did you mean 'typical'?"),
        ("realism", "mine.yaml", "bad_day, ideal, typical or a YAML file"),
        ("transports", "all", "none, random"),
        ("exchange", "0", "a number of seconds above 0"),
        ("exchange", "inf", "a number of seconds above 0"),
        ("record", "no/such/folder/run.bag", "a file that can be written"),
        ("replay", "run.bag", "a recording was expected; .*/run.bag is not there"),
        ("planner", "mine.yaml", "a YAML file that names a planner"),
        ("world", "bogus", "there is no world 'bogus'; tried"),
        ("viewer_token_file", "token", "token: No such file"),
        ("viewer_host", "no.such host", "an address of this machine"),
        ("cmd_vel", "kiva0", "names of robots were expected, such as 'kiva1 kiva2'"),
        ("cmd_vel", "kiva1 rover", "names of robots were expected"),
        ("map_resolution", "0", "a cell of 0.01 to 1 m"),
        ("map_resolution", "2", "a cell of 0.01 to 1 m"),
    ],
)
def test_one_sentence_names_argument_value_and_what_was_expected(name, wrong, expected, place):
    (text,) = launch_arguments.faults({name: wrong}, place)
    assert text.startswith(f"{name}:={wrong}: ")
    rest = text
    for part in expected.split(".*"):
        assert part in rest, text
        rest = rest[rest.index(part) + len(part) :]
    assert "\n" not in text


@pytest.mark.parametrize("text", ["", "kiva1", "kiva1 kiva23", "1,2", "kiva1000000"])
def test_robots_are_named_or_numbered(text, place):
    assert not launch_arguments.faults({"cmd_vel": text}, place)


@pytest.mark.parametrize("path", of_ours(), ids=lambda path: path.name)
def test_what_no_launch_file_knows_is_refused_with_the_nearest_name(path, place):
    known = launching.known_arguments(path, launching.SHARE)
    typed, meant = ("wrold", "world") if "world" in known else ("sede", "seed")
    line = caller("warehouse_sim", path.name, f"{typed}:=paper")
    with pytest.raises(LaunchError, match=rf"no argument '{typed}' \(did you mean '{meant}'\?\)"):
        launching.check_arguments({}, line, place)


def test_so_are_those_that_a_launch_file_sets_itself(place):
    line = caller("warehouse_sim", "empty_world.launch", "size:=small")
    with pytest.raises(LaunchError, match="no argument 'size'"):
        launching.check_arguments({}, line, place)


def test_arguments_of_a_launch_file_of_ones_own(tmp_path, place):
    include = "$(find warehouse_sim)/launch/warehouse.launch"
    (tmp_path / "mine.launch").write_text(
        '<launch><arg name="drive" default="car"/>'
        f'<include file="{include}"><arg name="seed" value="x"/></include></launch>',
        encoding="utf-8",
    )
    line = caller("mine.launch", "drive:=bus", cwd=tmp_path)
    with pytest.raises(LaunchError) as refused:
        launching.check_arguments({"seed": "x"}, line, place)
    assert str(refused.value).startswith("seed:=x: a whole number")
    with pytest.raises(LaunchError, match="no argument 'colour'"):
        launching.check_arguments({}, caller("mine.launch", "colour:=red", cwd=tmp_path), place)


def test_what_is_remapped_is_no_argument(place):
    line = caller("warehouse_sim", "warehouse.launch", "__log:=/tmp/x", "size:=small", "--screen")
    launching.check_arguments({}, line, place)


def test_a_launch_file_that_is_not_found_is_left_to_roslaunch(place):
    launching.check_arguments({}, caller("theirs", "theirs.launch", "a:=b"), place)
    assert caller("x.launch").name == "warehouse.launch"
    assert caller("warehouse_sim", "demo.launch").name == "demo.launch"
    assert isinstance(caller("warehouse_sim", "demo.launch").launch_file(), Path)
