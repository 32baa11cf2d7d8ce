# SPDX-License-Identifier: Apache-2.0
# Written by scripts/message_enums from the messages of warehouse_msgs.
"""The constants of messages, for programs without ROS."""

from enum import IntEnum


class Status(IntEnum):
    """The status of a robot."""

    IDLE = 0
    BUSY = 1
    BLOCKED = 2


class State(IntEnum):
    """The activity of a robot."""

    IDLE = 0
    MOVING_X = 1
    MOVING_Y = 2
    ROTATING = 3
    LIFTING = 4
    BLOCKED = 5
    WAITING = 6  # at the last released point of its path


class EventKind(IntEnum):
    """The kinds of events."""

    ACCEPTED = 0
    REFUSED = 1
    DONE = 2
    BLOCKED = 3
    LIFTED = 4
    DROPPED = 5
    COLLISION = 6
    SPAWNED = 7
    DELETED = 8
    LOST = 9  # a robot no longer knows where it is, and stops
    FAILED = 10  # something in a robot is broken
    REPAIRED = 11
    TIPPED = 12  # a storage unit tipped off the robot that carried it
    FELL = 13  # an item fell off its storage unit (other)
    PICKED_UP = 14  # an item that fell is back on its storage unit (other)
