# SPDX-License-Identifier: Apache-2.0
"""The boxes of all models in the running world, from the messages for its display."""

import time
from typing import Any

import numpy as np
from rospy.numpy_msg import numpy_msg

from warehouse_client import tracking
from warehouse_client.latest import LatestMessages
from warehouse_layout.floor import poses
from warehouse_layout.models.overlaps import Boxes
from warehouse_msgs.msg import FleetState, Scenery, UnitStates, WarehouseObjects

PATIENCE = 10.0  # for latched messages [s, wall]
FLAT = 0.01  # height below which a shape is paint or floor [m]


class StandingError(RuntimeError):
    """Raised where the world does not publish its models."""


def boxes(ros: Any) -> Boxes:
    """Returns the boxes of robots, storage units and other models. Raises StandingError.

    `ros` is rospy.
    """
    messages = LatestMessages(
        ros,
        scenery=("warehouse/scenery", Scenery),
        fleet=("warehouse/fleet", numpy_msg(FleetState)),
        objects=("warehouse/objects", numpy_msg(WarehouseObjects)),
        states=("warehouse/unit_states", numpy_msg(UnitStates)),
    )
    end = time.monotonic() + PATIENCE
    while not (messages["scenery"] and messages["fleet"] and messages.units_and_objects):
        if time.monotonic() > end:
            raise StandingError("the world does not publish what stands in it")
        messages.wait(0.1)
    units = tracking.storage_units(*messages.units_and_objects)
    return of_messages(messages["scenery"], messages["fleet"], units)


def of_messages(scenery: Any, fleet: Any, units: tracking.Tracked) -> Boxes:
    """Returns the boxes of robots, storage units and other models in these messages."""
    robots = [f"kiva{number}" for number in fleet.kiva_id]
    at = np.array([poses.planar(*p) for p in zip(fleet.x, fleet.y, fleet.yaw)]).reshape(-1, 7)
    out = _of_look(scenery, scenery.kiva_look, robots, at)
    out += _of_look(scenery, scenery.storage_unit_look, units.names, units.pose)
    frames = poses.rows(scenery.pose)
    for look in sorted({*scenery.model_look}):
        rows = np.flatnonzero(np.asarray(scenery.model_look) == look)
        names = [scenery.models[row] for row in rows]
        out += _of_look(scenery, look, names, frames[rows])
    return out


def _of_look(scenery: Any, look: int, names: list[str], frames: np.ndarray) -> Boxes:
    out = Boxes([], np.zeros((0, 2)), np.zeros((0, 2)), np.zeros(0), np.zeros((0, 2)))
    if look < 0 or not names:
        return out
    chosen = scenery.looks[look]
    links, shapes = poses.rows(chosen.link_pose), poses.rows(chosen.shape_pose)
    sizes = np.reshape(chosen.shape_size, (-1, 3))
    for link, shape, size in zip(chosen.shape_link, shapes, sizes):
        if size[2] > FLAT:
            within = poses.compose(links[link][None], shape[None])[0]
            out += Boxes.of_shapes(list(names), frames, within, size)
    return out
