# SPDX-License-Identifier: Apache-2.0
"""The topics on which robots take commands."""

from warehouse_msgs.msg import (
    Cancel,
    FleetFollow,
    FollowPath,
    Lift,
    LimitedPath,
    MoveAlong,
    MoveTo,
    Rotate,
    Stop,
)

# The message type of each topic.
COMMANDS = {
    "mov": MoveTo,
    "movx": MoveAlong,
    "movy": MoveAlong,
    "rot": Rotate,
    "lift": Lift,
    "follow": FollowPath,
    "follow_limited": LimitedPath,
    "warehouse/follow": FleetFollow,
    "cancel": Cancel,
    "stop": Stop,
}
