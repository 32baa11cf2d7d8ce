# SPDX-License-Identifier: Apache-2.0
"""A fleet at work with physics, in one process."""

import collections

import numpy as np
import pytest
from paths import ROOT

from kiva_plugin_cpp import World
from warehouse_fleet.hosts.fleet_driver import FleetDriver
from warehouse_fleet.hosts.random_transports import RandomTransports
from warehouse_fleet.robots.robot_table import NOWHERE, REPORT, RobotTable
from warehouse_fleet.transports.transports import STAY, Kind, Step
from warehouse_layout.floor import plan_reader
from warehouse_layout.message_enums import RobotMode

EXAMPLES = ROOT / "src/warehouse_fleet/examples"


@pytest.fixture
def drive():
    drivers = []

    def make(world, **options):
        drivers.append(FleetDriver(world, **options))
        return drivers[-1]

    yield make
    for driver in drivers:
        driver.close()


def work(driver, seconds, exchange=12.0, seed=1):
    """Keeps all stations busy. Units that are served stand where they are to be, always."""
    demand = RandomTransports(driver.transports, seed, exchange)
    while driver.time < seconds:
        demand.advance(driver.time, driver.transports.take_events())
        driver.step()
        for transport in driver.transports:
            if transport.step == Step.WAITING:
                assert driver.traffic.robots.cell[transport.robot] == transport.cell


def assert_clean(driver):
    assert (driver.collisions, driver.blocked, driver.watchdog, driver.refusals) == (0, 0, 0, [])


def test_units_are_brought_and_stored_without_contact(drive):
    driver = drive(World.preset("medium"))
    work(driver, 240)
    totals = driver.transports.totals
    assert totals.delivered > 40 and totals.stored > 25 and totals.failed == 0
    assert_clean(driver)
    assert driver.executed_over_planned < 1.15
    assert totals.cells < 1.25 * totals.shortest


def test_the_same_seed_gives_the_same_run(drive):
    hashes = []
    for _ in range(2):
        driver = drive(World.preset("small"))
        work(driver, 60)
        hashes.append(driver.world.state_hash())
    assert hashes[0] == hashes[1]


def run_until(driver, kinds, limit=200):
    """All events until the last of the transports has come to one of these kinds."""
    events = []
    while driver.time < limit and not any(event.kind in kinds for event in events):
        driver.step()
        events += driver.transports.take_events()
    return events


def test_a_transport_goes_through_all_its_steps(drive):
    driver = drive(World.preset("small"))
    transports = driver.transports
    station = driver.plan.stations[0].name
    number = transports.submit(7, station).transport_id
    events = run_until(driver, {Kind.ARRIVED})
    assert transports.release(number) == (True, "")
    events += run_until(driver, {Kind.STORED})
    steps = [Kind.RECEIVED, Kind.ASSIGNED, Kind.LIFTED, Kind.ARRIVED, Kind.RELEASED, Kind.STORED]
    assert [event.kind for event in events] == steps
    unit = driver.world.storage_units[6]
    assert unit["shelf_id"] == 7 and unit["kiva_id"] == 0
    cell = driver.plan.cell_of(unit["x"], unit["y"])
    assert driver.plan.storage.flat[cell] and transports.cell_of_unit[7] == cell


class HardOfHearing:
    """A World that is told to lift, or to drop, so many times in vain."""

    def __init__(self, world, in_vain):
        self._world, self._in_vain = world, in_vain
        self._counts = collections.Counter()

    def __getattr__(self, name):
        return getattr(self._world, name)

    def _tell(self, *command):
        self._counts[command] += 1
        if self._counts[command] > self._in_vain:
            getattr(self._world, command[0])(*command[1:])

    def carry(self, kiva_id, shelf_id):
        self._tell("carry", kiva_id, shelf_id)

    def drop(self, kiva_id, shelf_id):
        self._tell("drop", kiva_id, shelf_id)


def test_a_lift_is_asked_for_until_it_is_heard(drive):
    driver = drive(HardOfHearing(World.preset("small"), in_vain=4))
    number = driver.transports.submit(7, driver.plan.stations[0].name).transport_id
    events = run_until(driver, {Kind.ARRIVED, Kind.FAILED})
    assert driver.transports.release(number) == (True, "")
    events += run_until(driver, {Kind.STORED, Kind.FAILED})
    assert events[-1].kind == Kind.STORED
    assert_clean(driver)


def test_a_unit_stays_where_it_was_brought_and_is_fetched_from_there(drive):
    driver = drive(World.preset("small"))
    transports, plan = driver.transports, driver.plan
    streets = plan.passable & ~plan.storage & ~plan.parking & ~plan.lane
    x, y = plan.point_of(int(np.flatnonzero(streets)[20]))
    number = transports.submit(3, "", x, y, STAY).transport_id
    run_until(driver, {Kind.STORED})
    unit = driver.world.storage_units[2]
    assert unit["kiva_id"] == 0 and abs(unit["x"] - x) < 1e-3 and abs(unit["y"] - y) < 1e-3
    station = driver.plan.stations[0].name
    assert transports.submit(3, station).transport_id == number + 1
    assert run_until(driver, {Kind.ARRIVED}, 400)[-1].kind == Kind.ARRIVED
    assert_clean(driver)


def test_who_queues_is_not_stuck_however_long_a_service_takes(drive):
    driver = drive(World.preset("small"))
    transports, traffic = driver.transports, driver.traffic
    station = driver.plan.stations[0].name
    first, second = (transports.submit(unit, station).transport_id for unit in (7, 9))
    served = run_until(driver, {Kind.ARRIVED})[-1].transport_id
    behind = next(t.robot for t in transports if t.number == first + second - served)
    while driver.time - traffic.robots.still_since[behind] < 29:
        driver.step()
        # There is time to move up when the service ends, before the watchdog counts it.
        assert traffic.watchdog.stuck_for[behind] < 10
    assert traffic.plan.lane.flat[traffic.robots.cell[behind]]


def test_who_only_waits_leaves_its_place_to_who_fetches_the_unit_there(drive):
    world = World.preset("small")
    plan = plan_reader.of_world(world)
    streets = plan.passable & ~plan.storage & ~plan.parking & ~plan.lane
    world.set_pose("kiva1", *plan.point_of(int(np.flatnonzero(streets)[20])), 0, 0)
    driver = drive(world)
    transports, traffic = driver.transports, driver.traffic
    waits, fetches = 0, 1
    driver.step()
    cell = int(traffic.robots.goal[waits])
    unit = next(shelf for shelf, at in transports.cell_of_unit.items() if at == cell)
    transports.match_robots = lambda asked, free: [(asked[0], fetches)]
    transports.submit(unit, driver.plan.stations[0].name)
    driver.step()
    assert traffic.robots.goal[fetches] == cell
    assert traffic.robots.goal[waits] not in (cell, NOWHERE)


@pytest.mark.parametrize(
    ("request_", "text"),
    [
        ((999, "pick1"), "there is no storage unit 999"),
        ((1, "nowhere"), "there is no station 'nowhere'"),
        ((1, "", float("nan"), 0.0), "neither a station nor a point: (nan, 0.0)"),
        ((1, "", 1e6, 0.0), "no robot can stand at (1e+06, 0)"),
        ((1, "pick1", None, None, 7), "then is 7; 0 (STORE) or 1 (STAY) was expected"),
    ],
)
def test_what_can_not_be_is_refused(drive, request_, text):
    transports = drive(World.preset("small")).transports
    assert transports.submit(*request_) == (0, False, text)
    assert transports.take_events() == [] and list(transports) == []


def test_a_planner_of_ones_own_drives_the_fleet(drive, monkeypatch):
    monkeypatch.syspath_prepend(str(EXAMPLES))
    driver = drive(World.preset("medium"), planner={"planner": "right_of_way:RightOfWay"})
    work(driver, 120)
    assert driver.transports.totals.delivered > 4
    assert driver.collisions == driver.blocked == driver.traffic.plans.refused == 0


class Colliding:
    """Sends everybody where the first one is to go."""

    def start(self, floor, rules, seed):
        self.width = floor.width

    def plan(self, fleet):
        steps = np.array([1, self.width, -1, -self.width])
        return fleet.cell + steps[fleet.heading]


def test_a_plan_that_would_collide_is_refused_with_the_robots_names(drive):
    driver = drive(World.preset("small"), planner={"planner": f"{__name__}:Colliding"})
    work(driver, 5)
    assert driver.traffic.plans.refused > 0
    assert "kiva" in driver.traffic.plans.alarm
    assert driver.collisions == 0 and (driver.traffic.robots.stands).all()


def test_who_is_gone_is_another_array_once_it_has_changed():
    def reports(*kivas):
        out = np.zeros(len(kivas), REPORT)
        out["kiva_id"] = kivas
        return out

    robots = RobotTable(np.array([1, 2, 3]))
    at_first = robots.gone
    robots.align(reports(1, 2, 3))
    assert robots.gone is at_first
    for _ in range(2):
        robots.align(reports(1, 3))
        assert robots.gone.tolist() == [False, True, False]
        assert robots.mode[1] == RobotMode.OUT_OF_SERVICE
    robots.align(reports(1, 2, 3))
    assert not robots.gone.any() and robots.mode[1] == RobotMode.AUTOMATIC
