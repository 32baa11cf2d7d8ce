# SPDX-License-Identifier: Apache-2.0
"""Batteries, charging, failures and repair of ideal robots: how much of their time they can work.

The parameters have the names and files of the realism of simulated robots
(doc/explanation/realism.md); ideal robots ignore its other parts (localisation, people …).
"""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from warehouse_fleet.transports.charging import FULL, Opportunity, Policy
from warehouse_operations.fleets.consumption import Drain
from warehouse_operations.stock.yaml_file import read_yaml

HOUR = 3600.0  # [s]
DAY = 24 * HOUR  # [s]
SECTIONS = ("energy", "failures", "actuation", "radio")
KINDS = ("motor", "lift_stuck", "laser_blind", "radio_lost", "wheel_slips")


class RealismError(ValueError):
    """Raised for an invalid realism; names its file and field."""


@dataclass(frozen=True)
class Energy:
    """A battery: capacity [Wh], the share of it that is left, its charge at first, powers [W]."""

    capacity: float = 960.0
    health: float = 1.0
    initial_least: float = 0.6
    initial_most: float = 1.0
    electronics: float = 80.0
    rolling_resistance: float = Drain.rolling_resistance
    drive_efficiency: float = Drain.drive_efficiency
    regeneration: float = Drain.regeneration
    lift_efficiency: float = Drain.lift_efficiency
    charge_power: float = 1500.0
    charge_taper: float = 0.8

    @property
    def joules(self) -> float:
        """The energy of a full battery [J]."""
        return self.capacity * self.health * HOUR

    def charged(self, charge: float, seconds: float) -> float:
        """Returns the state of charge after a duration at a charger, electronics on."""
        rate = (self.charge_power - self.electronics) / self.joules
        if rate <= 0:
            return max(charge + rate * seconds, 0.0)
        constant = max(self.charge_taper - charge, 0.0) / rate
        if seconds <= constant:
            return charge + rate * seconds
        # From the taper on the power falls evenly with the charge, and the electronics take
        # theirs: an exponential approach.
        charge = max(charge, self.charge_taper)
        slope = self.charge_power / max(1 - self.charge_taper, 1e-9) / self.joules
        top = 1 - self.electronics / self.joules / slope
        return float(top - (top - charge) * np.exp(-slope * (seconds - constant)))

    def seconds_to(self, charge: float, aim: float) -> float:
        """Returns how long charging takes from one state of charge to another [s]; a day where it
        is longer."""
        low, high = 0.0, DAY
        for _ in range(50):
            middle = (low + high) / 2
            low, high = (low, middle) if self.charged(charge, middle) >= aim else (middle, high)
        return high


@dataclass(frozen=True)
class Failures:
    """Random failures: their number per robot and hour, and the time of a repair [s]."""

    per_robot_hour: float = 0.01
    repair_time: float = 300.0
    motor: float = 0.3
    lift_stuck: float = 0.15
    laser_blind: float = 0.15
    radio_lost: float = 0.25
    wheel_slips: float = 0.15

    @property
    def down_share(self) -> float:
        """The share of failures with which a robot can't work: all but slipping wheels."""
        total = sum(getattr(self, kind) for kind in KINDS)
        return 1 - self.wheel_slips / total if total else 0.0


@dataclass(frozen=True)
class Motors:
    """Motors: the time constant with which speeds follow their commands [s]."""

    motor_lag: float = 0.0


@dataclass(frozen=True)
class Radio:
    """Mean delays of commands and of reports [s]."""

    latency_mean: float = 0.03
    status_latency_mean: float = 0.0


@dataclass(frozen=True)
class Availability:
    """The causes that keep ideal robots from work; None: without that cause. motor_lag: time
    constant with which speeds follow their commands [s]. radio_delay: of a robot's report that it
    has left a cell, and of the command by which another one goes on [s]."""

    energy: Energy | None = None
    failures: Failures | None = None
    motor_lag: float = 0.0
    radio_delay: float = 0.0

    def __bool__(self) -> bool:
        return bool(self.energy or self.failures)

    @property
    def drain(self) -> Drain | None:
        """The energy of motion; None where batteries are not simulated."""
        if self.energy is None:
            return None
        names = {field.name for field in fields(Drain)} & {field.name for field in fields(Energy)}
        return Drain(
            motor_lag=self.motor_lag, **{name: getattr(self.energy, name) for name in names}
        )


def read(realism: str) -> Availability:
    """Returns the availability that a realism gives ideal robots: the name of a preset, or a file;
    "": full availability. Raises RealismError."""
    if not realism:
        return Availability()
    return of_content(content_of(realism), realism)


def content_of(realism: str) -> Any:
    """Returns the sections of a realism by its name or file. Raises RealismError."""
    return read_yaml(_path(realism), RealismError)


def of_content(data: Any, realism: str = "realism") -> Availability:
    """Returns the availability of a realism's sections. realism: its name, for messages. Raises
    RealismError."""
    if not isinstance(data, dict):
        raise RealismError(f"{realism}: sections with parameters were expected")
    energy, failures, actuation, radio = (data.get(section, False) for section in SECTIONS)
    delays = Radio(**_section(realism, "radio", radio, Radio)) if radio else Radio(0.0)
    return Availability(
        Energy(**_section(realism, "energy", energy, Energy)) if energy else None,
        Failures(**_section(realism, "failures", failures, Failures)) if failures else None,
        Motors(**_section(realism, "actuation", actuation, Motors)).motor_lag if actuation else 0.0,
        delays.latency_mean + delays.status_latency_mean,
    )


def _path(realism: str) -> Path:
    from kiva_plugin_cpp import worlds_folder

    path = worlds_folder() / "realism" / f"{realism}.yaml"
    if "/" not in realism and path.exists():
        return path
    if not Path(realism).is_file():
        raise RealismError(
            f"realism is '{realism}'; ideal, typical, bad_day or a file was expected"
        )
    return Path(realism)


def _section(
    realism: str, name: str, values: Any, kind: type[Energy | Failures | Motors | Radio]
) -> Mapping[str, float]:
    """Returns the parameters of a section that ideal robots have."""
    if values is True:
        return {}
    if not isinstance(values, dict):
        raise RealismError(f"{realism}: {name} is {values!r}; true, false or parameters")
    known = {field.name for field in fields(kind)}
    for key, value in values.items():
        number = isinstance(value, (int, float)) and not isinstance(value, bool)
        if key in known and (not number or value < 0):
            raise RealismError(f"{realism}: {name}: {key} is {value!r}; a number was expected")
    return {key: float(values[key]) for key in values.keys() & known}


class Upkeep:
    """The batteries of a fleet of ideal robots, by index, and the time spent on them.

    cells: charging places. charge: states of charge, (n,). place: the charging place that is kept
    for a robot, by index. charging_s: robot-seconds. radio_delay: as Availability's.
    """

    def __init__(
        self,
        availability: Availability,
        robots: int,
        cells: np.ndarray,
        rng: np.random.Generator,
        policy: Policy | None = None,
    ) -> None:
        energy = availability.energy
        self.energy, self.failures, self.rng = energy, availability.failures, rng
        self.drain = availability.drain
        self.radio_delay = availability.radio_delay
        self.policy, self._cells = policy or Opportunity(), [int(cell) for cell in cells]
        least, most = (energy.initial_least, energy.initial_most) if energy else (1.0, 1.0)
        self.charge = rng.uniform(least, max(least, most), robots)
        self._noted = np.zeros(robots)  # the time of each charge [s]
        self.place: dict[int, int] = {}
        # Robots at chargers or on their way: when they are there [s], and the cell. A full robot
        # stays there, and is charged, until it has work; its place is kept no longer.
        self._stands: dict[int, tuple[float, int]] = {}
        self._failures: list[tuple[float, float]] = []  # (when, how long), [s]
        self.charging_s = 0.0

    def note(self, index: int, now: float) -> None:
        """Brings the charge of a robot up to date: electronics, and what a charger gave."""
        if self.energy is None:
            return
        begin, charge = float(self._noted[index]), float(self.charge[index])
        there, _ = self._stands.get(index, (np.inf, 0))
        charging = max(now - max(begin, there), 0.0)
        charge -= max(now - begin - charging, 0.0) * self.energy.electronics / self.energy.joules
        if charging:
            charge = self.energy.charged(max(charge, 0.0), charging)
            self.charging_s += charging * (index in self.place)
        self.charge[index], self._noted[index] = max(charge, 0.0), max(now, begin)

    def spend(self, index: int, joules: float) -> None:
        """Takes the energy of a motion from the battery of a robot [J]."""
        if self.energy is not None:
            self.charge[index] = max(self.charge[index] - joules / self.energy.joules, 0.0)

    def may_work(self, index: int) -> bool:
        """Returns whether a robot without work may be given some."""
        if self.energy is None:
            return True
        charge = self.charge[[index]]
        if index in self.place and not self.policy.frees(charge)[0]:
            return False
        return not self.policy.spares(charge)[0]

    def leave(self, index: int) -> None:
        """Has a robot leave its charger for work."""
        self.place.pop(index, None)
        self._stands.pop(index, None)

    def release_full(self, index: int) -> None:
        """Keeps no charging place any longer for a robot that is full."""
        if self.charge[index] >= FULL:
            self.place.pop(index, None)

    def wants(self, index: int, is_wanted: bool) -> bool:
        """Returns whether a robot without work is to charge."""
        if self.energy is None or index in self.place:
            return False
        return bool(self.policy.sends(self.charge[[index]], is_wanted)[0])

    def free_cells(self, index: int) -> list[int]:
        """Returns the charging places that a robot may take: free ones, or that of the fullest
        robot which could work, if it is low itself."""
        kept = set(self.place.values())
        free = [cell for cell in self._cells if cell not in kept]
        if free or self.charge[index] >= self.policy.low or not self.place:
            return free
        others = np.array(list(self.place))
        able = others[self.policy.frees(self.charge[others])]
        if not len(able):
            return []
        fullest = int(able[self.charge[able].argmax()])
        cell = self.place[fullest]
        self.leave(fullest)
        return [cell]

    def is_taken(self, cell: int) -> bool:
        """Returns whether a robot stands in a charging place, or is to."""
        return any(cell == other for _, other in self._stands.values())

    def begin(self, index: int, cell: int, there: float) -> float:
        """Gives a robot a charging place; returns when it may work again [s]."""
        self.place[index], self._stands[index] = cell, (there, cell)
        assert self.energy is not None
        enough = getattr(self.policy, "enough", getattr(self.policy, "high", 1.0))
        charge = max(float(self.charge[index]), 0.0)
        if charge >= enough:
            return there
        return there + self.energy.seconds_to(charge, enough)

    def note_failure(self, time: float, duration: float) -> None:
        """Notes that a robot can't work from a time on, for a duration [s]."""
        self._failures.append((time, duration))

    def down_s(self, now: float) -> float:
        """Returns the robot-seconds of failures up to now."""
        return sum(min(duration, now - begin) for begin, duration in self._failures)

    def next_failure(self, robots: int) -> float:
        """Draws the time to the fleet's next failure [s]; infinity without failures."""
        rate = self.failures.per_robot_hour * robots / HOUR if self.failures else 0.0
        return float(self.rng.exponential(1 / rate)) if rate else np.inf

    def draw_failure(self, robots: int) -> tuple[int, float]:
        """Draws which robot fails, and for how long it can't work [s]."""
        assert self.failures is not None
        index = int(self.rng.integers(robots))
        repair = float(self.rng.exponential(self.failures.repair_time))
        return index, repair if self.rng.random() < self.failures.down_share else 0.0
