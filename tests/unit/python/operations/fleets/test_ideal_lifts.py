# SPDX-License-Identifier: Apache-2.0
"""Ideal robots ride elevators: one at a time, for the times of the file, and lose nothing there."""

import numpy as np
import pytest
from instance_file import RIDE, write_tiers_instance
from operations_site import stock_faults
from test_ideal import run

from warehouse_fleet.transports.transports import STAY, Kind
from warehouse_operations.fleets import fleet_now
from warehouse_operations.fleets.forked_fleet import ForkedFleet
from warehouse_operations.fleets.ideal import IdealFleet, NearestHooks
from warehouse_operations.runs.rawsim import read_instance
from warehouse_operations.runs.simulation import Description, open_operations
from warehouse_operations.stock.travel import CHANGE, Travel


@pytest.fixture
def where(tmp_path):
    return read_instance(write_tiers_instance(tmp_path / "a.xinst"))


def units_by_tier(site):
    """The units of each tier, in the order of their numbers."""
    tier = site.plan.tier.flat
    return [[unit for unit, cell in site.units.items() if tier[cell] == k] for k in (0, 1)]


def services(site):
    """The names of the first picking station of each tier, and their service cells."""
    tier = site.plan.tier.flat
    picking = [station for station in site.plan.stations if station.kind == "PICK"]
    return [next(s for s in picking if tier[s.service_cell] == k) for k in (0, 1)]


def fleet_of(site, *units):
    """A fleet with a robot beneath each of some units."""
    robots = {i: site.units[unit] for i, unit in enumerate(units, 1)}
    return IdealFleet(site.plan, robots, site.units, kinematics=site.kinematics)


def parts(site, unit, station):
    """How long a unit is under way to a station on another tier: by hand, drive, ride, drive."""
    (elevator,) = site.plan.elevators
    tier = site.plan.tier.flat
    start, end = sorted(elevator.cells, key=lambda cell: tier[cell] != tier[site.units[unit]])
    drives = Travel(site.plan, site.kinematics)
    there = drives._search(start, False).seconds[site.units[unit]]
    return there, RIDE, drives._search(end, True).seconds[station.service_cell]


def test_a_unit_to_the_other_tier(where):
    """It takes the drive to the elevator, the ride and the drive from it; metres are driven."""
    (unit, *_), _ = units_by_tier(where)
    station = services(where)[1]
    fleet = fleet_of(where, unit)
    fleet.submit(unit, station.name)
    events = {event.kind: event.stamp for event in run(fleet, 400)}
    seconds = parts(where, unit, station)
    assert events[Kind.ARRIVED] - events[Kind.LIFTED] == pytest.approx(sum(seconds))
    table = fleet.travel.loaded_to(station.service_cell)
    assert table.seconds[where.units[unit]] == pytest.approx(sum(seconds))
    before, after = table.runs(where.units[unit])
    assert table.metres[where.units[unit]] == len(before) + len(after) - 2
    assert {before[-1], after[0]} == set(where.plan.elevators[0].cells)
    assert fleet.elevators["elevator_rides"] == 1 and fleet.elevators["elevator_wait_s"] == 0
    assert fleet.passages().flat[list(where.plan.elevators[0].cells)].tolist() == [1, 1]


def test_two_robots_at_an_elevator(where):
    """The second rides once the first has left the cell at the other end: it moves up by a cell."""
    units = units_by_tier(where)[0][:2]
    station = services(where)[1]
    alone = [parts(where, unit, station) for unit in units]
    fleet = fleet_of(where, *units)
    for unit in units:
        fleet.submit(unit, station.name)
    run(fleet, 200)
    (lift,) = fleet.trips.lifts.all
    kinematics, spacing = where.kinematics, where.plan.spacing
    moves = kinematics.leaving(spacing) + float(kinematics.run(spacing))
    first, second = sorted(drive for drive, *_ in alone)  # both were lifted at the same time
    assert second < first + RIDE and lift.rides == 2
    assert lift.waited == pytest.approx(first + RIDE + moves - second)


def test_an_empty_elevator_on_another_tier_is_no_wait(where):
    """The next robot rides at once though the last ride ended on the other tier: see RAWSim-O."""
    units = units_by_tier(where)[0][:2]
    fleet = fleet_of(where, *units)
    for unit in units:
        fleet.submit(unit, services(where)[1].name)
        run(fleet, fleet.time + 150)
    assert fleet.elevators == {**fleet.elevators, "elevator_rides": 2, "elevator_wait_s": 0}


def test_robots_without_units_ride_too(where):
    """A robot of the other tier fetches a unit, where none is nearer."""
    below, above = (units[0] for units in units_by_tier(where))
    fleet = fleet_of(where, above)
    fleet.submit(below, services(where)[0].name)
    lifted = next(event.stamp for event in run(fleet, 400) if event.kind == Kind.LIFTED)
    seconds, metres = fleet.travel.unloaded([where.units[above]], [where.units[below]])
    assert lifted == pytest.approx(seconds[0, 0] + where.kinematics.lift)
    start, end = (int(cell) for cell in where.plan.elevators[0].cells[::-1])
    width, spacing = where.plan.width, where.plan.spacing

    def apart(a, b):
        return (abs(a % width - b % width) + abs(a // width - b // width)) * spacing

    driven = apart(where.units[above], start) + apart(end, where.units[below])
    assert metres[0, 0] == pytest.approx(driven)


def test_policies_prefer_the_tier(where):
    """Places and units of another tier count as farther than any on the same one."""
    travel, plan = Travel(where.plan, where.kinematics), where.plan
    places = np.flatnonzero(plan.storage)
    for station in services(where):
        metres = travel.metres_to_places(station.service_cell, places)
        same = plan.tier.flat[places] == plan.tier.flat[station.service_cell]
        assert metres[same].max() < CHANGE < metres[~same].min()


def test_three_tiers_are_one_ride_apart(tmp_path):
    site = read_instance(write_tiers_instance(tmp_path / "a.xinst", tiers=3))
    (elevator,) = site.plan.elevators
    assert elevator.seconds == ((0, 10, 20), (10, 0, 10), (20, 10, 0)) and elevator.a_tier == 10
    table = Travel(site.plan, site.kinematics).loaded_to(elevator.cells[2])
    assert table.seconds[elevator.cells[0]] == 20 and table.metres[elevator.cells[0]] == 0


@pytest.mark.parametrize("tiers, share", [(2, 0.6), (3, 0.3)])
def test_an_hour_on_tiers_loses_nothing(tmp_path, tiers, share):
    path = write_tiers_instance(tmp_path / "a.xinst", tiers=tiers, bots=8)
    database = tmp_path / "run.db"
    description = Description(instance=str(path), physics=False, seed=3)
    with open_operations(description, str(database)) as ops:
        ops.run(minutes=60)
        assert stock_faults(ops) == []
        figures, trips = ops.kpis(), ops.fleet.trips
        standing = dict(ops.fleet.cell_of_unit)
        assert len(set(standing.values())) == len(standing)
        carried = {t.shelf for t in trips.book if t.shelf not in standing}
        assert carried | set(standing) == set(ops.site.units)
    assert figures["items_picked"] > share * figures["item_upper_bound_per_hour"]
    assert figures["elevator_rides"] > 20
    assert 0 < figures["elevator_ride_fraction"] < 1


def test_a_shift_on_tiers_repeats(tmp_path):
    path = str(write_tiers_instance(tmp_path / "a.xinst"))
    picked = []
    for _ in range(2):
        with open_operations(Description(instance=path, physics=False)) as ops:
            ops.run(minutes=20)
            picked.append((ops.kpis()["items_picked"], ops.fleet.distance_m, ops.fleet.elevators))
    assert picked[0] == picked[1]


def test_a_robot_that_breaks_down_clears_the_elevator(where):
    """A robot that loses its transport in an elevator leaves it to the others."""
    units = units_by_tier(where)[0][:2]
    station = services(where)[1]
    fleet = fleet_of(where, *units)
    for unit in units:
        fleet.submit(unit, station.name)
    lift = fleet.trips.lifts.all[0]
    while not lift.riding or not lift.queue:
        fleet.step_until(fleet.time + 0.5)
        fleet.take_events()
        assert fleet.time < 200
    stuck = lift.riding.robot
    fleet.trips._break_down(stuck, 3600)
    events = run(fleet, fleet.time + 300)
    assert [event.kind for event in events if event.kind in (Kind.FAILED, Kind.ARRIVED)] == [
        Kind.FAILED,
        Kind.ARRIVED,
    ]
    assert lift.riding is None and not lift.queue


class Homing(NearestHooks):
    """Sends robots without work to a cell."""

    def __init__(self, home):
        self.home = home

    def park(self, kiva_id, cell):
        return self.home


@pytest.mark.parametrize("tier", [0, 1])
def test_a_robot_without_work_parks_on_its_tier(where, tier):
    """It drives to a parking cell there, and waits where it is if that is on another tier."""
    (unit, *_), _ = units_by_tier(where)
    home = services(where)[tier].cells[0]
    fleet = fleet_of(where, unit)
    fleet.set_hooks(Homing(home))
    transport = fleet.submit(unit, services(where)[0].name)
    run(fleet, 200)
    fleet.release(transport.transport_id)
    run(fleet, 400)
    (robot,) = fleet.trips.robots
    assert (robot.cell == home) == (tier == 0)


@pytest.mark.parametrize("at", ["coming", "waiting", "riding"])
def test_a_fork_goes_on_with_rides(where, at):
    """A fleet that goes on from one with robots at an elevator brings the same units."""
    units = units_by_tier(where)[0][:2]
    station = services(where)[1]
    fleet = fleet_of(where, *units)
    for unit in units:
        fleet.submit(unit, station.name, then=STAY)
    lift = fleet.trips.lifts.all[0]
    reached = {
        "coming": lambda: lift.coming == 2,
        "waiting": lambda: lift.queue,
        "riding": lambda: lift.riding and not lift.queue,
    }
    while not reached[at]():
        fleet.step_until(fleet.time + 0.5)
        fleet.take_events()
        assert fleet.time < 200
    fork = ForkedFleet(where.plan, fleet_now.of(fleet), kinematics=where.kinematics)
    fork.resume()
    ours, theirs = (
        [e.stamp for e in run(each, each.time + 300) if e.kind == Kind.ARRIVED]
        for each in (fleet, fork)
    )
    assert len(theirs) == len(ours)
    assert theirs == pytest.approx(ours, abs=RIDE + 10)
