# SPDX-License-Identifier: Apache-2.0
"""A rosbag of a fleet in this process, as `rosbag record /warehouse/fleet` makes it."""

import rosbag
import rospy

from warehouse_msgs.msg import FleetState

COLUMNS = ("kiva_id", "x", "y", "yaw", "vx", "vy", "yaw_rate", "status", "state", "shelf_id")
MORE = ("path_id", "failures", "charge")
RATE = 10.0  # [Hz]


def message_of(world):
    """Returns the FleetState of a world."""
    fleet, out = world.fleet, FleetState(stamp=rospy.Time.from_sec(world.time))
    for name in COLUMNS + MORE:
        setattr(out, name, getattr(fleet, name).tolist())
    return out


def record(ops, seconds, path):
    """Steps a shift on, and writes what its fleet does into a bag."""
    with rosbag.Bag(str(path), "w") as bag:
        begin = ops.shift.now
        for count in range(round(seconds * RATE)):
            ops.step_until(begin + (count + 1) / RATE)
            message = message_of(ops.fleet.world)
            bag.write("/warehouse/fleet", message, message.stamp)
