# SPDX-License-Identifier: Apache-2.0
"""A robot that drives by a formula: straight from point to point at a constant speed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from warehouse_vda5050.driver import Driver, Point, Report
from warehouse_vda5050.model import Factsheet

LIFT_TIME = 2.0  # [s]


class FormulaRobot(Driver):
    """Heads along each stretch at once, and halts where its path ends.

    limits: top speeds of stretches, by their ends [m/s]; headings: those to stand with, by point
    [rad]. reports: fields of its Report that are something else; lift_fault: why no lift succeeds,
    '' if it does; lift_time: how long one takes [s].
    """

    keeps_speeds = True

    def __init__(self, x: float, y: float, yaw: float, speed: float = 1.5) -> None:
        self.x, self.y, self.yaw = x, y, yaw
        self._speed, self._sheet = speed, Factsheet("conform", "a vehicle that conform plays")
        self.limits: dict[tuple[Point, Point], float] = {}
        self.headings: dict[Point, float] = {}
        self.reports: dict[str, Any] = {}
        self.lift_fault, self.lift_time = "", LIFT_TIME
        self.load = ""
        self._path: list[Point] = []
        self._speeds: dict[int, float] = {}  # of the ways to points of the path, by number
        self._path_id = self._reached = 0
        self._lift: tuple[str, bool, float] | None = None  # unit, up, and the time left [s]
        self._busy = self._stopped = self._cancelling = False
        self._refusal = ""

    # --- commands

    def follow(
        self,
        path_id: int,
        first: int,
        points: Sequence[Point],
        released: int,
        speeds: Sequence[float] = (),
    ) -> None:
        """Drives a path, or extends the one under way; takes its speeds at once."""
        self._refusal = ""
        if path_id == self._path_id and self._busy:
            self._path[first:] = points
        elif self._busy or first:
            self._refusal = "the robot is under way"
        else:
            self._path, self._path_id, self._reached = [*points], path_id, 1
            self._busy, self._cancelling = True, False
            self._speeds = {}
        if not self._refusal:
            self._speeds.update(enumerate(speeds, first))

    def lift(self, unit: str, up: bool) -> None:
        """Lifts whatever is meant, and puts it down."""
        self._refusal = self.lift_fault
        if not self.lift_fault:
            self._lift, self._busy = (unit or "load", up, self.lift_time), True

    def cancel(self) -> None:
        """Ends the path at its next point."""
        self._cancelling = self._busy and self._lift is None

    def stop(self, stopped: bool) -> None:
        """Pauses or resumes."""
        self._stopped = stopped

    def carry_to(self, x: float, y: float) -> None:
        """Stands elsewhere, as one that a person has pushed."""
        self.x, self.y, self._busy, self._lift = x, y, False, None

    # --- progress

    def step(self, seconds: float) -> None:
        """Goes on by some time [s]."""
        if not self._busy or self._stopped:
            return
        if self._lift:
            self._go_on_lifting(seconds)
        else:
            self._drive(seconds)

    def _go_on_lifting(self, seconds: float) -> None:
        assert self._lift
        unit, up, left = self._lift
        self._lift = unit, up, left - seconds
        if left <= seconds:
            self.load, self._lift, self._busy = (unit if up else ""), None, False

    def _drive(self, seconds: float) -> None:
        while self._reached < len(self._path) and seconds > 0:
            start, goal = self._path[self._reached - 1], self._path[self._reached]
            speed = self._speed_between(start, goal)
            way = math.dist((self.x, self.y), goal)
            if way > 1e-9:
                self.yaw = math.atan2(goal[1] - self.y, goal[0] - self.x)
            step = min(way, speed * seconds)
            seconds -= step / speed if way > step else way / speed
            self._move(goal, way, step)
            if step < way:
                return
            self._arrive(goal)
            if self._cancelling:
                break
        if self._cancelling or self._reached == len(self._path):
            self._busy = self._cancelling = False

    def _speed_between(self, start: Point, goal: Point) -> float:
        ordered = self._speeds.get(self._reached, math.inf)
        return min(self._speed, ordered, self.limits.get((start, goal), math.inf))

    def _move(self, goal: Point, way: float, step: float) -> None:
        share = step / way if way > 0 else 1.0
        self.x += share * (goal[0] - self.x)
        self.y += share * (goal[1] - self.y)

    def _arrive(self, goal: Point) -> None:
        self.x, self.y = goal
        self.yaw = self.headings.get(goal, self.yaw)
        self._reached += 1

    # --- reports

    @property
    def is_moving(self) -> bool:
        """Whether it drives."""
        return self._busy and not self._stopped and self._lift is None

    @property
    def _present_speed(self) -> float:
        if not 0 < self._reached < len(self._path):
            return self._speed
        return self._speed_between(self._path[self._reached - 1], self._path[self._reached])

    def report(self) -> Report:
        """Returns its report."""
        speed = self._present_speed if self.is_moving else 0.0
        report = Report(
            self.x,
            self.y,
            self.yaw,
            speed * math.cos(self.yaw),
            speed * math.sin(self.yaw),
            busy=self._busy,
            moving=self.is_moving,
            path_id=self._path_id,
            reached=self._reached,
            load=self.load,
            refusal=self._refusal,
        )
        return replace(report, **self.reports)

    def factsheet(self) -> Factsheet:
        """Returns what it is."""
        return self._sheet

    def init_position(self, x: float, y: float, yaw: float) -> str:
        """Takes a position over."""
        self.x, self.y, self.yaw = x, y, yaw
        return ""
