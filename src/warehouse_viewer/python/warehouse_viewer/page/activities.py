# SPDX-License-Identifier: Apache-2.0
"""What robots do at a glance: five activities, each with a colour, the same in list, floor, panels,
pictures and API. words.js and design.css have them for the page."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from enum import IntEnum
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from warehouse_layout.message_enums import EventKind, State, Status

if TYPE_CHECKING:
    from warehouse_msgs.msg import CoordinatorState, FleetState


class Activity(IntEnum):
    """What a robot does, from what needs no attention to what needs a person."""

    RESTING = 0  # without command and load
    MOVING = 1  # drives, turns, or waits for its turn for a moment
    WORKING = 2  # lifts, or stands with a storage unit: at a station, as a rule
    WAITING = 3  # for too long, or before an obstacle
    NEEDS_HELP = 4  # broken, or its last command ended before an obstacle


TOO_LONG = 30.0  # to wait [s, simulated]
QUEUED_TOO_LONG = 120.0  # to stand in the queue of a station, while a unit is served [s, simulated]
IN_QUEUE = "in the queue of "  # how the coordinator's reason begins there
FAULTY = ", which is "  # how it says that the queue has a robot that does not drive


def shown_status(fleet: FleetState) -> np.ndarray:
    """Returns the status of each robot in a FleetState, (n,) uint8.

    BLOCKED itself lasts only a moment; it shows until the robot's next command is accepted.
    """
    # rospy reads uint8[] as bytes.
    status = _bytes(fleet.status).copy()
    status[_bytes(fleet.last_end) == EventKind.BLOCKED] = Status.BLOCKED
    return status


def wait_too_long(coordinator: CoordinatorState | None) -> list[int]:
    """Returns the numbers of the robots that wait for too long, by a CoordinatorState or None.

    A robot in the queue of a station stands while units before it are served: it waits for too
    long from QUEUED_TOO_LONG for each of them on, others from TOO_LONG on.
    """
    if coordinator is None:
        return []
    texts = list(coordinator.waiting_text) or [""] * len(coordinator.waiting_kiva)
    before = dict(zip(coordinator.waiting_kiva, coordinator.waiting_for))
    waits = zip(coordinator.waiting_kiva, coordinator.waiting_since, texts)
    now = coordinator.header.stamp.to_sec()
    return [robot for robot, since, text in waits if now - since >= _explained(robot, text, before)]


def _explained(robot: int, text: str, before: Mapping[int, int]) -> float:
    """Returns how long a robot may wait for its reason [s]; `before`: the robot ahead of each."""
    if not text.startswith(IN_QUEUE) or FAULTY in text:
        return TOO_LONG
    place, passed = 0, {0}
    while robot not in passed:
        passed.add(robot)
        robot, place = before.get(robot, 0), place + 1
    return QUEUED_TOO_LONG * max(1, place - 1)


def activity(fleet: FleetState, waiting: Collection[int] = ()) -> np.ndarray:
    """Returns the Activity of each robot in a FleetState, (n,) uint8.

    `waiting` are the numbers of robots that wait for too long; see wait_too_long().
    """
    status, state = shown_status(fleet), _bytes(fleet.state)
    out = np.full(len(status), Activity.MOVING, np.uint8)
    idle = status == Status.IDLE
    out[idle] = np.where(np.asarray(fleet.shelf_id) != 0, Activity.WORKING, Activity.RESTING)[idle]
    out[state == State.LIFTING] = Activity.WORKING
    out[(state == State.BLOCKED) | np.isin(fleet.kiva_id, list(waiting))] = Activity.WAITING
    out[(status == Status.BLOCKED) | (_bytes(fleet.failures) != 0)] = Activity.NEEDS_HELP
    return out


def _bytes(field: ArrayLike | bytes) -> np.ndarray:
    """(n,) uint8 of a message's uint8[]."""
    return np.frombuffer(bytes(field), np.uint8)
