# SPDX-License-Identifier: Apache-2.0
"""A fleet whose robots break and are repaired: no robot touches another, and the work goes on.

Time is ten times as dense as in a warehouse: as many robots are broken at once as where ten break
an hour and are repaired in five minutes. With FAILURE_MINUTES it lasts longer, at that rate.
"""

import os

import numpy as np
import pytest
from fault_site import Site

from kiva_plugin_cpp import EventKind, FailureKind, World
from warehouse_fleet.hosts.fleet_driver import FleetDriver
from warehouse_fleet.hosts.random_transports import RandomTransports
from warehouse_fleet.robots.failures import EMPTY, FailureLog
from warehouse_fleet.transports.transports import Kind, Step
from warehouse_layout.message_enums import RobotMode

LONG = float(os.environ.get("FAILURE_MINUTES", "0"))
DENSE = 1 if LONG else 10  # failures an hour, for each of those in a warehouse
MINUTES = LONG or 4
WARM_UP = 60  # [s]
KEPT = 0.85  # of the throughput of sound robots


class Fleet(Site):
    """A preset whose stations are all busy."""

    def __init__(self, size, seed=1, tow_after=None, **realism):
        self.world = World.preset(size, seed=seed, realism=realism)
        self.driver = FleetDriver(self.world, seed=seed, tow_after=tow_after)
        self.traffic, self.transports = self.driver.traffic, self.driver.transports
        self._demand = RandomTransports(self.transports, seed, exchange=10)
        self.events = []

    def run(self, seconds):
        """Units delivered meanwhile."""
        before, end = self.transports.totals.delivered, self.world.time + seconds
        while self.world.time < end - 1e-9:
            self.step()
        return self.transports.totals.delivered - before

    def until(self, condition, patience=120):
        return super().until(condition, patience)

    def loaded_in_streets(self):
        """Robots with a unit that drive fast, far from storage and lanes."""
        fleet, plan = self.world.fleet, self.driver.plan
        aside = (plan.storage | plan.lane).ravel()
        fast = np.hypot(fleet.vx, fleet.vy) > 1
        return np.flatnonzero(
            fast & (fleet.shelf_id != 0) & ~aside[self.traffic.robots.cell]
        ).tolist()

    def refuge(self, robot):
        """The cell to which a robot would be towed."""
        order = self.driver.controller.tow(self.kiva(robot))
        return self.driver.plan.cell_of(order.x, order.y)

    def kiva(self, robot):
        return int(self.traffic.robots.kiva_ids[robot])


@pytest.mark.long
def test_throughput_with_ten_failures_an_hour():
    failures = {"per_robot_hour": 0.1 * DENSE, "repair_time": 300 / DENSE}
    delivered = {}
    for name, realism in (("sound", {}), ("broken", {"failures": failures})):
        with Fleet("large", **realism) as fleet:
            fleet.run(WARM_UP)
            delivered[name] = fleet.run(60 * MINUTES)
            assert fleet.driver.collisions == 0
            assert not fleet.traffic.robots.mode.any()
            log = fleet.driver.failures
    print(delivered, log.figures(), log.by_kind())
    assert log.total >= 3
    assert 0.9 < log.figures()["availability"] < 1
    assert delivered["broken"] >= KEPT * delivered["sound"]


@pytest.mark.parametrize("kind", [FailureKind.MOTOR, FailureKind.RADIO_LOST])
def test_a_robot_breaks_in_a_street_with_a_unit_on_it(kind):
    with Fleet("medium") as fleet:
        fleet.run(WARM_UP)
        robot = fleet.until(fleet.loaded_in_streets)[0]
        unit = int(fleet.world.fleet.shelf_id[robot])
        fleet.world.fail(fleet.kiva(robot), kind)
        fleet.run(1)
        assert fleet.traffic.robots.broken[robot]
        assert fleet.traffic.robots.cell[robot] in fleet.traffic.closed
        fleet.events.clear()
        assert fleet.run(90) > 0
        lost = [e.text for e in fleet.events if e.kind == Kind.FAILED]
        assert lost == ["its robot is broken"]
        assert fleet.traffic.watchdog.count == 0
        fleet.world.fail(fleet.kiva(robot), FailureKind.REPAIRED)
        is_stored = lambda e: e.kind == Kind.STORED and e.shelf_id == unit  # noqa: E731
        fleet.until(lambda: any(map(is_stored, fleet.events)), 240)
        assert fleet.driver.collisions == 0
        assert not fleet.traffic.robots.mode.any()


def test_a_broken_robot_is_towed_away_with_its_unit():
    with Fleet("medium") as fleet:
        fleet.run(WARM_UP)
        robot = fleet.until(fleet.loaded_in_streets)[0]
        kiva, plan = fleet.kiva(robot), fleet.driver.plan
        with pytest.raises(ValueError, match=f"kiva{kiva} is not broken"):
            fleet.driver.tow(kiva)
        fleet.world.fail(kiva, FailureKind.MOTOR, 60)
        fleet.run(3)
        held = set(fleet.traffic.closed.tolist())
        fleet.driver.tow(kiva)
        fleet.run(2)
        assert plan.storage.flat[fleet.traffic.robots.cell[robot]]
        assert fleet.world.fleet.shelf_id[robot] != 0
        assert not held & set(fleet.traffic.closed.tolist())  # others pass where it stood
        fleet.events.clear()
        fleet.run(60)
        fleet.until(lambda: fleet.world.fleet.shelf_id[robot] == 0)
        assert fleet.driver.collisions == 0
        assert [e.text for e in fleet.events if e.kind == Kind.FAILED] == ["its robot is broken"]


def test_who_is_not_heard_in_a_street_is_found_and_towed():
    with Fleet("medium", tow_after=10) as fleet:
        fleet.run(WARM_UP)
        robot = fleet.until(fleet.loaded_in_streets)[0]
        fleet.world.fail(fleet.kiva(robot), FailureKind.RADIO_LOST)
        fleet.run(15)
        at = fleet.traffic.robots.cell[robot]
        assert fleet.driver.plan.storage.flat[at]
        assert at == fleet.driver.plan.cell_of(
            fleet.world.fleet.x[robot], fleet.world.fleet.y[robot]
        )
        assert fleet.driver.collisions == 0


def test_who_is_lost_beneath_a_unit_is_towed_from_there():
    with Fleet("medium", tow_after=10) as fleet:
        fleet.run(20)
        traffic, plan = fleet.traffic, fleet.driver.plan
        beneath = lambda: plan.storage.flat[traffic.robots.cell] & ~traffic.robots.loaded  # noqa: E731
        robot = fleet.until(lambda: np.flatnonzero(beneath()).tolist())[0]
        at = traffic.robots.cell[robot]
        traffic.robots.lost[robot], traffic.robots.mode[robot] = True, RobotMode.OUT_OF_SERVICE
        fleet.until(lambda: traffic.robots.cell[robot] != at, 30)
        assert traffic.robots.mode[robot] == RobotMode.AUTOMATIC


def test_who_was_not_heard_since_it_lifted_works_again_when_it_is_repaired():
    with Fleet("medium") as fleet:
        fleet.run(WARM_UP)
        lifting = lambda: [t for t in fleet.transports if t.step == Step.LIFTING]  # noqa: E731
        transport = fleet.until(lifting)[0]
        fleet.world.fail(fleet.kiva(transport.robot), FailureKind.RADIO_LOST, 45)
        fleet.events.clear()
        is_stored = lambda e: e.kind == Kind.STORED and e.shelf_id == transport.shelf  # noqa: E731
        fleet.until(lambda: any(map(is_stored, fleet.events)), 180)
        assert [e.text for e in fleet.events if e.kind == Kind.FAILED] == ["its robot is broken"]
        fleet.until(lambda: any(t.robot == transport.robot for t in fleet.transports))


def test_nobody_is_towed_to_where_others_are_about_to_pass():
    with Fleet("medium") as fleet:
        traffic, count = fleet.traffic, len(fleet.traffic.robots.kiva_ids)
        for _ in range(60):
            fleet.run(1)
            for robot in fleet.loaded_in_streets():
                traffic.robots.broken[robot] = True
                refuge = fleet.refuge(robot)
                traffic.robots.broken[robot] = False
                assert all(refuge not in traffic.paths(other)[0] for other in range(count))


def test_who_is_empty_is_towed_to_where_it_is_charged():
    with Fleet("medium") as fleet:
        fleet.run(20)
        traffic = fleet.traffic
        traffic.robots.broken = np.ones(len(traffic.robots.broken), bool)
        traffic.robots.failures = np.full(len(traffic.robots.broken), 1 << EMPTY, np.uint8)
        unloaded = traffic.robots.kiva_ids[~traffic.robots.loaded].tolist()
        assert unloaded
        refuges = [fleet.refuge(traffic.robots.index(kiva)) for kiva in unloaded]
        assert np.isin(refuges, fleet.driver.plan.charging).all()


def test_what_is_not_yet_lifted_others_take_over():
    with Fleet("medium") as fleet:
        fleet.run(WARM_UP)
        transport = next(t for t in fleet.transports if t.step == Step.FETCHING)
        robot = transport.robot
        fleet.world.fail(fleet.kiva(robot), FailureKind.LIFT_STUCK, 60)
        fleet.run(5)
        assert all(t.robot != robot for t in fleet.transports)
        fleet.run(60)
        assert fleet.world.fleet.failures[robot] == 0
        fleet.until(lambda: any(t.robot == robot for t in fleet.transports))
        assert fleet.driver.collisions == 0


def test_the_same_seed_breaks_the_same_robots():
    def story(seed):
        realism = {"failures": {"per_robot_hour": 200, "repair_time": 20}}
        world = World.preset("small", seed=seed, realism=realism)
        world.step(60000)
        events = world.events()
        broken = events[events["kind"] == EventKind.FAILED]
        return list(zip(broken["model"], broken["text"], broken["time"]))

    first = story(3)
    assert len(first) > 5
    assert story(3) == first
    assert story(4) != first


def test_a_robot_that_is_broken_at_first_is_a_figure_at_once():
    log = FailureLog()
    log.update(5.0, np.array([1 << FailureKind.MOTOR], np.uint8))
    assert log.figures()["availability"] == 1 and log.figures()["failures"] == 1


def test_availability():
    log = FailureLog()
    for second in range(101):
        bits = np.zeros(4, np.uint8)
        if 10 <= second < 30:
            bits[1] |= 1 << FailureKind.MOTOR
        if 20 <= second < 40:
            bits[1] |= 1 << FailureKind.RADIO_LOST
        if second >= 50:
            bits[2] |= 1 << FailureKind.WHEEL_SLIPS  # slow, but at work
        log.update(float(second), bits)
    figures = log.figures()
    assert figures["failures"] == 3
    assert figures["availability"] == pytest.approx(1 - 30 / 400)
    assert figures["mttr_s"] == pytest.approx(20)
    assert figures["mtbf_h"] == pytest.approx(370 / 3 / 3600)
    hours = {entry["kind"]: (entry["robot_h"], entry["down_h"]) for entry in log.by_kind()}
    assert hours["drive without torque"] == pytest.approx((20 / 3600, 20 / 3600))
    assert hours["wheels slip"] == pytest.approx((50 / 3600, 0))
