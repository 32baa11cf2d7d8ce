# SPDX-License-Identifier: Apache-2.0
"""Batteries: that a fleet lives with them. They are so small here that robots have to charge every
few minutes; what robots use and take up is what the real ones do.
"""

import os
from dataclasses import replace

import numpy as np
import pytest

from kiva_plugin_cpp import World
from warehouse_fleet.hosts.controller import FleetController
from warehouse_fleet.hosts.fleet_driver import FleetDriver
from warehouse_fleet.hosts.random_transports import RandomTransports
from warehouse_fleet.transports.charging import Opportunity, Threshold
from warehouse_layout.floor import plan_reader

LONG = float(os.environ.get("CHARGING_MINUTES", "0"))
MINUTES = LONG or 8
SMALL = {"capacity": 80, "initial_least": 0.3, "initial_most": 0.8}  # [Wh], 0…1
# Of what is delivered without: all robots are at work, and stand at places to charge at for a tenth
# of their time, at first on what the batteries began with (doc/explanation/realism.md).
# The ways are the rest.
KEPT = 0.85 if LONG else 0.9


@pytest.mark.parametrize(("size", "robots"), [("small", 4), ("medium", 20), ("large", 100)])
def test_one_place_in_five_charges(size, robots):
    plan = plan_reader.of_world(World.preset(size))
    assert len(plan.charging) == np.ceil(robots / 5)
    assert plan.parking.ravel()[plan.charging].all()


def test_a_robot_that_is_charged_elsewhere_gets_no_work_below_a_charge():
    world = World.preset("small")
    plan = replace(plan_reader.of_world(world), charging=np.zeros(0, np.int32))
    controller = FleetController(plan, world.fleet.kiva_id)
    controller.robots.charge = np.array([0.04, 0.14, 0.16, 1.0], np.float32)
    assert controller.transports.charging.kept().tolist() == [True, True, False, False]
    controller.close()


def test_a_threshold_is_one():
    with pytest.raises(ValueError, match="low is 0.9 and high 0.3"):
        Threshold(low=0.9, high=0.3)


def shift(policy=None, **realism):
    """(units delivered, least charge, the driver) of `medium` with all stations busy."""
    world = World.preset("medium", realism=realism)
    driver = FleetDriver(world)
    if policy:
        driver.transports.charging.policy = policy
    demand = RandomTransports(driver.transports, 1, exchange=10)
    least, counted = 1.0, 0
    while world.time < 60 * (MINUTES + 1):
        driver.step()
        demand.advance(world.time, driver.transports.take_events())
        least = min(least, float(world.fleet.charge.min()))
        if world.time < 60:
            counted = driver.transports.totals.delivered
    driver.close()
    assert driver.collisions == 0
    return driver.transports.totals.delivered - counted, least, driver


@pytest.fixture(scope="module")
def ideal():
    """What is delivered where batteries are not simulated."""
    return shift()[0]


@pytest.mark.parametrize("policy", [Threshold, Opportunity])
def test_little_throughput_is_lost_to_charging(ideal, policy):
    delivered, least, driver = shift(policy(), energy=SMALL)
    charging = driver.transports.charging.robot_s / driver.failures.robot_s
    print(ideal, delivered, least, charging)
    assert driver.failures.total == 0  # no battery was empty
    assert 0 < least < 0.5
    assert charging > 0.01
    assert delivered >= KEPT * ideal
