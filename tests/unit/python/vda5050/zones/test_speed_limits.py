# SPDX-License-Identifier: Apache-2.0
"""Speed limits of edges and of zones, which a robot that keeps them drives by; sections are those
of 3.0.0."""

import json
import math

import pytest
from grid_robot import Bench, LimitedRobot, is_over, order, row
from test_zones import ZoneBench, area, types

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.paths import Motion, waypoints
from warehouse_vda5050.topics import Kind
from warehouse_vda5050.zones.zone import Zone, ZoneType

KIVA = Motion(1.5, 1.0, 1.0, 0.625)
ANY = math.inf


class SpeedBench(Bench):
    """A vehicle whose robot keeps speed limits."""

    robot_type = LimitedRobot


class SpeedZoneBench(ZoneBench):
    """The same, with zones."""

    robot_type = LimitedRobot


def limited(cells, speeds, released=None, version="2.1.0", **more):
    """Returns an order with limits of edges, by their number."""
    codec = codec_for(version)
    value = codec.to_json(order("o", cells, released, **more))
    name = "maximumSpeed" if version.startswith("3") else "maxSpeed"
    for number, speed in speeds.items():
        value["edges"][number][name] = speed
    return codec.decode(Kind.ORDER, json.dumps(value).encode()).message


def limits(bench):
    """Returns the limits that the robot has, of those that are finite."""
    return {k: speed for k, speed in bench.robot.limits.items() if math.isfinite(speed)}


def slow(x0, x1, speed):
    """Returns a zone over row 0, from column x0 to x1."""
    return Zone("s", ZoneType.SPEED_LIMIT, area(x0 - 0.1, -0.1, x1 + 0.1, 0.1), speed)


@pytest.mark.parametrize("version", ["2.1.0", "3.0.0"])
def test_the_vehicle_is_given_the_highest_speed_of_each_edge(version):
    bench = SpeedBench()
    assert bench.vehicle.on_order(limited(row(0, 4), {1: 0.2, 2: 0.7}, version=version), 0.0)
    bench.tick()
    assert limits(bench) == {2: 0.2, 3: 0.7}
    bench.until(is_over)
    assert bench.robot.cell == (4, 0)


def test_an_order_without_limits_is_sent_as_ever():
    bench = SpeedBench()
    assert bench.vehicle.on_order(limited(row(0, 3), {0: 1.5, 1: 3.0}), 0.0)
    bench.until(is_over)
    assert not bench.robot.limits


def test_limits_of_an_extended_base_come_with_it():
    bench = SpeedBench()
    assert bench.vehicle.on_order(limited(row(0, 4), {0: 0.5, 3: 0.4}, released=3), 0.0)
    bench.tick()
    assert limits(bench) == {1: 0.5}
    update = limited(row(2, 6), {0: 0.3, 1: 0.4}, update=1, first=2)
    assert bench.vehicle.on_order(update, bench.now)
    bench.tick()
    assert limits(bench) == {1: 0.5, 3: 0.3, 4: 0.4}
    bench.until(is_over)
    assert bench.robot.cell == (6, 0)


@pytest.mark.parametrize("speed", [0, 0.001, -1])
def test_a_limit_that_the_robot_cannot_creep_at_is_refused_by_the_field(speed):
    bench = SpeedBench()
    assert not bench.vehicle.on_order(limited(row(0, 2), {1: speed}), 0.0)
    (error,) = bench.vehicle.state().errors
    assert "maxSpeed" in error.description and "0.01 m/s or more" in error.description


def test_the_factsheet_says_whether_limits_are_driven():
    texts = [
        {name: text for name, _, text in bench.vehicle.sheet.parameters}["order.edges.maxSpeed"]
        for bench in (SpeedBench(), Bench())
    ]
    assert texts[0].startswith("driven") and texts[1].startswith("checked")
    assert "SPEED_LIMIT" in SpeedZoneBench().vehicle.sheet.zone_types
    assert "SPEED_LIMIT" not in ZoneBench().vehicle.sheet.zone_types


def test_the_speed_limit_is_reached_upon_entering_the_zone():
    """6.4.1.1: the contour enters; the robot is 1 m long."""
    bench = SpeedZoneBench(slow(3, 4, 0.3))
    assert bench.order("o", row(0, 6))
    assert limits(bench) == {3: 0.3, 4: 0.3, 5: 0.3}
    bench.until(is_over)
    assert bench.robot.cell == (6, 0)


def test_a_zone_that_comes_while_it_drives_slows_it_down_and_one_that_goes_lets_it_go():
    bench = SpeedZoneBench()
    assert bench.order("o", row(0, 9))
    assert not limits(bench)
    bench.hold(slow(4, 9, 0.3))
    bench.until(lambda _: limits(bench))
    assert set(limits(bench).values()) == {0.3} and max(limits(bench)) == 9
    bench.hold()
    bench.until(lambda _: not any(k > bench.robot.reached for k in limits(bench)))
    bench.until(is_over)


def test_the_lowest_of_the_competing_values_applies():
    """6.4.4."""
    bench = SpeedZoneBench(slow(1, 4, 0.4), Zone("t", ZoneType.SPEED_LIMIT, area(0, 0, 9, 1), 0.6))
    assert bench.vehicle.on_order(limited(row(0, 6), {1: 0.2, 5: 0.9}), bench.now)
    bench.tick()
    assert limits(bench) == {1: 0.4, 2: 0.2, 3: 0.4, 4: 0.4, 5: 0.4, 6: 0.6}


@pytest.mark.parametrize("speed", [0.0, -0.5, 1e-6])
def test_a_zone_that_no_robot_can_creep_through_is_refused_by_its_field(speed):
    bench = SpeedZoneBench()
    bench.hold(slow(1, 2, speed))
    assert ("UNSUPPORTED_PARAMETER", "CRITICAL") in types(bench.vehicle.state())
    assert "maximumSpeed" in bench.vehicle.state().errors[0].description


def test_arrivals_know_the_limits():
    points = [(float(x), 0.0) for x in range(4)]
    (_, first, second, end) = waypoints(points, [ANY, 0.5, ANY], 0.0, 0.0, KIVA, 0.0)
    # Up to a peak and down to 0.5 m/s, 1 m at 0.5 m/s, and up to a peak and down to a stop.
    peak = math.sqrt((2 + 0.25) / 2)
    assert first.eta == pytest.approx(2 * peak - 0.5)
    assert second.eta - first.eta == pytest.approx(2.0)
    assert end.eta - second.eta == pytest.approx(first.eta)
    assert [round(point.x, 6) for point in (first, second, end)] == [1.0, 2.0, 3.0]


def test_the_intermediate_path_of_an_order_with_limits_is_later():
    arrivals = []
    for speeds in ({}, {1: 0.2}):
        bench = SpeedZoneBench()
        assert bench.vehicle.on_order(limited(row(0, 3), speeds), bench.now)
        bench.tick()
        arrivals.append(bench.vehicle.state().intermediate[-1].eta - bench.now)
    assert arrivals[1] > arrivals[0] + 2
