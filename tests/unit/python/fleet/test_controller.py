# SPDX-License-Identifier: Apache-2.0
"""A FleetController decides by observations that are made by hand: no world, no ROS."""

import numpy as np
import pytest
from instance_file import write_hall_instance
from operations_site import site

from warehouse_fleet.hosts.controller import FleetController, Observation
from warehouse_fleet.robots.robot_table import NOWHERE, REPORT
from warehouse_fleet.transports.lifts import LiftOrder
from warehouse_fleet.transports.transport_book import Kind, Step
from warehouse_fleet.transports.unit_map import UnitPoses
from warehouse_fleet.transports.waiting import Waiting
from warehouse_layout.convert.rawsim.instance import read_floor
from warehouse_layout.message_enums import FailureKind, RobotMode, State, Status

STATION = "pick1"
WHERE = site(robots=2)
PLAN = WHERE.plan
STREET = int(np.flatnonzero(~PLAN.storage & ~PLAN.lane)[3])


class Fleet:
    """A controller, and what two robots would report."""

    def __init__(self, **options):
        self.controller = FleetController(PLAN, np.array([1, 2]), seed=1, **options)
        self.time = 0.0
        self.reports = np.zeros(2, REPORT)
        self.reports["kiva_id"] = 1, 2
        self.reports["charge"] = 1.0
        self.put(0, WHERE.robots[1])
        self.put(1, WHERE.robots[2])
        self.controller.transports.update_units(self.units())

    def put(self, robot, cell):
        self.reports["x"][robot], self.reports["y"][robot] = PLAN.point_of(cell)

    def units(self, **moved):
        cells = {**WHERE.units, **{int(name[4:]): cell for name, cell in moved.items()}}
        x, y = PLAN.point_of(np.array(list(cells.values())))
        still = np.zeros(len(cells))
        ids = np.array(list(cells))
        return UnitPoses(ids, x, y, still, np.zeros(len(cells), bool), self.time)

    def tick(self, **observed):
        self.time += 0.1
        return self.controller.tick(
            Observation(self.time, self.reports[observed.pop("robots", slice(None))], **observed)
        )

    def kinds(self):
        return [event.kind for event in self.controller.transports.take_events()]

    def step(self):
        return next(iter(self.controller.transports.book)).step


@pytest.fixture
def begin():
    fleets = []

    def make(**options):
        fleets.append(Fleet(**options))
        return fleets[-1]

    yield make
    for fleet in fleets:
        fleet.controller.close()


def unit_above(robot):
    """The unit beneath which a robot stands at first."""
    return next(unit for unit, cell in WHERE.units.items() if cell == WHERE.robots[robot + 1])


def test_a_fleet_without_work_decides_nothing(begin):
    fleet = begin()
    decision = fleet.tick()
    assert decision.lifts == decision.cancels == decision.tows == []
    assert len(decision.releases.kiva_id) == 0


def test_a_robot_beneath_the_unit_is_to_lift_it_and_then_to_drive(begin):
    fleet = begin()
    unit = unit_above(0)
    assert fleet.controller.transports.submit(unit, STATION).accepted
    lifts = [lift for _ in range(5) for lift in fleet.tick().lifts]
    assert lifts == [LiftOrder(1, unit, True)] and fleet.step() == Step.LIFTING
    assert fleet.kinds() == [Kind.RECEIVED, Kind.ASSIGNED]
    fleet.reports["shelf_id"][0] = unit
    released = [fleet.tick().releases for _ in range(20)]
    assert fleet.kinds() == [Kind.LIFTED] and fleet.step() == Step.BRINGING
    released = [each for each in released if len(each.kiva_id)]
    assert released and {int(kiva) for each in released for kiva in each.kiva_id} == {1}


def test_a_robot_that_is_missing_in_reports_loses_its_transport(begin):
    fleet = begin()
    fleet.controller.transports.submit(unit_above(0), STATION)
    fleet.tick()
    fleet.tick(robots=[1])
    assert fleet.controller.robots.gone.tolist() == [True, False]
    transport = next(iter(fleet.controller.transports.book))
    assert transport.robot == 1


def test_units_are_looked_at_when_a_robot_is_gone(begin):
    fleet, looks = begin(), []
    fleet.tick(look_at_units=lambda: looks.append(1))
    assert looks == []
    fleet.tick(robots=[1], look_at_units=lambda: looks.append(1))
    assert looks == [1]


def test_the_transport_of_a_unit_that_is_gone_fails(begin):
    fleet = begin()
    unit = unit_above(1)
    fleet.controller.transports.submit(unit, STATION)
    units = fleet.units()
    left = units.shelf_id != unit
    fleet.tick(units=UnitPoses(*(column[left] for column in units[:5]), units.stamp))
    assert fleet.kinds() == [Kind.RECEIVED, Kind.FAILED]


def test_the_map_is_looked_at_while_items_lie_on_the_floor(begin):
    fleet, looks = begin(), []

    def look():
        looks.append(fleet.time)
        occupancy = np.zeros(PLAN.shape, np.uint8)
        occupancy.flat[STREET] = 100
        return occupancy

    fleet.tick(look_at_map=look)
    assert looks == []
    fleet.tick(fallen=1, look_at_map=look)
    assert len(looks) == 1 and fleet.controller.traffic.closed.tolist() == [STREET]


def test_paths_that_others_gave_out_are_cancelled(begin):
    fleet = begin()
    fleet.reports["path_id"][1], fleet.reports["status"][1] = 9, Status.BUSY
    assert fleet.tick().cancels == [2]


def test_a_robot_on_a_path_of_its_fleet_that_came_late_is_stopped_and_not_manual(begin):
    fleet = begin()
    unit = unit_above(0)
    assert fleet.controller.transports.submit(unit, STATION).accepted
    for _ in range(5):
        fleet.tick()
    fleet.reports["shelf_id"][0] = unit
    paths = []
    while len(paths) < 2:  # the first one is refused, and given up
        releases = fleet.tick(refused=["kiva1"]).releases
        paths += [path for path in releases.path_id.tolist() if path not in paths]
    fleet.reports["path_id"][0], fleet.reports["reached"][0] = paths[0], 1
    fleet.reports["status"][0], fleet.reports["state"][0] = Status.BUSY, State.MOVING_X
    cancels = [fleet.tick(refused=["kiva1"]).cancels for _ in range(15)]
    assert [1] in cancels
    assert fleet.controller.robots.automatic.all() and fleet.step() == Step.BRINGING


def test_a_robot_that_is_set_manual_on_its_way_is_to_stop(begin):
    fleet = begin()
    fleet.tick()
    assert fleet.controller.set_mode(2, RobotMode.MANUAL) == []  # stands
    fleet.controller.robots.stands[0] = False
    assert fleet.controller.set_mode(1, RobotMode.OUT_OF_SERVICE) == [1]
    with pytest.raises(ValueError, match="there is no kiva3"):
        fleet.controller.set_mode(3, RobotMode.MANUAL)


def test_a_robot_that_is_broken_in_a_street_is_towed_aside(begin):
    fleet = begin(tow_after=1.0)
    fleet.put(0, STREET)
    fleet.reports["failures"][0] = 1 << FailureKind.MOTOR
    tows = [tow for _ in range(15) for tow in fleet.tick().tows]
    assert [tow.kiva_id for tow in tows] == [1]
    assert PLAN.storage.flat[PLAN.cell_of(tows[0].x, tows[0].y)]
    with pytest.raises(ValueError, match="kiva2 is not broken"):
        fleet.controller.tow(2)


def test_a_robot_waits_for_a_broken_one_that_stands_where_it_has_to_go(begin):
    fleet = begin()
    unit = unit_above(0)
    fleet.reports["failures"][0] = 1 << FailureKind.MOTOR
    assert fleet.controller.transports.submit(unit, STATION).accepted
    for _ in range(500):
        fleet.tick()
    traffic = fleet.controller.traffic
    assert traffic.robots.goal[1] == WHERE.units[unit]
    assert traffic.all_ahead().tolist() == [NOWHERE, 0]
    waiting = Waiting(traffic, fleet.controller.transports.book)
    assert dict(waiting.long())[1] == "behind kiva1, which is broken"
    assert traffic.watchdog.count == 0
    for _ in range(200):
        fleet.tick()
    text = f"unit {unit} is cut off by kiva1, broken or out of service"
    assert [why for _, why in fleet.controller.transports.held()] == [text]
    assert traffic.robots.goal[1] == NOWHERE
    fleet.reports["failures"][0] = 0
    fleet.tick()
    assert fleet.step() > Step.OPEN and not fleet.controller.transports.held()


def test_an_observation_that_is_late_is_stale(begin):
    fleet = begin()
    fleet.tick()
    assert fleet.controller.is_stale(fleet.time - 0.05)
    assert not fleet.controller.is_stale(fleet.time)


def test_a_unit_that_stands_in_a_street_is_no_obstacle_to_its_robot(begin):
    fleet = begin()
    unit = unit_above(1)
    fleet.tick(units=fleet.units(**{f"unit{unit}": STREET}))
    transports = fleet.controller.transports
    assert transports.cell_of_unit[unit] == STREET
    assert transports.submit(unit, STATION).accepted
    fleet.tick()
    robot = next(iter(transports.book)).robot
    assert robot != NOWHERE and fleet.controller.robots.goal[robot] == STREET


def test_a_robot_that_is_driven_by_velocities_is_manual_until_it_is_given_back(begin):
    fleet = begin()
    fleet.reports["status"][0], fleet.reports["state"][0] = Status.BUSY, State.STEERED
    fleet.tick()
    assert fleet.controller.robots.mode.tolist() == [RobotMode.MANUAL, RobotMode.AUTOMATIC]
    fleet.reports["status"][0], fleet.reports["state"][0] = Status.BLOCKED, State.BLOCKED
    fleet.tick()
    with pytest.raises(ValueError, match="kiva1 is driven by /kiva1/cmd_vel: give it back"):
        fleet.controller.set_mode(1, RobotMode.AUTOMATIC)
    fleet.reports["status"][0], fleet.reports["state"][0] = Status.IDLE, State.IDLE
    fleet.tick()
    fleet.controller.set_mode(1, RobotMode.AUTOMATIC)
    fleet.tick()
    assert fleet.controller.robots.mode.tolist() == [RobotMode.AUTOMATIC] * 2


@pytest.mark.parametrize("where", ["the only way to its station", "its own only way on"])
def test_a_robot_that_brings_a_unit_waits_for_a_broken_one_in(begin, where):
    cells = {
        "the only way to its station": PLAN.station(STATION).cells[0],
        "its own only way on": only_way_on(WHERE.robots[2]),
    }
    fleet = begin()
    unit = unit_above(1)
    assert fleet.controller.transports.submit(unit, STATION).accepted
    for _ in range(5):
        fleet.tick()
    fleet.reports["shelf_id"][1] = unit
    fleet.tick()
    assert fleet.step() == Step.BRINGING
    fleet.put(0, int(cells[where]))
    fleet.reports["failures"][0] = 1 << FailureKind.MOTOR
    for _ in range(700):
        fleet.tick()
    traffic = fleet.controller.traffic
    assert traffic.all_ahead().tolist() == [NOWHERE, 0]
    waiting = Waiting(traffic, fleet.controller.transports.book)
    assert dict(waiting.long())[1] == "behind kiva1, which is broken"
    assert traffic.watchdog.count == 0


def only_way_on(cell):
    """The only cell to which a loaded robot can drive from another."""
    ahead = np.asarray(PLAN.floor().edges(True))[cell]
    (only,) = ahead[ahead != NOWHERE]
    return int(only)


def test_a_robot_waits_for_the_one_at_the_end_of_its_short_cut(tmp_path):
    """The next cell of the lane is free, but that is the longer way."""
    plan = read_floor(write_hall_instance(tmp_path / "a.xinst")).plan
    station = plan.stations[0]
    controller = FleetController(plan, np.array([1, 2]), seed=1)
    for cell, end in station.short_cuts:
        reports = np.zeros(2, REPORT)
        reports["kiva_id"] = 1, 2
        reports["x"], reports["y"] = plan.point_of(np.array([end, cell]))
        controller.traffic.update_robots(controller.traffic.time + 0.1, reports)
        robots = controller.robots
        robots.goal[:] = station.service_cell
        assert controller.traffic.all_ahead()[1] == 0, cell
        robots.goal[1] = robots.cell[1]  # without work there
        assert controller.traffic.all_ahead()[1] == NOWHERE, cell
    controller.close()
