# SPDX-License-Identifier: Apache-2.0
"""Events within a scenario: what a file may say, and what then happens in a shift."""

import json
import subprocess
import sys
from dataclasses import replace

import pytest
from paths import ROOT

from warehouse_layout.file import layout_file
from warehouse_layout.generate import layout_choice
from warehouse_layout.message_enums import OrderEventKind
from warehouse_operations.runs import event_file, simulation, sweep
from warehouse_operations.runs.event_file import Event, EventError, of_line, seconds_of
from warehouse_operations.runs.simulation import Description, open_operations

COMPLETED = OrderEventKind.COMPLETED
SIMULATE = ROOT / "src" / "warehouse_viewer" / "nodes" / "simulate"
HOUR = 3600.0


def opened(*events, **options):
    settings = {"size": "small", "physics": False, "orders": "poisson:300", "seed": 2} | options
    return open_operations(Description(events=tuple(events), **settings))


def pieces_in(ops, minutes):
    before = ops.shift.tally.items_picked
    ops.run(minutes=minutes)
    return ops.shift.tally.items_picked - before


# --- what a file says


def test_all_kinds_are_read(tmp_path):
    rush = tmp_path / "rush.csv"
    rush.write_text("reference,sku,quantity\na,sku-1,1\n")
    path = tmp_path / "events.yaml"
    path.write_text(
        "- {at: 2:30:00, close: pick1}\n- {at: 0:10:00, open: pick1}\n- {at: 60, robots: +4}\n"
        "- {at: 61, robots: -2}\n- {at: 62, fail: robot 7}\n- {at: 63, fail: 10%, for: 15m}\n"
        "- {at: 64, speed: 50%}\n- {at: 65, sku_out: sku-3}\n- {at: 66, orders: rush.csv}\n"
        "- {at: 67, picker: {station: pick1, seconds_a_piece: 14}}\n"
        "- {at: 68, priority: {order: rush-17, to: 5}}\n"
        "- {at: 69, policy: {storage: random, units: most lines}}\n"
    )
    events = event_file.read(path)
    assert [event.at for event in events] == [60, 61, 62, 63, 64, 65, 66, 67, 68, 69, 600, 9000]
    values = {(event.kind, str(event.value)) for event in events}
    assert ("robots", "4") in values and ("robots", "-2") in values and ("fail", "7") in values
    assert ("orders", str(rush)) in values and ("speed", "0.5") in values
    assert events[3].value == pytest.approx(0.1) and events[3].duration == 900
    again = event_file.events_of([event.to_json() for event in events], tmp_path)
    assert again == events


@pytest.mark.parametrize(
    ("line", "place", "fault"),
    [
        ("- {close: pick1}", "[0]", "has no `at`"),
        ("- {at: soon, close: pick1}", "[0].at", "is soon"),
        ("- {at: -1, close: pick1}", "[0].at", "is -1"),
        ("- {at: 1, shut: pick1}", "[0].shut", "is unknown"),
        ("- {at: 1, close: 3}", "[0].close", "name of a station"),
        ("- {at: 1, robots: many}", "[0].robots", "+4 or -2"),
        ("- {at: 1, robots: 0}", "[0].robots", "+4 or -2"),
        ("- {at: 1, fail: pick1}", "[0].fail", "robot 7"),
        ("- {at: 1, fail: 130%}", "[0].fail", "robot 7"),
        ("- {at: 1, speed: fast}", "[0].speed", "share of the top speed"),
        ("- {at: 1, sku_out: [1]}", "[0].sku_out", "a SKU"),
        ("- {at: 1, orders: none.csv}", "[0].orders", "No such file"),
        ("- {at: 1, orders: fill}", "[0].orders", "CSV file"),
        ("- {at: 1, picker: {station: pick1}}", "[0].picker", "seconds_a_piece"),
        ("- {at: 1, picker: {station: a, seconds_a_piece: 0}}", "[0].picker", "from 0.1"),
        ("- {at: 1, priority: 5}", "[0].priority", "{order: rush-17, to: 5}"),
        ("- {at: 1, priority: {order: [], to: 5}}", "[0].priority", "reference or number"),
        ("- {at: 1, priority: {order: a, to: 256}}", "[0].priority", "to is 256; 0 to 255"),
        ("- {at: 1, priority: {order: a, to: .nan}}", "[0].priority", "to is .nan"),
        ("- {at: 1, policy: nearest}", "[0].policy", "{storage: nearest}"),
        ("- {at: 1, policy: {storing: nearest}}", "[0].policy", "'storing' is not a role"),
        ("- {at: 1, policy: {storage: far}}", "[0].policy", "there is no 'far'"),
        ("- {at: 1, close: a, open: b}", "[0]", "one of"),
        ("- {at: 1, close: a, for: 5}", "[0]", "goes with fail"),
        ("- often", "[0]", "is often"),
        ("at: 5", "", "has to be a list"),
    ],
)
def test_wrong_events_name_file_line_and_field(tmp_path, line, place, fault):
    path = tmp_path / "events.yaml"
    path.write_text(f"# a comment\n\n{line}\n")
    with pytest.raises(EventError) as error:
        event_file.read(path)
    where = 1 if not place else 3
    where = 3 if line.startswith("at") else where
    assert str(error.value).startswith(f"{path}:{where}: {place}"), error.value
    assert fault in str(error.value)


def test_times_and_lines():
    assert seconds_of("2:30:00") == 9000 and seconds_of("10m") == 600 and seconds_of("1.5h") == 5400
    assert of_line("+10m robots +2", 100.0) == Event(700.0, "robots", 2)
    assert of_line("+0 close pick3", 50.0) == Event(50.0, "close", "pick3")
    assert of_line("2:30:00 fail robot 7 for 15m") == Event(9000.0, "fail", 7, 900.0)
    assert of_line("5 priority rush 17 9").value == {"order": "rush 17", "to": 9}
    assert of_line("5 policy units most lines").value == {"units": "most lines"}
    assert of_line("5 picker pick1 14").value == {"station": "pick1", "seconds_a_piece": 14}
    for text in ("close pick3", "soon close pick3", "5 shut pick3"):
        with pytest.raises(EventError):
            of_line(text)


@pytest.mark.parametrize(
    ("event", "fault"),
    [
        (Event(1.0, "close", "pick9", where="f:1"), "f:1: close is pick9; there are pick1"),
        (Event(1.0, "fail", 999), "robot 999; there are 1 to"),
        (Event(1.0, "sku_out", "green"), "no such SKU"),
        (Event(1.0, "picker", {"station": "x", "pickers": 2}), "is x"),
    ],
)
def test_what_could_not_happen_is_refused_at_once(event, fault):
    with pytest.raises(EventError, match=fault):
        opened(event)


# --- what happens


def test_a_station_closes_and_opens():
    with opened(Event(600.0, "close", "pick1"), Event(1200.0, "open", "pick1")) as ops:
        ops.run(minutes=9)
        assert ops.shift.station("pick1").is_open
        ops.run(minutes=2)
        assert not ops.shift.station("pick1").is_open
        ops.run(minutes=10)
        assert ops.shift.station("pick1").is_open


def test_robots_come_and_go():
    with opened(orders="fill") as ops:
        base = ops.fleet.robot_count
    events = Event(HOUR, "robots", 6), Event(2 * HOUR, "robots", -7)
    with opened(*events, orders="fill", robots=2) as ops:
        assert ops.fleet.robot_count == 8 and base > 2
        few, many, fewer = (pieces_in(ops, 60) for _ in range(3))
        seconds = sum(ops.fleet.activities().values())
        assert 0 <= seconds - (2 + 8 + 1) * HOUR < 7 * 600  # transports end first
    assert many > 1.5 * few and fewer < few


def test_robots_that_fail_stand_until_they_are_repaired():
    with opened(orders="fill", robots=4) as ops:
        ops.run(minutes=10)
        usual = pieces_in(ops, 20)
    with opened(Event(600.0, "fail", 1.0, 1200.0), orders="fill", robots=4) as ops:
        ops.run(minutes=10)
        assert pieces_in(ops, 20) < 0.35 * usual
        assert pieces_in(ops, 30) > usual


def test_one_robot_fails():
    with opened(Event(600.0, "fail", 1, 3000.0), orders="fill", robots=2) as ops:
        ops.run(minutes=10)
        half = pieces_in(ops, 50)
    with opened(orders="fill", robots=2) as ops:
        ops.run(minutes=10)
        both = pieces_in(ops, 50)
    assert 0.4 < half / both < 0.75


def test_robots_become_slow():
    with opened(Event(1800.0, "speed", 0.1), orders="fill", robots=2) as ops:
        fast = pieces_in(ops, 30)
        slow = pieces_in(ops, 30)
    assert slow < 0.8 * fast


def test_a_sku_runs_out():
    with opened(Event(600.0, "sku_out", "sku-1")) as ops:
        ops.run(minutes=9)
        assert ops.shift.inventory.available("sku-1")
        ops.run(minutes=60)
        assert not ops.shift.inventory.available("sku-1")


def test_more_orders_come(tmp_path):
    rush = tmp_path / "rush.csv"
    rows = "".join(f"rush-{i},sku-{i + 1},1,{i},{i + 900}\n" for i in range(20))
    rush.write_text("reference,sku,quantity,at,due\n" + rows)
    with opened(Event(600.0, "orders", str(rush)), orders="none") as ops:
        ops.run(minutes=9)
        assert ops.shift.tally.orders_received == 0
        ops.run(minutes=40)
        assert ops.shift.tally.orders_received == ops.shift.tally.orders_completed == 20


def test_a_picker_is_slow():
    event = Event(1800.0, "picker", {"station": "pick1", "seconds_a_piece": 30})
    with opened(event, orders="fill", robots=6) as ops:
        ops.run(minutes=30)
        before = ops.shift.station("pick1").pieces
        ops.run(minutes=30)
        assert ops.shift.station("pick1").pieces - before < 0.5 * before


def test_an_order_gets_another_priority(tmp_path):
    rows = "".join(f"o-{i},sku-{i % 9 + 1},1,0\n" for i in range(300))
    (tmp_path / "many.csv").write_text("reference,sku,quantity,at\n" + rows)
    orders, over = str(tmp_path / "many.csv"), {}
    for events in ((), (Event(60.0, "priority", {"order": "o-299", "to": 9}),)):
        with opened(*events, orders=orders) as ops:
            times = {}
            ops.shift.on_order_event = lambda order, kind, *_, times=times, ops=ops: (
                times.setdefault(order.reference, ops.time) if kind == COMPLETED else None
            )
            ops.run(minutes=30)
            over[bool(events)] = times.get("o-299", ops.time)
    assert over[True] < 600 < over[False]


def test_another_policy_decides_from_then_on():
    event = Event(600.0, "policy", {"storage": "random", "batches": "together"})
    with opened(event) as ops:
        before = ops.shift.policies.storage
        ops.run(minutes=9)
        assert ops.shift.policies.storage is before
        ops.run(minutes=2)
        assert type(ops.shift.policies.storage).__name__ == "Random"
        assert type(ops.shift.policies.batches).__name__ == "Together"
        assert ops.shift.policies.chosen["storage"] == "random"


def test_the_same_events_give_the_same_shift():
    event = Event(600.0, "fail", 0.5)
    hashes = []
    for _ in range(2):
        with opened(event, orders="fill") as ops:
            ops.run(minutes=30)
            hashes.append(ops.shift.state_hash())
    assert hashes[0] == hashes[1]


def test_simulated_robots_come_fail_and_go():
    events = Event(60.0, "robots", 1), Event(120.0, "fail", 1, 60.0), Event(240.0, "robots", -1)
    with opened(*events, physics=True, robots=3, orders="fill") as ops:
        assert ops.fleet.robot_count == 4
        ops.run(minutes=6)
        assert ops.fleet.failures.count[1] >= 1 or sum(ops.fleet.failures.count.values()) >= 1
        assert ops.fleet.collisions == 0 and ops.shift.tally.items_picked > 0
    with pytest.raises(EventError, match="speed holds for ideal robots"):
        opened(Event(60.0, "speed", 0.5), physics=True)


# --- pickers who differ


def with_settings(**settings):
    file = layout_choice.chosen("small")
    stations = [
        replace(station, settings=dict(station.settings) | settings) for station in file.stations
    ]
    return replace(file, stations=tuple(stations))


def test_pickers_differ_from_piece_to_piece(tmp_path):
    file = with_settings(seconds_a_piece=(12.0, 6.0))
    path = tmp_path / "differ.layout.yaml"
    layout_file.write(file, path)
    assert "mean: 12" in path.read_text()
    assert layout_file.read(path).stations[0].settings["seconds_a_piece"] == (12.0, 6.0)
    with opened(layout=str(path), orders="fill") as ops:
        ops.run(hours=2)
        station = ops.shift.station("pick1")
        assert station.busy_s / station.pieces == pytest.approx(12.0, rel=0.08)


def test_breaks_and_a_roster(tmp_path):
    file = with_settings(breaks=((0.25, 0.5),), roster=(1, 2))
    path = tmp_path / "roster.layout.yaml"
    layout_file.write(file, path)
    assert layout_file.read(path).stations[0].settings["roster"] == (1, 2)
    with opened(layout=str(path), orders="fill") as ops:
        first, pause = pieces_in(ops, 15), pieces_in(ops, 15)
        assert pause < 0.1 * first
        ops.run(minutes=30)
        assert ops.shift.station("pick1").pickers == 2
        ops.run(minutes=30)
        assert ops.shift.station("pick1").busy_fraction(ops.time) <= 1


# --- programs


def test_simulate_takes_events(tmp_path):
    file = tmp_path / "events.yaml"
    file.write_text("- {at: 60, close: pick1}\n")
    command = [sys.executable, SIMULATE, "--size", "small", "--no-physics", "--minutes", "5"]
    command += ["--events", file, "--out", tmp_path / "run"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    config = json.loads((tmp_path / "run" / "run.json").read_text())["config"]
    assert config["events"] == [{"at": 60.0, "close": "pick1"}]
    file.write_text("- {at: 60, close: pick77}\n")
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 1 and f"{file}:1: close is pick77" in done.stderr


def test_a_sweep_takes_events(tmp_path):
    (tmp_path / "day.yaml").write_text("- {at: 5, close: pick1}\n")
    path = tmp_path / "s.yaml"
    path.write_text("size: small\nphysics: false\nevents:\n- {at: 60, close: pick1}\n")
    assert sweep.read(path).jobs[0][0].events == (Event(60.0, "close", "pick1"),)
    path.write_text("size: small\nphysics: false\ngrid:\n  events: [day.yaml, []]\n")
    jobs = sweep.read(path).jobs
    assert [job.events for job, _ in jobs] == [(Event(5.0, "close", "pick1"),), ()]
    assert len({folder for _, folder in jobs}) == 2
    path.write_text("size: small\nevents:\n- {at: 60, shut: pick1}\n")
    with pytest.raises(sweep.SweepError, match=r"s.yaml:3: events\[0\].shut is unknown"):
        sweep.read(path)


STOCK = "sku,quantity,storage_unit\nred,20,1\nblue,20,2\n"
ORDERS = "reference,sku,quantity\na,{},1\n"


def own_layout(folder):
    """A layout file of `small` with a stock of red and blue."""
    path = folder / "own.layout.yaml"
    layout_file.write(replace(layout_choice.chosen("small"), items=0, stock="stock.csv"), path)
    (folder / "stock.csv").write_text(STOCK)
    return path


@pytest.mark.parametrize(
    ("line", "fault"),
    [
        ("close: pick9", "close is pick9; there are pick1, pick2"),
        ("open: pick9", "open is pick9; there are"),
        ("picker: {station: pick9, pickers: 2}", "picker is pick9; there are"),
        ("fail: robot 99", "fail is robot 99; there are 1 to 4"),
        ("sku_out: green", "sku_out is green; the stock has no such SKU"),
        ("orders: rush.csv", "the stock has none of 1 SKU of 1: green"),
    ],
)
def test_names_that_do_not_exist_are_refused_before_anything_runs(tmp_path, line, fault):
    own_layout(tmp_path)
    (tmp_path / "rush.csv").write_text(ORDERS.format("green"))
    events, path = tmp_path / "events.yaml", tmp_path / "s.yaml"
    events.write_text(f"- {{at: 5, close: pick1}}\n- {{at: 60, {line}}}\n")
    # simulate
    command = [sys.executable, SIMULATE, "--layout", tmp_path / "own.layout.yaml", "--no-physics"]
    command += ["--events", events, "--out", tmp_path / "run"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 1 and f"{events}:2: {line.partition(':')[0]}" in done.stderr
    assert fault in done.stderr and not (tmp_path / "run").exists()
    # a sweep: events of its own, of a file, and of its grid
    site = "layout: own.layout.yaml\nphysics: false\n"
    for text, where in (
        (f"events:\n- {{at: 60, {line}}}\n", f"{path}:4:"),
        ("events: events.yaml\n", f"{events}:2:"),
        (f"grid:\n  events:\n  - []\n  - - {{at: 60, {line}}}\n", f"{path}:6:"),
    ):
        path.write_text(site + text)
        with pytest.raises(sweep.SweepError) as error:
            sweep.read(path)
        assert str(error.value).startswith(where) and fault in str(error.value)


@pytest.mark.parametrize(
    ("setting", "fault"),
    [
        ("orders: green.csv", "green.csv:2: "),
        ("orders: day:green.csv", "the stock has none of 1 SKU of 1: green"),
        ("stations: 9", "stations is 9; small has 2 for picking"),
        ("robots: 900", "900 robots, but there is room for"),
    ],
)
def test_settings_of_what_does_not_exist_are_refused_by_a_sweep(tmp_path, setting, fault):
    own_layout(tmp_path)
    (tmp_path / "green.csv").write_text(ORDERS.format("green"))
    path = tmp_path / "s.yaml"
    path.write_text(f"layout: own.layout.yaml\nphysics: false\n{setting}\n")
    with pytest.raises(sweep.SweepError) as error:
        sweep.read(path)
    assert str(path) in str(error.value) and fault in str(error.value)


def test_robots_and_skus_that_come_are_known(tmp_path):
    path = tmp_path / "s.yaml"
    events = "- {at: 5, robots: +2}\n- {at: 60, fail: robot 6}\n- {at: 61, sku_out: sku-3}\n"
    path.write_text(f"size: small\nphysics: false\nevents:\n{events}")
    assert len(sweep.read(path).jobs[0][0].events) == 3
    path.write_text(path.read_text().replace("robot 6", "robot 7"))
    with pytest.raises(sweep.SweepError, match="s.yaml:5: fail is robot 7; there are 1 to 6"):
        sweep.read(path)


def test_errors_of_events_are_those_of_simulations():
    assert EventError in simulation.ERRORS
