# SPDX-License-Identifier: Apache-2.0
"""Each policy works for an hour; a user's own class is one line of YAML; wrong ones are told."""

from types import SimpleNamespace

import numpy as np
import pytest
from operations_site import site

from warehouse_operations import Operations, Policies, PolicyError
from warehouse_operations.policies import ROLES
from warehouse_operations.shift.kpis import served_visits
from warehouse_operations.stock.travel import LeadTime

CHOICES = [(role, name) for role, names in ROLES.items() for name in names]


@pytest.mark.parametrize("role, name", CHOICES)
def test_a_shift_with(role, name):
    ops = Operations(site=site(), physics=False, policies={role: name})
    ops.run(minutes=30)
    figures = ops.kpis()
    assert figures["items_picked"] > 120
    reserved = sum(bin_.reserved for bin_ in ops.shift.inventory.bins.values())
    allotted = sum(line.allotted for o in ops.shift.orders.values() for line in o.lines)
    assert reserved == allotted
    if name != "never":
        assert figures["bundles_stored"] > 10


def throughput(policies):
    ops = Operations(site=site(robots=6, rows=6), physics=False, policies=policies)
    ops.run(hours=1)
    return ops.kpis()


def test_assignment_decides_as_the_literature_tells():
    """Orders given to stations by chance cost far more than units chosen by chance."""
    best = throughput({})
    orders = throughput({"orders": "random"})
    assert best["item_throughput_per_hour"] > 1.2 * orders["item_throughput_per_hour"]
    assert best["pile_on"] > 2 * orders["pile_on"]


def test_a_class_of_ones_own(tmp_path, monkeypatch):
    (tmp_path / "mine.py").write_text(
        "class Oldest:\n"
        "    def __init__(self, most=12):\n"
        "        self.most, self.calls = most, 0\n"
        "    def choose(self, station, view):\n"
        "        self.calls += 1\n"
        "        orders = [o for o in view.backlog if view.in_stock(o)]\n"
        "        return orders[0] if orders and len(station.orders) < self.most else None\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "mine.yaml").write_text("orders: {name: mine:Oldest, most: 3}\n")
    ops = Operations(site=site(), physics=False, policies=str(tmp_path / "mine.yaml"))
    ops.run(minutes=10)
    assert ops.shift.policies.orders.calls > 10
    assert max(len(station.orders) for station in ops.shift.picking.stations) == 3


@pytest.mark.parametrize("seconds, most", [(30, 0.7), ("lead time", 0.8)])
def test_units_are_fetched_no_further_ahead_than_told(seconds, most):
    """The pieces on their way are fewer, and so are the metres that robots drive for a piece."""
    policies = {"units": {"name": "most lines", "ahead": seconds}}
    ops = Operations(site=site(), physics=False, policies=policies)
    ahead = []

    def note(ops):
        ahead.extend(s.seconds_to_pick() for s in ops.shift.picking.stations)

    ops.run(minutes=30, observe=note)
    usual = Operations(site=site(), physics=False)
    usual_ahead = []
    usual.run(
        minutes=30,
        observe=lambda ops: usual_ahead.extend(
            s.seconds_to_pick() for s in ops.shift.picking.stations
        ),
    )
    assert 0 < np.mean(ahead) < most * np.mean(usual_ahead)
    assert ops.kpis()["items_picked"] > 100  # no station waits for ever


def test_a_lead_time_follows_what_units_take():
    lead_time = LeadTime()
    assert lead_time.horizon == np.inf  # nothing is early before it is known
    for seconds in [40.0, 60.0] * 50:
        lead_time.note(seconds)
    assert lead_time.mean == pytest.approx(50, abs=2)
    assert lead_time.horizon == pytest.approx(60, abs=2)


def test_an_object_decides():
    class First:
        def choose(self, station, view):
            return next((order for order in view.backlog if view.in_stock(order)), None)

    first = First()
    policies = Policies({"orders": first})
    assert policies.orders is first and policies.chosen["orders"].endswith("First")
    ops = Operations(site=site(), physics=False, policies=policies)
    ops.run(minutes=5)
    assert ops.kpis()["items_picked"] > 10
    with pytest.raises(PolicyError, match="a name, or a mapping"):
        Policies({"orders": 7})


@pytest.mark.parametrize(
    "text, message",
    [
        ("order: random", "'order' is not a role; expected orders, units"),
        ("orders: best", "orders: there is no 'best'; random, first come"),
        ("orders: json:Best", "module 'json' has no attribute 'Best'"),
        ("orders: nowhere_at_all:Best", "No module named 'nowhere_at_all'"),
        ("orders: json:JSONDecoder", "json:JSONDecoder has no method choose"),
        ("orders: {fast_lane: true}", "a name, or a mapping with `name`, was expected"),
        ("orders: {name: pile-on, slow_lane: 1}", "unexpected keyword argument 'slow_lane'"),
        ("storage: {name: turnover classes, classes: [0.5]}", "shares above 0 that add up to 1"),
        ("replenishment: {name: threshold, begin: 0.9, stop: 0.1}", "begin 0.9 and stop 0.1"),
        ("units: {name: most work, ahead: soon}", "ahead is 'soon'; seconds or 'lead time'"),
        ("units: {name: most lines, ahead: .nan}", "ahead is nan; 0 s or more was expected"),
        ("batches: {name: together, most: 0}", "most is 0; 1 or more was expected"),
        ("batches: {name: together, begin: 0.9}", "begin 0.9 and stop 0.85"),
        ("- orders", "roles with a policy each were expected"),
        ("orders: [", "policies.yaml"),
    ],
)
def test_wrong_policies_are_told(tmp_path, text, message):
    path = tmp_path / "policies.yaml"
    path.write_text(text)
    with pytest.raises(PolicyError) as error:
        Policies.read(path)
    assert message in str(error.value) and str(path) in str(error.value)


@pytest.mark.parametrize("level, least", [(0.9, 8), (0.85, 8), (0.75, 4), (0.65, 1), (0.1, 1)])
def test_the_fuller_the_stock_the_more_bundles_go_together(level, least):
    view = SimpleNamespace(inventory=SimpleNamespace(level=level))
    assert abs(Policies({"batches": "together"}).batches.least(view) - least) <= (level == 0.75)
    assert Policies().batches.least(view) == 1


def pieces_and_bundles_a_visit(batches, hours):
    """The pieces picked, the bundles stored in each replenishing visit, and the stock's level."""
    ops = Operations(site=site(), physics=False, policies=Policies({"batches": batches}), seed=3)
    ops.run(hours=hours)
    kpis = ops.kpis()
    _, visits = served_visits(ops.shift.tally, ops.shift.stations)
    return kpis["items_picked"], kpis["bundles_stored"] / visits, ops.shift.inventory.level


def test_bundles_that_go_together_save_trips():
    """Four hours of the same orders: fewer trips for as much stock, and as many pieces."""
    pieces, at_once, _ = pieces_and_bundles_a_visit("at once", hours=4)
    as_many, together, _ = pieces_and_bundles_a_visit("together", hours=4)
    assert as_many > 0.98 * pieces and together > 1.5 * at_once


def test_visits_that_are_filled_save_trips_without_a_wait():
    """No bundle waits for others: as much stock is put in as by visits for one each, or more."""
    pieces, one_each, level = pieces_and_bundles_a_visit("at once", hours=4)
    fills = {"name": "at once", "fills": True}
    as_many, filled, filled_level = pieces_and_bundles_a_visit(fills, hours=4)
    assert as_many > 0.98 * pieces and filled > 1.05 * one_each and filled_level > 0.98 * level


def test_visits_are_filled_or_not():
    with pytest.raises(PolicyError, match="fills is 'no'; true or false was expected"):
        Policies({"batches": {"name": "at once", "fills": "no"}})


def test_bundles_go_together_where_stock_is_low_as_well():
    low = {"name": "together", "begin": 0.98, "stop": 1.0}
    pieces, at_once, level = pieces_and_bundles_a_visit("at once", hours=1)
    as_many, together, low_level = pieces_and_bundles_a_visit(low, hours=1)
    assert max(level, low_level) < 0.98  # one bundle is enough to fetch a unit
    assert as_many > 0.98 * pieces and together > 1.2 * at_once


def test_a_bundle_that_comes_goes_along_with_a_unit_under_way():
    filling = {"name": "at once", "fills": True}
    for what in ("together", "at once", filling):
        ops = Operations(site=site(), physics=False, policies=Policies({"batches": what}), seed=3)
        ops.run(minutes=1)
        shift = ops.shift
        station = shift.replenishing.stations[0]
        visit, sku = next(
            (visit, bin_.sku)
            for visit in station.coming_for(replenishes=True)
            for bin_ in shift.inventory.of_unit[visit.unit]
            if shift.inventory.takes(bin_, bin_.sku, 1)
        )
        before = len(visit.puts)
        shift.replenishing.order(sku, 1)
        shift.advance(shift.now)
        assert (len(visit.puts) > before) == (what != "at once")


@pytest.mark.parametrize("name", ["most lines", "most work"])
@pytest.mark.parametrize("reach, unit", [(20, 1), (120, 2), (170, 3)])
def test_units_farther_than_the_reach_from_the_nearest_are_left(name, reach, unit):
    policy = Policies({"units": {"name": name, "reach": reach}}).units
    candidates = SimpleNamespace(
        units=np.array([1, 2, 3]), completes=np.array([1, 1, 2]), pieces=np.array([1, 3, 5])
    )
    view = SimpleNamespace(
        seconds_to_all=lambda _station, _units: np.array([30.0, 60.0, 200.0]), work=lambda _unit: 0
    )
    station = SimpleNamespace(name="pick1", coming=["a visit"])
    assert policy.choose(station, candidates, view) == unit


def test_a_reach_below_none_is_refused():
    with pytest.raises(PolicyError, match="reach is -1; 0 s or more"):
        Policies({"units": {"name": "most lines", "reach": -1}})
