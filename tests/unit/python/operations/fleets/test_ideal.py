# SPDX-License-Identifier: Apache-2.0
"""Ideal robots take what their ways cost, and one after the other at a station."""

import numpy as np
import pytest
from operations_site import site

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_fleet.transports.transports import STAY, Kind
from warehouse_layout.file.request import PRESETS
from warehouse_layout.generate import generated
from warehouse_operations.fleets.ideal import IdealFleet
from warehouse_operations.fleets.odometer import Odometer, Stretch
from warehouse_operations.stock.travel import Travel


def run(fleet, until):
    """All events up to a time [s]."""
    events = []
    while fleet.time < until:
        fleet.step_until(until)
        events += fleet.take_events()
    return events


@pytest.fixture
def where():
    return site()


def fleet_of(where, robots=1):
    cells = list(where.units.values())
    return IdealFleet(where.plan, {i + 1: cells[i] for i in range(robots)}, where.units)


def test_runs_take_what_a_trapezoid_takes():
    robot = Kinematics()
    assert robot.run(np.array([0.0, 1.0, 2.25, 10.0])) == pytest.approx([0, 2, 3, 10 / 1.5 + 1.5])
    assert robot.leaving(0.5) == pytest.approx(1.0)
    assert robot.leaving(3.0) == pytest.approx(1.5 + 1.875 / 1.5)


def test_ways_of_loaded_robots_keep_to_streets_and_lanes(where):
    travel, plan = Travel(where.plan, Kinematics()), where.plan
    service = plan.stations[0].service_cell
    for unit, cell in list(where.units.items())[:20]:
        there, back = travel.loaded_to(service), travel.loaded_from(service)
        for way in (there.cells(cell), back.cells(cell)):
            assert {way[0], way[-1]} == {cell, service}
            assert len(way) == len(set(way))
            assert not plan.storage.flat[way[1:-1]].any(), unit
        assert there.metres[cell] == len(there.cells(cell)) - 1
        # At least the way at top speed, a start, and turns: into the street and into the lane.
        assert there.seconds[cell] >= there.metres[cell] / 1.5 + 1.5 + 2 * 0.625
        lane = set(plan.stations[0].cells.tolist())
        assert set(back.cells(cell)) & lane == set(plan.stations[0].cells[4:].tolist())


def test_ways_to_and_from_storage_are_those_of_tables_of_all_cells():
    plan = generated.plan(PRESETS["small"]).plan
    assert not plan.passable.all()  # their graph has the passable cells alone
    travel = Travel(plan, Kinematics())
    places = np.flatnonzero(plan.storage)
    for cell in (plan.stations[-1].service_cell, int(places[7])):
        there, back = travel.loaded_to(cell), travel.loaded_from(cell)
        assert travel.seconds_from_all(places, cell).tolist() == there.seconds[places].tolist()
        assert travel.metres_to_places(cell, places).tolist() == back.metres[places].tolist()


def test_a_transport_from_the_first_event_to_the_last(where):
    fleet = fleet_of(where)
    answer = fleet.submit(2, "pick1")
    assert answer.accepted
    assert not fleet.submit(2, "pick1").accepted
    events = run(fleet, 500)
    kinds = [event.kind for event in events]
    assert kinds == [Kind.RECEIVED, Kind.ASSIGNED, Kind.LIFTED, Kind.ARRIVED]
    travel, home, beneath = fleet.travel, where.units[2], where.units[1]
    service = where.plan.stations[0].service_cell
    drive = travel.unloaded([beneath], [home])[0][0, 0]
    there = travel.loaded_to(service).seconds[home]
    assert events[2].stamp == pytest.approx(drive + 2.2)
    assert events[3].stamp == pytest.approx(drive + 2.2 + there)
    assert fleet.release(answer.transport_id) == (True, "")
    assert [event.kind for event in run(fleet, 1000)] == [Kind.RELEASED, Kind.STORED]
    assert fleet.distance_m > 10 and fleet.waiting("pick1") == 0
    assert sum(fleet.activities().values()) == pytest.approx(fleet.time)


def test_metres_count_as_they_are_driven(where):
    """While a robot stands, broken or served, none are added."""
    fleet = fleet_of(where)
    assert fleet.submit(1, "pick1").accepted
    events = run(fleet, 5.0)
    assert events[-1].kind == Kind.LIFTED and fleet.distance_m < 10
    way = fleet.travel.loaded_to(where.plan.stations[0].service_cell)
    metres = [fleet.distance_m]
    fleet.fail(1, 30.0)
    for time in (20.0, 34.0, 35.0, 40.0, 45.0, 200.0, 300.0):
        run(fleet, time)
        metres.append(fleet.distance_m)
    assert metres[:3] == [metres[0]] * 3  # it stands until 35 s
    steps = np.diff(metres[3:6])
    assert (steps > 3).all() and steps[0] == pytest.approx(steps[1])
    assert metres[6:] == [pytest.approx(way.metres[where.units.get(1, -1)], abs=1e-6)] * 2


def test_a_robot_that_turns_off_counts_what_it_drove():
    odometer = Odometer()
    odometer.begin(0, 0.0, Stretch(0.0, 10.0, 20.0))
    odometer.begin(0, 0.0, Stretch(10.0, 20.0, 8.0))  # after it
    odometer.begin(1, 0.0, Stretch(5.0, 5.0, 0.0))
    assert [odometer.read(t) for t in (0.0, 5.0, 10.0, 15.0)] == [0, 10, 20, 24]
    odometer.stop(0, 15.0)
    assert odometer.read(100.0) == 24


def test_units_are_served_in_the_order_in_which_they_come(where):
    fleet = fleet_of(where, robots=4)
    asked = [fleet.submit(unit, "pick1").transport_id for unit in (1, 2, 3, 4)]
    arrived, left = [], None
    for _ in asked:
        (event,) = [
            event_ for event_ in run(fleet, fleet.time + 300) if event_.kind == Kind.ARRIVED
        ]
        if left is not None:  # one drives out of the cell, then the next drives in
            assert event.stamp - left == pytest.approx(np.sqrt(2) + 2.0)
        arrived.append(event.transport_id)
        left = fleet.time
        fleet.release(event.transport_id)
    assert sorted(arrived) == asked


def test_cancelled_units_are_stored_and_a_closed_station_gets_none(where):
    fleet = fleet_of(where, robots=2)
    first = fleet.submit(1, "pick1").transport_id
    events = run(fleet, 5)
    assert events[-1].kind == Kind.LIFTED
    fleet.set_open("pick1", False)
    kinds = [event.kind for event in run(fleet, 300)]
    assert kinds == [Kind.CANCELLED, Kind.STORED]
    assert fleet.cancel(first)[0] is False
    assert fleet.submit(1, "pick1").message == "station pick1 is closed"
    fleet.set_open("pick1", True)
    assert fleet.submit(1, "pick1").accepted


def test_a_unit_is_brought_to_a_cell_and_stays(where):
    fleet = fleet_of(where)
    free = np.flatnonzero(
        where.plan.storage.ravel()
        & ~np.isin(np.arange(where.plan.storage.size), list(where.units.values()))
    )
    x, y = where.plan.point_of(free[0])
    assert fleet.submit(1, x=x, y=y, then=STAY).accepted
    assert run(fleet, 300)[-1].kind == Kind.STORED
    assert fleet.unit_cell(1) == free[0]
    other = where.plan.point_of(where.units[2])
    assert "is taken" in fleet.submit(1, x=other[0], y=other[1], then=STAY).message
