# SPDX-License-Identifier: Apache-2.0
"""Where a vehicle says that it will drive, and when it will be there (6.8 of 3.0.0)."""

import math
from collections.abc import Sequence

from warehouse_vda5050.driver import Report
from warehouse_vda5050.grid import Grid
from warehouse_vda5050.model import Factsheet
from warehouse_vda5050.paths import Motion, PlannedPath, Waypoint, corners, straight, waypoints
from warehouse_vda5050.vehicle.actions import holds_at
from warehouse_vda5050.vehicle.progress import OrderProgress

LONGEST = 1000  # points of a path


def planned_path(order: OrderProgress, grid: Grid, report: Report) -> PlannedPath | None:
    """Returns the way from where the robot is to the end of the base; None if it is there."""
    points = corners(_points(order, grid, report, order.base_end))[:LONGEST]
    nodes = tuple(node.id for node in order.nodes[1 : order.base_end + 1])
    return PlannedPath(straight(points), nodes) if len(points) > 1 else None


def intermediate_path(
    order: OrderProgress,
    grid: Grid,
    report: Report,
    sheet: Factsheet,
    limit: int | None,
    speeds: Sequence[float],
    wall: float,
) -> tuple[Waypoint, ...]:
    """Returns when the robot will be at the corners of its way, and where its speed limit changes,
    up to where it stands next: for an action, at a zone that it waits for, at the end of its base.
    Nothing of a robot that is held: when it goes on is not known. speeds: the highest on each edge
    of the base [m/s]. wall: the time [s since 1970]."""
    if report.blocked or report.stopped:
        return ()
    end = order.base_end if limit is None else min(limit, order.base_end)
    stop = next((k for k in range(1, end + 1) if holds_at(order.nodes[k])), end)
    points = _points(order, grid, report, stop)[:LONGEST]
    motion = Motion(
        sheet.max_speed, sheet.max_acceleration, sheet.max_deceleration, sheet.quarter_turn
    )
    yaw = math.remainder(report.yaw, math.tau)
    way = waypoints(points, speeds, yaw, report.speed, motion, wall)
    return tuple(way) if len(way) > 1 else ()


def _points(
    order: OrderProgress, grid: Grid, report: Report, end: int
) -> list[tuple[float, float]]:
    here = (round(report.x, 4), round(report.y, 4))
    return [here, *(grid.position(cell) for cell in order.cells[1 : end + 1])]
