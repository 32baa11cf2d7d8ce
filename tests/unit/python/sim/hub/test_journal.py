# SPDX-License-Identifier: Apache-2.0
"""The hub's journal: one file, readable, bounded, and read again by the next hub."""

import json

from warehouse_sim.hub import journal
from warehouse_sim.hub.journal import Journal


def entry(**texts):
    return {"who": '"bot" at 127.0.0.1', "action": "stop_simulation"} | texts


def test_entries_are_lines_of_a_file_and_stay(tmp_path):
    book = Journal(tmp_path)
    book.add("assistant", entry(arguments={"name": "one"}, outcome="stopped"), True)
    book.add("person", entry(simulation="two", outcome="refused"), False)
    lines = [json.loads(line) for line in (tmp_path / journal.NAME).read_text().splitlines()]
    assert [line["id"] for line in lines] == [1, 2]
    assert lines[0]["arguments"] == '{"name": "one"}' and lines[0]["done"]
    assert not lines[1]["done"]

    again = Journal(tmp_path)
    assert [e["id"] for e in again.since(0)] == [1, 2]
    assert again.add("person", entry(), True)["id"] == 3
    assert [e["id"] for e in again.since(1, limit=1)] == [3]
    assert [e["id"] for e in again.since(0, "two")] == [2]


def test_texts_are_one_bounded_line(tmp_path):
    book = Journal(tmp_path)
    out = book.add("assistant", entry(who="a\n\x1b[2Jb", outcome=5000 * "x"), True)
    assert out["who"] == "a  [2Jb" and len(out["outcome"]) == 400
    assert len((tmp_path / journal.NAME).read_text().splitlines()) == 1


def test_a_line_that_was_cut_off_is_left_out(tmp_path):
    (tmp_path / journal.NAME).write_text('{"id": 4, "simulation": ""}\n{"id": 5, "wh\n[]\nnull\n')
    assert [e["id"] for e in Journal(tmp_path).since(0)] == [4]


def test_the_file_is_bounded(tmp_path, monkeypatch):
    monkeypatch.setattr(journal, "MOST_BYTES", 2000)
    book = Journal(tmp_path)
    for _ in range(50):
        book.add("person", entry(), True)
    files = sorted(tmp_path.iterdir())
    assert len(files) == 2 and all(file.stat().st_size < 2500 for file in files)
    assert Journal(tmp_path).since(0)[-1]["id"] == 50
