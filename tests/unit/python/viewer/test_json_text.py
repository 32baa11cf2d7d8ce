# SPDX-License-Identifier: Apache-2.0
"""JSON knows no NaN: what is not finite is null, for pages and for programs."""

import json
import math

import pytest

from warehouse_viewer.json_text import JSONResponse, dumps

TOLD = {"a": [1.0, math.nan, (math.inf, "ä")], "b": {"c": -math.inf}, "d": 2}


def strict(text):
    def refuse(word):
        raise AssertionError(f"{word} is not JSON")

    return json.loads(text, parse_constant=refuse)


@pytest.mark.parametrize("text", [dumps(TOLD), JSONResponse(TOLD).body], ids=["text", "response"])
def test_what_is_not_finite_is_null(text):
    assert strict(text) == {"a": [1.0, None, [None, "ä"]], "b": {"c": None}, "d": 2}


def test_a_half_of_a_character_is_written_too():
    assert strict(JSONResponse({"detail": "\ud800"}).body) == {"detail": "\ud800"}
