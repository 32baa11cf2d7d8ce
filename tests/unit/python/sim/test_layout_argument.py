# SPDX-License-Identifier: Apache-2.0
"""The argument layout:= and what contradicts it."""

import pytest
from paths import ROOT

from warehouse_layout.file import files
from warehouse_sim import layout_argument

LAYOUTS = ROOT / "tests" / "layouts"


def conflicts(**values):
    return layout_argument.conflicts(values, files.worlds(), LAYOUTS)


@pytest.mark.parametrize(
    ("text", "sentences"),
    [
        ("", ""),
        ("medium", ""),
        ("north.layout.yaml", ""),
        ("in_hall.layout.yaml", ""),
        ("blocked.layout.yaml", "loaded robots that meet at"),
        ("north.csv", "north.csv:1:1:"),
        ("nix", "no such layout file, and 'nix' is not a preset; known are empty, small"),
        ("nix.layout.yaml", "nix.layout.yaml: No such file or directory"),
    ],
)
def test_a_layout_is_checked_from_where_it_was_typed(text, sentences):
    fault = layout_argument.fault(text, LAYOUTS)
    assert sentences in fault if sentences else fault == ""


def test_policies_of_the_file_are_checked(tmp_path):
    text = (LAYOUTS / "in_hall.layout.yaml").read_text() + "policies: {orders: best}\n"
    (tmp_path / "x.layout.yaml").write_text(text)
    fault = layout_argument.fault("x.layout.yaml", tmp_path)
    assert "x.layout.yaml: policies: orders: there is no 'best'; " in fault


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"layout": "north.layout.yaml", "size": "none", "robots": "7"}, ""),
        ({"layout": "in_hall.layout.yaml"}, ""),
        ({"layout": "in_hall.layout.yaml", "world": "hall"}, ""),
        ({"layout": "medium", "robots": "50"}, ""),
        ({"layout": "small", "size": "large"}, "size:=large: with layout:=small it was expected"),
        ({"layout": "small", "at": "1,2"}, "at:=1,2: with layout:=small it was expected to be"),
        ({"robots": "4"}, "robots:=4: it is for layout:="),
        ({"layout": "north.layout.yaml", "robots": "99"}, "99 robots, but there is room for 23"),
        ({"layout": "in_hall.layout.yaml", "world": "empty"}, "world:=empty: layout:=in_hall"),
        ({"layout": "medium", "world": "hall"}, "world:=hall: a layout file was expected"),
        ({"layout": "north.layout.yaml", "world": "hall"}, "spacing is 1.2 m, but the grid of"),
    ],
)
def test_what_contradicts_a_layout_is_told(values, sentence):
    faults = conflicts(**values)
    assert [sentence in fault for fault in faults] == ([True] if sentence else [])


def test_a_building_with_something_in_the_way_is_told(tmp_path):
    text = (LAYOUTS / "in_hall.layout.yaml").read_text().replace("[-5, -5]", "[-3, -5]")
    (tmp_path / "x.layout.yaml").write_text(text)
    faults = conflicts(layout=str(tmp_path / "x.layout.yaml"))
    assert "something of hall stands at [9, 0], [10, 0]" in faults[0]


def test_the_world_of_a_layout(tmp_path):
    def world(layout, named=""):
        return layout_argument.world_of(layout, named, LAYOUTS, tmp_path)

    assert world("medium") == ""
    assert world("in_hall.layout.yaml") == str(files.worlds() / "hall.sdf")
    assert world("in_hall.layout.yaml", "hall") == "hall"
    made = tmp_path / "warehouse" / "empty-1.2.sdf"
    assert world("north.layout.yaml") == str(made)
    assert "<spacing>1.2</spacing>" in made.read_text()
