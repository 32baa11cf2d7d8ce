# SPDX-License-Identifier: Apache-2.0
"""A station has a screen and labels; a name that is none is told, and what is asked for checked."""

import asyncio
import re

import pytest
from asgi import request
from paths import ROOT
from starlette.applications import Starlette

from warehouse_viewer.server import labels
from warehouse_viewer.server.station_pages import StationPages

CODES = ROOT / "src/warehouse_viewer/web/js/station/codes.js"


async def totes(name):
    await asyncio.sleep(0)
    return {"pick1": 3, "replenish1": 0}.get(name)


def get(path):
    return request(Starlette(routes=StationPages(totes).routes()), path)


def test_a_station_has_a_screen_and_its_worker():
    answer = get("/station/pick1")
    assert answer.status == 200 and b'id="wall"' in answer.body
    worker = get("/station-worker.js")
    assert worker.headers["content-type"].startswith("text/javascript")
    assert get("/station/").headers["location"] == "/operations"


def test_labels_of_totes_buttons_and_goods_are_printed():
    text = get("/station/pick1/labels").body.decode()
    assert re.findall(r"<small>(pick1-\d+)</small>", text) == ["pick1-1", "pick1-2", "pick1-3"]
    assert "CMD-UNDO" in text and text.count("data:image/svg+xml") == 3 + len(labels.COMMANDS)
    assert "Totes" not in get("/station/replenish1/labels").body.decode()
    goods = labels.page("pick1", 0, ["a<b>"])
    assert "a&lt;b&gt;" in goods and "<b>a<b>" not in goods


def test_the_screen_knows_the_codes_that_are_printed():
    result = re.search(r"COMMANDS = \[(.*?)\]", CODES.read_text())
    assert re.findall(r"'(\w+)'", result.group(1)) == list(labels.COMMANDS)


def test_a_name_of_no_station_is_reported():
    answer = get("/station/<x>/labels")
    assert answer.status == 404 and "there is no station &#x27;&lt;x&gt;&#x27;" in (
        answer.body.decode()
    )


@pytest.mark.parametrize(
    ("skus", "fault"),
    [
        (["sku-1"], ""),
        ([""], "'' is not an SKU"),
        (["x" * 81], "is not an SKU"),
        (["a\nb"], "is not an SKU"),
        (["a"] * 201, "201 SKUs are asked for; 200 at most were expected"),
    ],
    ids=["good", "empty", "long", "line", "many"],
)
def test_what_is_no_sku_gets_no_label(skus, fault):
    result = labels.fault_of(skus)
    assert result.endswith(fault) if fault else result == ""
