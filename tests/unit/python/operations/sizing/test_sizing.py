# SPDX-License-Identifier: Apache-2.0
"""The program size: its search, its statistics, and what it writes and says."""

import csv
import json
import math
import re
import signal
import subprocess
import sys
import time
from concurrent.futures import Executor, Future
from dataclasses import dataclass, replace

import numpy as np
import pytest
from paths import ROOT
from scipy import stats

from warehouse_layout.file import layout_file
from warehouse_layout.file.request import Request
from warehouse_layout.generate import generator, layout_choice
from warehouse_operations.reports import comparison, warm_up
from warehouse_operations.sizing import point, prices, sites, table
from warehouse_operations.sizing.answer import Answer
from warehouse_operations.sizing.point import SERIES, Record
from warehouse_operations.sizing.search import Search
from warehouse_operations.sizing.store import Store
from warehouse_operations.sizing.study import Study, choose
from warehouse_operations.sizing.verdict import RISK, Verdict, difference
from warehouse_operations.sizing.wish import ImpossibleError, Wish, WishError
from warehouse_operations.stock import order_mix
from warehouse_operations.stock.assortment import Assortment
from warehouse_operations.stock.demand import make_demand
from warehouse_operations.stock.order_file import DemandError

NODE = ROOT / "src" / "warehouse_operations" / "nodes" / "size"
COMMON = ("--orders-per-hour", 120, "--hours", 1, "--seeds", 3, "--late", "20%", "--robots", 6)


def size(*arguments, **options):
    command = [sys.executable, NODE, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


# --- the search


@dataclass
class Response:
    met: bool
    busy: float

    def at_work(self):
        return self.busy


@pytest.mark.parametrize(
    ("needs", "expected"),
    [
        ({3: None, 4: 58, 5: 21, 6: 17, 7: 17}, {3: None, 4: 58, 5: 21, 6: 17}),
        ({3: 1, 4: 1}, {3: 1}),
        ({3: None, 4: None}, {3: None, 4: None}),
        ({3: 60, 4: 59}, {3: 60, 4: 59}),
    ],
)
def test_the_search_finds_the_fewest_robots_and_asks_little(needs, expected):
    asked = []

    def judge(robots, stations):
        assert (robots, stations) not in asked
        asked.append((robots, stations))
        need = needs[stations]
        return Response(need is not None and robots >= need, 0.6 * robots)

    frontier = Search(judge, lambda _: 60).run(min(needs), max(needs))
    assert frontier == expected
    # Both ends, a guess, and a bisection for each number of stations.
    assert len(asked) <= len(needs) * (2 + math.ceil(math.log2(60)))


def test_a_good_guess_saves_points():
    counts = {}
    for busy in (1.0, 0.35):
        asked = []

        def judge(robots, _, busy=busy, asked=asked):
            asked.append(robots)
            return Response(robots >= 21, busy * robots)

        assert Search(judge, lambda _: 60).fewest(1, 60) == 21
        counts[busy] = len(asked)
    assert counts[0.35] <= counts[1.0] <= 8


class Capacity(Executor):
    """Answers each shift at once: a robot does 10 orders an hour, a station 250."""

    def __init__(self):
        self.points = []

    def submit(self, _, point_):
        self.points.append(point_)
        rate = float(point_.orders.split(":")[1])
        rng = np.random.default_rng((point_.seed, 7))
        capacity = min(10 * point_.robots, 250 * point_.stations) * (0.9 if point_.physics else 1)
        done = min(rate, capacity) / 60 * (1 + 0.001 * rng.standard_normal())
        minutes = point_.run_in + point_.minutes
        series = dict.fromkeys(SERIES, [1.0] * minutes)
        series |= {
            "arrived": [rate / 60] * minutes,
            "completed": [done] * minutes,
            "in_time": [done] * minutes,
            "missed": [max(rate / 60 - done, 0.0)] * minutes,
        }
        future = Future()
        head = (point_.robots, point_.stations, point_.seed, point_.physics)
        future.set_result(Record(*head, series, [], 0.1))
        return future


def wish(**options):
    file = generator.of_request(Request(10, 100, 300, 4), "floor")
    return Wish(file, **({"orders_per_hour": 400, "hours": 1, "seeds": 3, "late": 0.02} | options))


def test_a_study_answers_a_known_capacity_with_few_shifts(tmp_path):
    pool = Capacity()
    study = Study(wish(), Store(tmp_path), pool)
    # 98 % of 400 orders take 39.2 robots; the first station can't, by its bound.
    assert study.search() == {2: 40}
    assert study.verdicts[40, 2].met and not study.verdicts[39, 2].met
    assert len(pool.points) < 40 and study.shifts == len(pool.points)
    # All points had the same seeds: those of 1 to 3, at least.
    assert {point_.seed for point_ in pool.points if point_.robots == 40} >= {1, 2, 3}

    # Simulated robots do a tenth less; a few more are tried.
    assert study.check(40, 2, 1.0) == 44 and list(study.checks) == [(40, 2), (42, 2), (44, 2)]
    assert Answer(study, study.verdicts[40, 2], study.checks[44, 2]).limit == "the streets"

    # Points of the curve are there to be looked at: they change no answer.
    before = dict(study.verdicts)
    study.draw()
    assert {50, 32, 24, 16} <= {robots for robots, _ in study.verdicts}
    assert all(study.verdicts[key].word == verdict.word for key, verdict in before.items())

    # Nothing is simulated twice, not even by another program.
    again = Study(wish(), Store(tmp_path), Capacity())
    assert again.search() == {2: 40} and again.shifts == 0
    other = Study(wish(late=0.5, orders_per_hour=401), Store(tmp_path), Capacity())
    other.search()
    assert other.shifts > 0


def test_what_prices_choose():
    frontier = {3: None, 4: 58, 5: 21, 6: 20}
    assert choose(frontier, None, 100, 2) == (58, 4)
    dear = prices.Prices(robot=20_000, station=10_000, hour=1.0)
    assert choose(frontier, dear, 100, 2) == (21, 5)
    assert dear.per_hour(21, 5, 0) == pytest.approx((21 * 20_000 + 50_000) / 20_000 + 5)


def test_a_piece_pays_for_replenishing_stations_and_their_people(tmp_path):
    study = Study(wish(), Store(tmp_path), Capacity())
    assert study.wish.replenishing == 2
    verdict = study.judge(40, 2)
    money = prices.Prices(robot=20_000, station=40_000, unit=100, hour=30.0, hours=10_000)
    bought = 40 * 20_000 + 4 * 40_000 + 100 * 100
    hourly = bought / 10_000 + 4 * 30.0
    pieces = verdict.estimate("pieces_per_hour").mean
    assert float(table.cost_of(study, money, verdict)) == pytest.approx(hourly / pieces, rel=1e-3)


# --- statistics


def record(seed, missed, piles_up=0.0, minutes=60, robots=5):
    series = dict.fromkeys(SERIES, [0.0] * minutes)
    series |= {
        "arrived": [10.0] * minutes,
        "completed": [10.0 * (1 - piles_up)] * minutes,
        "in_time": [10.0 * (1 - missed)] * minutes,
        "missed": [10.0 * missed] * minutes,
    }
    return Record(robots, 1, seed, False, series, [], 1.0)


def test_a_verdict_is_students():
    values = [0.004, 0.006, 0.003, 0.007, 0.005]
    verdict = Verdict(5, 1, tuple(record(i, v) for i, v in enumerate(values)), 0.01, 5)
    error = stats.sem(values)
    expected = np.mean(values) + stats.t.ppf(1 - RISK, 4) * error
    assert verdict.limit(RISK, 1) == pytest.approx(expected) and expected < 0.01
    assert verdict.met and verdict.decided and verdict.word == "met"
    two_sided = stats.t.interval(0.95, 4, np.mean(values), error)
    half = verdict.estimate("late").half
    assert half == pytest.approx((two_sided[1] - two_sided[0]) / 2)
    # As many, wider apart: their mean is the same, and nothing is sure.
    wide = [0.001, 0.009, 0.0, 0.01, 0.005]
    unsure = Verdict(5, 1, tuple(record(i, v) for i, v in enumerate(wide)), 0.01, 5)
    assert unsure.word == "undecided" and not unsure.decided
    # Too few are never enough to be sure of it, but three are enough to give up.
    few = tuple(record(i, v) for i, v in enumerate((0.3, 0.31, 0.3)))
    assert not Verdict(5, 1, (record(1, 0.0),) * 3, 0.01, 5).met
    assert Verdict(5, 1, few, 0.01, 5).fails and not Verdict(5, 1, few[:2], 0.01, 5).fails
    # Where none is late yet, but orders pile up, all will be.
    grows = Verdict(5, 1, tuple(record(i, 0.0, 0.1 + v) for i, v in enumerate(wide)), 0.01, 5)
    assert grows.fails and not grows.met
    # Seed by seed, what all have in common drops out.
    shifted = tuple(record(i, v + 0.1) for i, v in enumerate(wide))
    more = difference(unsure, Verdict(4, 1, shifted, 0.01, 5), "late")
    assert more.mean == pytest.approx(0.1) and more.half < 1e-6


def test_the_warm_up_ends_where_the_series_is_steady():
    rng = np.random.default_rng(3)
    noise = rng.normal(0, 1, (5, 200))
    assert warm_up.mser5(noise) <= 20
    fills = noise + 50 * (1 - np.exp(-np.arange(200) / 12))
    assert 35 <= warm_up.mser5(fills) <= 70
    assert warm_up.mser5(np.arange(200.0)) == 100  # never steady: half is left
    assert warm_up.mser5([1.0, 5.0]) == 0
    # The closed form, by hand: each cut's variance over the number of batches.
    series = [9.0] * 5 + [1.0] * 5 + [2.0] * 5 + [1.0] * 5
    means = np.array([9.0, 1.0, 2.0, 1.0])
    errors = [means[cut:].var() / (4 - cut) for cut in range(3)]
    assert warm_up.mser5(series) == 5 * int(np.argmin(errors))


def test_holm_corrects_as_by_hand():
    assert comparison.holm([0.01, 0.04, 0.03]) == pytest.approx([0.03, 0.06, 0.06])
    assert comparison.holm([0.6, 0.7]) == [1.0, 1.0]
    assert comparison.holm([]) == []


def test_differences_of_pairs_and_samples():
    a, b = {1: 10.0, 2: 12.0, 3: 14.0}, {1: 11.0, 2: 13.0, 3: 15.5}
    difference = comparison.difference_of(a, b)
    by_scipy = stats.ttest_rel(list(b.values()), list(a.values()))
    assert difference.p_value == pytest.approx(by_scipy.pvalue)
    interval = by_scipy.confidence_interval(0.95)
    assert difference.estimate.half == pytest.approx((interval.high - interval.low) / 2)
    deltas = np.array([1.0, 1.0, 1.5])
    assert difference.effect == pytest.approx(deltas.mean() / deltas.std(ddof=1) * (1 - 3 / 7))
    # Pairs that all differ alike: their signs are all that can be tested.
    alike = comparison.difference_of(a, {seed: value + 1 for seed, value in a.items()})
    assert alike.p_value == 0.25 and alike.effect == math.inf
    same = comparison.difference_of(a, a)
    assert same.p_value == 1 and same.effect == 0
    # Without common seeds Welch's test says the same as scipy's, with its interval.
    other = {seed + 10: value for seed, value in b.items()}
    welch = comparison.difference_of(a, other)
    by_scipy = stats.ttest_ind(list(b.values()), list(a.values()), equal_var=False)
    interval = (
        by_scipy.confidence_interval(0.95) if hasattr(by_scipy, "confidence_interval") else None
    )
    assert welch.p_value == pytest.approx(by_scipy.pvalue) and not welch.paired
    if interval:
        assert welch.estimate.half == pytest.approx((interval.high - interval.low) / 2)


def test_the_mix_of_orders():
    assortment = Assortment.draw(200, np.random.default_rng(1))

    def draw(text, seed=5):
        demand = make_demand(text, assortment, (2, 1), np.random.default_rng(seed))
        return list(demand.due(3600 * 20, [], lambda _: 100))

    orders = draw(order_mix.text_of(300, 2.5, 1.4))
    assert len(orders) == pytest.approx(6000, rel=0.05)
    lines = [len(draft.lines) for draft in orders]
    pieces = [n for draft in orders for _, n in draft.lines]
    assert np.mean(lines) == pytest.approx(2.5, rel=0.03)
    assert np.mean(pieces) == pytest.approx(1.4, rel=0.03)
    with pytest.raises(DemandError, match="mix:PER_HOUR:LINESxPIECES"):
        draw("mix:300:2.5")


def test_the_same_orders_come_whatever_the_stock_is():
    assortment = Assortment.draw(200, np.random.default_rng(1))
    text = order_mix.text_of(300, 1.5, 1.1)
    both = [make_demand(text, assortment, (2, 1), np.random.default_rng(5)) for _ in range(2)]
    scarce = assortment.skus[int(np.argmax(assortment.popularity))]
    ample = list(both[0].due(7200, [], lambda _: 100))
    short = list(both[1].due(7200, [], lambda sku: 0 if sku == scarce else 100))
    assert [draft.at for draft in ample] == [draft.at for draft in short]
    changed = [a for a, b in zip(ample, short) if a.lines != b.lines]
    assert changed and all(scarce in dict(draft.lines) for draft in changed)


def test_orders_like_those_of_a_file(tmp_path):
    file = tmp_path / "orders.csv"
    file.write_text("reference,sku,quantity,at,due\nA,sku-1,2,100,400\nA,sku-2,1,100,400\n")
    assortment = Assortment.draw(5, np.random.default_rng(1))
    text = order_mix.text_of(60, 1, 1, str(file))
    demand = make_demand(text, assortment, (2, 1), np.random.default_rng(1))
    orders = list(demand.due(36000, [], lambda _: 0))
    assert len(orders) == pytest.approx(600, rel=0.2)
    assert {draft.lines for draft in orders} == {(("sku-1", 2), ("sku-2", 1))}
    assert all(draft.due - draft.at == pytest.approx(300) for draft in orders)
    assert wish(orders_file=str(file)).pieces_per_order == 3


# --- wishes


def test_a_wish_that_can_not_be_met_by_its_bound():
    with pytest.raises(ImpossibleError) as raised:
        wish(orders_per_hour=1000, lines=1.9, pieces=1.0).least_stations()
    assert str(raised.value) == "pick1…pick4 can do 1,440 pieces an hour; 1,900 are asked for"
    assert wish(orders_per_hour=1000, lines=1.4, pieces=1.0).least_stations() == 4
    with pytest.raises(WishError, match="items is 0; there is nothing to pick"):
        Wish(generator.of_request(Request(4, 24, 0, 2), "bare"), 100)


OWN = "reference,sku,quantity,at,due\n" + "".join(
    f"A{i},bolt-m{i % 9},1,{60 * i},{60 * i + 1800}\n" for i in range(60)
)


def test_a_stock_and_skus_of_ones_own_are_sized(tmp_path):
    (tmp_path / "orders.csv").write_text(OWN)
    rows = "".join(f"bolt-m{i % 9},20,{i + 1}\n" for i in range(18))
    (tmp_path / "stock.csv").write_text(f"sku,quantity,storage_unit\n{rows}")
    drawn = layout_choice.chosen("small")
    layout_file.write(replace(drawn, stock="stock.csv"), tmp_path / "own.layout.yaml")
    for file in (layout_file.read(tmp_path / "own.layout.yaml"), drawn):
        wish = Wish(file, 60, orders_file=str(tmp_path / "orders.csv"), hours=0.25)
        (point_,) = wish.points(3, 1, [1])
        record = point.simulate(replace(point_, run_in=5))
        assert sum(record.series["completed"]) > 5
    # What the stock lacks is named once, in whichever number of lines it is asked for.
    (tmp_path / "orders.csv").write_text(OWN.replace("bolt-m8", "nut"))
    wish = Wish(
        layout_file.read(tmp_path / "own.layout.yaml"), 60, orders_file=str(tmp_path / "orders.csv")
    )
    with pytest.raises(DemandError) as raised:
        point.simulate(wish.points(3, 1, [1])[0])
    assert str(raised.value).count("sku 'nut' is unknown") == 1 and "\n" not in str(raised.value)


def test_a_point_is_the_shift_that_simulate_would_run():
    file = layout_choice.chosen("small")
    orders = order_mix.text_of(150, 1.5, 1.0)
    point_ = point.Point(3, 1, 4, False, layout_file.text_of(file), orders, 10, 20)
    first, again = point.simulate(point_), point.simulate(point_)
    assert first.series == again.series
    with sites.open_shift(file, robots=3, stations=1, orders=orders, seed=4, physics=False) as ops:
        ops.run(minutes=30)
        figures = ops.kpis()
        station, other = sites.picking_stations(file)
        assert ops.shift.station(station).pieces == figures["items_picked"] > 50
        assert not ops.shift.station(other).is_open and not ops.shift.station(other).pieces
    assert figures["robots"] == 3
    assert sum(first.series["pieces"]) == figures["items_picked"]
    assert sum(first.series["completed"]) == figures["orders_completed"]
    assert sum(first.series["metres"]) == pytest.approx(figures["distance_m"], abs=0.1)
    assert first.series["open"][-1] == sum(first.series["arrived"]) - figures["orders_completed"]


def test_an_order_that_is_not_due_at_the_end_is_judged_by_what_becomes_of_it():
    file = layout_choice.chosen("small")
    orders = order_mix.text_of(150, 1.5, 1.0)
    point_of = lambda minutes: point.Point(  # noqa: E731
        4, 1, 4, False, layout_file.text_of(file), orders, 20, minutes
    )
    short = point.simulate(point_of(20)).series
    longer = point.simulate(point_of(60)).series
    # Orders in process at the end: all of those minutes have come to their end in both.
    assert short["open"][-1] > 0
    for name in point.FATES:
        assert short[name] == longer[name][: len(short[name])]
    came, over = (sum(map(sum, map(short.get, names))) for names in (("arrived",), point.FATES))
    assert over == came
    verdict = Verdict(4, 1, (point.simulate(point_of(20)),), 0.01, 5, 20)
    assert verdict.figures[0]["late"] == 0


# --- the program


def test_a_small_warehouse_is_sized(tmp_path):
    out = tmp_path / "out"
    (tmp_path / "prices.yaml").write_text("robot: 20000\nstation: 30000\nhour: 25\n")
    common = ("--layout", "small", *COMMON, "--prices", tmp_path / "prices.yaml", "--out", out)
    done = size(*common)
    assert done.returncode == 0, done.stderr
    assert re.search(
        r"\d robots? and 1 open picking station \(pick1\) meet 120 orders", done.stdout
    )
    assert "Limit: " in done.stdout and "h simulated in" in done.stderr
    page = (out / "report.html").read_text()
    assert page.count("<svg") == 10 and not re.search(r'(src|href)="(?!#|data:)', page)
    assert "What limits it" in page and "What was assumed" in page
    rows = list(csv.DictReader((out / "points.csv").read_text().splitlines()))
    met = [row for row in rows if row["verdict"] == "met"]
    assert met and all(float(row["cost a piece"]) > 0 for row in rows)

    # Started again, nothing is simulated again; one shift that is lost is simulated, alone.
    kept = sorted((out / "points").iterdir())
    again = size(*common)
    assert again.stdout == done.stdout and not again.stderr
    kept[0].write_text(json.dumps({"cut": "off"}))
    once = size(*common)
    assert once.stdout == done.stdout and once.stderr.count("% in time") == 1


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (("--orders-per-hour", 800), 2, "pick1 and pick2 can do 720 pieces an hour; 1,302 are"),
        (("--orders-per-hour", 300, "--robots", 1, "--hours", 1), 2, "1 robot and pick1 and"),
        (("--orders-per-hour", 0), 2, "a number above 0"),
        (("--orders-per-hour", 9, "--late", "120%"), 2, "above 0 and below 100% was expected"),
        (("--orders-per-hour", 9, "--orders", "no.csv"), 1, "no.csv: No such file"),
        (("--orders-per-hour", 9, "--prices", "no.yaml"), 1, "no.yaml: No such file"),
        (("--orders-per-hour", 9, "--layout", "no.layout.yaml"), 1, "no.layout.yaml: No such"),
    ],
)
def test_what_can_not_be_is_told(tmp_path, arguments, code, message):
    done = size("--layout", "small", "--out", tmp_path / "out", *arguments)
    assert done.returncode == code and message in done.stderr, done.stderr
    assert "Traceback" not in done.stderr


def test_wrong_prices_are_told(tmp_path):
    for text, message in (
        ("robots: 3", "'robots' is unknown; robot, station, unit, hour, hours were expected"),
        ("robot: dear", "robot is 'dear'; a number of 0 or more was expected"),
        ("hours: 0", "hours is 0"),
        ("3", "keys with prices were expected"),
    ):
        (tmp_path / "p.yaml").write_text(text)
        with pytest.raises(prices.PriceError, match=re.escape(message)):
            prices.read(tmp_path / "p.yaml")


@pytest.mark.long
def test_an_interrupted_sizing_goes_on(tmp_path):
    out = tmp_path / "out"
    arguments = ("--layout", "small", *COMMON, "--hours", 3, "--out", out)
    # So that this test looks before all points are done, however busy the machine is.
    command = ["nice", "-n", "19", sys.executable, NODE, *map(str, arguments)]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as running:
        deadline = time.monotonic() + 60
        while not list(out.glob("points/*.json")):
            assert time.monotonic() < deadline
            time.sleep(0.01)
        running.send_signal(signal.SIGINT)
        _, raised = running.communicate(timeout=60)
    assert running.returncode == 130
    assert f"started again, it goes on from {out}" in raised and "Traceback" not in raised
    kept = {path: path.stat().st_mtime_ns for path in out.glob("points/*.json")}
    assert kept
    done = size(*arguments)
    assert done.returncode == 0, done.stderr
    assert kept == {path: path.stat().st_mtime_ns for path in kept}
    assert done.stderr.count("% in time") == len(list(out.glob("points/*.json"))) - len(kept)
