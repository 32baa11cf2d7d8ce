# SPDX-License-Identifier: Apache-2.0
"""The status of robots as a person shall see it."""

import numpy as np

BLOCKED = 2  # as KivaStatus says it
ENDED_BLOCKED = 3  # as Event does


def shown_status(fleet):
    """The status of each robot in a FleetState, (n,) uint8.

    BLOCKED itself lasts but a moment; it shows until the robot's next command is accepted.
    """
    # rospy reads uint8[] as bytes.
    status = np.frombuffer(bytes(fleet.status), np.uint8).copy()
    status[np.frombuffer(bytes(fleet.last_end), np.uint8) == ENDED_BLOCKED] = BLOCKED
    return status
