# SPDX-License-Identifier: Apache-2.0
"""Planned and intermediate paths in the JSON of 3.0.0."""

import datetime
from typing import Any

from warehouse_vda5050.headers import iso
from warehouse_vda5050.model import VehicleState
from warehouse_vda5050.paths import PlannedPath, Trajectory, Waypoint, fault_of
from warehouse_vda5050.validation import MessageError
from warehouse_vda5050.validation.fields import Fields


def paths_json(state: VehicleState) -> dict[str, Any]:
    """Returns the fields of a state that say where the vehicle will drive; none if it stands."""
    value: dict[str, Any] = {}
    if state.planned:
        trajectory = _trajectory_json(state.planned.trajectory)
        nodes = [*state.planned.nodes]
        value["plannedPath"] = {"trajectory": trajectory, "traversedNodes": nodes}
    if state.intermediate:
        rows = [_waypoint_json(point) for point in state.intermediate]
        value["intermediatePath"] = {"polyline": rows}
    return value


def _trajectory_json(curve: Trajectory) -> dict[str, Any]:
    return {
        "degree": curve.degree,
        "knotVector": [*curve.knots],
        "controlPoints": [
            {"x": x, "y": y, "weight": weight}
            for (x, y), weight in zip(curve.points, curve.weights)
        ],
    }


def _waypoint_json(point: Waypoint) -> dict[str, Any]:
    heading = {} if point.theta is None else {"theta": point.theta}
    return {"x": point.x, "y": point.y, **heading, "eta": iso(point.eta)}


def read_planned(fields: Fields | None) -> PlannedPath | None:
    """Returns a planned path; None stands for none. Raises MessageError."""
    curve = fields.object("trajectory") if fields else None
    if fields is None or curve is None:
        return None
    nodes = fields.any("traversedNodes", [])
    names = tuple(str(node) for node in nodes) if isinstance(nodes, list) else ()
    return PlannedPath(_read_trajectory(curve), names)


def _read_trajectory(fields: Fields) -> Trajectory:
    rows = fields.objects("controlPoints")
    points = tuple((row.number("x"), row.number("y")) for row in rows)
    weights = tuple(row.number("weight", 1.0) for row in rows)
    degree = fields.natural("degree", 1)
    knots = _read_knots(fields, len(points), degree)
    curve = Trajectory(degree, knots, points, weights)
    if why := fault_of(curve):
        raise MessageError(f"{fields.path_of('controlPoints')}: {why}")
    return curve


def _read_knots(fields: Fields, count: int, degree: int) -> tuple[float, ...]:
    """Returns the knots; without any they are even, with the ends in the first and last point."""
    values = fields.any("knotVector", None)
    if values is None:
        pieces = max(1, count - degree)
        inner = [k / pieces for k in range(pieces + 1)]
        return (*[0.0] * degree, *inner, *[1.0] * degree)
    numbers = values if isinstance(values, list) else []
    if not numbers or not all(type(n) in (int, float) and 0 <= n <= 1 for n in numbers):
        raise MessageError(f"{fields.path_of('knotVector')} is no list of numbers in 0 to 1")
    return tuple(map(float, numbers))


def read_intermediate(fields: Fields | None) -> tuple[Waypoint, ...]:
    """Returns the waypoints of an intermediate path. Raises MessageError."""
    return tuple(map(_read_waypoint, fields.objects("polyline"))) if fields else ()


def _read_waypoint(fields: Fields) -> Waypoint:
    text = fields.text("eta")
    try:
        eta = datetime.datetime.fromisoformat(text)
    except ValueError:
        where = fields.path_of("eta")
        raise MessageError(f"{where} is {text[:60]!r}; a time of ISO 8601 was expected") from None
    eta = eta if eta.tzinfo else eta.replace(tzinfo=datetime.UTC)
    theta = fields.number("theta", None)
    return Waypoint(fields.number("x"), fields.number("y"), eta.timestamp(), theta)
