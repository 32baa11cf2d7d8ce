# SPDX-License-Identifier: Apache-2.0
"""What cuts a robot off from its goal, on small floors; and what robots that stand broken or out of
service for long shut to new work."""

import numpy as np
from operations_site import site
from test_failures import WARM_UP, Fleet

from kiva_plugin_cpp import FailureKind
from warehouse_fleet.robots.robot_table import NOWHERE, RobotTable
from warehouse_fleet.traffic.closed_zones import ClosedZones, ZoneRequest
from warehouse_fleet.traffic.cut_off import CutOff
from warehouse_fleet.traffic.standing_robots import LONG, StandingRobots
from warehouse_fleet.transports.transports import Kind, Step
from warehouse_layout import Floor
from warehouse_layout.floor.floor_edges import FloorEdges
from warehouse_layout.message_enums import RobotMode

EAST, NORTH, WEST, SOUTH = 1, 2, 4, 8  # bits of exits


def one_way(length):
    """A street of cells that leads to the east alone."""
    exits = np.full((1, length), EAST, np.uint8)
    return CutOff(FloorEdges(Floor(np.ones((1, length), bool), exits=exits)))


def test_the_obstacle_ahead_cuts_off_and_one_behind_does_not():
    cut = one_way(6)
    cut.set_obstacles(np.array([0, 3]), 6)
    assert cut.obstacles(1, 5, False).tolist() == [3]
    assert cut.obstacles(1, 2, False).tolist() == []


def test_obstacles_that_have_gone_are_forgotten():
    cut = one_way(4)
    cut.set_obstacles(np.array([2]), 4)
    assert cut.obstacles(0, 3, False).tolist() == [2]
    cut.set_obstacles(np.array([], int), 4)
    assert cut.obstacles(0, 3, False).tolist() == []


def test_of_several_obstacles_the_one_that_bars_the_way_is_told():
    """Two rows: the lower leads east and up at its end, the upper is a blind alley."""
    exits = np.array([[EAST | NORTH, EAST, EAST, NORTH], [EAST, 0, 0, 0]], np.uint8)
    cut = CutOff(FloorEdges(Floor(np.ones((2, 4), bool), exits=exits)))
    cut.set_obstacles(np.array([2, 5]), 8)
    assert cut.obstacles(0, 7, False).tolist() == [2]
    cut.set_obstacles(np.array([1, 2, 5]), 8)
    assert cut.obstacles(0, 7, False).tolist() == [1, 5], "neither alone"


# --- robots that stand for long

PLAN = site(robots=2).plan
EDGES = FloorEdges(PLAN.floor())
LANE = PLAN.stations[0]
UNIT = 23
PLACE = int(np.flatnonzero(PLAN.storage)[0])
BESIDE = [c for c in PLAN.beside([PLACE]).tolist() if PLAN.passable.flat[c]]
BESIDE = [c for c in BESIDE if not PLAN.storage.flat[c]]


class Standing:
    """Robots 1 and 2, in cells; the first at first."""

    def __init__(self, *cells):
        self.robots = RobotTable(np.array([1, 2]))
        self.held = dict(zip(cells, range(2)))
        self.zones = ClosedZones(PLAN, EDGES, lambda cells: None)
        self.look = StandingRobots(PLAN, EDGES, self.zones, self.robots, lambda: self.held)

    def after(self, seconds):
        self.look.update(0.0)
        self.look.update(seconds)
        return self.look


def test_a_station_with_a_broken_robot_in_its_lane_is_cut_off_after_a_while():
    standing = Standing(int(LANE.cells[0]))
    standing.robots.broken[0] = True
    assert standing.after(LONG - 1).why_station(LANE.name) == ""
    text = f"{LANE.name} is cut off by kiva1, broken or out of service"
    assert standing.after(LONG + 1).why_station(LANE.name) == text
    assert all(standing.look.why_station(s.name) == "" for s in PLAN.stations[1:])
    standing.robots.broken[0] = False
    assert standing.after(LONG + 2).why_station(LANE.name) == ""
    assert not standing.look and not standing.look.is_cut.any()


def test_one_that_a_person_drives_shuts_nothing_and_one_out_of_service_does():
    standing = Standing(PLACE)
    standing.robots.mode[0] = RobotMode.MANUAL
    assert standing.after(2 * LONG).why_unit(UNIT, PLACE) == ""
    standing.robots.mode[0] = RobotMode.OUT_OF_SERVICE
    standing.look.update(3 * LONG)
    standing.look.update(4 * LONG + 1)
    text = f"unit {UNIT} is cut off by kiva1, broken or out of service"
    assert standing.look.why_unit(UNIT, PLACE) == text


def test_a_broken_robot_and_a_zone_cut_a_place_off_together():
    standing = Standing(BESIDE[0])
    standing.robots.broken[0] = True
    look = standing.after(LONG + 1)
    alone = len(BESIDE) == 1
    assert bool(look.why_unit(UNIT, PLACE)) == alone
    for cell in BESIDE[1:]:
        x, y = map(float, PLAN.point_of(cell))
        zones = standing.zones
        zones.close(zones.propose(ZoneRequest(x, y, x, y, reason="spill"), 0.0))
    look.update(LONG + 2)
    assert "is cut off by kiva1" in look.why_unit(UNIT, PLACE)


def test_transports_to_a_station_wait_for_a_robot_that_stands_in_its_lane():
    with Fleet("medium") as fleet:
        fleet.run(WARM_UP)
        stations = {s.name: s for s in fleet.driver.plan.stations}

        def in_lane():
            return [
                t
                for t in fleet.transports
                if t.step == Step.BRINGING
                and t.robot != NOWHERE
                and t.station in stations
                and fleet.traffic.robots.cell[t.robot] == stations[t.station].cells[0]
            ]

        transport = fleet.until(in_lane, 240)[0]
        station, kiva = transport.station, fleet.kiva(transport.robot)
        fleet.world.fail(kiva, FailureKind.MOTOR)
        fleet.run(LONG + 30)
        text = f"{station} is cut off by kiva{kiva}, broken or out of service"
        assert text in {why for _, why in fleet.transports.held()}
        waiting = [t for t in fleet.transports if t.station == station]
        assert not [t for t in waiting if Step.OPEN < t.step <= Step.READY]
        others = fleet.transports.totals.delivered
        fleet.run(60)
        assert fleet.transports.totals.delivered > others
        fleet.world.fail(kiva, FailureKind.REPAIRED)
        fleet.events.clear()
        numbers = {t.number for t in waiting}
        done = lambda e: e.transport_id in numbers and e.kind == Kind.ARRIVED  # noqa: E731
        fleet.until(lambda: any(map(done, fleet.events)), 240)
        assert not fleet.transports.held()
        assert fleet.driver.collisions == 0 and fleet.traffic.watchdog.count == 0
