# SPDX-License-Identifier: Apache-2.0
"""A fork is the shift that it is of; runs from it are repeatable, and changes change them."""

import contextlib
import gc
import math
import os
import signal
import threading
import time
import weakref
from dataclasses import replace

import numpy as np
import pytest

from warehouse_fleet.transports.transport_book import Step
from warehouse_layout.message_enums import OrderState
from warehouse_operations.fleets import fleet_now
from warehouse_operations.fleets.forked_fleet import Pace
from warehouse_operations.forecast import (
    ahead,
    bands,
    comparison,
    fork,
    pacing,
    request,
    running,
    worker,
    workers,
)
from warehouse_operations.forecast.request import ForecastError, Request
from warehouse_operations.forecast.workers import Runs, RunsError
from warehouse_operations.runs.simulation import Description, open_operations

MINUTES = 6.0


def opened(physics=False, orders="fill", size="small"):
    return open_operations(Description(size, orders=orders, physics=physics, seed=3))


def forked(ops):
    return fork.of_shift(ops.shift, fleet_now.of(ops.fleet))


@pytest.fixture(scope="module", params=[False, True], ids=["ideal", "simulated"])
def shift(request):
    """A shift after some minutes, in which units are on their way and pieces in hands."""
    with opened(request.param) as ops:
        ops.run(minutes=MINUTES)
        yield ops


def a_task(ops, minutes=10, lines=(), seed=1):
    asked = Request(minutes, 2, tuple(lines), seed)
    return request.tasks_of(asked, ops.site, ops.shift, forked(ops))[-1]


def stock_of(shift):
    bins = shift.inventory.bins.values()
    return {b.bin_id: (b.sku, b.quantity, b.reserved, b.expected) for b in bins}


def orders_of(shift):
    return {
        order.order_id: (
            order.state,
            order.station,
            order.due,
            [(line.sku, line.quantity, line.picked, line.allotted) for line in order.lines],
        )
        for order in shift.orders.values()
    }


def test_a_fork_is_the_shift_that_it_is_of(shift):
    copy = ahead.Ahead(a_task(shift), 0)
    assert copy.shift is not shift.shift and copy.shift.now == shift.time
    assert stock_of(copy.shift) == stock_of(shift.shift)
    assert orders_of(copy.shift) == orders_of(shift.shift)
    for station, other in zip(shift.stations, copy.shift.stations):
        assert list(station.orders) == list(other.orders)
        assert list(station.inbound) == list(other.inbound)
        assert (station.at_work, station.is_open) == (other.at_work, other.is_open)
    steps = {each.number: each.step for each in shift.fleet.transports.book}
    copied = {each.number: each.step for each in copy.fleet.book}
    # Ideal robots don't wait beneath a unit.
    assert copied == {n: Step.FETCHING if s == Step.READY else s for n, s in steps.items()}
    carried = {t.shelf for t in copy.fleet.book if t.step in (Step.BRINGING, Step.WAITING)}
    assert carried and not carried & copy.fleet.cell_of_unit.keys()


def test_forking_leaves_a_shift_as_it_is():
    hashes = []
    for forks in (False, True):
        with opened() as ops:
            for _ in range(10):
                ops.run(minutes=1)
                if forks:
                    ahead.run(replace(a_task(ops), times=(ops.time + 60,)), 0)
            hashes.append(ops.shift.state_hash())
    assert hashes[0] == hashes[1]


def test_a_run_that_is_over_keeps_no_memory(shift):
    gone = weakref.ref(ahead.Ahead(a_task(shift), 0).shift)
    gc.collect()
    assert gone() is None


def test_stock_balances_and_no_order_is_lost(shift):
    copy = ahead.Ahead(a_task(shift), 0)
    tally, inventory = copy.shift.tally, copy.shift.inventory
    pieces, picked, stored = inventory.total, tally.items_picked, tally.pieces_stored
    received, known = tally.orders_received, len(copy.shift.orders)
    completed = tally.orders_completed
    copy.step_until(shift.time + 1200)
    taken, put = tally.items_picked - picked, tally.pieces_stored - stored
    assert taken > 50 and inventory.total == pieces - taken + put
    assert inventory.total == sum(bin_.quantity for bin_ in inventory.bins.values())
    done, came = tally.orders_completed - completed, tally.orders_received - received
    assert len(copy.shift.orders) == known + came - done
    assert all(o.state != OrderState.COMPLETED for o in copy.shift.orders.values())


def test_transports_under_way_arrive(shift):
    copy = ahead.Ahead(a_task(shift), 0)
    numbers = {transport.number for transport in copy.fleet.book}
    copy.step_until(shift.time + 900)
    assert numbers and not numbers & {transport.number for transport in copy.fleet.book}


@pytest.mark.parametrize("physics", [False, True], ids=["ideal", "simulated"])
def test_a_unit_on_a_broken_robot_is_stored_and_then_fetched(physics):
    with opened(physics) as ops:
        ops.run(minutes=2)
        ops.run(minutes=2, progress=lambda _: bool(carrying(ops)))
        unit, kiva_id = carrying(ops)[0]
        if physics:
            ops.fleet.fail(kiva_id, 3600)
        else:
            trips = ops.fleet.trips
            trips._break_down(next(r for r in trips.robots if r.kiva_id == kiva_id), 3600)
        ops.run(seconds=60)
        assert unit not in ops.fleet.transports.book.of_unit  # its robot lost it
        asked = ops.fleet.transports.submit(unit, "pick1")
        assert asked.accepted == physics  # ideal robots are asked when they have stored it
        task = a_task(ops)
        assert task.fork.fleet.carried[unit] == kiva_id
        copy = ahead.Ahead(task, 0)
        copy.step_until(ops.time + 900)
        if physics:
            assert copy.fleet.book.get(asked.transport_id).step == Step.WAITING
        else:
            assert unit in copy.fleet.cell_of_unit


def carrying(ops):
    """Returns (unit, robot) of all units on their way to a station."""
    steps = [t for t in ops.fleet.transports.book if t.step == Step.BRINGING]
    ids = [r.kiva_id for r in ops.fleet.trips.robots] if ops.ideal else ops.fleet.robots.kiva_ids
    return [(transport.shelf, int(ids[transport.robot])) for transport in steps]


def test_an_ideal_fork_takes_each_motion_up_where_it_was():
    with opened(size="medium") as ops:
        ops.run(minutes=MINUTES)
        copy = ahead.Ahead(a_task(ops), 0)
        expected = fleet_now.time_left(ops.fleet.trips)
        left = fleet_now.time_left(copy.fleet.trips)
        assert expected and {n: left[n] for n in expected} == pytest.approx(expected)


@pytest.mark.long
def test_simulated_robots_go_on_from_a_checkpoint_of_their_world():
    with opened(physics=True) as ops:
        ops.run(minutes=4)
        digest, done = ops.fleet.state_hash(), ops.context.tally.orders_completed
        forked = running.fork_of(ops, physics=True)
        asked = Request(8, 2, physics=True)
        (task,) = request.tasks_of(asked, ops.site, ops.shift, forked)
        with contextlib.closing(ahead.Ahead(task, 0)) as copy:
            steps = {each.number: each.step for each in ops.fleet.transports.book}
            assert {each.number: each.step for each in copy.fleet.transports.book} == steps
            assert copy.fleet.state_hash() == digest
            copy.step_until(ops.time + 900)
            assert not steps.keys() & {each.number for each in copy.fleet.transports.book}
            assert (copy.fleet.collisions, copy.fleet.stuck) == (0, 0)
        assert ops.fleet.state_hash() == digest
        (forecast,) = running.forecasts(ops, asked)
        ends = [ahead.run(task, number).done[-1] for number in (0, 1)]
        assert forecast.bands["done"][1, -1] == pytest.approx(np.mean(ends))
        ops.run(minutes=8)
        happened = ops.context.tally.orders_completed - done
        assert 0.6 * min(ends) < happened < 1.6 * max(ends)


@pytest.mark.parametrize(
    ("line", "text"),
    [
        ("+0 robots +2", "simulated robots are those of the checkpoint"),
        ("+0 speed 80%", "simulated ones have that of their model"),
    ],
)
def test_what_simulated_robots_can_not_do_is_refused(line, text):
    with opened(physics=True) as ops:
        ops.run(seconds=60)
        with pytest.raises(ForecastError, match=text):
            running.forecasts(ops, Request(changes=(line,), physics=True))


def test_equal_seed_equal_forecast_and_another_run_another_one(shift):
    task = a_task(shift)
    first, again, other = ahead.run(task, 0), ahead.run(task, 0), ahead.run(task, 1)
    assert first == again or math.isnan(first.finish) and first.over == again.over
    assert first.over != other.over


def test_a_closed_station_lowers_what_is_done(shift):
    name = next(station.name for station in shift.stations if station.picks)
    as_it_is = [ahead.run(a_task(shift), number) for number in range(3)]
    closed = [ahead.run(a_task(shift, lines=[f"+0 close {name}"]), n) for n in range(3)]
    change = {each.name: each for each in comparison.differences(as_it_is, closed)}
    assert change["pieces"].mean + change["pieces"].half < 0


def test_equal_pairs_do_not_claim_to_be_sure(shift):
    as_it_is = [ahead.run(a_task(shift), number) for number in range(3)]
    two_fewer = [replace(run, done=[count - 2 for count in run.done]) for run in as_it_is]
    change = comparison.differences(as_it_is, two_fewer)[0]
    assert str(change) == "-2.0 in all 3"


def test_robots_are_added_and_taken_away(shift):
    few = ahead.Ahead(a_task(shift, lines=["+0 robots -2"]), 0)
    more = ahead.Ahead(a_task(shift, lines=["+0 robots +2"]), 0)
    assert more.fleet.robot_count == few.fleet.robot_count + 2
    for each in (few, more):
        each.step_until(shift.time + 300)
    able = [sum(r.in_service for r in each.fleet.trips.robots) for each in (few, more)]
    assert able[1] == able[0] + 4


@pytest.mark.parametrize(
    "asked, text",
    [
        (Request(changes=("+0 close pick99",)), "close is pick99; there are"),
        (Request(changes=("+0 shut pick1",)), "shut is unknown"),
        (Request(changes=("+0 fail robot 999",)), "fail is robot 999; there are 1 to"),
        (Request(changes=("+0 priority gone 9",)), "priority is of gone; no such order is open"),
        (Request(changes=("+0 policy storage far",)), "policy storage: there is no 'far'"),
        (Request(changes=("+0 robots -500",)), "robots is -500; there are"),
        (Request(changes=("+5m robots -9", "+0 robots +1")), "robots is -9; there are"),
        (Request(10, changes=("+20m close pick1",)), "comes after the 10 minutes"),
        (Request(changes=("0 close pick1",)), "is over; +0 is now"),
        (Request(1441), "minutes is 1441; above 0, up to 1440 (a day), was expected"),
        (Request(math.nan), "minutes is nan; above 0"),
        (Request(0), "minutes is 0; above 0"),
        (Request(runs=2000), "runs is 2000; 0 (by time) to 1000 was expected"),
        (Request(changes=("+0 close pick1",) * 51), "51 changes; 50 or fewer were expected"),
        (
            Request(changes=("+0 close pick1\n+0 open",)),
            "a line of up to 200 characters was expected",
        ),
        (
            Request(changes=("+0 close " + "p" * 300,)),
            "a line of up to 200 characters was expected",
        ),
        (Request(physics=True), "simulated robots need a checkpoint of their world"),
    ],
)
def test_what_can_not_be_is_refused_in_a_sentence(asked, text):
    with opened() as ops:
        ops.run(seconds=60)
        with pytest.raises(ForecastError) as error:
            request.tasks_of(asked, ops.site, ops.shift, forked(ops))
    assert text in str(error.value) and "\n" not in str(error.value)


def test_a_shift_without_orders_is_refused():
    with opened(orders="none") as ops:
        ops.run(seconds=60)
        with pytest.raises(ForecastError, match="no order is open, and none is to come"):
            request.tasks_of(Request(), ops.site, ops.shift, forked(ops))


# Processes.


def test_processes_make_the_same_runs(shift):
    task = a_task(shift, minutes=2)
    made = dict(out for out in ((o.number, o) for _, o in Runs([task], 3).outcomes()))
    assert sorted(made) == [0, 1, 2]
    assert made[1].over == ahead.run(task, 1).over and made[1].done == ahead.run(task, 1).done


def children(runs):
    deadline = time.monotonic() + 30
    while not runs._running and time.monotonic() < deadline:
        time.sleep(0.01)
    return list(runs._running)


def test_a_killed_run_is_made_again(shift):
    runs = Runs([a_task(shift, minutes=2)], 2, processes=1)
    outcomes = runs.outcomes()
    first = next(outcomes)
    os.kill(children(runs)[0].pid, signal.SIGKILL)
    assert sorted(outcome.number for _, outcome in [first, *outcomes]) == [0, 1]


def test_runs_that_are_given_up_end_at_once(shift):
    runs = Runs([a_task(shift, minutes=600)], 50)
    outcomes = runs.outcomes()
    processes = []

    def give_up():
        processes.extend(children(runs))
        runs.give_up()

    threading.Thread(target=give_up).start()
    with pytest.raises(RunsError, match="given up for a newer one"):
        list(outcomes)
    assert processes and all(process.wait(5) is not None for process in processes)


def test_processes_take_the_time_that_others_leave(shift):
    runs = Runs([a_task(shift, minutes=600)], 5, processes=1)
    outcomes = runs.outcomes()
    thread = threading.Thread(target=lambda: pytest.raises(RunsError, list, outcomes))
    thread.start()
    process = children(runs)[0]
    deadline = time.monotonic() + 30
    while os.sched_getscheduler(process.pid) != os.SCHED_IDLE and time.monotonic() < deadline:
        time.sleep(0.05)
    assert os.sched_getscheduler(process.pid) == os.SCHED_IDLE
    assert os.getpriority(os.PRIO_PROCESS, process.pid) == worker.LOWEST
    runs.give_up()
    thread.join(10)


def test_as_many_runs_as_fit_into_a_time(shift):
    runs = Runs([a_task(shift, minutes=1)], 0, processes=1, budget=0.0)
    assert len(list(runs.outcomes())) == workers.FEWEST


# Bands.


def outcome(number, done, finish=math.nan, over=None):
    series = tuple(done)
    return ahead.Outcome(number, series, series, series, series, over or {}, finish)


def test_a_further_run_lies_in_the_band_with_80_percent():
    rng = np.random.default_rng(1)
    values = rng.normal(size=(4000, 13, 1))
    held = 0
    for rows in values:
        low, _, high = bands.quantiles(rows[:-1])[:, 0]
        held += low <= rows[-1, 0] <= high
    assert held / len(values) == pytest.approx(0.8, abs=0.02)


def test_finishes_that_are_not_within_come_last():
    ends = [100.0 * i for i in range(1, 7)] + [math.nan] * 3
    low, middle, high = bands.finish_quantiles(ends)
    assert (low, middle) == (100.0, 500.0) and math.isnan(high)


def test_late_orders_are_named_with_their_odds():
    runs = [outcome(0, [1], over={1: 50.0, 2: 500.0}), outcome(1, [1], over={1: 150.0})]
    known = {1: ("A", 100.0), 2: ("B", 200.0), 3: ("C", 0.0), 4: ("D", 900.0)}
    late = bands.late_orders(runs, known, 600.0)
    assert [(each.reference, each.odds) for each in late] == [("B", 1.0), ("A", 0.5)]


def test_a_text_says_when_all_is_done(shift):
    task = replace(a_task(shift), times=(shift.time + 60,))
    runs = [outcome(i, [10 + i], finish=3600.0 + 60 * i) for i in range(9)]
    text = bands.forecast_of(task, 1, runs, {1: ("A", 0.0)}).text
    assert text.startswith("all orders of now done at 1:04 (1:00 to 1:08); 14 (10 to 18) orders")


# Pace.


def test_robots_are_as_slow_as_they_were(shift, monkeypatch):
    monkeypatch.setattr(pacing, "FEWEST", 2)  # the warehouse is small
    task = a_task(shift)
    lift = task.site.kinematics.lift
    usual = pacing.PILOT
    pilot = ahead.Ahead(task, pacing.NUMBER)
    pilot.step_until(shift.time + pacing.SETTLE)
    pilot.shift.tally.ways_back.clear()
    pilot.step_until(shift.time + usual)
    slow = tuple(lift + 1.5 * (way - lift) for way in pilot.shift.tally.ways_back)
    pace = pacing.pace_of(replace(task, fork=replace(task.fork, ways_back=slow)))
    assert pace.loaded == pytest.approx(1.5, abs=0.01) and pace.unloaded == pace.loaded
    assert pacing.pace_of(replace(task, fork=replace(task.fork, ways_back=()))).loaded == 1.0


def test_a_slower_pace_makes_ways_longer(shift):
    task = a_task(shift)
    means = []
    for pace in (Pace(), Pace(2.0, 2.0)):
        copy = ahead.Ahead(replace(task, fork=replace(task.fork, pace=pace)), 0)
        copy.shift.tally.ways_back.clear()
        copy.step_until(shift.time + 900)
        means.append(np.mean(copy.shift.tally.ways_back) - task.site.kinematics.lift)
    assert 1.5 < means[1] / means[0] < 2.5
