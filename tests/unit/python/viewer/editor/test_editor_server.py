# SPDX-License-Identifier: Apache-2.0
"""The server's side of the layout editor: checks, files, generated drawings, trials."""

import base64
import json

import pytest
from asgi import request

from warehouse_layout.file import layout_file
from warehouse_layout.file.request import PRESETS
from warehouse_layout.generate import generator
from warehouse_viewer.editor import checking, drawing_json, standalone, trial
from warehouse_viewer.server.access import AccessControl

SMALL = layout_file.text_of(generator.of_request(PRESETS["small"], "small"))
TWO_ON_A_LINE = """layout: 1
floor: |
  .........
  .........
  .........
  ......A..
  .........
  .........
  .........
  ......B..
  .........
  .........
  .........
stations:
  A: {name: a}
  B: {name: b}
"""


def ask(path, body=None, method="POST", file=None, limit=AccessControl):
    """(status, answer) of a request to the page's server."""
    sent = b"" if body is None else json.dumps(body).encode()
    app = limit(standalone.application(file))
    headers = {"host": "localhost", "content-length": str(len(sent))}
    answer = request(app, path, method=method, headers=headers, body=[sent])
    return answer.status, json.loads(answer.body)


def files(**contents):
    return {
        "files": {
            n.replace("_", "."): base64.b64encode(t.encode()).decode() for n, t in contents.items()
        }
    }


def test_the_page_is_served():
    answer = request(AccessControl(standalone.application()), "/layout", headers={"host": "[::1]"})
    assert answer.status == 200 and b"js/editor/main.js" in answer.body
    answer = request(AccessControl(standalone.application()), "/layout", headers={"host": "evil"})
    assert answer.status == 403


def test_a_good_layout_has_no_faults():
    assert ask("/layout/check", {"text": SMALL}) == (
        200,
        {"faults": [], "remarks": [], "lanes": {}},
    )


def test_what_robots_leave_out_is_a_remark():
    text = SMALL[: SMALL.index("floor:")] + "floor: |2\n  >..v\n  ^ssv\n  ^<<<\nrobots: 0\n"
    status, answer = ask("/layout/check", {"text": text})
    (remark,) = answer["remarks"]
    assert (status, answer["faults"]) == (200, [])
    assert remark.startswith("robots with bodies do not drive from [2, 2] to [1, 2]: ")


def test_faults_have_sentences_and_cells():
    text = SMALL.replace("robots: [[", "robots: [[0, 12], [")
    _, result = ask(
        "/layout/check", {"text": text.replace("storage_units: 24", "storage_units: 99")}
    )
    assert result["faults"] and all(f["text"] and "cells" in f for f in result["faults"])
    _, result = ask("/layout/check", {"text": "layout: 1\nfloor: |\n  .?\n"})
    assert result["faults"][0]["text"].startswith("3:4: '?' is not a cell")


def test_lanes_that_are_found_leave_room_for_each_other():
    result = checking.checked(TWO_ON_A_LINE)
    lanes = {key: {tuple(cell) for cell in cells} for key, cells in result["lanes"].items()}
    assert set(lanes) == {"A", "B"} and not lanes["A"] & lanes["B"]
    assert not result["faults"]


def test_a_file_is_opened_as_it_is():
    status, result = ask("/layout/read", files(small_layout_yaml=SMALL))
    assert status == 200 and result["told"] == []
    assert result["drawing"] == json.loads(
        json.dumps(drawing_json.of_file(layout_file.parse(SMALL, "small.layout.yaml")))
    )


@pytest.mark.parametrize(
    ("sent", "reason"),
    [
        (files(a_layout_yaml="layout: 1\nflor: x"), "a.layout.yaml:2:1: 'flor' is not a key"),
        (files(), "one file to open was expected, not nothing"),
        (files(a_layout_yaml=SMALL, b_layout_yaml=SMALL), "one file to open was expected"),
        ({"files": {"../../x.layout.yaml": "?"}}, "x.layout.yaml: can't be taken"),
    ],
)
def test_a_wrong_file_is_refused_with_the_reason(sent, reason):
    status, result = ask("/layout/read", sent)
    assert status == 409 and result["detail"].startswith(reason), result


@pytest.mark.parametrize("body", [None, [], {"txt": ""}, {"text": 3}])
def test_a_wrong_request_is_reported(body):
    assert ask("/layout/check", body)[0] == 422


def test_a_drawing_is_generated_from_counts():
    counts = {"robots": 4, "units": 24, "items": 96, "stations": 2}
    status, drawing = ask("/layout/new", counts)
    assert status == 200 and len(drawing["robots"]) == 4
    assert [s["kind"] for s in drawing["stations"]].count("pick") == 2
    assert ask("/layout/new", counts | {"stations": 0})[0] == 409
    assert ask("/layout/new", counts | {"items": 10**5})[0] == 409


def test_the_file_is_written_whole_or_not_at_all(tmp_path):
    file = tmp_path / "a.layout.yaml"
    assert ask("/layout/file", {"text": SMALL}, "PUT", file)[0] == 200
    assert ask("/layout/file", {"text": "layout: 2"}, "PUT", file)[0] == 409
    assert file.read_text() == SMALL and list(tmp_path.iterdir()) == [file]
    assert ask("/layout/about", None, "GET", file)[1]["drawing"]["name"] == "small"
    assert ask("/layout/file", {"text": SMALL}, "PUT")[0] == 409


def test_large_layouts_pass_but_not_elsewhere():
    large = "layout: 1\nfloor: |\n" + ("  " + "." * 400 + "\n") * 400
    assert ask("/layout/check", {"text": large})[0] == 200
    assert ask("/other", {"text": large})[0] == 413


def test_a_trial_tells_how_far_it_is_and_what_came_of_it():
    *_, last = trial.lines(SMALL)
    result = last["result"]
    assert result["seconds"] == trial.SECONDS and result["pieces"] > 50
    assert sum(result["per_minute"]) == result["pieces"]
    assert {s["name"] for s in result["stations"]} >= {"pick1", "pick2"}
    assert len(result["traffic"]) == len(result["waiting"]) == 21 * 14
    assert max(result["traffic"]) > 0


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (("items: 96", "items: 0"), "the drawing lacks an item in stock"),
        (("kind: pick", "kind: replenish"), "the drawing lacks a picking station"),
        (("storage_units: 24", "storage_units: 99"), "99 storage units, but"),
    ],
)
def test_a_trial_says_what_is_missing(change, reason):
    with pytest.raises(ValueError, match=reason):
        list(trial.lines(SMALL.replace(*change)))
