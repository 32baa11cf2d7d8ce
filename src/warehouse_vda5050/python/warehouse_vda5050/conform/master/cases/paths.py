# SPDX-License-Identifier: Apache-2.0
"""Planned and intermediate paths of vehicles (3.0.0: 6.8): a master reads them, or not, without
harm."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from typing import Any

from warehouse_vda5050.conform.case import Chapter
from warehouse_vda5050.conform.master.actor import Actor
from warehouse_vda5050.conform.master.cases.states import demand_sound
from warehouse_vda5050.conform.master.stage import Stage
from warehouse_vda5050.topics import Kind

chapter = Chapter("paths")
case = chapter.case
Json = dict[str, Any]
ONLY = ("3.0.0",)
ETA = "2030-01-01T00:00:00.000Z"
WAYPOINTS = 300
# Trajectories that are none: no points, too high a degree, knots that fall, no numbers.
SPOILT: tuple[Json, ...] = (
    {"degree": 1, "controlPoints": []},
    {"degree": 9, "knotVector": [0, 0, 1, 1], "controlPoints": [{"x": 0, "y": 0}]},
    {"degree": 1, "knotVector": [1, 0, 0], "controlPoints": [{"x": 0, "y": 0}, {"x": 1, "y": 0}]},
    {"degree": -1, "controlPoints": [{"x": "here", "y": None}, {"x": 1e308, "y": 1e308}]},
    {"controlPoints": 3},
)


def _bent(x: float, y: float) -> Json:
    """Returns a curve of the third degree with weights, which leads from a place back to it."""
    points = [(x, y, 1.0), (x + 2, y, 0.5), (x, y + 2, 2.0), (x, y, 1.0)]
    rows = [{"x": px, "y": py, "weight": weight} for px, py, weight in points]
    return {"degree": 3, "knotVector": [0, 0, 0, 0, 1, 1, 1, 1], "controlPoints": rows}


def _drive(stage: Stage, path_of: Callable[[float, float], Json]) -> None:
    """Has vehicles report paths for a time, and demands that orders come and fit all the same."""
    stage.idle()
    for actor in stage.actors:
        actor.link.edits[Kind.STATE] = _adding(actor, path_of)
    stage.wait(stage.settings.reaction)
    mark = stage.mark
    stage.an_order(mark)
    stage.wait(2 * stage.settings.watch)
    demand_sound(stage, mark)


def _adding(actor: Actor, path_of: Callable[[float, float], Json]) -> Callable[[Json], None]:
    def edit(state: Json) -> None:
        state.update(path_of(actor.robot.x, actor.robot.y))

    return edit


@case("curve", "6.8", versions=ONLY)
def curve(stage: Stage) -> None:
    """A plannedPath may be any curve, also off the order's nodes: orders come as before."""

    def path(x: float, y: float) -> Json:
        return {"plannedPath": {"trajectory": _bent(x, y), "traversedNodes": []}}

    _drive(stage, path)


@case("nodes", "6.8", versions=ONLY)
def nodes(stage: Stage) -> None:
    """A plannedPath may name nodes in traversedNodes that no order has: the order stays."""

    def path(x: float, y: float) -> Json:
        names = [f"conform_{k}" for k in range(20)]
        return {"plannedPath": {"trajectory": _bent(x, y), "traversedNodes": names}}

    _drive(stage, path)


@case("intermediate", "6.8", versions=ONLY)
def intermediate(stage: Stage) -> None:
    """An intermediatePath of many waypoints is read as any state."""

    def path(x: float, y: float) -> Json:
        turns = [k / WAYPOINTS * math.tau for k in range(WAYPOINTS)]
        rows = [
            {"x": x + math.sin(t), "y": y + math.cos(t) - 1, "theta": 0.0, "eta": ETA}
            for t in turns
        ]
        return {"intermediatePath": {"polyline": rows}}

    _drive(stage, path)


@case("spoilt", "6.8", versions=ONLY)
def spoilt(stage: Stage) -> None:
    """A plannedPath that is no curve does not stop the master: orders come again after it."""
    actor = stage.idle()
    for trajectory in SPOILT:
        _send(actor, {"trajectory": trajectory, "traversedNodes": [3, None]})
    stage.wait(1.0)
    actor.vehicle.request_state()
    stage.an_order(stage.mark, actor)


def _send(actor: Actor, path: Json) -> None:
    """Sends a copy of the vehicle's state with a path that it does not drive."""
    payload = actor.link.state_payload()
    value = json.loads(payload)
    value["plannedPath"] = path
    value["intermediatePath"] = {"polyline": [{"x": 0.0, "y": "there", "eta": "soon"}]}
    actor.link.send_raw(Kind.STATE, json.dumps(value).encode())
