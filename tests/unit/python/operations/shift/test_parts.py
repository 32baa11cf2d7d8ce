# SPDX-License-Identifier: Apache-2.0
"""Parts of a shift by themselves, with what they share and recorded answers of the others."""

import pytest
from operations_site import site

from warehouse_fleet.transports.transports import Kind, TransportAnswer, TransportEvent
from warehouse_layout.message_enums import OrderEventKind, OrderState
from warehouse_operations.shift.context import Context
from warehouse_operations.shift.journal import Journal
from warehouse_operations.shift.notices import Notices
from warehouse_operations.shift.order_book import OrderBook
from warehouse_operations.shift.visits import HOLD, Visits
from warehouse_operations.stock.event_queue import Clock
from warehouse_operations.stock.goods_in import GoodsIn
from warehouse_operations.stock.inventory import Bin
from warehouse_operations.stock.settings import Settings
from warehouse_operations.stock.stations import WorkStation
from warehouse_operations.stock.whereabouts import Whereabouts

UNIT = 3


class Requests:
    """A fleet that takes requests down; refuses all while `refusal` is set."""

    def __init__(self):
        self.refusal, self.calls = "", []

    def submit(self, unit, station):
        self.calls.append(("submit", unit, station))
        return (
            TransportAnswer(0, False, self.refusal)
            if self.refusal
            else TransportAnswer(len(self.calls), True, "")
        )

    def release(self, transport):
        self.calls.append(("release", transport))

    def cancel(self, transport):
        self.calls.append(("cancel", transport))


class Part:
    """Takes down what it learns of its visits."""

    def __init__(self):
        self.calls = []

    def on_arrival(self, visit):
        self.calls.append(("arrival", visit.unit))

    def drop_visit(self, visit):
        self.calls.append(("drop", visit.unit))

    def on_unit_free(self, unit):
        self.calls.append(("free", unit))


@pytest.fixture
def context():
    bins = [Bin(1, "item1", UNIT, 24, "sku-1"), Bin(2, "item2", 4, 24, "sku-2")]
    return Context(Clock(10.0), bins, Journal())


@pytest.fixture
def fleet():
    return Requests()


@pytest.fixture
def part():
    return Part()


@pytest.fixture
def visits(context, fleet, part):
    place = site()
    floor = Whereabouts(place.plan, place.robots, place.units)
    visits = Visits(context, fleet, floor, Notices(), most=4)
    visits.register(part, replenishes=False)
    return visits


@pytest.fixture
def station(context):
    return WorkStation(site().plan.stations[0], Settings(), context.inventory)


def event(visit, kind, stamp):
    return TransportEvent(stamp, visit.transport_id, kind, 1, visit.unit, visit.station.name, "")


def test_a_part_learns_what_becomes_of_its_visits(visits, station, part, fleet):
    visit = visits.request(UNIT, station)
    assert visit in station.coming and UNIT not in visits.free_units
    visits.on_event(event(visit, Kind.LIFTED, 20.0))
    visits.on_event(event(visit, Kind.ARRIVED, 30.0))
    assert visit.here and part.calls == [("arrival", UNIT)]
    visits.release(visit)
    assert not visit.here and fleet.calls[-1] == ("release", visit.transport_id)
    visits.on_event(event(visit, Kind.STORED, 50.0))
    assert part.calls[1:] == [("drop", UNIT), ("free", UNIT)]
    assert (visit.ended, visit.outcome, station.inbound) == (50.0, "stored", {})
    assert UNIT in visits.free_units


def test_a_unit_that_the_fleet_refuses_is_held_for_a_while(context, visits, station, fleet):
    fleet.refusal = "no robot gets there"
    assert visits.request(UNIT, station) is None and not station.coming
    context.clock.run_until(10.0 + HOLD - 0.1)
    assert UNIT not in visits.free_units
    context.clock.run_until(10.0 + HOLD)
    assert UNIT in visits.free_units


def test_the_visit_of_a_unit_that_is_gone_ends(visits, station, part, fleet):
    visit = visits.request(UNIT, station)
    visits.update_units({4})
    assert fleet.calls[-1] == ("cancel", visit.transport_id) and part.calls == [("drop", UNIT)]
    visits.on_event(event(visit, Kind.CANCELLED, 20.0))
    assert UNIT not in visits.free_units
    visits.update_units({UNIT, 4})
    assert UNIT in visits.free_units and part.calls[-1] == ("free", UNIT)


def test_an_order_is_taken_away_from_its_station_where_it_is_cancelled(context):
    book, changes, taken = OrderBook(context, ["sku-1"], Notices()), [], []
    book.register(lambda: changes.append(len(book.backlog)), taken.append)
    order, waits_for = book.submit([("sku-1", 2), ("sku-1", 1)])
    assert [line.quantity for line in order.lines] == [3] and changes == [1]
    assert waits_for == "waits for replenishment of sku-1"
    book.backlog.remove(order)
    order.state = OrderState.ASSIGNED
    kinds = []
    book.on_event = lambda _, kind, *rest: kinds.append(kind)
    assert book.cancel(order.order_id) == (True, "")
    assert taken == [order] and kinds == [OrderEventKind.CANCELLED] and not book.orders
    assert book.submit([("sku-9", 1)]) == (None, "there is no SKU 'sku-9'")


def test_goods_in_count_the_pieces_of_each_sku():
    goods_in = GoodsIn()
    goods_in.order("sku-1", 5, now=3.0)
    goods_in.order("sku-2", 2, now=4.0)
    first, second = goods_in.bundles.values()
    assert (first.created, goods_in.pieces) == (3.0, 7)
    goods_in.remove(first)
    assert goods_in.pieces_of == {"sku-1": 0, "sku-2": 2} and goods_in.changed == {"sku-1", "sku-2"}
    goods_in.add(first)
    assert list(goods_in.bundles.values()) == [second, first]


def test_each_record_changes_the_state_hash(context):
    hashes = {context.state_hash()}
    context.update_hash("order", 1)
    hashes.add(context.state_hash())
    context.clock.now = 11.0
    context.update_hash("order", 1)
    hashes.add(context.state_hash())
    assert len(hashes) == 3
