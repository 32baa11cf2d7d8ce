# SPDX-License-Identifier: Apache-2.0
"""Costs of a layout, and sizing for a day: checked by hand."""

import csv
import json
import subprocess
import sys

import numpy as np
import pytest
from paths import ROOT

from warehouse_layout.generate import layout_choice
from warehouse_operations.sizing import costs
from warehouse_operations.sizing.costs import Costs, LayoutCosts, Thing
from warehouse_operations.sizing.day import Day
from warehouse_operations.sizing.prices import PriceError
from warehouse_operations.stock.order_file import DemandError

SIZE = ROOT / "src" / "warehouse_operations" / "nodes" / "size"
WHOLE = """
currency: EUR
robot: {price: 20000, years: 10, a_year: 500}
station: {price: 40000, years: 10}
replenish_station: {price: 30000, years: 10}
charger: {price: 1000, years: 5}
storage_unit: {price: 100, years: 20}
person_hour: 30
people: {station: 1, replenish_station: 0.5, floor: 2}
square_metre_year: 10
kwh: 0.2
hours_a_year: 2000
instead: {order: 5}
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "costs.yaml"
    path.write_text(WHOLE)
    return path


def test_everything_that_the_layout_has_is_in_it(file):
    layout = layout_choice.chosen("small")
    priced = LayoutCosts(costs.read(file), layout, 50)
    robots, stations = 4, 2
    refill = sum(station.kind == "replenish" for station in layout.stations)
    chargers = int(np.isin(layout.floor, ["c"]).sum())
    assert priced.chargers == chargers and refill
    buy = 20_000 * 4 + 40_000 * 2 + 30_000 * refill + 1_000 * chargers + 100 * 50
    assert priced.to_buy(robots, stations) == buy
    things = 4 * 2_500 + 2 * 4_000 + refill * 3_000 + chargers * 200 + 50 * 5
    people = 30 * 2_000 * (2 + 0.5 * refill + 2)
    floor = 10 * priced.square_metres
    energy = 0.2 * 2_000 * 4 * 0.15
    bill = priced.bill(robots, stations, 100, 150)
    assert bill.a_year == pytest.approx(things + people + floor + energy)
    assert bill.an_order == pytest.approx(bill.a_year / 200_000)
    assert bill.a_piece == pytest.approx(bill.a_year / 300_000)
    running = people + floor + energy + 4 * 500
    assert bill.years == pytest.approx(buy / (5 * 200_000 - running))
    assert priced.per_hour(robots, stations + refill) == pytest.approx(bill.a_year / 2_000)


def test_interest_is_an_annuity():
    thing = Thing(1000.0, 10.0, 7.0)
    assert thing.annual(0.0) == 107
    rate = 0.05
    worth = sum((thing.annual(rate) - 7) / (1 + rate) ** year for year in range(1, 11))
    assert worth == pytest.approx(1000)


def test_a_warehouse_that_saves_nothing_never_pays():
    layout = layout_choice.chosen("small")
    cheap = LayoutCosts(Costs({"robot": Thing(1.0)}, person_hour=30, instead=0.01), layout, 1)
    assert cheap.bill(1, 1, 10, 10).years is None


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("robot: {price: dear}", ":1: robot.price is dear"),
        ("# a\nrobot: {cost: 5}", ":2: robot.cost is unknown"),
        ("people: 5", ":1: people is 5"),
        ("people: {cook: 1}", ":1: people.cook is unknown"),
        ("roboter: 5", ":1: roboter is unknown"),
        ("hours_a_year: 0", ":1: hours_a_year is 0"),
        ("robot: {price: 1, years: 0}", ":1: robot.years is 0"),
        ("kwh: -1", ":1: kwh is -1"),
        ("5", "keys with costs"),
    ],
)
def test_wrong_costs_name_line_and_field(file, text, fault):
    file.write_text(text)
    with pytest.raises(PriceError) as error:
        costs.read(file)
    assert str(error.value).startswith(str(file)) and fault in str(error.value)


def test_a_day_has_its_hours_and_its_peak(tmp_path):
    path = tmp_path / "day.csv"
    rows = [f"a{i},x,2,{3600 * hour + i},0" for hour in (0, 2) for i in range(5 * hour + 5)]
    rows = [f"{n}-{row}" for n, row in enumerate(rows)]
    path.write_text("reference,sku,quantity,at,due\n" + "\n".join(rows) + "\n")
    day = Day.read(f"{path}*2")
    assert day.by_hour == [10, 0, 30] and day.hours == 3 and day.peak == 30
    assert day.orders_per_hour == 20 and day.pieces_per_order == 2
    assert day.whole_text == f"run-in:60:day:{path}*2"
    path.write_text("reference,sku,quantity,at,due\na,x,1,900000,0\n")
    with pytest.raises(DemandError, match="describe them by `demand` first"):
        Day.read(str(path))


def test_size_answers_for_a_day(tmp_path, file):
    rng = np.random.default_rng(1)
    rows = [
        f"o{hour}-{i},part-{rng.integers(30)},1,{3600 * hour + rng.integers(3600)},"
        for hour, count in enumerate((30, 90))
        for i in range(count)
    ]
    day = tmp_path / "day.csv"
    day.write_text("reference,sku,quantity,at,due\n" + "\n".join(rows) + "\n")
    out = tmp_path / "out"
    command = [sys.executable, SIZE, "--layout", "small", "--demand", day, "--costs", file]
    command += ["--late", "20%", "--robots", "3", "--seeds", "3", "--realism", "bad_day"]
    done = subprocess.run([*command, "--out", out], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "the day of day.csv (120 orders, 90 in the busiest hour)" in done.stdout
    assert "A robot more" in done.stdout and "EUR a piece" in done.stdout
    with open(out / "by_hour.csv", encoding="utf-8") as table:
        hours = list(csv.DictReader(table))
    assert [float(hour["orders in"]) for hour in hours] == [30, 90]
    assert all(hour["limit"] for hour in hours)
    bill = json.loads((out / "costs.json").read_text())
    assert bill["a_piece"] > 0 and bill["currency"] == "EUR"
    assert (out / "by_hour.png").exists() and "Hour by hour" in (out / "report.html").read_text()
    file.write_text("robot: many")
    done = subprocess.run([*command, "--out", out], capture_output=True, text=True, check=False)
    assert done.returncode == 1 and f"{file}:1: robot is many" in done.stderr
