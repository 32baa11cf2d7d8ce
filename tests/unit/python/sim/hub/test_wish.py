# SPDX-License-Identifier: Apache-2.0
"""Requests for simulations: each field is checked before anything starts."""

import pytest

from warehouse_layout.file import layout_file
from warehouse_layout.file.request import PRESETS
from warehouse_layout.generate import generator
from warehouse_sim.hub import forms, wish
from warehouse_sim.hub.wish import WishError

SMALL = layout_file.text_of(generator.of_request(PRESETS["small"], "small"))


def test_arguments_go_to_the_launch_file_as_text(tmp_path):
    asked = wish.read({"name": "a-1", "size": "small", "rtf": 5, "coordinator": True}, tmp_path)
    assert (asked.name, asked.file) == ("a-1", "warehouse.launch")
    assert asked.arguments == {"size": "small", "rtf": "5", "coordinator": "true"}


@pytest.mark.parametrize(
    "kind, file", [("shift", "operations.launch"), ("empty", "empty_world.launch")]
)
def test_a_shift_and_an_empty_world_have_launch_files_of_their_own(tmp_path, kind, file):
    assert wish.read({"name": "a", kind: True}, tmp_path).file == file


def test_orders_ask_for_a_shift(tmp_path):
    assert wish.read({"name": "a", "orders": "poisson:100"}, tmp_path).file == "operations.launch"


@pytest.mark.parametrize(
    "body, field, reason, nearest",
    [
        ({}, "name", "small letters", ""),
        ({"name": "My Hall"}, "name", "small letters", "my-hall"),
        ({"name": "../a"}, "name", "small letters", "a"),
        ({"name": "a", "size": "meduim"}, "size", "one of none", "medium"),
        ({"name": "a", "sise": "small"}, "sise", "no such argument", "size"),
        ({"name": "a", "rtf": float("nan")}, "rtf", "a factor above 0", ""),
        ({"name": "a", "seed": -1}, "seed", "a whole number", ""),
        ({"name": "a", "robots": [3]}, "robots", "a text, a number", ""),
        ({"name": "a", "viewer_port": 80}, "viewer_port", "the hub sets it", ""),
        ({"name": "a", "shift": "yes"}, "shift", "true or false", ""),
        ({"name": "a", "shift": True, "empty": True}, "empty", "a shift needs a warehouse", ""),
        ({"name": "a", "orders": "fill", "shift": False}, "orders", "no such argument", ""),
        ({"name": "a", "world": "mars"}, "world", "there is no world 'mars'", ""),
        ({"name": "a", "realism": "a\nb"}, "realism", "one line", ""),
        ({"name": "a", "size": "x" * 5000}, "size", "5000 characters", ""),
        ({"name": "a", "robots": 3}, "robots", "it is for layout:=", ""),
        ({"name": "a", "planner": "\0"}, "planner", "one line", ""),
    ],
)
def test_a_wrong_field_is_named_with_the_nearest_right_value(
    tmp_path, body, field, reason, nearest
):
    with pytest.raises(WishError) as error:
        wish.read(body, tmp_path)
    assert error.value.field == field
    assert reason in error.value.reason
    assert error.value.nearest == nearest


def test_a_layout_may_come_as_text(tmp_path):
    asked = wish.written(wish.read({"name": "mine", "layout": SMALL}, tmp_path), tmp_path)
    path = tmp_path / "mine.layout.yaml"
    assert asked.arguments == {"layout": str(path)}
    assert path.read_text() == SMALL


def test_a_layout_in_which_no_fleet_can_work_is_refused(tmp_path):
    asked = wish.read({"name": "mine", "layout": SMALL.replace("s", "#")}, tmp_path)
    with pytest.raises(WishError) as error:
        wish.written(asked, tmp_path)
    assert error.value.field == "layout"


def test_a_wish_is_kept():
    asked = wish.Wish("a", "operations.launch", {"size": "small"})
    import json

    assert wish.Wish.from_json(json.dumps(asked.as_json())) == asked
    for text in ("", "[]", '{"name": "a"}', "null"):
        with pytest.raises(ValueError):
            wish.Wish.from_json(text)


def test_each_argument_of_a_form_is_documented():
    rows = forms.arguments()["arguments"]
    names = {row["name"] for row in rows}
    assert {"size", "layout", "world", "orders", "realism", "rtf", "seed"} <= names
    assert not names & {*wish.OWN}
    assert all(row["documentation"] and row["files"] for row in rows)
    (orders,) = (row for row in rows if row["name"] == "orders")
    assert orders["files"] == ["operations.launch"]
