# SPDX-License-Identifier: Apache-2.0
# Written by scripts/message_enums from the messages of warehouse_msgs.
"""The constants of messages, for programs without ROS."""

from enum import IntEnum


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


class Mode(IntEnum):
    """Whether a station works by itself or waits for a person."""

    AUTOMATIC = 0
    MANUAL = 1  # it waits for /warehouse/confirm_pick


class Outcome(IntEnum):
    """How a person's task at a station ended."""

    DONE = 0  # so many pieces were taken, or a bundle of so many was put in
    SHORT = 1  # so many pieces are missing; at a picking station 0: the bin is empty
    DAMAGED = 2  # so many pieces are damaged
