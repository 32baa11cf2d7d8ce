# SPDX-License-Identifier: Apache-2.0
"""How fast a vehicle drives, by its own reports of velocity or by its successive positions."""

import math
from dataclasses import dataclass

from warehouse_vda5050.master.frame import Pose
from warehouse_vda5050.master.whereabouts import FASTEST
from warehouse_vda5050.model import VehicleState

TRUSTED = 3.0  # age up to which a velocity is believed [s]
SHORTEST = 0.05  # least time between two positions that tell a speed [s]
SETS_OFF = 1.5  # for which a vehicle that begins to drive counts as moving without a speed [s]
CREEP = 0.02  # its speed meanwhile: just more than a standstill [m/s]
Twist = tuple[float, float, float]  # vx, vy [m/s], yaw rate [rad/s], in the frame world
REST: Twist = (0.0, 0.0, 0.0)


@dataclass
class Speedometer:
    """The velocity of one vehicle in the frame world. Times are wall clock [s] of any zero."""

    fastest: float = FASTEST  # that it drives [m/s]
    _twist: Twist = REST
    _noted_at: float = -math.inf
    _pose: Pose | None = None  # where it was at _posed_at
    _posed_at: float = -math.inf
    _set_off_at: float = -math.inf  # when it began to drive
    _is_driving: bool = False
    _yaw: float = 0.0  # [rad]

    def take(self, state: VehicleState, pose: Pose, now: float) -> None:
        """Notes the state of a vehicle at a pose of the frame world."""
        self._noted_at, self._yaw = now, pose[2]
        if state.driving and not self._is_driving:
            self._set_off_at = now
        self._is_driving = state.driving
        if state.velocity is not None:
            vx, vy, yaw = state.velocity.vx, state.velocity.vy, pose[2]
            c, s = math.cos(yaw), math.sin(yaw)
            self._twist = c * vx - s * vy, s * vx + c * vy, state.velocity.omega
        elif not state.driving:
            self._twist = REST
        elif now - self._posed_at < SHORTEST:
            return  # two events at once: the time between them says nothing
        else:
            self._twist = self._between(pose, now)
        self._pose, self._posed_at = pose, now

    def forget(self) -> None:
        """Begins again, as with a vehicle that comes back."""
        self._twist, self._pose, self._posed_at = REST, None, -math.inf
        self._is_driving = False

    def read(self, now: float) -> Twist:
        """Returns the last velocity, or rest if that is too old. The state that says that a vehicle
        begins to drive has no speed yet, and the next may be a cell away."""
        if now > self._noted_at + TRUSTED:
            return REST
        is_still = math.hypot(*self._twist) < CREEP
        if is_still and self._is_driving and now <= self._set_off_at + SETS_OFF:
            return CREEP * math.cos(self._yaw), CREEP * math.sin(self._yaw), 0.0
        return self._twist

    def _between(self, pose: Pose, now: float) -> Twist:
        """Returns the mean velocity since the last position; rest where it can't have driven so."""
        seconds = now - self._posed_at
        if self._pose is None or seconds > TRUSTED:
            return REST
        vx, vy = ((b - a) / seconds for a, b in zip(self._pose[:2], pose[:2]))
        if math.hypot(vx, vy) > self.fastest:
            return REST
        return vx, vy, math.remainder(pose[2] - self._pose[2], math.tau) / seconds
