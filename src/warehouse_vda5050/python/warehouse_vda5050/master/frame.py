# SPDX-License-Identifier: Apache-2.0
"""Where a vehicle's own map lies on the warehouse's floor."""

import math
from dataclasses import dataclass

Pose = tuple[float, float, float]  # x, y [m], yaw [rad]


@dataclass(frozen=True)
class Frame:
    """The origin of a vehicle's map, in the frame world: x, y [m] and theta [rad]."""

    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0

    def to_world(self, x: float, y: float, yaw: float = 0.0) -> Pose:
        """Returns the vehicle's report, transformed from its own frame to the frame world."""
        c, s = math.cos(self.theta), math.sin(self.theta)
        return self.x + c * x - s * y, self.y + s * x + c * y, yaw + self.theta

    def to_vehicle(self, x: float, y: float) -> tuple[float, float]:
        """Returns a point of the frame world in the vehicle's own."""
        c, s = math.cos(self.theta), math.sin(self.theta)
        dx, dy = x - self.x, y - self.y
        return c * dx + s * dy, c * dy - s * dx
