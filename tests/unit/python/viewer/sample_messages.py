# SPDX-License-Identifier: Apache-2.0
"""Messages of a small world, and the model of a page that takes them."""

import math

import numpy as np
import rospy
from std_msgs.msg import Header

from warehouse_msgs.msg import (
    CoordinatorState,
    FleetState,
    Look,
    Scenery,
    UnitStates,
    WarehouseObjects,
)
from warehouse_viewer.page.model import Model


def coordinator_state(stamp=1.0, **fields):
    return CoordinatorState(header=Header(stamp=rospy.Time(stamp)), **fields)


def fleet(x=(0.0, 1.0), vx=(0.0, 0.0), yaw=(0.0, 0.0), shelf=(0, 0), stamp=1.0, ended=(), limit=()):
    n = len(x)
    return FleetState(
        rospy.Time(stamp),
        [1, 2][:n],
        list(x),
        [0.0] * n,
        list(yaw),
        list(vx),
        [0.0] * n,
        [0.0] * n,
        bytes(n),
        bytes(n),
        list(shelf),
        *[[0] * n] * 3,  # of paths
        bytes(ended) or bytes(n),
        bytes(n),
        [1.0] * n,  # charge
        list(limit),
        bytes(n),  # mode
        1,  # timeline
    )


def objects(items=1):
    out = WarehouseObjects(revision=1, storage_units=["storage_unit1"], kiva_id=[1, 2])
    out.items = [f"item{i + 1}" for i in range(items)]
    out.item_unit = [0] * items
    out.item_pose = [0, 0, 0.46, 0, 0, 0, 1] * items
    return out


def states(x=5.0, z=0.0, yaw=0.0, carrier=0):
    pose = [x, 0, z, 0, 0, math.sin(yaw / 2), math.cos(yaw / 2)]
    return UnitStates(revision=1, pose=pose, carrier=[carrier])


def scenery(x=9.0):
    look = Look(links=["body"], link_pose=[0, 0, 0, 0, 0, 0, 1])
    look.shape_link, look.shape_kind = [0], bytes([Look.BOX])
    look.shape_pose, look.shape_size = [0, 0, 0.5, 0, 0, 0, 1], [1, 1, 1]
    look.shape_colour = [1, 0, 0, 1]
    out = Scenery(floor=[-1, 1, -2, 2], grid_spacing=1.0, looks=[look], models=["wall1"])
    out.model_look, out.pose = [0], [x, 0, 0, 0, 0, 0, 1]
    return out


class World:
    """The newest messages, of which some are replaced at each turn."""

    def __init__(self):
        self.now = 100.0  # [s, wall]
        self.model = Model(clock=lambda: self.now)
        self.messages = {
            "objects": objects(),
            "states": states(),
            "fleet": fleet(),
            "scenery": scenery(),
        }

    def turn(self, **messages):
        self.messages |= messages
        return self.model.update(**self.messages)


def rows(update):
    """Row counts of an update: robots, units, loose items, scenery."""
    return np.frombuffer(update, "<u4", 4, 20).tolist()
