# SPDX-License-Identifier: Apache-2.0
"""Rows keep numbers and texts of any length in memory that is taken at once."""

import pytest

from warehouse_viewer.rows import Rows

LONG = "kiva1 waits behind kiva2 " * 9


@pytest.fixture
def rows():
    return Rows(3, {"id": int, "time": float, "text": 12})


@pytest.mark.parametrize("text", ["", "done", "x -47.5…47.5", LONG, "ends in \0", "\udc80"])
def test_a_row_comes_back_as_it_was(rows, text):
    row = {"id": 2**40, "time": 12.345, "text": text}
    rows[1] = row
    assert rows[1] == row
    assert [type(value) for value in rows[1].values()] == [int, float, str]


def test_a_long_text_goes_with_its_row(rows):
    rows[0] = {"id": 1, "time": 0.0, "text": LONG}
    rows[0] = {"id": 2, "time": 0.0, "text": ""}
    assert rows[0]["text"] == ""


def test_rows_that_grow_keep_what_they_had(rows):
    rows[2] = {"id": 7, "time": 1.0, "text": LONG}
    rows.grow(2)
    assert len(rows) == 5 and rows[2]["text"] == LONG
    rows[4] = {"id": 8, "time": 2.0, "text": "new"}
    assert rows[4]["id"] == 8 and rows[2]["id"] == 7
