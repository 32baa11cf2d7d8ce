# SPDX-License-Identifier: Apache-2.0
"""A recording as all sources give it: tracks of robots, lifts, failures, and work at stations."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

NOWHERE = float("nan")


class CalibrationError(Exception):
    """Raised for a recording that can't be read; names file, line and topic, and what was
    expected."""


@dataclass(frozen=True)
class Track:
    """Samples of a robot by time [s]: where it is [m, rad], how fast [m/s, rad/s], whether it
    carries a unit, its state of charge (NaN: unknown), the bits of what is broken, whether it
    says that it charges."""

    time: np.ndarray
    x: np.ndarray
    y: np.ndarray
    yaw: np.ndarray
    speed: np.ndarray
    turning: np.ndarray
    loaded: np.ndarray
    charge: np.ndarray
    failures: np.ndarray
    lifting: np.ndarray

    @classmethod
    def of_rows(cls, rows: Sequence[Sequence[float]]) -> "Track":
        """Returns the track of rows with these columns, sorted by time. Of several of a time the
        last stays, and of several of the same moment of a motion, which was reported again, the
        first."""
        table = np.asarray(rows, float)
        table = table[np.argsort(table[:, 0], kind="stable")]
        table = table[np.append(np.diff(table[:, 0]) > 0, True)]
        again = (np.diff(table[:, 1:6], axis=0) == 0).all(axis=1) & (table[1:, 4] > 0)
        table = table[np.append(True, ~again)]
        columns: list[Any] = list(table.T)
        columns[6] = columns[6] > 0
        columns[8] = columns[8].astype(int)
        columns[9] = columns[9] > 0
        return cls(*columns)

    def __len__(self) -> int:
        return len(self.time)


@dataclass
class Recording:
    """What a source holds. tracks: by robot. lifts: durations of raising and lowering [s];
    lift_step: between two looks at a robot that may lift, 0 where each begin and end is there [s].
    of_figures: whether failures are those of a run's figures, which count what tracks tell, too.
    robot_hours, failures, repairs: exposure, the kind of each failure, and durations of repairs
    [s]; unrepaired: the time of those not over [s]. gaps: of pieces at stations; see service."""

    tracks: dict[str, Track] = field(default_factory=dict)
    lifts: list[float] = field(default_factory=list)
    lift_step: float = 0.0
    of_figures: bool = True
    robot_hours: float = 0.0
    failures: list[str] = field(default_factory=list)
    repairs: list[float] = field(default_factory=list)
    unrepaired: float = 0.0
    pieces: list["Piece"] = field(default_factory=list)
    bundles: list["Piece"] = field(default_factory=list)
    arrivals: list["Arrival"] = field(default_factory=list)
    sources: list[str] = field(default_factory=list)

    def add(self, other: "Recording") -> None:
        """Adds what another source holds. Tracks of the same robot are kept apart."""
        for name, track in other.tracks.items():
            self.tracks[f"{len(self.sources)}:{name}"] = track
        if other.lifts and (not self.lifts or other.lift_step < self.lift_step):
            self.lifts, self.lift_step = [], other.lift_step  # what is finer holds
        if other.lift_step == self.lift_step:
            self.lifts += other.lifts
        self._add_failures(other)
        for name in ("pieces", "bundles", "arrivals", "sources"):
            getattr(self, name).extend(getattr(other, name))

    def _add_failures(self, other: "Recording") -> None:
        """Adds failures. Those of tracks hold: figures may count the same."""
        if not other.robot_hours or (other.of_figures and not self.of_figures):
            return
        if self.of_figures and not other.of_figures:
            self.robot_hours = self.unrepaired = 0.0
            self.failures, self.repairs, self.of_figures = [], [], False
        self.robot_hours += other.robot_hours
        self.unrepaired += other.unrepaired
        self.failures += other.failures
        self.repairs += other.repairs


@dataclass(frozen=True)
class Piece:
    """Pieces that followed others from the same unit. gap: time since those [s]. quantity: of
    pieces. new_line: whether they are the first of a line."""

    station: str
    gap: float
    quantity: int = 1
    new_line: bool = False


@dataclass(frozen=True)
class Arrival:
    """A unit that came to a station. wait: from its arrival to its first piece [s]. idle: since
    when the people there had no work [s]. quantity: of that piece. exchange: time since the unit
    before left [s]. departure: from the last piece to the release [s]."""

    station: str
    wait: float
    idle: float
    quantity: int = 1
    new_line: bool = True
    exchange: float = NOWHERE


def require(condition: bool, text: str) -> None:
    """Raises CalibrationError with a sentence unless a condition holds."""
    if not condition:
        raise CalibrationError(text)


def named(values: Iterable[str]) -> str:
    """Returns names as a sentence has them, ten at most."""
    names = sorted(values)
    more = f" and {len(names) - 10} more" if len(names) > 10 else ""
    return ", ".join(names[:10]) + more
