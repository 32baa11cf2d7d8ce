# SPDX-License-Identifier: Apache-2.0
"""The results of a plan that was driven with bodies: figures, and a table of them."""

from typing import Any

import numpy as np

from warehouse_fleet.league.plan_driver import Cause, PlanDriver

PERIOD = 5.0  # time between two points of the curve [s, simulated]
WORDS = {
    Cause.DRIVING: "driving, as long as at top speed",
    Cause.ACCELERATION: "more for starting and braking",
    Cause.TURN: "turning",
    Cause.AHEAD: "standing behind the robot ahead",
    Cause.ORDER: "standing until another has passed first",
    Cause.RING: "standing where a ring is broken",
    Cause.RELEASE: "standing until a release arrives",
    Cause.ARRIVED: "done with its plan",
}


class DriveLog:
    """Records the progress of a drive every PERIOD; to be called after each step of the driver.

    `curve`: rows of time [s], the mean tick of the plan that robots have come to, and the number of
    robots for each Cause since the row before.
    """

    def __init__(self, driver: PlanDriver) -> None:
        self._driver = driver
        self._seconds, self._noted = driver.seconds.sum(axis=1), driver.time
        self.curve: list[list[float]] = []
        self.note()

    def __call__(self) -> None:
        """Adds a row to the curve if that is due."""
        if self._driver.time >= self._noted + PERIOD - 1e-9:
            self.note()

    def note(self) -> None:
        """Adds a row to the curve."""
        driver = self._driver
        seconds, elapsed = driver.seconds.sum(axis=1), driver.time - self._noted
        robots = (seconds - self._seconds) / max(elapsed, 1e-9)
        row = driver.time, float(driver.tick.mean()), *robots.tolist()
        self.curve.append([round(value, 2) for value in row])
        self._seconds, self._noted = seconds, driver.time


def figures(driver: PlanDriver, wall: float, cpu: float) -> dict[str, Any]:
    """Returns the contents of drive.json. wall, cpu: the drive's duration and its processor time
    [s]. For an interrupted drive planned_s covers only the ticks that robots reached."""
    order, spacing = driver.order, driver.plan.spacing
    tick_s = spacing / driver.kinematics.speed
    has_arrived = ~np.isnan(driver.arrival)
    planned = tick_s * order.last
    travels = has_arrived & (order.last > 0)
    executed, due = float(driver.arrival.max()), float(planned.max())
    if not driver.is_over:
        executed, due = driver.time, tick_s * float(driver.tick.mean())
    waiting = {cause.name.lower(): round(float(driver.seconds[cause].sum()), 1) for cause in Cause}
    return {
        "robots": len(order.steps),
        "ticks": len(order.rank_of_tick),
        "tick_s": tick_s,
        "planned_s": round(due, 1),
        "executed_s": round(executed, 1),
        "executed_over_planned": _ratio(executed, due),
        "executed_over_planned_of_a_robot": _ratio(
            float(driver.arrival[travels].sum()), float(planned[travels].sum())
        ),
        "arrived": int(has_arrived.sum()),
        "at_their_ends": int(driver.at_end().sum()),
        "contacts": driver.collisions,
        "refusals": driver.refusals,
        "rings_broken": order.rings,
        "cells": driver.cells,
        "metres": driver.cells * spacing,
        "robot_seconds": waiting,
        "simulated_s": round(driver.time, 1),
        "wall_s": round(wall, 2),
        "cpu_s": round(cpu, 2),
        "real_time_factor": _ratio(driver.time, wall),
        "real_time_factor_by_cpu": _ratio(driver.time, cpu),
        "state_hash": f"{driver.world.state_hash():016x}",
    }


def _ratio(numerator: float, denominator: float) -> float:
    """Returns one / other to four digits; 1 for nothing planned."""
    return float(f"{numerator / denominator:.4g}") if denominator > 0 else 1.0


def faults(report: dict[str, Any], is_whole: bool) -> list[str]:
    """Returns sentences about what a drive should not have done, by its figures. is_whole: it was
    not interrupted."""
    problems = []
    if report["contacts"]:
        problems.append(f"{report['contacts']} contacts of robots")
    missing = report["robots"] - report["at_their_ends"]
    if is_whole and missing:
        problems.append(f"{missing} robots are not where the plan ends")
    return problems


def table(report: dict[str, Any]) -> str:
    """Returns the figures as a table for people."""
    rows = [
        ("robots", f"{report['robots']:,}"),
        ("ticks of the plan", f"{report['ticks']:,}"),
        ("planned", f"{report['planned_s']:,.1f} s, {report['tick_s']:.3f} s a tick"),
        ("executed", f"{report['executed_s']:,.1f} s"),
        ("executed over planned", f"{report['executed_over_planned']:.3f}"),
        ("the same, mean of robots", f"{report['executed_over_planned_of_a_robot']:.3f}"),
        ("at their ends", f"{report['at_their_ends']:,} of {report['robots']:,}"),
        ("contacts", f"{report['contacts']:,}"),
        ("rings broken", f"{report['rings_broken']:,}"),
        ("driven", f"{report['metres'] / 1000:,.1f} km"),
        (
            "real-time factor",
            f"{report['real_time_factor']:.3g},"
            f" by CPU time {report['real_time_factor_by_cpu']:.3g}",
        ),
    ]
    seconds = report["robot_seconds"]
    whole = max(sum(seconds.values()), 1e-9)
    spent = [(WORDS[cause], seconds[cause.name.lower()]) for cause in Cause]
    rows += [("", ""), ("time of a robot", f"{whole / report['robots']:,.1f} s, of which")]
    rows += [
        (f"  {words}", f"{value / report['robots']:,.1f} s, {100 * value / whole:.1f} %")
        for words, value in spent
    ]
    wide = max(len(name) for name, _ in rows)
    return "\n".join(f"{name:{wide}}  {value}".rstrip() for name, value in rows)
