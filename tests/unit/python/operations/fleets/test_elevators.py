# SPDX-License-Identifier: Apache-2.0
"""Robots with bodies ride elevators: one at a time, for the times of the file, without contact."""

from dataclasses import replace

import numpy as np
import pytest
from instance_file import RIDE, write_tiers_instance
from operations_site import stock_faults
from paths import ROOT
from test_ideal_lifts import services, units_by_tier

from warehouse_fleet.hosts.fleet_driver import UPDATE, FleetDriver
from warehouse_fleet.robots.robot_table import NOWHERE
from warehouse_fleet.traffic.elevators import Phase
from warehouse_fleet.traffic.traffic import Traffic
from warehouse_fleet.transports.transports import STAY, Kind
from warehouse_layout import FloorError
from warehouse_layout.file import layout_file
from warehouse_layout.floor import landings
from warehouse_layout.floor.elevators import Elevator
from warehouse_layout.floor.floor_edges import FloorEdges
from warehouse_layout.floor.landings import Landings
from warehouse_layout.message_enums import FailureKind
from warehouse_layout.place import file_check
from warehouse_operations.fleets.building import world_of
from warehouse_operations.runs.rawsim import read_instance
from warehouse_operations.runs.simulation import Description, open_operations
from warehouse_operations.stock.travel import Travel

DEADLINE = 400.0  # simulated [s]


@pytest.fixture
def fleet_of(tmp_path):
    """Makes a fleet with a robot beneath each of some units, which are chosen by the site."""
    drivers = []
    site = read_instance(write_tiers_instance(tmp_path / "a.xinst"))

    def make(choose):
        robots = {i: site.units[unit] for i, unit in enumerate(choose(site), 1)}
        site.robots.clear()
        site.robots.update(robots)
        world, there = world_of(site, seed=1)
        driver = FleetDriver(world, 1, None, there.kinematics, tow_after=60.0, plan=there.plan)
        drivers.append(driver)
        return driver, there

    yield make
    for driver in drivers:
        driver.close()


def of_each_tier(site):
    """The first unit of each tier."""
    return [units[0] for units in units_by_tier(site)]


def run(driver, is_over, deadline=DEADLINE):
    """Steps until something is over; returns the events of transports."""
    events = []
    while not is_over(events):
        driver.step()
        events += driver.transports.take_events()
        assert driver.time < deadline, "not over in time"
    assert (driver.collisions, driver.blocked, driver.watchdog, driver.refusals) == (0, 0, 0, [])
    return events


def arrivals(count):
    """Returns a function that tells whether `count` units have arrived, by a list of events."""
    return lambda events: sum(event.kind == Kind.ARRIVED for event in events) >= count


def phases(driver, robot=None):
    """The phases of all rides, or of that of a robot."""
    trips = driver.traffic.elevators._trips.values()
    return [trip.phase for trip in trips if robot in (None, trip.robot)]


def test_a_unit_to_the_other_tier(fleet_of):
    """Robot and unit stand in the car for the time of the ride, then at its other end."""
    driver, site = fleet_of(lambda site: of_each_tier(site)[:1])
    (unit,) = of_each_tier(site)[:1]
    station, (elevator,) = services(site)[1], site.plan.elevators
    driver.transports.submit(unit, station.name)
    inside, where, times = [], [], []

    def look(events):
        units = driver.world.storage_units
        row = units[units["shelf_id"] == unit][0]
        robot = driver.world.fleet
        assert not row["kiva_id"] or np.hypot(row["x"] - robot.x[0], row["y"] - robot.y[0]) < 0.02
        where.append(int(driver.plan.cell_of(row["x"], row["y"])))
        times.append(driver.time)
        if Phase.RIDING in phases(driver):
            inside.append(driver.time)
        return arrivals(1)(events)

    events = {event.kind: event.stamp for event in run(driver, look)}
    assert len(inside) * UPDATE == pytest.approx(RIDE, abs=UPDATE + 1e-6)
    start, end = sorted(elevator.cells, key=lambda c: site.plan.tier.flat[c])
    last, first = max(i for i, c in enumerate(where) if c == start), where.index(end)
    assert first == last + 1, "the unit is nowhere between the ends of the ride"
    travel = Travel(site.plan, site.kinematics)
    table = travel.loaded_to(station.service_cell)
    assert driver.distance_m == table.metres[site.units[unit]]
    seconds = table.seconds[site.units[unit]]
    assert events[Kind.ARRIVED] - events[Kind.LIFTED] == pytest.approx(seconds, abs=6)
    assert driver.elevators["elevator_rides"] == 1
    assert driver.elevators["elevator_wait_s"] < 4 and not len(driver.fallen)  # to the gate


def test_two_robots_from_both_ends(fleet_of):
    """Each lets the other pass: no robot stands where one is set down."""
    driver, site = fleet_of(of_each_tier)
    stations = services(site)[::-1]
    for unit, station in zip(of_each_tier(site), stations):
        driver.transports.submit(unit, station.name)
    rode, kept = [], []

    def look(events):
        riding = [t for t in driver.traffic.elevators._trips.values() if t.phase == Phase.RIDING]
        assert len(riding) <= 1
        for trip in riding:
            rode.append(trip.robot)
            kept.append(driver.traffic.holder(trip.ride.end))
        return arrivals(2)(events)

    run(driver, look)
    assert set(rode) == {0, 1} and kept == rode
    assert driver.elevators["elevator_rides"] == 2
    assert driver.elevators["elevator_wait_s"] > RIDE / 4
    (car,) = driver.traffic.elevators.cars
    assert car.user == NOWHERE and not car.trips


@pytest.mark.parametrize("seconds, lost", [(20.0, 0), (60.0, 1)])
def test_a_robot_that_breaks_down_in_an_elevator(fleet_of, seconds, lost):
    """It is carried, and others wait until it is repaired; as anywhere, it soon loses its work."""
    driver, site = fleet_of(of_each_tier)
    for unit, station in zip(of_each_tier(site), services(site)[::-1]):
        driver.transports.submit(unit, station.name)
    run(driver, lambda _: Phase.RIDING in phases(driver))
    (trip,) = (t for t in driver.traffic.elevators._trips.values() if t.phase == Phase.RIDING)
    driver.world.fail(int(driver.robots.kiva_ids[trip.robot]), int(FailureKind.MOTOR), seconds)
    run(driver, lambda _: driver.robots.cell[trip.robot] == trip.ride.end)
    assert driver.robots.broken[trip.robot]
    events = run(driver, arrivals(2 - lost))
    assert sum(event.kind == Kind.FAILED for event in events) == lost
    assert driver.elevators["elevator_rides"] == 2


def test_a_robot_that_breaks_down_before_an_elevator_lets_others_ride(fleet_of):
    """The elevator is not kept for it."""
    driver, site = fleet_of(of_each_tier)
    for unit, station in zip(of_each_tier(site), services(site)[::-1]):
        driver.transports.submit(unit, station.name, then=STAY)
    run(driver, lambda _: Phase.ENTERING in phases(driver))
    (trip,) = (t for t in driver.traffic.elevators._trips.values() if t.phase == Phase.ENTERING)
    other = 1 - trip.robot
    driver.world.fail(int(driver.robots.kiva_ids[trip.robot]), int(FailureKind.MOTOR), 120.0)
    run(driver, lambda _: phases(driver, other) == [Phase.RIDING], driver.time + 20)
    assert driver.robots.broken[trip.robot] and phases(driver, trip.robot) == [Phase.WAITING]


def test_a_queue_rides_in_its_order(fleet_of):
    """Robots that move up push none out of the car."""
    driver, site = fleet_of(lambda site: units_by_tier(site)[0][:4])
    for unit in units_by_tier(site)[0][:4]:
        driver.transports.submit(unit, services(site)[1].name, then=STAY)
    entered, rode = [], []

    def look(_):
        elevators = driver.traffic.elevators
        for trip in elevators._trips.values():
            if trip.phase >= Phase.ENTERING:
                has_car = driver.traffic.holder(trip.ride.start) == trip.robot
                assert elevators.busy[trip.robot] == has_car
            for phase, robots in ((Phase.ENTERING, entered), (Phase.RIDING, rode)):
                if trip.phase == phase and trip.robot not in robots[-1:]:
                    robots.append(trip.robot)
        return len(rode) == 4

    run(driver, look)
    assert entered == rode and sorted(rode) == list(range(4))


@pytest.mark.parametrize("tiers, bots", [(2, 4), pytest.param(3, 6, marks=pytest.mark.long)])
def test_a_shift_on_tiers(tmp_path, tiers, bots):
    """Twelve minutes with many rides: no contact, no jam, the stock balances; it repeats."""
    path = write_tiers_instance(tmp_path / "a.xinst", tiers=tiers, bots=bots)
    outcomes = []
    for k in range(2):
        description = Description(instance=str(path), seed=3)
        with open_operations(description, str(tmp_path / f"{k}.db")) as ops:
            ops.run(minutes=12)
            assert stock_faults(ops) == []
            figures, fleet = ops.kpis(), ops.fleet
            assert fleet.stuck == 0 and fleet.refusals == [] and fleet.fallen_items == []
        outcomes.append(figures)
    first, again = outcomes
    assert first["state_hash"] == again["state_hash"]
    assert first["items_picked"] == again["items_picked"]
    assert [first[name] for name in ("collisions", "blocked", "watchdog")] == [0, 0, 0]
    assert first["elevator_rides"] > 20 and first["elevator_wait_s"] > 0
    with open_operations(Description(instance=str(path), seed=3, physics=False)) as ops:
        ops.run(minutes=12)
        ideal = ops.kpis()["items_picked"]
    assert 0.85 * ideal < first["items_picked"] < 1.1 * ideal


def test_a_shift_on_the_floors_of_a_layout(tmp_path):
    """Robots with bodies ride its elevator, too: units reach stations of both floors."""
    description = Description(layout=str(ROOT / "tests/layouts/two_floors.layout.yaml"), seed=2)
    with open_operations(description, str(tmp_path / "run.db")) as ops:
        ops.run(minutes=10)
        figures = ops.kpis()
    assert figures["items_picked"] > 20 and figures["elevator_rides"] >= 2
    assert [figures[name] for name in ("collisions", "blocked", "watchdog")] == [0, 0, 0]


def test_an_elevator_of_a_layout_in_the_only_street_is_a_fault():
    """It hinders robots with bodies alone: ideal ones pass through each other."""
    file = layout_file.read(ROOT / "tests/layouts/two_floors.layout.yaml")
    (lift,) = file.elevators
    moved = replace(file, elevators=(replace(lift, cells=((10, 0), lift.cells[1])),))
    assert file_check.faults(file) == []
    (fault,) = file_check.faults(moved)
    assert fault.is_of_bodies and "have no other way there and back" in fault.text


def test_the_cells_before_an_elevator(tmp_path):
    """Its lane is its queue; the cell that leads in is its gate."""
    plan = read_instance(write_tiers_instance(tmp_path / "a.xinst")).plan
    there = Landings(plan)
    there.check()
    for cell in plan.elevators[0].cells:
        steps = sorted(there.approach[cell].values())
        assert steps == [1, 2, 3, 4] and there.gates[cell] == [cell + 1]
        assert there.lane.flat[[cell, cell + 1, cell + 4]].all()


def test_an_elevator_in_the_only_street_is_refused(tmp_path):
    """Robots that do not ride would have to drive through it."""
    plan = read_instance(write_tiers_instance(tmp_path / "a.xinst")).plan
    first, second = plan.elevators[0].cells
    streets = np.flatnonzero(plan.passable & ~plan.storage & ~plan.lane & (plan.tier == 0))
    moved = (Elevator.evenly("lift", (int(streets[0]), second), RIDE),)
    floor = replace(plan, elevators=moved)
    for check in (Landings(floor).check, lambda: Traffic(floor, np.array([1]))):
        with pytest.raises(FloorError, match="do not ride, and have no other way|no street leads"):
            check()


def test_a_floor_without_elevators_is_not_searched(tmp_path, monkeypatch):
    plan = replace(read_instance(write_tiers_instance(tmp_path / "a.xinst")).plan, elevators=())
    monkeypatch.setattr(FloorEdges, "ahead", lambda *_: pytest.fail("it reads the floor's edges"))
    monkeypatch.setattr(landings, "layout_faults", lambda _: pytest.fail("it checks the streets"))
    cells = Landings(plan)
    cells.check()
    assert not cells.lane.any()
