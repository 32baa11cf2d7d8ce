# SPDX-License-Identifier: Apache-2.0
"""A database remembers a shift at any time of it, and a forecast goes on from there."""

import argparse
import sqlite3

import numpy as np
import pytest

from warehouse_operations.forecast import ahead, of_database, program, request
from warehouse_operations.forecast.request import ForecastError, Request
from warehouse_operations.runs.simulation import Description, open_operations
from warehouse_operations.stock.demand import Poisson, alike
from warehouse_operations.stock.order_file import OrderDraft
from warehouse_operations.store import moment
from warehouse_operations.store.engines import DatabaseError

THEN, LAST = 480.0, 900.0  # [s]


def state_of(shift):
    orders = {
        o.order_id: (o.station, o.due, [(n.sku, n.quantity, n.picked) for n in o.lines])
        for o in shift.orders.values()
    }
    stock = {b.bin_id: b.quantity for b in shift.inventory.bins.values()}
    visits = {
        v.transport_id: (v.unit, v.station.name, v.lifted, v.arrived, v.released)
        for v in shift.visits.under_way
    }
    return orders, stock, visits


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    """A shift that is over: (its database, orders, stock and visits as they were THEN)."""
    path = tmp_path_factory.mktemp("forecast") / "run.db"
    description = Description("small", orders="fill:60", physics=False, seed=3)
    with open_operations(description, str(path)) as ops:
        ops.step_until(THEN)
        state = state_of(ops.shift)
        ops.step_until(LAST)
    return path, state


def arguments(path, **options):
    usual = {"at": None, "layout": "", "robots": 0, "orders": "", "realism": ""}
    return argparse.Namespace(database=str(path), **(usual | options))


def test_a_database_remembers_the_shift_as_it_was(kept):
    path, (orders, stock, visits) = kept
    prepared = program.prepare(arguments(path, at=str(THEN)), Request(10, 1))
    copy = ahead.Ahead(prepared.tasks[0], 0)
    orders_then, stock_then, visits_then = state_of(copy.shift)
    assert orders_then == orders and stock_then == stock and visits_then == visits
    assert copy.shift.now == THEN and orders and visits
    assert set(prepared.known) == set(orders)


def test_what_is_remembered_goes_on(kept):
    path, (_, stock, _) = kept
    prepared = program.prepare(arguments(path, at="8m"), Request(10, 1))
    copy = ahead.Ahead(prepared.tasks[0], 0)
    copy.step_until(THEN + 600)
    tally = copy.shift.tally
    assert tally.orders_completed > 20
    assert copy.shift.inventory.total == (
        sum(stock.values()) - tally.items_picked + tally.pieces_stored
    )


def test_without_a_time_it_is_the_latest(kept):
    then = moment.read(str(kept[0]))
    assert then.time == then.last == pytest.approx(LAST, abs=60)
    assert then.ways_back and min(then.ways_back) > 2.2


@pytest.mark.parametrize(
    "options, text",
    [
        ({"at": "2:00:00"}, "at is 7200 s; the last shift went from 0 s to"),
        ({"at": "soon"}, "at is soon; seconds of the shift"),
        ({"layout": "large"}, "is of another warehouse"),
    ],
)
def test_what_can_not_be_is_refused_in_a_sentence(kept, options, text):
    with pytest.raises(program.ERRORS) as error:
        program.prepare(arguments(kept[0], **options), Request(10, 1))
    assert text in str(error.value) and "\n" not in str(error.value)


def test_a_folder_that_can_not_be_written_to_is_refused_before_a_run(kept, tmp_path, monkeypatch):
    prepared = program.prepare(arguments(kept[0]), Request(1, 1))
    monkeypatch.setattr(program, "Runs", lambda *_, **__: pytest.fail("a run was begun"))
    (tmp_path / "file").write_text("")
    with pytest.raises(ForecastError, match="out is .*/file: File exists"):
        program.answer(prepared, Request(1, 1), 1, tmp_path / "file")


def test_other_files_are_refused_and_left_alone(kept, tmp_path):
    with pytest.raises(DatabaseError, match="there is no such file"):
        moment.read(str(tmp_path / "none.db"))
    assert not (tmp_path / "none.db").exists()
    sqlite3.connect(tmp_path / "empty.db").close()
    with pytest.raises(DatabaseError, match="there is no warehouse in it"):
        moment.read(str(tmp_path / "empty.db"))
    old = tmp_path / "old.db"
    old.write_bytes(kept[0].read_bytes())
    with sqlite3.connect(old) as connection:
        connection.execute("UPDATE schema_version SET version = 3")
    with pytest.raises(DatabaseError, match="of schema version 3; 4 was expected"):
        moment.read(str(old))


def test_a_site_without_a_preset_has_to_be_named(kept, tmp_path):
    path = tmp_path / "run.db"
    path.write_bytes(kept[0].read_bytes())
    with sqlite3.connect(path) as connection:
        connection.execute("UPDATE run SET site = 'my hall'")
    with pytest.raises(ForecastError, match="is of 'my hall', which is no preset; --layout"):
        program.prepare(arguments(path), Request(10, 1))
    assert program.prepare(arguments(path, layout="small"), Request(10, 1)).tasks


def test_orders_to_come_are_like_those_that_came():
    recent = [OrderDraft((("red", 2),), at, at + 600, 0) for at in np.arange(0.0, 3600.0, 60.0)]
    demand = alike(recent, 0.0, 3600.0, np.random.default_rng(1))
    assert isinstance(demand, Poisson) and demand.per_hour == pytest.approx(60)
    assert demand.next_time() > 3600.0
    draft = demand.customers.order(4000.0, lambda _: 1)
    assert draft.lines == (("red", 2),) and draft.due == 4600.0
    assert alike([], 0.0, 3600.0, np.random.default_rng(1)) is None


def test_a_shift_whose_orders_come_from_elsewhere_has_them_to_come(kept):
    then = moment.read(str(kept[0]), THEN)
    site = program._site(then, "", None)
    remembered = of_database.remember(then, site, str(kept[0]), "none")
    copy = request.tasks_of(Request(10, 1), site, remembered.shift, remembered.fork)[0]
    assert isinstance(ahead.Ahead(copy, 0).shift.demand, Poisson)
