# SPDX-License-Identifier: Apache-2.0
"""Stations and the four figures at a glance; orders as sheets."""

import zipfile
from io import BytesIO

import pytest
from sample_messages import fleet

from warehouse_msgs.msg import Kpis, StationState, Throughput
from warehouse_viewer.api import order_sheet
from warehouse_viewer.page.activities import QUEUED_TOO_LONG, Activity
from warehouse_viewer.watch.figures import Figures
from warehouse_viewer.watch.station_watch import StationWatch, state_of

ORDER = {
    "order_id": 7,
    "reference": "=1+1",
    "state": "OPEN",
    "station": "",
    "priority": 0,
    "created": 5.0,
    "due": 0.0,
    "completed": 0.0,
    "lines": [
        {"sku": "sku-1", "quantity": 2, "picked": 1},
        {"sku": "sku-2", "quantity": 1, "picked": 0},
    ],
}


@pytest.mark.parametrize(
    ("station", "starved", "does"),
    [
        ({"open": False}, 0, Activity.RESTING),
        ({"open": True}, 0, Activity.RESTING),
        ({"open": True, "inbound": [3]}, 0, Activity.MOVING),
        ({"open": True, "inbound": [3], "orders": [1]}, 61, Activity.WAITING),
        ({"open": True, "shelf_id": 3}, 0, Activity.WORKING),
        ({"open": True, "shelf_id": 3, "waiting": 61.0}, 0, Activity.NEEDS_HELP),
    ],
)
def test_a_station_does_one_of_five_things(station, starved, does):
    assert state_of(StationState(**station), starved) == does


def test_a_queue_tells_how_long_its_robots_have_stood():
    watch, station = StationWatch(), StationState(name="pick1", open=True, inbound=[6, 9])
    for now in (0.0, QUEUED_TOO_LONG + 1):
        watch.update(now, [station], fleet(shelf=(6, 0), vx=(0.0, 1.0)))
    carried, other = watch.as_json(station)["queue"]
    assert (carried["robot"], carried["stands"], carried["is_long"]) == (1, 121.0, True)
    assert (other["robot"], other["is_long"]) == (0, False)
    watch.update(130.0, [station], fleet(shelf=(6, 0), vx=(1.0, 1.0)))
    assert watch.as_json(station)["queue"][0]["stands"] == 0


def test_pieces_an_hour_are_of_the_last_quarter():
    watch = StationWatch()
    for now in range(0, 1800, 30):
        watch.update(float(now), [StationState(name="pick1", pieces=now // 30)], None)
    result = watch.as_json(StationState(name="pick1", pieces=1770 // 30))
    assert result["pieces_per_hour"] == 120


def test_a_station_tells_since_when_it_has_had_no_unit():
    watch = StationWatch()
    empty = StationState(name="pick1", open=True, orders=[4])
    watch.update(10.0, [StationState(name="pick1", open=True, orders=[4], shelf_id=2)], None)
    assert watch.as_json(StationState(name="pick1", shelf_id=2))["since"] == 10.0
    for now in (20.0, 90.0):
        watch.update(now, [empty], None)
    assert (watch.as_json(empty)["since"], watch.as_json(empty)["activity"]) == (20.0, "WAITING")


def test_four_figures_have_targets_and_their_last_hour():
    figures = Figures()
    for now in range(0, 1200, 10):
        kpis = Kpis(
            orders_completed=now // 10,
            orders_waiting=5,
            late_orders_fraction=0.01,
            item_upper_bound_per_hour=1000,
        )
        figures.update(float(now), kpis, 0.9)
    throughput = Throughput(
        interval=60, begin=0, end=630, items_picked=[10] * 10 + [3], orders_completed=[5] * 11
    )
    four = figures.as_json(kpis, throughput, 0.9, 20)
    assert (four["pieces"]["value"], four["pieces"]["target"]) == (600, 900)
    assert four["pieces"]["early"] and four["orders"]["early"] and not four["late"]["early"]
    throughput.end = 900
    assert not figures.as_json(kpis, throughput, 0.9, 20)["pieces"]["early"]
    assert not four["pieces"]["enough"]  # 5 orders wait
    kpis.orders_waiting = 0
    assert not figures.as_json(kpis, throughput, 0.9, 20)["pieces"]["enough"]  # 300 of 360 are done
    throughput.orders_completed = [6] * 11
    assert figures.as_json(kpis, throughput, 0.9, 20)["pieces"]["enough"]
    assert len(four["pieces"]["values"]) == 10  # the interval that goes on is none yet
    assert four["orders"]["target"] == pytest.approx(360, abs=1)
    assert (four["late"]["value"], four["late"]["target"]) == (0.01, 0.02)
    assert (four["available"]["of"], len(four["available"]["values"])) == (20, 20)


def test_a_sheet_has_a_row_for_each_line_and_no_formulas():
    first, *rows = order_sheet.as_csv([ORDER]).decode("utf-8-sig").splitlines()
    assert first == ",".join(order_sheet.COLUMNS)
    assert rows == ["7,'=1+1,OPEN,,0,5.0,,,sku-1,2,1", "7,'=1+1,OPEN,,0,5.0,,,sku-2,1,0"]


def test_a_spreadsheet_opens_as_one():
    with zipfile.ZipFile(BytesIO(order_sheet.as_xlsx([ORDER]))) as book:
        assert "<f>" not in book.read("xl/worksheets/sheet1.xml").decode()
        assert b"=1+1" in book.read("xl/sharedStrings.xml")
