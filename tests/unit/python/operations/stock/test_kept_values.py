# SPDX-License-Identifier: Apache-2.0
"""What the stock, the backlog and stations keep is what a look at everything computes, after random
changes."""

from types import SimpleNamespace

import numpy as np
import pytest

from warehouse_operations.policies.order_assignment import PileOn
from warehouse_operations.stock.inventory import STOCKS_KEPT, Bin, Inventory, Reason
from warehouse_operations.stock.orders import Backlog, Order
from warehouse_operations.stock.settings import Settings
from warehouse_operations.stock.stations import Visit, WorkStation

SKUS = [f"sku-{i}" for i in range(6)]
UNITS = range(1, 8)
PLACE = SimpleNamespace(name="pick1", kind="PICK")


class Changes:
    """Stock, backlog and a station, which change at random."""

    def __init__(self, seed):
        self.rng = np.random.default_rng(seed)
        numbers = np.arange(1, 31)
        bins = [Bin(int(i), f"item{i}", 1 + int(i) % 7, 12, self.sku()) for i in numbers]
        self.inventory, self.backlog = Inventory(bins), Backlog()
        self.station = WorkStation(PLACE, Settings(slots=2), self.inventory)
        self.waiting, self.count = {}, 0  # the orders, by their numbers in the backlog

    def sku(self):
        return SKUS[self.rng.integers(len(SKUS))]

    def any_of(self, things):
        things = list(things)
        return things[self.rng.integers(len(things))] if things else None

    def change(self):
        changes = (self.stock, self.promise, self.expect, self.fall, self.write_off)
        self.any_of((*changes, self.order, self.order, self.take, self.visit, self.visit))()

    def stock(self):
        bin_ = self.any_of(self.inventory.bins.values())
        if bin_.fallen is not None or bin_.expected:
            return
        sku = bin_.sku if bin_.quantity else self.sku()
        available, pieces = bin_.available, int(self.rng.integers(0, 5))
        reason = self.any_of((Reason.PUT, Reason.SHORT))
        self.inventory.move(
            bin_, sku, pieces if reason == Reason.PUT else -min(pieces, available), reason
        )

    def promise(self):
        bin_ = self.any_of(self.inventory.bins.values())
        self.inventory.reserve(bin_, int(self.rng.integers(-bin_.reserved, bin_.available + 1)))
        if bin_.reserved and self.rng.random() < 0.5:
            self.inventory.pick(bin_, 1)

    def expect(self):
        bin_, sku = self.any_of(self.inventory.bins.values()), self.sku()
        if self.inventory.takes(bin_, sku, 2):
            self.inventory.expect(bin_, sku, 2)
            self.any_of((self.inventory.put, self.inventory.unexpect))(bin_, sku, 2)

    def fall(self):
        bin_ = self.any_of(self.inventory.bins.values())
        if bin_.fallen is not None:
            self.inventory.pick_up(bin_)
        elif not bin_.reserved and not bin_.expected:
            self.inventory.fall(bin_)

    def write_off(self):
        bin_ = self.any_of(self.inventory.bins.values())
        if len(self.inventory.bins) > 20 and not bin_.reserved and not bin_.expected:
            self.inventory.write_off(bin_)

    def order(self):
        self.count += 1
        skus = {self.sku(): int(self.rng.integers(1, 4)) for _ in range(self.rng.integers(1, 3))}
        self.add(Order(self.count, skus.items(), 0.0, due=float(self.rng.integers(9))))

    def add(self, order):
        self.backlog.add(order)
        self.waiting[self.backlog.added] = order

    def take(self):
        """Takes an order from the backlog; some of them come back."""
        if order := self.any_of(self.backlog):
            self.remove(order)
            if self.rng.random() < 0.3:
                self.add(order)

    def remove(self, order):
        self.backlog.remove(order)
        self.waiting = {number: each for number, each in self.waiting.items() if each != order}

    def visit(self):
        """Brings a visit on, or begins another one."""
        visit = self.any_of((*self.station.inbound.values(), None))
        if visit is None:
            unit, replenishes = int(self.rng.choice(UNITS)), self.rng.random() < 0.2
            self.count += 1
            visit = Visit(self.count, self.count, unit, self.station, 0.0, replenishes=replenishes)
            visit.released = 0.0 if self.rng.random() < 0.1 else None
            self.station.add_visit(visit)
        elif visit.arrived is None and self.station.here is None:
            visit.arrived = 1.0
        elif visit.released is None:
            self.station.release(visit, 2.0)
        else:
            self.station.end_visit(visit)


def stock_of(inventory, units):
    stock = {}
    for unit in units:
        for bin_ in inventory.bins.values():
            if bin_.unit == unit and bin_.available:
                stock[bin_.sku] = stock.get(bin_.sku, 0) + bin_.available
    return stock


def served(orders, stock):
    pieces = {
        order: sum(min(line.open, stock.get(line.sku, 0)) for line in order.lines)
        for order in orders
    }
    return {order: count for order, count in pieces.items() if count}


@pytest.mark.parametrize("seed", range(10))
def test_what_is_kept_is_what_a_look_at_everything_computes(seed):
    changes = Changes(seed)
    inventory, backlog, station = changes.inventory, changes.backlog, changes.station
    for _ in range(400):
        changes.change()
        for unit in UNITS:
            assert inventory.stock_on(unit) == stock_of(inventory, [unit])
        coming = [visit for visit in station.inbound.values() if visit.released is None]
        here = [visit for visit in coming if visit.arrived is not None]
        assert station.coming == coming and station.here == next(iter(here), None)
        assert station.coming_for(True) == [visit for visit in coming if visit.replenishes]
        picking = [visit.unit for visit in coming if not visit.replenishes]
        assert station.inbound_stock() == stock_of(inventory, picking)
        at_it = [visit.unit for visit in here if not visit.replenishes]
        assert station.stock_here() == stock_of(inventory, at_it)
        assert station.refills_coming == len(station.coming_for(True))
        stock, since = station.inbound_stock(), int(changes.rng.integers(backlog.added + 1))
        assert backlog.served_by(stock) == served(changes.waiting.values(), stock)
        newer = (order for number, order in changes.waiting.items() if number > since)
        assert backlog.served_by(stock, since) == served(newer, stock)


@pytest.mark.parametrize("seed", range(10))
def test_a_look_in_vain_hides_no_order_that_comes_to_be_complete(seed):
    changes, policy = Changes(seed), PileOn()
    station, answers = changes.station, set()
    station.take_on(Order(-1, [("sku-0", 1)], 0.0))
    assert station.free_slots == 1  # that of the fast lane
    view = SimpleNamespace(backlog=changes.backlog, in_stock=lambda _: True)
    for _ in range(600):
        changes.change()
        order = policy.choose(station, view)
        assert order is PileOn().choose(station, view)
        answers.add(order is None)
        if order:
            changes.remove(order)
    assert answers == {True, False}


def test_stocks_are_kept_of_some_units_only():
    units = range(1, 2 * STOCKS_KEPT)
    inventory = Inventory([Bin(unit, f"item{unit}", unit, 12, "sku-0") for unit in units])
    assert not any(inventory.stock_on(unit) for unit in units)
    assert len(inventory._stock_on) <= STOCKS_KEPT
