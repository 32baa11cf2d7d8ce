# SPDX-License-Identifier: Apache-2.0
"""A robot with faults, as a driver around that of the robot."""

import math
from dataclasses import replace
from typing import Any

from warehouse_vda5050.driver import Driver, Report
from warehouse_vda5050.errors import Error, ErrorLevel, ErrorType
from warehouse_vda5050.faults.active import ActiveFaults
from warehouse_vda5050.faults.kinds import JUMP, LOW, SLOW, Fault
from warehouse_vda5050.model import Battery, Factsheet

DECLINES = "the robot refuses all orders: a fault on demand"


class FaultyDriver(Driver):
    """Passes all on to a driver; what `faults` are active changes its reports and its speed."""

    def __init__(self, driver: Driver, faults: ActiveFaults) -> None:
        self._driver, self._faults = driver, faults
        self.keeps_speeds = driver.keeps_speeds
        self._paused = False  # by the core
        self._held = False  # by a fault
        self._controlled_at = self._release_at = 0.0

    def control(self, now: float) -> None:
        """Holds a robot that a fault makes slow or lets stand; called ten times a second or more
        often. now: any clock [s]."""
        before, self._controlled_at = self._controlled_at, now
        if not self._faults and not self._held:
            return
        report = self._driver.report()
        if report is None or not report.answers:
            return
        is_fast = Fault.SLOW in self._faults and self._is_fast(report.speed, now, now - before)
        held = is_fast or self._is_broken
        if held != self._held:
            self._held = held
            if not self._paused:
                self._driver.stop(held)

    def _is_fast(self, speed: float, now: float, seconds: float) -> bool:
        """Returns whether a slow robot has to be held. Above its speed it is stopped, and released
        at half of it; one that stops at once also waits until its mean speed is right."""
        if speed > SLOW:
            self._release_at = now + min(seconds, 1.0) * (speed / SLOW - 1)
            return True
        return self._held and (speed > SLOW / 2 or now < self._release_at)

    @property
    def _is_broken(self) -> bool:
        return Fault.ERROR in self._faults and self._faults.level is ErrorLevel.FATAL

    def report(self) -> Report | None:
        """Returns the robot's report, with what the faults make of it."""
        report = self._driver.report()
        return report and self._distorted(report)

    def _distorted(self, report: Report) -> Report:
        faults = self._faults
        if Fault.JUMP in faults:
            report = replace(report, x=report.x + JUMP)
        if Fault.HEADING in faults:
            report = replace(report, yaw=report.yaw + math.pi / 2)
        if Fault.BATTERY in faults:
            report = replace(report, battery=Battery(LOW))
        if Fault.REFUSE in faults:
            report = replace(report, declines=DECLINES)
        if Fault.ERROR in faults:
            report = replace(report, errors=(*report.errors, self._error()))
        if Fault.SLOW in faults and report.busy and self._held and not self._paused:
            report = replace(report, moving=True)  # it goes on in a moment
        return report

    def _error(self) -> Error:
        return Error(ErrorType.DEMANDED.value, self._faults.level, "an error on demand")

    def stop(self, stopped: bool) -> None:
        """Pauses the robot at once, or resumes what it did as far as no fault holds it."""
        self._paused = stopped
        self._driver.stop(stopped or self._held)

    # What faults leave as it is.

    def follow(self, *path: Any) -> None:
        """Drives a path, or extends the one under way; with speeds if it gets them."""
        self._driver.follow(*path)

    def lift(self, unit: str, up: bool) -> None:
        """Lifts the unit that stands here, or puts it down."""
        self._driver.lift(unit, up)

    def cancel(self) -> None:
        """Ends what the robot does."""
        self._driver.cancel()

    def factsheet(self) -> Factsheet:
        """Returns what the robot is and can."""
        return self._driver.factsheet()

    def take(self) -> str:
        """Takes the robot for an order."""
        return self._driver.take()

    def give_back(self) -> None:
        """Gives the robot back."""
        self._driver.give_back()

    def is_taken(self) -> bool:
        """Returns whether an earlier run took the robot."""
        return self._driver.is_taken()

    def charge(self, on: bool) -> str:
        """Begins or ends charging."""
        return self._driver.charge(on)

    def init_position(self, x: float, y: float, yaw: float) -> str:
        """Sets the robot's pose."""
        return self._driver.init_position(x, y, yaw)
