# SPDX-License-Identifier: Apache-2.0
"""Failures that robots report of themselves, and statistics of them."""

import collections
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from warehouse_layout.message_enums import EventKind, FailureKind

# Bits of FleetState.failures are the kinds of failures, and these.
EMPTY = 0
OUT_OF_ORDER = 6  # of a vehicle of another maker, which says itself why
NAMES: dict[int, str] = {
    EMPTY: "battery empty",
    FailureKind.MOTOR: "drive without torque",
    FailureKind.LIFT_STUCK: "lift stuck",
    FailureKind.LASER_BLIND: "laser blind",
    FailureKind.RADIO_LOST: "radio lost",
    FailureKind.WHEEL_SLIPS: "wheels slip",
    OUT_OF_ORDER: "out of order",
}
MISHAPS = {EventKind.LOST: "lost their way", EventKind.TIPPED: "lost their load, which tipped"}
# Masks of failures: the robot can't drive or can't be sent orders, can't lift, does no work.
# A robot whose wheels slip works, slowly.
STANDS = (
    1 << EMPTY
    | 1 << FailureKind.MOTOR
    | 1 << FailureKind.LASER_BLIND
    | 1 << FailureKind.RADIO_LOST
    | 1 << OUT_OF_ORDER
)
LIFTS_NOT = 1 << FailureKind.LIFT_STUCK
DOWN = STANDS | LIFTS_NOT


def names_of(failures: int) -> str:
    """Returns the names of the failures of one robot, separated by commas; failures: its bits of
    FleetState.failures."""
    return ", ".join(name for kind, name in NAMES.items() if failures >> kind & 1)


def heard(world: Any) -> Any:
    """Returns the robots of a kiva_plugin_cpp.World as known from their reports: arrays (n,), named
    as those of its Fleet. A robot whose radio is lost or whose reports are late has the values of
    its last report, except for `failures`, which show the lost radio, and `charge`."""
    fleet = world.fleet
    last = world.last_heard()
    if not len(last):
        return fleet
    names = [name for name in last.dtype.names or () if name != "index"]
    columns: dict[str, NDArray[Any]] = {name: np.array(getattr(fleet, name)) for name in names}
    for name, column in columns.items():
        column[last["index"]] = last[name]
    return SimpleNamespace(
        kiva_id=fleet.kiva_id,
        failures=np.array(fleet.failures),
        charge=np.array(fleet.charge),
        **columns,
    )


class FailureLog:
    """Counts failures, repairs and mishaps, and sums up how long robots were down, from the first
    report on. Dictionaries are keyed by kind of failure, a key of NAMES.

    Attributes: `count` (failures), `repairs`, `repaired_s` (from failure to repair, of those
    repaired [s]), `lasted_s` (robot seconds with the failure), `mishaps` (by name, see MISHAPS),
    `down_s` (robot seconds without work for any failure), `robot_s` (robot seconds in all).
    """

    def __init__(self) -> None:
        self.count = dict.fromkeys(NAMES, 0)
        self.repairs = dict.fromkeys(NAMES, 0)
        self.repaired_s = dict.fromkeys(NAMES, 0.0)
        self.lasted_s = dict.fromkeys(NAMES, 0.0)
        self.mishaps: collections.Counter[str] = collections.Counter()
        self.down_s = 0.0
        self.robot_s = 0.0
        self._time: float | None = None
        self._before: NDArray[np.uint8] | None = None
        self._since: dict[tuple[int, int], float] = {}  # failed at [s], by robot and kind

    def update(self, time: float, failures: NDArray[np.uint8]) -> None:
        """Updates the statistics with the bits of FleetState.failures, (n,), at `time` [s]."""
        failures = np.array(failures)
        before = self._before
        if before is None or len(before) != len(failures):
            before, self._since = np.zeros_like(failures), {}
        elapsed = 0.0 if self._time is None else max(0.0, time - self._time)
        self._time, self._before = time, failures
        self.robot_s += elapsed * len(failures)
        if before.any():
            self.down_s += elapsed * np.count_nonzero(before & DOWN)
            for kind in NAMES:
                self.lasted_s[kind] += elapsed * np.count_nonzero(before >> kind & 1)
        if not np.array_equal(before, failures):
            self._count_changes(time, before, failures)

    def _count_changes(
        self, time: float, before: NDArray[np.uint8], failures: NDArray[np.uint8]
    ) -> None:
        for robot in np.flatnonzero(before != failures).tolist():
            for kind in NAMES:
                was, now = before[robot] >> kind & 1, failures[robot] >> kind & 1
                if now and not was:
                    self.count[kind] += 1
                    self._since[robot, kind] = time
                elif was and not now:
                    self.repairs[kind] += 1
                    self.repaired_s[kind] += time - self._since.pop((robot, kind), time)

    def note(self, kinds: NDArray[np.integer[Any]]) -> None:
        """Counts the mishaps among events of the world; kinds: their Event.kind, (n,)."""
        for kind, name in MISHAPS.items():
            if count := int(np.count_nonzero(kinds == kind)):
                self.mishaps[name] += count

    @property
    def total(self) -> int:
        """The number of failures of all kinds."""
        return sum(self.count.values())

    def figures(self) -> dict[str, float]:
        """Returns the figures for kpis.json: the number of failures, availability (0…1), mean time
        between failures [h] and to repair [s]; empty without a failure."""
        if not self.total:
            return {}
        repairs = sum(self.repairs.values())
        return {
            "failures": self.total,
            # A robot may be broken before any time has passed.
            "availability": 1 - self.down_s / self.robot_s if self.robot_s else 1.0,
            "mtbf_h": (self.robot_s - self.down_s) / self.total / 3600,
            "mttr_s": sum(self.repaired_s.values()) / max(repairs, 1),
        }

    def by_kind(self) -> list[dict[str, Any]]:
        """Returns [{kind, count, repairs, mean_repair_s, robot_h, down_h}], one for each kind of
        failure that occurred: kind is its name, robot_h the robot hours with it, down_h those of
        them in which it kept robots from working."""
        return [
            {
                "kind": NAMES[kind],
                "count": count,
                "repairs": self.repairs[kind],
                "mean_repair_s": self.repaired_s[kind] / max(self.repairs[kind], 1),
                "robot_h": self.lasted_s[kind] / 3600,
                "down_h": self.lasted_s[kind] / 3600 if DOWN >> kind & 1 else 0.0,
            }
            for kind, count in self.count.items()
            if count
        ]
