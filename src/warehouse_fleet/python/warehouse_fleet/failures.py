# SPDX-License-Identifier: Apache-2.0
"""What robots report of what is broken in them, and what that cost."""

import collections
from types import SimpleNamespace

import numpy as np

# Bits of FleetState.failures: kinds of warehouse_msgs/Fail, before them an empty battery.
EMPTY, MOTOR, LIFT_STUCK, LASER_BLIND, RADIO_LOST, WHEEL_SLIPS = range(6)
NAMES = {
    EMPTY: "battery empty",
    MOTOR: "drive without torque",
    LIFT_STUCK: "lift stuck",
    LASER_BLIND: "laser blind",
    RADIO_LOST: "radio lost",
    WHEEL_SLIPS: "wheels slip",
}
MISHAPS = {9: "lost their way", 12: "lost their load, which tipped"}  # by Event.kind
STANDS = (
    1 << EMPTY | 1 << MOTOR | 1 << LASER_BLIND | 1 << RADIO_LOST
)  # it stands, or can't be sent on
LIFTS_NOT = 1 << LIFT_STUCK
DOWN = STANDS | LIFTS_NOT  # it does not work; one whose wheels slip does, slowly


def names_of(failures):
    """What is broken, by the bits of FleetState.failures: words."""
    return ", ".join(name for kind, name in NAMES.items() if failures >> kind & 1)


def heard(world):
    """What is heard of a World's robots: its Fleet; of those whose radio is lost, and where reports
    come late, what was heard last. Who is silent is known by its bit in `failures`."""
    fleet = world.fleet
    last = world.last_heard()
    if not len(last):
        return fleet
    names = [name for name in last.dtype.names if name != "index"]
    columns = {name: np.array(getattr(fleet, name)) for name in names}
    for name, column in columns.items():
        column[last["index"]] = last[name]
    return SimpleNamespace(
        kiva_id=fleet.kiva_id,
        failures=np.array(fleet.failures),
        charge=np.array(fleet.charge),
        **columns,
    )


class FailureLog:
    """Which failures there were, and how long robots were down, from the first report on; and what
    else befell them, by note()."""

    def __init__(self):
        self.count = dict.fromkeys(NAMES, 0)
        self.repairs = dict.fromkeys(NAMES, 0)
        self.repaired_s = dict.fromkeys(NAMES, 0.0)  # from failure to repair, of those repaired
        self.lasted_s = dict.fromkeys(NAMES, 0.0)  # robot seconds with it
        self.mishaps = collections.Counter()  # by their names
        self.down_s = 0.0  # robot seconds without work, whatever for
        self.robot_s = 0.0  # robot seconds in all
        self._time, self._before = None, None
        self._since = {}  # by robot and kind [s]

    def update(self, time, failures):
        """Takes in the bits that robots report at that time [s], (n,)."""
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
            self._take_changes(time, before, failures)

    def _take_changes(self, time, before, failures):
        for robot in np.flatnonzero(before != failures).tolist():
            for kind in NAMES:
                was, now = before[robot] >> kind & 1, failures[robot] >> kind & 1
                if now and not was:
                    self.count[kind] += 1
                    self._since[robot, kind] = time
                elif was and not now:
                    self.repairs[kind] += 1
                    self.repaired_s[kind] += time - self._since.pop((robot, kind), time)

    def note(self, kinds):
        """Takes in what kinds of events the world tells, (n,) of Event.kind."""
        for kind, name in MISHAPS.items():
            if count := int(np.count_nonzero(kinds == kind)):
                self.mishaps[name] += count

    @property
    def total(self):
        """How many there were."""
        return sum(self.count.values())

    def figures(self):
        """Availability, mean time between failures and to repair, as kpis.json has them; empty
        without a failure."""
        if not self.total:
            return {}
        repairs = sum(self.repairs.values())
        return {
            "failures": self.total,
            "availability": 1 - self.down_s / self.robot_s,
            "mtbf_h": (self.robot_s - self.down_s) / self.total / 3600,
            "mttr_s": sum(self.repaired_s.values()) / max(repairs, 1),
        }

    def by_kind(self):
        """[{kind, count, repairs, mean_repair_s, robot_h, down_h}] of those that there were: robot
        hours with it, and those of them without work for it."""
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
