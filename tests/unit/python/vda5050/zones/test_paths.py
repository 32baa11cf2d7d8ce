# SPDX-License-Identifier: Apache-2.0
"""Planned and intermediate paths of 3.0.0 (6.8)."""

import json
import math

import pytest
from grid_robot import is_over, pick, row
from official_schemas import validator_of
from test_zones import ZoneBench, release

from warehouse_vda5050.codec import codec_for
from warehouse_vda5050.master.frame import Frame
from warehouse_vda5050.master.vehicle_view import VehicleView
from warehouse_vda5050.paths import Motion, Trajectory, fault_of, sampled, straight, waypoints
from warehouse_vda5050.topics import Kind
from warehouse_vda5050.validation import MessageError

CODEC = codec_for("3.0.0")
KIVA = Motion(1.5, 1.0, 1.0, 0.625)
TURN = [*row(0, 4), (4, 1), (4, 2)]


def test_the_planned_path_covers_the_base_from_where_the_robot_is():
    bench = ZoneBench()
    bench.order("o", TURN, released=6)
    state = bench.tick(2)
    x, y = map(float, bench.robot.cell)
    assert state.planned.trajectory.points == ((x, y), (4.0, 0.0), (4.0, 1.0))
    assert state.planned.nodes == tuple(node.id for node in state.nodes if node.released)
    value = CODEC.to_json(state)
    validator_of(Kind.STATE, "3.0.0").validate(value)
    back = CODEC.decode(Kind.STATE, json.dumps(value).encode())
    assert back.message.planned == state.planned and not back.unknown
    assert [p.x for p in back.message.intermediate] == [p.x for p in state.intermediate]


def test_a_vehicle_without_a_way_says_none():
    bench = ZoneBench()
    assert "plannedPath" not in CODEC.to_json(bench.tick())
    bench.order("o", row(0, 3))
    value = CODEC.to_json(bench.until(is_over))
    assert "plannedPath" not in value and "intermediatePath" not in value


def test_versions_before_have_no_paths():
    bench = ZoneBench()
    bench.order("o", row(0, 3))
    assert "plannedPath" not in codec_for("2.1.0").to_json(bench.vehicle.state())


def test_the_intermediate_path_ends_where_the_robot_stops_next():
    bench = ZoneBench(release(6), units={"7": (3, 0)})
    bench.order("o", row(0, 9), actions={3: [pick()]})
    assert bench.vehicle.state().intermediate[-1].x == 3.0
    state = bench.until(lambda s: s.last_node == "c4_0")
    assert state.intermediate[-1].x == 5.0  # before the zone
    state = bench.instant("startPause", "pause")
    assert state.planned and not state.intermediate


def test_arrivals_are_estimated_by_a_trapezoid_and_quarter_turns():
    way = waypoints([(0.0, 0.0), (3.0, 0.0), (3.0, 3.0)], [math.inf] * 2, 0.0, 0.0, KIVA, 100.0)
    assert [round(point.eta, 3) for point in way] == [100.0, 103.5, 107.625]
    assert way[-1].theta == pytest.approx(math.pi / 2)
    (_, end) = waypoints([(0.0, 0.0), (0.25, 0.0)], [math.inf], 0.0, 0.0, KIVA, 0.0)
    assert end.eta == pytest.approx(1.0)


def test_a_curve_of_three_degrees_is_sampled():
    """A quarter of a circle is a NURBS of degree 2, exactly."""
    weights = (1.0, math.sqrt(0.5), 1.0)
    arc = Trajectory(2, (0, 0, 0, 1, 1, 1), ((1, 0), (1, 1), (0, 1)), weights)
    points = sampled(arc)
    assert len(points) == 9 and points[-1] == pytest.approx((0, 1))
    assert all(math.hypot(*point) == pytest.approx(1.0) for point in points)


def test_a_straight_path_is_a_curve():
    curve = straight([(0, 0), (1, 0), (1, 1)])
    assert curve.knots == (0.0, 0.0, 0.5, 1.0, 1.0) and not fault_of(curve)


@pytest.mark.parametrize(
    "path,text",
    [
        ({"controlPoints": [{"x": 0, "y": 0}]}, "1 control points"),
        ({"controlPoints": [{"x": 0, "y": 0}] * 3, "knotVector": [0, 1]}, "2 knots"),
        ({"controlPoints": [{"x": 0, "y": 0}] * 2, "knotVector": [0, 0.9, 0.1, 1]}, "smaller"),
        ({"controlPoints": [{"x": 0, "y": 0}] * 2, "knotVector": [0, 0, 1, "a"]}, "no list"),
        ({"controlPoints": [{"x": 0, "y": 0, "weight": 0}] * 2}, "weight is not above 0"),
    ],
)
def test_a_path_that_is_no_curve_is_refused(path, text):
    value = CODEC.to_json(ZoneBench().tick())
    value["plannedPath"] = {"trajectory": path}
    with pytest.raises(MessageError, match=text):
        CODEC.decode(Kind.STATE, json.dumps(value).encode())


def test_the_master_has_the_path_where_the_floor_is():
    bench = ZoneBench()
    bench.order("o", row(0, 3))
    view = VehicleView(Frame(10.0, 5.0, math.pi / 2))
    view.take_state(bench.vehicle.state(), 1.0)
    assert view.planned_path[-1] == pytest.approx((10.0, 8.0))
