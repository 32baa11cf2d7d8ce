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
    WAITING = 6  # stands at the last released point of its path
    STEERED = 7  # is driven by /kiva<id>/cmd_vel


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


class FailureKind(IntEnum):
    """The failures of a robot."""

    REPAIRED = 0  # nothing is broken in it any more
    MOTOR = 1  # the drive has no torque, and its brakes close: it stands where it can
    LIFT_STUCK = 2  # the tower stands wherever it is
    LASER_BLIND = 3  # no scans, and the robot stands, since it does not see people
    RADIO_LOST = 4  # it hears and reports nothing; it completes the commands that it has
    WHEEL_SLIPS = 5  # less grip: it turns and brakes as that allows


class RobotMode(IntEnum):
    """Which side commands a robot."""

    AUTOMATIC = 0  # the coordinator
    MANUAL = 1  # a person; others drive around it
    OUT_OF_SERVICE = 2  # no one; the robot is an obstacle


class TransportEventKind(IntEnum):
    """What happened to a transport."""

    RECEIVED = 0
    ASSIGNED = 1  # a robot is on its way to the unit
    LIFTED = 2
    ARRIVED = 3  # at the station, or the cell; waits to be released
    RELEASED = 4
    STORED = 5  # the unit stands again; the transport is over
    FAILED = 6  # it is over, and the text says why
    CANCELLED = 7  # a unit that was lifted already is stored again


class Then(IntEnum):
    """What becomes of a unit after its transport."""

    STORE = 0
    STAY = 1


class OrderState(IntEnum):
    """The state of an order."""

    OPEN = 0  # no station has it
    ASSIGNED = 1
    COMPLETED = 2
    CANCELLED = 3


class OrderEventKind(IntEnum):
    """What happened to an order."""

    RECEIVED = 0
    ASSIGNED = 1  # a station works at it
    PICKED = 2  # quantity pieces of sku, from unit shelf_id at station
    COMPLETED = 3
    CANCELLED = 4
    SHORT = 5  # pieces of sku are not there; text says why
    UNPICKED = 6  # quantity pieces of sku that were PICKED lie in their bin again
    REOPENED = 7  # after COMPLETED: a person took the last piece back
    CHANGED = 8  # priority or due time; text says to what


class StationMode(IntEnum):
    """Whether a station works by itself or waits for a person."""

    AUTOMATIC = 0
    MANUAL = 1  # it waits for /warehouse/confirm_pick


class PickOutcome(IntEnum):
    """How a person's task at a station ended."""

    DONE = 0  # so many pieces were taken, or a bundle of so many was put in
    SHORT = 1  # so many pieces are missing; at a picking station 0: the bin is empty
    DAMAGED = 2  # so many pieces are damaged
