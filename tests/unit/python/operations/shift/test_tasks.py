# SPDX-License-Identifier: Apache-2.0
"""What a person reports of a pick is done to that pick, once; a write-off can be taken back."""

from dataclasses import replace

import pytest
from operations_site import site

from warehouse_layout.message_enums import OrderState, PickOutcome, StationMode
from warehouse_operations import Operations
from warehouse_operations.shift.task_reports import Report
from warehouse_operations.shift.tasks import UNDO_WITHIN
from warehouse_operations.stock.orders import Bundle, Order
from warehouse_operations.stock.totes import Totes
from warehouse_operations.store import check, stored
from warehouse_operations.store.database import open_engine

PICK, REPLENISH = "pick1", "replenish3"


def by_hand(database=None, least=1):
    """(Operations, WorkStation) with a unit that has `least` things or more to be picked."""
    ops = Operations(site=site(), physics=False, database=database, orders="fill:30")
    ops.shift.set_station(PICK, True, StationMode.MANUAL)
    ops.shift.set_station("pick2", False, StationMode.AUTOMATIC)
    ops.run(minutes=10)
    station = ops.shift.station(PICK)
    while len(station.here.picks) < least:
        ops.shift.tasks.report(report_of(station.here.picks[0]))
        ops.run(minutes=2)
    return ops, station


def report_of(pick, quantity=None, outcome=PickOutcome.DONE):
    order = pick.line.order
    quantity = pick.quantity if quantity is None else quantity
    return Report(PICK, order.order_id, pick.bin.item, pick.sequence, quantity, outcome)


def promised(ops):
    lines = [line for order in ops.shift.orders.values() for line in order.lines]
    bins = ops.shift.inventory.bins.values()
    return sum(bin_.reserved for bin_ in bins), sum(line.allotted for line in lines)


def test_a_report_that_comes_twice_is_carried_out_once():
    ops, station = by_hand(least=2)
    first, second = list(station.here.picks)[:2]
    report = report_of(first)
    for _ in range(3):
        answer = ops.shift.tasks.report(report)
        assert (answer.success, answer.quantity) == (True, report.quantity)
    assert station.pieces == report.quantity and second in station.here.picks
    # The same pick with another outcome is not a repetition.
    other = replace(report, outcome=PickOutcome.DAMAGED)
    assert ops.shift.tasks.report(other).message == "that was reported as DONE already"


def test_what_is_no_longer_shown_is_refused_and_what_is_asked_for_named():
    ops, station = by_hand(least=2)
    first, second = list(station.here.picks)[:2]
    stale = report_of(first)
    assert ops.shift.cancel_order(first.line.order.order_id)[0]
    before = station.pieces
    answer = ops.shift.tasks.report(stale)
    assert not answer.success and station.pieces == before
    assert answer.message.startswith("that is no longer asked for; pick1 asks for")
    pick = station.here.picks[0]
    assert f"{pick.quantity} of {pick.line.sku} in {pick.bin.item} for" in answer.message
    # Nor is one taken for another: each part of its name counts.
    order, item, sequence = pick.line.order.order_id, pick.bin.item, pick.sequence
    for name in ((order + 1, item, sequence), (order, "item0", sequence), (order, item, 10**9)):
        assert not ops.shift.tasks.report(Report(PICK, *name, 1, PickOutcome.DONE)).success
    assert station.pieces == before
    for name, text in (("pick2", "pick2 works by itself"), ("x", "there is no station 'x'")):
        report = Report(name, order, item, sequence, 1, PickOutcome.DONE)
        assert ops.shift.tasks.report(report).message == text


def test_what_is_left_of_a_pick_is_another_one():
    ops, station = by_hand()
    while station.here.picks[0].quantity < 2:
        ops.shift.tasks.report(report_of(station.here.picks[0]))
        while not (station.here and station.here.picks):
            ops.run(minutes=1)
    pick = station.here.picks[0]
    report = report_of(pick, quantity=1)
    before, left = station.pieces, pick.quantity - 1
    for _ in range(2):  # a double tap
        assert ops.shift.tasks.report(report).success
    assert (station.pieces, pick.quantity) == (before + 1, left)
    assert pick.sequence != report.sequence


@pytest.mark.parametrize("outcome", [PickOutcome.SHORT, PickOutcome.DAMAGED])
def test_a_write_off_is_taken_back_by_a_move_of_its_own(tmp_path, outcome):
    ops, station = by_hand(tmp_path / "run.db", least=2)
    pick = station.here.picks[0]
    bin_, order, stock = pick.bin, pick.line.order, pick.bin.quantity
    report = report_of(pick, 0 if outcome == PickOutcome.SHORT else 1, outcome)
    answer = ops.shift.tasks.report(report)
    lacking = stock if outcome == PickOutcome.SHORT else 1
    assert (answer.success, answer.quantity) == (True, lacking), answer
    assert bin_.quantity == stock - lacking
    for _ in range(2):
        assert ops.shift.tasks.undo(PICK, report.sequence) == (True, "")
        assert bin_.quantity == stock and promised(ops)[0] == promised(ops)[1]
    again = station.here.picks[0]
    assert (again.bin, again.line.order) == (bin_, order)  # it is asked for again, the next thing
    assert again.sequence != report.sequence
    assert ops.shift.tasks.undo(PICK, again.sequence)[0] is False
    assert ops.shift.tasks.undo("pick2", report.sequence)[0] is False
    ops.shift.set_station(PICK, True, StationMode.AUTOMATIC)
    ops.run(hours=1)
    assert order.state == OrderState.COMPLETED
    ops.close()
    engine = open_engine(tmp_path / "run.db")
    assert check.faults(engine) == []
    with engine.connect() as connection:
        rows = connection.exec_driver_sql(
            "SELECT reason, quantity FROM move WHERE reason IN ('short', 'damaged', 'undone')"
        )
        assert sorted(map(tuple, rows)) == sorted(
            [(outcome.name.lower(), -lacking), ("undone", lacking)]
        )


def test_a_write_off_is_for_good_after_a_while_and_where_the_place_is_taken():
    ops, station = by_hand(least=2)
    pick = station.here.picks[0]
    report = report_of(pick, 1, PickOutcome.DAMAGED)
    assert ops.shift.tasks.report(report).success
    bin_, stock = pick.bin, pick.bin.quantity
    bin_.capacity = stock
    refused, text = ops.shift.tasks.undo(PICK, report.sequence)
    assert not refused and text == f"{bin_.item} has no room for 1 of {bin_.sku} any more"
    bin_.capacity += 1
    ops.run(minutes=(UNDO_WITHIN + 1) / 60)
    refused, text = ops.shift.tasks.undo(PICK, report.sequence)
    assert not refused and text == "it was written off more than 60 s ago"
    assert bin_.quantity == stock


def test_of_a_bundle_what_stays_out_can_go_in_after_all():
    ops = Operations(site=site(), physics=False, orders="none")
    ops.shift.set_station(REPLENISH, True, StationMode.MANUAL)
    ops.run(minutes=10)
    station, tasks = ops.shift.station(REPLENISH), ops.shift.tasks
    bundle = station.here.puts[0]
    quantity, stock = bundle.quantity, bundle.bin.quantity

    def report(pieces, outcome):
        named = REPLENISH, 0, bundle.bin.item, bundle.sequence
        return Report(*named, pieces, outcome)

    assert not tasks.report(report(quantity + 1, PickOutcome.DONE)).success
    lost = report(1, PickOutcome.DAMAGED)
    assert tasks.report(lost).success and bundle.quantity == quantity - 1
    assert tasks.undo(REPLENISH, lost.sequence) == (True, "") and bundle.quantity == quantity
    done = report(quantity, PickOutcome.DONE)
    for _ in range(2):
        assert tasks.report(done).success
    assert bundle.bin.quantity == stock + quantity and station.pieces == quantity


def test_a_station_tells_for_how_long_it_waits_for_a_person():
    ops, station = by_hand()
    shift = ops.shift
    assert station.waiting(shift.now) > 0
    shift.tasks.report(report_of(station.here.picks[0]))
    assert station.waiting(shift.now) == 0
    while not (station.here and station.here.picks):
        ops.run(minutes=1)
    before = station.waiting(shift.now)
    ops.run(minutes=20)
    assert station.waiting(shift.now) == pytest.approx(before + 1200)
    shift.set_station(PICK, True, StationMode.AUTOMATIC)
    assert station.waiting(shift.now) == 0


def test_a_report_that_comes_again_under_its_id_gets_the_first_answer():
    ops, station = by_hand(least=2)
    first, second = list(station.here.picks)[:2]
    before = station.pieces
    report = replace(report_of(first), id="a")
    answers = [ops.shift.tasks.report(report) for _ in range(3)]
    assert answers[0].success and answers[0] is answers[1] is answers[2]
    assert station.pieces == before + report.quantity
    other = replace(report_of(second), id="a")
    assert ops.shift.tasks.report(other).message == "the id a is of another report"
    # What was refused stays refused, whatever has changed since.
    ops.shift.set_station(PICK, True, StationMode.AUTOMATIC)
    refused = replace(report_of(second), id="b")
    text = ops.shift.tasks.report(refused).message
    ops.shift.set_station(PICK, True, StationMode.MANUAL)
    assert text == f"{PICK} works by itself" and ops.shift.tasks.report(refused).message == text


def test_a_report_is_known_after_a_restart(tmp_path):
    database = tmp_path / "run.db"
    ops, station = by_hand(database)
    report = replace(report_of(station.here.picks[0]), id="mine")
    answer = ops.shift.tasks.report(report)
    ops.close()
    again = Operations(site=site(), physics=False, database=database, orders="none")
    again.shift.set_station(PICK, True, StationMode.MANUAL)
    assert not again.shift.tasks.report(report).success  # it is not known yet
    again.close()
    engine = open_engine(database)
    tasks = Operations(site=site(), physics=False, orders="none").shift.tasks
    tasks.remember(stored.reports(engine, most=10))
    repeated = tasks.report(report)
    assert (repeated.success, repeated.quantity) == (True, answer.quantity)
    assert stored.reports(engine, most=0) == [] and check.faults(engine) == []
    engine.dispose()


def test_what_was_picked_is_taken_back_while_its_unit_is_there(tmp_path):
    ops, station = by_hand(tmp_path / "run.db", least=2)
    shift, unit = ops.shift, station.here.unit
    pick = station.here.picks[0]
    order, bin_, pieces, tote = pick.line.order, pick.bin, pick.quantity, pick.line.order.tote
    before = bin_.quantity, station.pieces, shift.tally.items_picked, promised(ops)
    report = report_of(pick)
    assert shift.tasks.report(report).success
    for _ in range(2):  # a repetition changes nothing
        assert shift.tasks.undo(PICK, report.sequence) == (True, "")
        assert before == (
            bin_.quantity, station.pieces, shift.tally.items_picked, promised(ops)
        )  # fmt: skip
    again = station.here.picks[0]
    assert (again.line.order, again.bin, again.quantity) == (order, bin_, pieces)
    assert order.state == OrderState.ASSIGNED and order.tote == tote
    assert again.sequence != report.sequence
    last = None
    while station.here and station.here.unit == unit and station.here.picks:
        last = report_of(station.here.picks[0])
        assert shift.tasks.report(last).success
    refused = shift.tasks.undo(PICK, last.sequence)
    assert refused == (False, f"storage unit {unit} has left {PICK}")
    shift.set_station(PICK, True, StationMode.AUTOMATIC)
    ops.run(hours=1)
    assert order.state == OrderState.COMPLETED
    ops.close()
    assert check.faults(open_engine(tmp_path / "run.db")) == []


def complete_one(ops, station):
    """Confirms picks until one completes an order while its unit stays; returns the report."""
    while True:
        while not (station.here and station.here.picks):
            ops.run(minutes=1)
        pick = station.here.picks[0]
        report, visit = report_of(pick), station.here
        ops.shift.tasks.report(report)
        if pick.line.order.state == OrderState.COMPLETED and visit.here:
            return report, pick.line.order


def test_an_order_that_was_completed_is_open_again_in_its_tote(tmp_path):
    ops, station = by_hand(tmp_path / "run.db", least=2)
    shift = ops.shift
    report, order = complete_one(ops, station)
    done = shift.tally.orders_completed
    tote = order.tote
    shift.advance(shift.now)  # its place goes to another order
    assert shift.tasks.undo(PICK, report.sequence) == (True, "")
    assert (order.state, order.completed, shift.tally.orders_completed) == (1, 0.0, done - 1)
    assert station.orders[order.order_id] is order and station.totes.at(tote) is order
    assert len(station.orders) <= station.capacity
    assert len({each.tote for each in station.orders.values()}) == len(station.orders)
    shift.set_station(PICK, True, StationMode.AUTOMATIC)
    ops.run(hours=2)
    assert order.state == OrderState.COMPLETED
    ops.close()
    assert check.faults(open_engine(tmp_path / "run.db")) == []


def test_a_complete_order_stays_so_once_another_one_has_pieces_in_its_place():
    ops, station = by_hand(least=2)
    report, order = complete_one(ops, station)
    ops.shift.advance(ops.shift.now)
    taken = station.totes.at(order.tote) or next(iter(station.orders.values()))
    if not station.totes.at(order.tote):
        station.totes.leave(taken)
        taken.tote = order.tote
        station.totes.take_again(taken)
    taken.lines[0].picked = 1
    undone = ops.shift.tasks.undo(PICK, report.sequence)
    text = f"{order.reference} is complete; tote {order.tote} is {taken.reference}'s by now"
    assert undone == (False, text)


def test_a_bundle_that_was_put_in_comes_out_again(tmp_path):
    ops = Operations(site=site(), physics=False, database=tmp_path / "run.db", orders="none")
    ops.shift.set_station(REPLENISH, True, StationMode.MANUAL)
    ops.run(minutes=10)
    station, tasks = ops.shift.station(REPLENISH), ops.shift.tasks
    bundle, visit = station.here.puts[0], station.here
    visit.puts.append(Bundle(0, bundle.sku, 1, bin=bundle.bin))  # so that the unit stays
    ops.shift.inventory.expect(bundle.bin, bundle.sku, 1)
    stock, pieces = bundle.bin.quantity, ops.shift.tally.pieces_stored
    report = Report(
        REPLENISH, 0, bundle.bin.item, bundle.sequence, bundle.quantity, PickOutcome.DONE
    )
    assert tasks.report(report).success and bundle.bin.quantity == stock + bundle.quantity
    assert tasks.undo(REPLENISH, report.sequence) == (True, "")
    assert (bundle.bin.quantity, ops.shift.tally.pieces_stored) == (stock, pieces)
    assert station.here.puts[0] is bundle and bundle.sequence != report.sequence
    again = replace(report, sequence=bundle.sequence)
    assert tasks.report(again).success
    ops.shift.inventory.reserve(bundle.bin, bundle.bin.available)  # an order asks for all of it
    text = f"pieces of {bundle.sku} in {bundle.bin.item} are promised to orders by now"
    assert tasks.undo(REPLENISH, again.sequence) == (False, text)
    ops.shift.inventory.reserve(bundle.bin, -bundle.bin.reserved)
    ops.shift.commit()
    ops.close()
    assert check.faults(open_engine(tmp_path / "run.db")) == []


def test_totes_keep_their_places_and_are_changed_in_turn():
    totes, orders = Totes(3), [Order(i, [("a", 1)], 0.0) for i in range(1, 6)]
    for order in orders[:4]:
        totes.take(order)
    assert [order.tote for order in orders[:4]] == [1, 2, 3, 0]
    totes.leave(orders[1])
    totes.leave(orders[0])
    assert [order.order_id for order in totes] == [3] and totes.at(2) is None
    totes.take(orders[4])
    assert orders[4].tote == 2  # free for longer than 1
    assert orders[0].tote == 1
    totes.take_again(orders[0])
    assert totes.at(1) is orders[0]
    with pytest.raises(ValueError, match="not in deque"):
        totes.take_again(orders[1])


def test_each_order_of_a_station_has_a_tote_of_its_own():
    ops, station = by_hand()
    positions = {order.order_id: order.tote for order in station.orders.values()}
    assert sorted(positions.values()) == sorted(set(positions.values()))
    assert set(positions.values()) <= set(range(1, station.capacity + 1))
    ops.shift.tasks.report(report_of(station.here.picks[0]))
    ops.run(minutes=1)
    kept = {number: order.tote for number, order in station.orders.items() if number in positions}
    assert kept and all(positions[number] == tote for number, tote in kept.items())
