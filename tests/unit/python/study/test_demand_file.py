# SPDX-License-Identifier: Apache-2.0
"""The program demand: what it finds in a file of orders, and the days that are drawn from it."""

import subprocess
import sys
from collections import Counter

import numpy as np
import pytest
import yaml
from paths import ROOT

from warehouse_operations.demand import description, oddities
from warehouse_operations.runs import sweep
from warehouse_operations.runs.operations import Operations
from warehouse_operations.stock import days, demand_file, orders_text
from warehouse_operations.stock.assortment import Assortment
from warehouse_operations.stock.demand import make_demand
from warehouse_operations.stock.order_file import DemandError, read_csv
from warehouse_operations.stock.orders import Backlog
from warehouse_operations.stock.orders_text import DayText

NODE = ROOT / "src" / "warehouse_operations" / "nodes" / "demand"
HEAD = "reference,sku,quantity,at,due\n"
ZIPF, SKUS = 0.9, 60


def write_day(path, orders=600, seed=1, head=HEAD):
    """Writes a day of 4 h, with its peak in the third hour."""
    rng = np.random.default_rng(seed)
    weights = 1 / np.arange(1, SKUS + 1) ** ZIPF
    rows = []
    for i in range(orders):
        hour = rng.choice(4, p=[0.1, 0.2, 0.5, 0.2])
        at = 3600 * hour + rng.random() * 3600
        count = rng.choice([1, 2], p=[0.7, 0.3])
        for sku in rng.choice(SKUS, size=count, replace=False, p=weights / weights.sum()):
            rows.append(
                f"o{i},part-{sku},{rng.choice([1, 3], p=[0.8, 0.2])},{at:.1f},{at + 1800:.1f}"
            )
    path.write_text(head + "\n".join(rows) + "\n")
    return path


@pytest.fixture
def day(tmp_path):
    return write_day(tmp_path / "day.csv")


@pytest.fixture
def described(day, tmp_path):
    path = tmp_path / "day.demand.yaml"
    orders = description.Orders.read(day)
    demand_file.write(description.describe(orders, 3600.0), path)
    return path


def drawn_day(text, seed=1, seconds=4 * 3600.0):
    source = make_demand(text, None, (1, 1), np.random.default_rng(seed))
    out = []
    while source.next_time() < seconds:
        out += source.due(source.next_time(), Backlog(), lambda sku: 99)
    return out


def test_a_description_has_what_the_file_has(day, described):
    orders, demand = read_csv(day), demand_file.read(described)
    by_hour = Counter(int(order.at // 3600) for order in orders)
    assert demand.orders == tuple(by_hour[i] for i in range(4))
    lines = [len(order.lines) for order in orders]
    pieces = [n for order in orders for _, n in order.lines]
    assert demand.lines_an_order == pytest.approx(np.mean(lines), rel=1e-4)
    assert demand.pieces_a_line == pytest.approx(np.mean(pieces), rel=1e-4)
    assert demand.due.none == 0 and set(demand.due.seconds) == {1800.0}
    assert sum(demand.skus.values()) == sum(lines)
    assert demand.exponent == pytest.approx(ZIPF, abs=0.1)
    assert sum(part["lines"] for part in demand.classes.values()) == pytest.approx(1, abs=1e-3)
    assert demand.peak_per_hour == max(by_hour.values())


def test_days_that_are_drawn_are_like_the_file(day, described):
    orders, demand = read_csv(day), demand_file.read(described)
    drawn = [order for seed in range(5) for order in drawn_day(f"demand:{described}", seed)]
    assert len(drawn) / 5 == pytest.approx(len(orders), rel=0.08)
    peak = Counter(int(order.at // 3600) for order in drawn)
    assert peak[2] / len(drawn) == pytest.approx(demand.orders[2] / sum(demand.orders), abs=0.05)
    assert np.mean([len(order.lines) for order in drawn]) == pytest.approx(
        demand.lines_an_order, rel=0.05
    )
    assert all(order.due == pytest.approx(order.at + 1800) for order in drawn)
    asked = Counter(sku for order in drawn for sku, _ in order.lines)
    assert {sku for sku, _ in asked.most_common(3)} <= set(list(demand.skus)[:8])


def test_the_same_seed_draws_the_same_day(described):
    assert drawn_day(f"demand:{described}", 7) == drawn_day(f"demand:{described}", 7)
    assert drawn_day(f"demand:{described}", 7) != drawn_day(f"demand:{described}", 8)


def test_a_day_keeps_its_times(day):
    orders = sorted(read_csv(day), key=lambda order: order.at)
    assert drawn_day(f"day:{day}") == orders


@pytest.mark.parametrize("factor", [0.5, 1.3, 2.0])
def test_so_much_more(day, described, factor):
    orders = len(read_csv(day))
    assert len(drawn_day(f"day:{day}*{factor}")) == pytest.approx(factor * orders, rel=0.06)
    assert len(drawn_day(f"demand:{described}*{factor}")) == pytest.approx(
        factor * orders, rel=0.12
    )


def test_copies_have_references_of_their_own(day):
    references = Counter(order.reference for order in drawn_day(f"day:{day}*2"))
    assert max(references.values()) == 1


def test_a_run_in_comes_before_the_day(day, described):
    orders = sorted(read_csv(day), key=lambda order: order.at)
    drawn = drawn_day(f"run-in:90:day:{day}", seconds=4 * 3600.0 + 5400)
    later = [order for order in drawn if "before" not in order.reference]
    assert [order.at for order in later] == pytest.approx([order.at + 5400 for order in orders])
    first_hour = sum(order.at < 3600 for order in orders)
    assert len(drawn) - len(later) == pytest.approx(1.5 * first_hour, rel=0.2)
    source = make_demand(f"run-in:90:demand:{described}", None, (1, 1), np.random.default_rng(1))
    demand = demand_file.read(described)
    assert source.rate(10.0) == pytest.approx(demand.orders[0] / 3600)
    assert source.rate(5400 + 2.5 * 3600) == pytest.approx(demand.orders[2] / 3600)


@pytest.mark.parametrize("kind", ["day", "demand"])
def test_skus_that_the_stock_lacks_are_named_once(day, described, kind):
    stock = Assortment.of_lines({f"part-{i}": 1 for i in range(2, SKUS)})
    file = day if kind == "day" else described
    with pytest.raises(DemandError) as error:
        make_demand(f"{kind}:{file}", stock, (1, 1), np.random.default_rng(1))
    assert str(error.value).count("part-0") == 1 and str(error.value).count("part-1") == 1
    assert "none of 2 SKUs" in str(error.value) and "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("day:", "has to name a file"),
        ("demand:none.yaml", "No such file"),
        ("day:none.csv", "No such file"),
        ("day:a.csv*0", "a number above 0"),
        ("day:a.csv*much", "a number above 0"),
        ("run-in:x:day:a.csv", "a number above 0"),
        ("often", "demand:FILE.yaml"),
    ],
)
def test_wrong_texts(text, fault):
    with pytest.raises(DemandError, match=fault):
        make_demand(text, None, (1, 1), np.random.default_rng(1))


@pytest.mark.parametrize(
    ("change", "line", "fault"),
    [
        ({"orders": [1, -2]}, "orders[1]", "is -2"),
        ({"orders": [0, 0]}, "orders", "0 all day"),
        ({"lines": {"x": 1}}, "lines", "whole number"),
        ({"pieces": {}}, "pieces", "share for each"),
        ({"due": {"none": 2}}, "due.none", "from 0 to 1"),
        ({"due": {"seconds": [2, 1]}}, "due.seconds", "ascend"),
        ({"skus": {"a": 0}}, "skus.a", "from 1"),
        ({"interval": 5}, "interval", "is unknown"),
        ({"interval_s": "long"}, "interval_s", "a number from 1"),
    ],
)
def test_wrong_descriptions_name_line_and_field(described, change, line, fault):
    content = yaml.safe_load(described.read_text()) | change
    described.write_text(yaml.safe_dump(content, sort_keys=False))
    with pytest.raises(DemandError) as error:
        demand_file.read(described)
    assert fault in str(error.value)
    place, field = str(error.value).removeprefix(f"{described}:").split(": ", 1)
    assert described.read_text().splitlines()[int(place) - 1] and field.startswith(line)


def test_files_of_orders_texts():
    day = DayText("day", "a.csv", 1.3)
    assert orders_text.day_of("day:a.csv*1.3") == day and str(day) == "day:a.csv*1.3"
    assert orders_text.file_of("mix:60.0:b.csv") == "b.csv" == orders_text.file_of("b.csv")
    assert orders_text.file_of("poisson:5") == orders_text.file_of("fill") == ""
    changed = orders_text.with_file("demand:d.yaml*2", lambda file: f"/x/{file}")
    assert changed == "demand:/x/d.yaml*2"
    assert orders_text.with_file("mix:6:a.csv", lambda file: f"/x/{file}") == "mix:6:/x/a.csv"


@pytest.mark.parametrize("kind", ["day", "demand"])
def test_a_shift_takes_a_day_of_skus_of_its_own(day, described, kind):
    from kiva_plugin_cpp import World

    file = day if kind == "day" else described
    orders = f"{kind}:{file}"
    with Operations(World.preset("small"), orders=orders, physics=False, seed=3) as ops:
        assert set(ops.shift.assortment.skus) == {f"part-{i}" for i in range(SKUS)}
        ops.run(hours=1)
        assert ops.shift.tally.orders_completed > 20


def test_a_sweep_finds_a_day_beside_it(day, described, tmp_path):
    file = tmp_path / "s.yaml"
    file.write_text(
        "physics: false\nsize: small\n"
        "grid: {orders: ['day:day.csv*1.3', 'demand:day.demand.yaml']}\n"
    )
    texts = [job.orders for job, _ in sweep.read(file).jobs]
    assert texts == [f"day:{day}*1.3", f"demand:{described}"]


def test_dates_are_times_of_the_day(tmp_path):
    path = tmp_path / "dates.csv"
    path.write_text(HEAD + "a,x,1,2025-03-01 08:15,2025-03-01 09:15\nb,x,1,2025-03-02T00:00:30,\n")
    first, second = read_csv(path)
    assert (first.at, first.due) == (8.25 * 3600, 9.25 * 3600)
    assert (second.at, second.due) == (86_430.0, 0)
    path.write_text(HEAD + "a,x,1,2025-03-01 08:15,\nb,x,1,17,\n")
    with pytest.raises(DemandError, match=r"csv:3: at is '17'; dates in all rows"):
        read_csv(path)


def test_days_of_a_year_make_an_average_day(tmp_path):
    rows = [
        f"{day}-{i},x,1,{86_400 * day + 3600 * 9 + 60 * i},"
        for day, count in enumerate((10, 20, 0, 30))
        for i in range(count)
    ]
    path = tmp_path / "days.csv"
    path.write_text(HEAD + "\n".join(rows) + "\n")
    orders = description.Orders.read(path)
    demand = description.describe(orders, 900.0)
    assert demand.days == 3 and demand.orders_a_day == pytest.approx(20, abs=0.01)
    assert demand.busiest == 1.5 and demand.orders[9 * 4] == pytest.approx(40 / 3, abs=1e-3)
    assert any("1 days between" in text for text in oddities.oddities(orders))


def test_what_is_odd_is_said(tmp_path):
    path = tmp_path / "odd.csv"
    rows = [f"n{i},x,1,{60 * i},{60 * i + 600}" for i in range(30)]
    rows += ["early,x,1,500,400", "big,x,500,501,900", "twice,x,1,502,900", "twice,x,2,502,900"]
    rows += ["late,x,1,20000,20600", "free,x,1,20001,"]
    path.write_text(HEAD + "\n".join(rows) + "\n")
    orders = description.Orders.read(path)
    odd = " ".join(oddities.oddities(orders))
    for text in (
        "due when they come, or before: early",
        "up to 500: big",
        "line 35 (twice, x)",
        "1 of 35 orders have no due time",
        "No order comes for",
    ):
        assert text in odd
    assert description.describe(orders, 3600.0).repeated == pytest.approx(1 / 36, abs=1e-5)


def test_the_program_writes_a_description_with_pictures(day, tmp_path):
    out = tmp_path / "out" / "day.demand.yaml"
    command = [sys.executable, NODE, day, "--every", "quarter", "--out", out]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "600 orders in 4 h" in done.stdout and "exponent" in done.stdout
    assert len(demand_file.read(out).orders) == 16
    names = ("orders", "lines", "pieces", "popularity", "due", "repeated")
    for name in names:
        assert out.with_name(f"day.demand.{name}.png").read_bytes().startswith(b"\x89PNG")
    assert out.with_suffix(".html").read_text().count("<figure>") == len(names)


def test_the_program_refuses_what_it_cannot_read(tmp_path):
    path = tmp_path / "wrong.csv"
    path.write_text(HEAD + "a,x,none,0,0\n")
    command = [sys.executable, NODE, path, "--out", tmp_path / "o.demand.yaml"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 1 and f"{path}:2: quantity is 'none'" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_stock_is_checked_once():
    with pytest.raises(DemandError, match="none of 30 SKUs of 30.*and 10 more"):
        days.check_stock("f", [f"s{i}" for i in range(30)], [])
