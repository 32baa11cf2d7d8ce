# SPDX-License-Identifier: Apache-2.0
"""The commands a person is told to try must work in the very warehouse that stands."""

import re
from pathlib import Path

import numpy as np
import pytest
import yaml
from grid import Grid

from warehouse_client.routes import covered, elbow, point
from warehouse_client.survey import BELT, Survey, of_models
from warehouse_layout.file.request import PRESETS, resolve
from warehouse_layout.generate.generated import plan
from warehouse_sim import hints


def survey_of(layout):
    units = np.pad(layout.units, ((0, 0), (0, 1)))
    kinds = {"kiva": layout.robots, "storage_unit": units, "conveyor_belt": layout.belts}
    pairs = ((f"{kind}{i}", p) for kind, ps in kinds.items() for i, p in enumerate(ps, start=1))
    return of_models(dict(pairs))


def fields(command):
    """(topic, fields) of a `rostopic pub` line."""
    topic, text = re.match(r"rostopic pub -1 /(\w+) \S+ '(.*)'$", command).groups()
    return topic, yaml.safe_load(text)


@pytest.mark.parametrize("name", [name for name in PRESETS if name != "empty"])
def test_a_unit_is_fetched(name):
    layout = plan(resolve(name))
    (go, lift, out) = (fields(command) for command, _ in hints.commands(survey_of(layout)))
    robots = [point(p) for p in layout.robots]
    belts = [p for belt in layout.belts for p in covered(*belt, *BELT)]
    empty_handed = Grid(layout.floor, belts + robots)
    loaded = Grid(layout.floor, belts + robots + list(layout.units))

    assert (go[0], lift[0]) == ("mov", "lift")
    start, goal = robots[go[1]["kiva_id"] - 1], (go[1]["x"], go[1]["y"])
    assert all(empty_handed.free(p) for p in elbow(start, goal)[1:])
    assert lift[1]["status"] == 1
    assert point(layout.units[lift[1]["shelf_id"] - 1]) == goal
    step = np.array({"movx": (1, 0), "movy": (0, 1)}[out[0]]) * out[1]["distance"]
    assert loaded.free(point(step + goal))
    assert go[1]["kiva_id"] == lift[1]["kiva_id"] == out[1]["kiva_id"]


def test_without_units_a_robot_takes_a_stroll():
    layout = plan(resolve("", robots=3))
    ahead, turn, home = (fields(command) for command, _ in hints.commands(survey_of(layout)))
    assert ahead == ("movy", {"distance": 1, "kiva_id": 1})
    assert turn[0] == "rot"
    assert (home[1]["x"], home[1]["y"]) == point(layout.robots[0])


def test_a_unit_behind_a_belt_is_left_alone():
    survey = Survey(kiva={3: (0, 0, 0)}, storage_unit={5: (4, 0, 0)}, conveyor_belt={1: (2, 0, 0)})
    assert fields(hints.commands(survey)[0][0])[0] == "movx"


def test_a_unit_is_left_alone_that_only_comes_out_through_another():
    survey = Survey(kiva={1: (0, 0, 0)}, storage_unit={1: (0, 0, 0), 2: (1, 0, 0)})
    assert fields(hints.commands(survey)[0][0])[0] == "movx"


def test_on_an_empty_floor_one_may_build():
    assert "create_warehouse_models" in hints.commands(Survey())[0][0]


def test_robots_of_a_coordinator_are_looked_at():
    survey = Survey(kiva={1: (0, 0, 0)}, storage_unit={1: (1, 0, 0)})
    assert not any("rostopic pub" in command for command, _ in hints.commands(survey, True))


def test_greeting_reads_well():
    text = hints.greeting("small: 4 robots", [("a b", "first"), ("abc d", "second")])
    assert "    a b     # first\n    abc d   # second\n" in text
    assert "source devel/setup.bash" in text


def test_nothing_is_sourced_where_the_system_finds_packages(monkeypatch):
    monkeypatch.setattr(hints, "SYSTEM", Path(hints.__file__).parents[1])
    assert "setup.bash" not in hints.greeting("small: 4 robots", [("a b", "first")])


def test_a_survey_says_what_it_found():
    names = ["kiva1", "ground_plane", "person1", "storage_unit1", "storage_unit2"]
    survey = of_models(dict.fromkeys(names, (0, 0, 0)))
    assert str(survey) == "1 robot, 2 storage units, 1 other model"
    assert str(Survey()) == "an empty floor"


def test_in_a_namespace_the_names_are_those_within():
    pairs = [("rostopic echo -n 1 /warehouse/state", "all"), ("rosrun warehouse_sim events", "")]
    assert hints.within("/", pairs) == pairs
    assert hints.within("/sim1/", pairs) == [
        ("rostopic echo -n 1 /sim1/warehouse/state", "all"),
        ("ROS_NAMESPACE=/sim1 rosrun warehouse_sim events", ""),
    ]
