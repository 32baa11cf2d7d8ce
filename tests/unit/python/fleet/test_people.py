# SPDX-License-Identifier: Apache-2.0
"""People among a fleet at work: no robot touches a person, robots drive around or wait, and go on.

With CROSSINGS there are so many on `large`, by several people at a time.
"""

import os
from types import SimpleNamespace

import numpy as np
import pytest
from test_failures import Fleet

from warehouse_fleet.traffic.people import PeopleLog, people_in, zone_around

CROSSINGS = int(os.environ.get("CROSSINGS", "0"))
WARM_UP = 30  # [s]
RADIUS = 0.25  # of a person [m]
PATIENCE = 120  # for one crossing: who is kept from it longer goes elsewhere [s]


class Crowd:
    """People who cross the floor of a Fleet, from one street to another, again and again."""

    def __init__(self, fleet, people, seed=1):
        self._fleet, self._world = fleet, fleet.world
        self._random = np.random.default_rng(seed)
        plan = fleet.driver.plan
        self._open = np.flatnonzero(plan.passable & ~plan.storage & ~plan.lane & ~plan.parking)
        self._goal, self._since = {}, {}
        self.crossings, self.given_up, self.least = 0, 0, np.inf
        for number in range(1, people + 1):
            self._come(f"person{number}")

    def _come(self, name):
        for place in self._places():
            if self._gap(*place) > 1.5:
                self._world.spawn_model("person", name, *place)
                return self._send(name, place)
        raise AssertionError("there is no room for a person")

    def _places(self):
        while True:
            cell = self._random.choice(self._open)
            yield tuple(map(float, self._fleet.driver.plan.point_of(cell)))

    def _send(self, name, here):
        to = next(p for p in self._places() if np.hypot(p[0] - here[0], p[1] - here[1]) > 10)
        self._world.walk(name, [to[0]], [to[1]])
        self._goal[name], self._since[name] = to, self._world.time

    def _gap(self, x, y):
        """Returns the distance to the chassis of the nearest robot, or to its load [m]."""
        fleet = self._world.fleet
        c, s = np.cos(fleet.yaw), np.sin(fleet.yaw)
        dx, dy = x - fleet.x, y - fleet.y
        loaded = fleet.shelf_id != 0
        along = np.abs(c * dx + s * dy) - np.where(loaded, 0.4, 0.38)
        across = np.abs(c * dy - s * dx) - np.where(loaded, 0.4, 0.32)
        return float(np.hypot(np.maximum(along, 0), np.maximum(across, 0)).min()) - RADIUS

    def look(self):
        """Sends on who has arrived, and notes who came near whom."""
        for name, person in self._world.people.items():
            here = float(person["x"]), float(person["y"])
            self.least = min(self.least, self._gap(*here))
            goal = self._goal[name]
            if np.hypot(goal[0] - here[0], goal[1] - here[1]) < 1e-6:
                self.crossings += 1
                self._send(name, here)
            elif self._world.time - self._since[name] > PATIENCE:
                self.given_up += 1
                self._send(name, here)


def cross(fleet, crowd, crossings=np.inf, seconds=np.inf):
    """Goes on until there were so many, or that much time has passed."""
    end = fleet.world.time + seconds
    while crowd.crossings < crossings and fleet.world.time < end - 1e-9:
        fleet.step()
        crowd.look()


def test_people_cross_a_fleet_at_work():
    with Fleet("medium") as fleet:
        fleet.run(WARM_UP)
        crowd = Crowd(fleet, 3)
        before = fleet.transports.totals.delivered
        cross(fleet, crowd, seconds=90)
        log = fleet.driver.people
        assert crowd.crossings >= 5
        assert fleet.driver.collisions == 0
        assert crowd.least > 0.05
        assert fleet.transports.totals.delivered > before
        assert log.figures()["person_hours"] == pytest.approx(3 * 90 / 3600, rel=0.02)
        assert 0 < log.slowed_s < log.robot_s / 2
        for name in list(fleet.world.people):
            fleet.world.delete(name)
        before = fleet.transports.totals.delivered
        fleet.run(60)
        assert fleet.transports.totals.delivered > before
        assert not fleet.traffic.robots.slowed_for_people.any()
        assert not fleet.traffic.robots.mode.any()


def test_a_zone_is_closed_around_a_person_and_opened_behind():
    with Fleet("medium") as fleet:
        plan = fleet.driver.plan
        row = int(np.flatnonzero((plan.passable & ~plan.storage).sum(1) > 10)[0])
        cells = np.flatnonzero(plan.passable[row] & ~plan.storage[row]) + row * plan.width
        (x, y), (to, _) = plan.point_of(cells[0]), plan.point_of(cells[8])
        fleet.world.spawn_model("person", "person1", x, y)
        fleet.world.walk("person1", [to], [y])
        fleet.run(0.5)
        closed = fleet.traffic.closed
        assert {cells[0], cells[1], cells[2], cells[3]} <= set(closed)
        assert cells[8] not in closed
        fleet.run(10)
        assert set(cells[7:9]) & set(fleet.traffic.closed)
        assert cells[0] not in fleet.traffic.closed
        fleet.world.delete("person1")
        fleet.run(0.5)
        assert not set(cells) & set(fleet.traffic.closed)


def test_a_zone_reaches_where_people_are_to_be():
    plan = SimpleNamespace(origin=(-1.0, 2.0), spacing=1.0, shape=(4, 9))
    plan.point_of = lambda cell: (-1.0 + cell % 9, 2.0 + cell // 9)
    person = {"name": ["p"], "x": [0.0], "y": [3.0], "ahead_x": [3.0], "ahead_y": [3.0]}
    people = SimpleNamespace(**person)
    assert zone_around(plan, people).tolist() == [10, 11, 12, 13]
    people.y = people.ahead_y = [3.5]
    assert zone_around(plan, people).tolist() == [10, 11, 12, 13, 19, 20, 21, 22]
    people.x, people.ahead_x = [-9.0], [-5.0]
    assert zone_around(plan, people).tolist() == []


def test_what_people_cost():
    log = PeopleLog()
    assert log.figures() == {}
    for second in range(11):
        there = 2 <= second < 7
        log.update(
            float(second),
            SimpleNamespace(
                name=["p", "q"] if there else [],
                slowed=[4, 5] if there else [],
                stopped=[7] if second == 3 else [],
            ),
            20,
        )
    figures = log.figures()
    assert figures["person_hours"] == pytest.approx(10 / 3600)
    assert figures["slowed_fraction"] == pytest.approx(10 / 200)
    assert figures["stopped_fraction"] == pytest.approx(1 / 200)


def test_a_world_tells_of_its_people():
    with Fleet("small") as fleet:
        assert people_in(fleet.world).name == []
        x, y = map(float, fleet.world.pose("kiva1")[:2])
        fleet.world.spawn_model("person", "person1", x + 1, y)
        with pytest.raises(ValueError, match="there is no model 'person2'"):
            fleet.world.walk("person2", [0], [0])
        with pytest.raises(ValueError, match="x has 2 entries and y has 1"):
            fleet.world.walk("person1", [0, 1], [0])
        fleet.world.walk("person1")
        assert people_in(fleet.world).name == ["person1"]
        fleet.world.set_light_curtain("all", (-50, 50, -50, 50))
        fleet.world.step(10)
        assert len(people_in(fleet.world).stopped) == 4
        fleet.world.set_light_curtain("all")
        fleet.world.step(200)
        assert len(people_in(fleet.world).stopped) == 0
        with pytest.raises(KeyError, match="there is no light curtain 'all'"):
            fleet.world.set_light_curtain("all")


@pytest.mark.skipif(not CROSSINGS, reason="make test-long")
def test_many_crossings_at_a_hundred_robots():
    with Fleet("large") as fleet:
        fleet.run(2 * WARM_UP)
        crowd = Crowd(fleet, 10)
        before, begin = fleet.transports.totals.delivered, fleet.world.time
        cross(fleet, crowd, CROSSINGS)
        delivered = fleet.transports.totals.delivered - before
        print(
            f"{crowd.crossings} crossings, {crowd.given_up} given up, "
            f"in {fleet.world.time - begin:.0f} s, nearest {crowd.least:.3f} m, "
            f"{delivered} units delivered",
            fleet.driver.people.figures(),
        )
        assert fleet.driver.collisions == 0
        assert crowd.least > 0
        assert crowd.given_up < crowd.crossings / 3
        assert delivered > crowd.crossings / 10
