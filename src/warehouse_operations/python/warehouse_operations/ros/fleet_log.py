# SPDX-License-Identifier: Apache-2.0
"""A log of the robots of a running warehouse since a run began."""

import numpy as np

from warehouse_fleet.robots.failures import FailureLog
from warehouse_fleet.traffic.people import PeopleLog
from warehouse_msgs.msg import FleetState, KivaStatus, People
from warehouse_operations.fleets.floor_heat import FloorHeat

WAITS = (KivaStatus.STATE_WAITING, KivaStatus.STATE_BLOCKED)  # robots under way
JUMP = 1.0  # a longer move between two messages is a teleport, not a drive [m]


class FleetLog:
    """Counts from FleetState messages.

    distance_m: driven by all robots. heat: the FloorHeat to which they are added, or None.
    failures, people: logs of both.
    """

    def __init__(self, heat: FloorHeat | None = None) -> None:
        self.begin(heat)

    def begin(self, heat: FloorHeat | None) -> None:
        """Counts from now on, into `heat`."""
        self.distance_m, self.heat = 0.0, heat
        self.failures, self.people = FailureLog(), PeopleLog()

    def update(self, before: FleetState | None, fleet: FleetState, people: People) -> None:
        """Adds the time between two messages; before: None of the first."""
        if before and before.kiva_id == fleet.kiva_id:
            dx, dy = np.subtract(fleet.x, before.x), np.subtract(fleet.y, before.y)
            moved = np.hypot(dx, dy)
            self.distance_m += float(moved[moved < JUMP].sum())
        now = fleet.stamp.to_sec()
        self.failures.update(now, np.frombuffer(fleet.failures, np.uint8))
        self.people.update(now, people, len(fleet.kiva_id))
        if self.heat:
            waits = np.isin(np.frombuffer(bytes(fleet.state), np.uint8), WAITS)
            self.heat.update(now, fleet.x, fleet.y, waits)
