# SPDX-License-Identifier: Apache-2.0
"""What robots do, as a person shall see it."""

from typing import Any

import numpy as np

from warehouse_viewer.message_enums import EventKind, Status

HOLDING = 3  # beside those of Status: the robot carries a storage unit, and has no command


def shown_status(fleet: Any) -> np.ndarray:
    """Returns the status of each robot in a FleetState, (n,) uint8.

    BLOCKED itself lasts only a moment; it shows until the robot's next command is accepted.
    """
    # rospy reads uint8[] as bytes.
    status = np.frombuffer(bytes(fleet.status), np.uint8).copy()
    status[np.frombuffer(bytes(fleet.last_end), np.uint8) == EventKind.BLOCKED] = Status.BLOCKED
    return status


def activity(fleet: Any) -> np.ndarray:
    """Returns what each robot in a FleetState does, (n,) uint8: its shown_status(), or HOLDING.

    A robot that carries a storage unit is at work, even while it would take a command.
    """
    out = shown_status(fleet)
    out[(out == Status.IDLE) & (np.asarray(fleet.shelf_id) != 0)] = HOLDING
    return out
