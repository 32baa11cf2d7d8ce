# SPDX-License-Identifier: Apache-2.0
"""A simulated robot as a Driver: commands become messages, messages become reports."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from warehouse_layout.message_enums import FailureKind, RobotMode, State, Status
from warehouse_vda5050.driver import Driver, Point, Report
from warehouse_vda5050.errors import Error, ErrorLevel, ErrorType
from warehouse_vda5050.model import Battery, Factsheet, OperatingMode

MODES = {
    RobotMode.AUTOMATIC: OperatingMode.AUTOMATIC,
    RobotMode.MANUAL: OperatingMode.MANUAL,
    RobotMode.OUT_OF_SERVICE: OperatingMode.SERVICE,
}
MOVING = (State.MOVING_X, State.MOVING_Y, State.ROTATING)
FAILURES = {
    FailureKind.REPAIRED: (ErrorType.BATTERY, ErrorLevel.FATAL, "the battery is empty"),
    FailureKind.MOTOR: (ErrorType.MOTOR, ErrorLevel.FATAL, "the drive has no torque"),
    FailureKind.LIFT_STUCK: (ErrorType.LIFT, ErrorLevel.FATAL, "the lift is stuck"),
    FailureKind.LASER_BLIND: (ErrorType.LASER, ErrorLevel.FATAL, "the laser is blind"),
    FailureKind.WHEEL_SLIPS: (ErrorType.WHEELS, ErrorLevel.WARNING, "the wheels slip"),
}
SETTLING = 1.0  # until the world reports a mode that was set [s, wall]
LOST = Error(
    ErrorType.LOST.value,
    ErrorLevel.FATAL,
    "the robot does not know where it is",
    "a person has to move it to the middle of a cell",
)


@dataclass(frozen=True)
class Sighting:
    """One robot's part of the world's messages: its entries of FleetState, and its failures."""

    x: float
    y: float
    yaw: float
    vx: float
    vy: float
    yaw_rate: float
    status: int
    state: int
    shelf_id: int
    path_id: int
    reached: int
    failures: int
    charge: float  # 0 … 1
    mode: int
    held_by_person: bool = False
    at_charger: bool = False
    lost: bool = False


class World(Protocol):
    """Commands as the world takes them. set_mode() returns why not, or ''."""

    def follow(
        self,
        kiva_id: int,
        path_id: int,
        first: int,
        points: Sequence[Point],
        released: int,
        speeds: Sequence[float] = (),
    ) -> None:
        """Publishes on /warehouse/follow, and on /follow_limited with speeds."""
        ...

    def lift(self, kiva_id: int, shelf_id: int, up: bool) -> None:
        """Publishes on /lift."""
        ...

    def cancel(self, kiva_id: int) -> None:
        """Publishes on /cancel."""
        ...

    def stop(self, kiva_id: int, stopped: bool) -> None:
        """Publishes on /stop."""
        ...

    def set_mode(self, kiva_id: int, mode: int) -> str:
        """Calls /warehouse/set_robot_mode, if there is a coordinator."""
        ...

    def unit_at(self, x: float, y: float) -> int:
        """Returns the number of the storage unit that stands there [m], 0 without one."""
        ...

    def note_taken(self, kiva_id: int, before: int | None) -> None:
        """Keeps beyond the end of this program that a robot was taken, and its mode before; None:
        it was given back."""
        ...

    def taken_before(self, kiva_id: int) -> int | None:
        """Returns the mode before of a robot that was taken and not given back, else None."""
        ...


class SimulatedDriver(Driver):
    """One robot of the running warehouse. `sighting`, `refusal` and `silence`, the reason why the
    world sends nothing, are set from outside."""

    keeps_speeds = True

    def __init__(self, kiva_id: int, world: World, sheet: Factsheet | None = None) -> None:
        self.kiva_id = kiva_id
        self.sighting: Sighting | None = None
        self.refusal = self.silence = ""
        self._world, self._sheet = world, sheet or Factsheet()
        self._taken_from = world.taken_before(kiva_id)  # the mode that it goes back to
        self._gave_back: tuple[int, float] | None = None  # the mode, and when it expires
        self._stopped = False
        self._charged_enough = False  # it was commanded to stop, and still stands there

    def follow(
        self,
        path_id: int,
        first: int,
        points: Sequence[Point],
        released: int,
        speeds: Sequence[float] = (),
    ) -> None:
        """Sends a path, or more of it."""
        self.refusal = ""
        self._world.follow(self.kiva_id, path_id, first, points, released, speeds)

    def lift(self, unit: str, up: bool) -> None:
        """Sends a lift; a unit that is not a number refuses itself."""
        self.refusal = ""
        try:
            shelf_id = int(unit.removeprefix("storage_unit") or 0)
        except ValueError:
            self.refusal = f"loadId is {unit!r}; the number of a storage unit was expected"
            return
        if up and not shelf_id and self.sighting:
            shelf_id = self._world.unit_at(self.sighting.x, self.sighting.y)
        if up and not shelf_id:
            self.refusal = "no storage unit stands here"
            return
        self._world.lift(self.kiva_id, shelf_id, up)

    def cancel(self) -> None:
        """Sends a cancellation."""
        self._world.cancel(self.kiva_id)

    def stop(self, stopped: bool) -> None:
        """Sends a stop, or its end."""
        self._stopped = stopped
        self._world.stop(self.kiva_id, stopped)

    def report(self) -> Report | None:
        """Returns the last report from the world."""
        sighting = self.sighting
        return None if sighting is None else self._report(sighting)

    def _report(self, sighting: Sighting) -> Report:
        blocked = sighting.status == Status.BLOCKED or sighting.state == State.BLOCKED
        standing = abs(sighting.vx) + abs(sighting.vy) + abs(sighting.yaw_rate) < 1e-3
        self._charged_enough &= sighting.at_charger
        charging = sighting.at_charger and standing and not self._charged_enough
        return Report(
            sighting.x,
            sighting.y,
            sighting.yaw,
            sighting.vx,
            sighting.vy,
            sighting.yaw_rate,
            busy=sighting.status != Status.IDLE,
            moving=not standing or (sighting.state in MOVING and not blocked and not self._stopped),
            path_id=sighting.path_id,
            reached=sighting.reached,
            load=str(sighting.shelf_id) if sighting.shelf_id else "",
            refusal=self.refusal,
            blocked=blocked or sighting.held_by_person,
            localized=not sighting.lost,
            heard=not sighting.failures & 1 << FailureKind.RADIO_LOST,
            battery=Battery(100.0 * sighting.charge, charging),
            mode=self._mode(self._reported_mode(sighting)),
            errors=_errors(sighting),
            silent=self.silence,
        )

    def _reported_mode(self, sighting: Sighting) -> int:
        """The mode that the world reports, or will report in a moment."""
        if self._gave_back and time.monotonic() < self._gave_back[1]:
            return self._gave_back[0]
        return sighting.mode

    def _mode(self, mode: int) -> OperatingMode:
        # MANUAL by an order from here is AUTOMATIC to whom the order came from.
        if self._taken_from is not None and mode == RobotMode.MANUAL:
            return MODES[RobotMode.AUTOMATIC]
        return MODES.get(RobotMode(mode), OperatingMode.MANUAL)

    def factsheet(self) -> Factsheet:
        """Returns what all Kivas are."""
        return self._sheet

    def take(self) -> str:
        """Makes the robot MANUAL for the coordinator, if there is one."""
        assert self.sighting
        before = self._reported_mode(self.sighting)
        reason = self._world.set_mode(self.kiva_id, RobotMode.MANUAL)
        if not reason:
            self._taken_from, self._gave_back = before, None
            self._world.note_taken(self.kiva_id, before)
        return reason

    def is_taken(self) -> bool:
        """Returns whether an earlier run took the robot, and ended without a word."""
        return self._taken_from is not None

    def give_back(self) -> None:
        """Makes the robot what it was, unless it was put out of service meanwhile."""
        before, self._taken_from = self._taken_from, None
        sighting = self.sighting
        if before is None:
            return
        if sighting and sighting.mode == RobotMode.MANUAL:
            self._world.set_mode(self.kiva_id, before)
            self._gave_back = before, time.monotonic() + SETTLING
        self._world.note_taken(self.kiva_id, None)

    def charge(self, on: bool) -> str:
        """Reports charging, or hides it until the robot has left the charger. The charger in the
        floor charges whatever stands there."""
        if not (self.sighting and self.sighting.at_charger):
            return "the robot stands at no charger" if on else ""
        self._charged_enough = not on
        return ""

    def init_position(self, x: float, y: float, yaw: float) -> str:
        """Returns '' if the robot is there, else where it is."""
        sighting = self.sighting
        if sighting and not sighting.lost and max(abs(sighting.x - x), abs(sighting.y - y)) < 0.1:
            return ""
        where = (
            f"at {sighting.x:.2f}, {sighting.y:.2f}" if sighting and not sighting.lost else "lost"
        )
        return f"the robot finds its position by itself: it is {where}"


def _errors(sighting: Sighting) -> tuple[Error, ...]:
    errors = [
        Error(type.value, level, text)
        for kind, (type, level, text) in FAILURES.items()
        if sighting.failures & 1 << kind
    ]
    return (*errors, LOST) if sighting.lost else tuple(errors)
