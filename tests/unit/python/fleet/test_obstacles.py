# SPDX-License-Identifier: Apache-2.0
"""Things that stand where some cell has its only way out: robots behind them get out another way, a
unit is taken away by a robot, and a person is told of anything else.
"""

import os

import numpy as np
import pytest
from fault_site import BOX, Site

from kiva_plugin_cpp import World
from warehouse_fleet.transports.obstructions import in_the_way
from warehouse_fleet.transports.transports import Kind
from warehouse_layout.floor import plan_reader
from warehouse_layout.floor.stations import STEPS

FREE = 900  # within which no robot is near a cell [s]
STANDS = 60  # for which something is in the way [s]
FETCHED = 120  # within which a unit is taken away [s]
SAMPLE = {"small": [121], "medium": [270, 274, 208]}
ALL = os.environ.get("OBSTACLES") == "all"


def only_ways_out(size):
    """Cells, ascending, to which the only exit of another cell leads."""
    plan = plan_reader.of_world(World.preset(size))
    aside = (plan.storage | plan.parking | ~plan.passable).ravel()
    ways = set()
    for cell in np.flatnonzero(~aside).tolist():
        y, x = divmod(cell, plan.width)
        ahead = [
            (y + dy) * plan.width + x + dx
            for heading, (dx, dy) in enumerate(STEPS)
            if plan.exits.flat[cell] >> heading & 1
        ]
        ahead = [to for to in ahead if not aside[to]]
        ways.update(ahead if len(ahead) == 1 else [])
    return sorted(ways)


CASES = [(size, cell) for size in SAMPLE for cell in (only_ways_out(size) if ALL else SAMPLE[size])]


@pytest.mark.parametrize(("size", "cell"), CASES)
def test_a_unit_left_behind_is_taken_away(size, cell):
    with Site(size=size) as site:
        robot = site.until(lambda: is_free(site, cell) and site.at_speed(loaded=True), FREE)[0]
        shelf = int(site.world.fleet.shelf_id[robot])
        site.world.delete(site.name(robot))
        site.world.set_pose(f"storage_unit{shelf}", *site.plan.point_of(cell))
        site.events.clear()
        site.until(lambda: site.has_seen(Kind.LIFTED, shelf), FETCHED)
        flows(site)


@pytest.mark.parametrize(("size", "cell"), CASES)
def test_a_person_is_told_of_a_box(size, cell):
    with Site(size=size) as site:
        site.until(lambda: is_free(site, cell), FREE)
        x, y = site.plan.point_of(cell)
        site.world.spawn(BOX, "box", (x, y, 0, 0))
        site.run(STANDS)
        text = f"something stands in the way at ({x:.1f}, {y:.1f}): take it away"
        stuck = site.driver.time - site.traffic.robots.still_since > 30
        assert (
            text in list(in_the_way(site.driver.plan, site.traffic, site.transports.units))
            or not stuck.any()
        )
        site.world.delete("box")
        flows(site)


def is_free(site, cell):
    """Whether no robot is near a cell, or may drive there."""
    fleet, (x, y) = site.world.fleet, site.plan.point_of(cell)
    near = np.maximum(abs(fleet.x - x), abs(fleet.y - y)).min() < 1.4
    return not near and site.traffic.holder(cell) == -1


def flows(site):
    """All robots work again, and nothing was touched."""
    before = site.transports.totals.delivered
    count = len(site.world.fleet.x)
    site.until(lambda: site.transports.totals.delivered >= before + count, 180)
    robots = site.traffic.robots
    assert site.driver.collisions == 0
    assert not robots.stalled.any() and not robots.mode[~robots.gone].any()
    assert (site.driver.time - robots.still_since[robots.busy == 0] < 60).all()
    assert not list(in_the_way(site.driver.plan, site.traffic, site.transports.units))
