# SPDX-License-Identifier: Apache-2.0
"""A fleet serves the largest reachable part of a floor, and names the rest."""

import numpy as np
import pytest

from warehouse_fleet.robots.robot_table import RobotTable
from warehouse_fleet.traffic.closed_zones import ClosedZones
from warehouse_fleet.traffic.standing_robots import StandingRobots
from warehouse_fleet.transports.transports import Transports
from warehouse_layout import FloorError
from warehouse_layout.floor.floor_edges import FloorEdges
from warehouse_layout.floor.floor_plan import PICK, FloorPlan, Station
from warehouse_layout.floor.served_part import not_driven, served_part, with_ways_back

EVERY_WAY = 0b1111


def plan_of(rows, stations=(), exits=None):
    """`.` aisle, `u` storage place, `#` wall; the first row is y = 0."""
    cells = np.array([list(row) for row in rows])
    passable = cells != "#"
    return FloorPlan.laid_out(
        origin=(0, 0),
        spacing=1,
        passable=passable,
        storage=cells == "u",
        parking=np.zeros_like(passable),
        exits=np.full(cells.shape, EVERY_WAY, np.uint8) if exits is None else exits,
        stations=stations,
    )


def test_a_whole_floor_is_served_as_it_is():
    plan = plan_of(["....", ".uu.", "...."])
    part, left_out = served_part(plan)
    assert part is plan
    assert left_out.text(plan) == ""


def test_an_island_is_left_out_with_what_stands_there():
    plan = plan_of(["....#..", ".uu.#u.", "....#.."])
    part, left_out = served_part(plan)
    part.check()
    assert left_out.cells.tolist() == [5, 6, 12, 13, 19, 20]
    text = left_out.text(plan, units=[7], robots=[3])
    assert "come to 6 cells and back: (5, 0), (6, 0)" in text
    assert "storage units 7 are there; robots kiva3 are there" in text


def test_a_dead_end_is_left_out():
    plan = plan_of([".....", ".#.##", "...##"])
    part, left_out = served_part(plan)
    part.check()
    assert left_out.cells.tolist() == [3, 4]


def test_a_one_way_street_that_only_leads_in_is_left_out_not_the_rest():
    rows = ["##.###", "##.###", "......", ".uuuu.", "......"]
    exits = np.full((5, 6), EVERY_WAY, np.uint8)
    exits[:2, 2] = 0b0010  # towards +y
    exits[2, 2] = 0b0111
    part, left_out = served_part(plan_of(rows, exits=exits))
    part.check()
    assert left_out.cells.tolist() == [2, 8]


def one_way_ring():
    """Returns a plan whose streets lead round once, and its exits."""
    right, up, left, down = 1, 2, 4, 8
    exits = np.array(
        [
            [right, right | up, right | up, up],
            [down, EVERY_WAY, EVERY_WAY, up | left],
            [down, left, left, left],
        ],
        np.uint8,
    )
    return ["....", ".uu.", "...."], exits


def test_a_way_against_a_one_way_street_is_left_out_alone():
    """A robot could only come back from there, against those that come along the street."""
    rows, exits = one_way_ring()
    exits[1, 3] |= 8
    plan = plan_of(rows, exits=exits)
    with pytest.raises(FloorError, match=r"\(3, 1\) to \(3, 0\)$"):
        plan.check()
    part, left_out = served_part(plan)
    part.check()
    assert left_out.cells.tolist() == [] and part.exits[1, 3] == 2 | 4
    same, steps = with_ways_back(plan)
    assert steps.tolist() == [[7, 3]] and (same.exits == part.exits).all()
    assert left_out.steps.tolist() == [[7, 3]]
    sentence = "robots with bodies do not drive from (3, 1) to (3, 0): they could only come back"
    assert not_driven(plan, steps).startswith(sentence) and not not_driven(plan, steps[:0])


def test_a_floor_of_which_some_is_left_out_stays_as_it_is():
    for plan in (plan_of([".....", ".#.##", "...##"]), plan_of(["u"]), plan_of(one_way_ring()[0])):
        same, steps = with_ways_back(plan)
        assert same is plan and not len(steps)


def test_a_station_beyond_is_left_out_by_name():
    lane = np.array([5, 12, 19], np.int32)
    stations = [Station("pick1", PICK, lane, 1)]
    part, left_out = served_part(plan_of(["....#.#", ".uu.#.#", "....#.#"], stations))
    part.check()
    assert (part.stations, left_out.stations) == ((), ("pick1",))


def test_a_floor_without_aisles_is_refused():
    with pytest.raises(FloorError, match="no aisle"):
        served_part(plan_of(["##", "##"]))


class Parked:
    """The part of Traffic that Transports asks, without robots."""

    def __init__(self, plan):
        self.plan, self.time = plan, 0.0
        self.robots = RobotTable([])
        edges = FloorEdges(plan.floor())
        self.zones = ClosedZones(plan, edges, lambda cells: None)
        self.standing = StandingRobots(plan, edges, self.zones, self.robots, dict)

    def set_units(self, cells):
        pass


def test_transports_to_what_is_left_out_are_refused_with_the_reason():
    lane = np.array([5, 12, 19], np.int32)
    whole = plan_of(["....#.#", ".uu.#.#", "....#.#"], [Station("pick1", PICK, lane, 1)])
    part, left_out = served_part(whole)
    transports = Transports(part, Parked(part))
    transports.left_out = frozenset(left_out.stations)
    transports.update_cells({1: 8, 2: 12}, 0.0)
    assert transports.units.out_of_reach() == [2]
    answer = transports.submit(2, x=0.0, y=0.0)
    assert (answer.accepted, answer.message) == (
        False,
        "no robot can reach storage unit 2 and return",
    )
    answer = transports.submit(1, "pick1")
    assert answer.message == "no robot can reach station pick1 and return"
