# SPDX-License-Identifier: Apache-2.0
"""Fleets at work for ten minutes each, nothing goes wrong: no robot touches
another, blocks or waits in vain.

SOAK_SEEDS=20 runs that many seeds of each layout (make test-long); by default none are.
"""

import os

import pytest

from kiva_plugin_cpp import World
from warehouse_fleet.hosts.fleet_driver import FleetDriver
from warehouse_fleet.hosts.random_transports import RandomTransports

SEEDS = range(1, 1 + int(os.environ.get("SOAK_SEEDS", "0")))
LAYOUTS = ("medium", "large", "huge")  # 20, 100 and 1,000 robots
MINUTES = 10
EXCHANGE = {"medium": 10.0}  # [s] from one unit to the next at a station


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("seed", SEEDS)
def test_ten_minutes_are_clean(layout, seed):
    driver = FleetDriver(World.preset(layout, seed=seed), seed=seed)
    demand = RandomTransports(driver.transports, seed, EXCHANGE.get(layout, 20.0))
    try:
        while driver.time < 60 * MINUTES:
            driver.step()
            demand.advance(driver.time, driver.transports.take_events())
    finally:
        driver.close()
    totals = driver.transports.totals
    counts = (driver.collisions, driver.blocked, driver.watchdog, totals.failed)
    assert counts == (0, 0, 0, 0), "contacts, blocked, watchdog, failed"
    assert driver.refusals == []
    assert totals.delivered > len(driver.traffic.robots.kiva_ids) / 2
