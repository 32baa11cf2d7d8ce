# SPDX-License-Identifier: Apache-2.0
"""Battery use and charging from the states of charge in tracks.

A state of charge is a share: powers come out as shares of the capacity an hour, and become watts by
a capacity that is known (`Energy.capacity`, or of the data sheet).
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from warehouse_operations.calibrate.estimates import (
    Finding,
    TooLittle,
    combined,
    resampled,
)
from warehouse_operations.calibrate.motion import EVEN, STANDS, TURNS
from warehouse_operations.calibrate.motion import _spans as spans
from warehouse_operations.calibrate.motion import _stretches as stretches
from warehouse_operations.calibrate.recording import Track
from warehouse_operations.fleets.availability import HOUR, Energy
from warehouse_operations.fleets.consumption import GRAVITY, ROBOT, WHEEL_INERTIA, WHEEL_RADIUS

STANDING = 5.0  # least time of a standstill whose use is measured [s]
PIECE, STEP = 30.0, 0.02  # of a long standstill, one sample: time [s], change of the charge
LONGEST_GAP = 60.0  # between two reports of a robot that stands [s]
BULK = 0.7  # state of charge up to which chargers give all their power
TAPERED = 0.15, 0.9  # part of that power in which the taper is measured
LEAST = 8
LEAST_DRIVES = 20


@dataclass(frozen=True)
class Use:
    """Powers [W], the state of charge at which charging slows down, and the share of the battery's
    energy that comes to the wheels."""

    electronics: Finding
    charge_power: Finding
    charge_taper: Finding
    drive_efficiency: Finding


def of_tracks(tracks: list[Track], capacity: float) -> Use:
    """Returns the Use of batteries of a capacity [Wh]."""
    joules = capacity * HOUR
    known = [track for track in tracks if np.isfinite(track.charge).any()]
    slopes = np.array([row for track in known for row in _standstills(track)]).reshape(-1, 2)
    falling = slopes[slopes[:, 0] < 0, 0] * -joules
    electronics = resampled(falling, LEAST, "standstills")
    rising = slopes[slopes[:, 0] > 0]
    bulk = resampled(rising[rising[:, 1] < BULK, 0] * joules, LEAST, "stretches of charging")
    power = combined(lambda at_rest, net: net + at_rest, electronics, bulk)
    return Use(
        electronics,
        power,
        _taper(rising, power, electronics, joules),
        _efficiency(known, electronics, joules),
    )


def _standstills(track: Track) -> Iterator[tuple[float, float]]:
    """Yields (change of the state of charge a second, its mean) while a robot stands."""
    still = (np.abs(track.speed) <= STANDS) & (np.abs(track.turning) <= TURNS) & ~track.lifting
    for begin, end in stretches(still & np.isfinite(track.charge)):
        # The first and the last sample may belong to what was before and comes after.
        yield from _pieces(track, begin + 1, end - 1)


def _pieces(track: Track, begin: int, end: int) -> Iterator[tuple[float, float]]:
    """Yields the same of pieces of a standstill, short enough that a charger's power hardly falls
    meanwhile."""
    time, charge = track.time, track.charge
    while begin < end - 1:
        last = begin + 1
        while last < end - 1 and time[last] - time[begin] < PIECE:
            if time[last] - time[begin] >= STANDING and abs(charge[last] - charge[begin]) >= STEP:
                break
            last += 1
        t, c = time[begin : last + 1], charge[begin : last + 1]
        if _is_even(t, c):
            yield float((c[-1] - c[0]) / (t[-1] - t[0])), float((c[0] + c[-1]) / 2)
        begin = last


def _is_even(time: np.ndarray, charge: np.ndarray) -> bool:
    """Returns whether a piece is long enough, and changes by itself alone: a full battery does not,
    nor does one at a charger that begins or ends."""
    if time[-1] - time[0] < STANDING or np.diff(time).max() > LONGEST_GAP or charge.max() >= 1:
        return False
    half = len(charge) // 2
    return bool(
        charge[-1] != charge[0] and (charge[half] - charge[0]) * (charge[-1] - charge[half]) >= 0
    )


def _taper(rising: np.ndarray, power: Finding, electronics: Finding, joules: float) -> Finding:
    """Returns the state of charge from which the power falls: by P (1 - c) / (1 - taper)."""
    if isinstance(power, TooLittle) or isinstance(electronics, TooLittle):
        return TooLittle(0, LEAST, "stretches of charging beyond the taper")
    share = (rising[:, 0] * joules + electronics.value) / power.value
    falls = (share > TAPERED[0]) & (share < TAPERED[1])
    tapers = 1 - (1 - rising[falls, 1]) / share[falls]
    return resampled(tapers, LEAST, "stretches of charging beyond the taper")


def _efficiency(tracks: list[Track], electronics: Finding, joules: float) -> Finding:
    """Returns the efficiency of drives without units: what comes to the wheels over what leaves the
    battery. Mass and rolling resistance are those of the model; braking gives back the usual."""
    kind = "drives without a unit"
    if isinstance(electronics, TooLittle):
        return TooLittle(0, LEAST_DRIVES, kind)
    usual = Energy()
    shares = []
    for track in tracks:
        for before, after in spans(track.speed, STANDS, track):
            if track.loaded[before : after + 1].any() or after - before < LEAST:
                continue
            seconds = track.time[after] - track.time[before]
            spent = (track.charge[before] - track.charge[after]) * joules
            spent -= electronics.value * seconds
            way = np.hypot(
                np.diff(track.x[before : after + 1]), np.diff(track.y[before : after + 1])
            )
            peak = _top(track.speed[before : after + 1])
            if not peak or np.abs(track.turning[before : after + 1]).max() > TURNS:
                continue
            inert = ROBOT.mass + 2 * WHEEL_INERTIA / WHEEL_RADIUS**2
            kinetic = inert * peak**2 / 2
            rolling = usual.rolling_resistance * ROBOT.mass * GRAVITY * float(way.sum())
            taken = spent + usual.regeneration * kinetic
            if taken > 0:
                shares.append((rolling + kinetic) / taken)
    return resampled(shares, LEAST_DRIVES, kind)


def _top(speed: np.ndarray) -> float:
    """Returns the speed at which a drive went on evenly and which it never exceeded; 0: it did
    not."""
    top = float(speed.max())
    even = speed >= (1 - EVEN) * top
    dips = np.diff(np.flatnonzero(speed > STANDS)).max(initial=1) > 1
    below = speed[int(np.argmax(even)) : len(speed) - int(np.argmax(even[::-1]))]
    steady = len(below) >= 3 and below.min() >= (1 - 2 * EVEN) * top
    return top if steady and not dips else 0.0
