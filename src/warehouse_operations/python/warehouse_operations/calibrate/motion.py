# SPDX-License-Identifier: Apache-2.0
"""The motion of robots from their tracks: top speed, acceleration, braking, turns.

A ramp is measured without a clock: a robot that set out from rest has v² = 2 a s after the way s,
whenever its report was made and came (and one that turns has w² = 2 α φ). So reports once a second
do, if there are many; delays of radio and rounded stamps don't matter.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from warehouse_operations.calibrate.estimates import (
    Finding,
    TooLittle,
    combined,
    resampled,
)
from warehouse_operations.calibrate.recording import Track

STANDS = 0.01  # up to this speed [m/s]; from there it has come 0.05 mm
TURNS = 0.02  # above this rate [rad/s]
CREEPS = 0.2  # slower is no cruise [m/s]
GAP = 2.5  # longest time between two samples of a drive [s]
STRAIGHT = 0.1  # most change of heading in one drive [rad]
STEADY = 3  # samples of a cruise, since two may be before and after a peak
EVEN = 0.01  # share by which speeds of a cruise may differ
RAMP = 0.15, 0.9  # part of the top speed in which a ramp is measured
LEAST_WAY = 0.02  # of a ramp's sample [m]
QUARTER = math.pi / 2
TURN_RAMP = 0.3  # share of a turn, from either end, in which its ramp is measured
TURN_MIDDLE = 0.1  # half of the share in its middle in which its top rate is measured
LEAST_TURN = 0.02  # of a ramp's sample [rad]
CAPPED = 0.95  # of the rate without a limit; below it a turn has a top rate
LEAST = 8  # ramps, cruises or turns of an estimate
LEAST_UNLOADED = 20  # that are enough without those with units


class Ramp(NamedTuple):
    """The (angular) acceleration of one ramp, and whether the robot carried a unit."""

    acceleration: float
    loaded: bool


class Middle(NamedTuple):
    """A sample near the middle of a turn: its rate [rad/s], and its angle to the nearer end."""

    rate: float
    angle: float


@dataclass(frozen=True)
class Motion:
    """What the tracks say. acceleration: that of both ramps together, by which runs from rest to
    rest take as long as they do; see `both`."""

    speed: Finding
    speeding_up: Finding
    braking: Finding
    acceleration: Finding
    turn_rate: Finding
    turn_acceleration: Finding
    quarter_turn_time: Finding


def of_tracks(tracks: list[Track]) -> Motion:
    """Returns the Motion of tracks."""
    cruises = [speed for track in tracks for speed in _cruises(track)]
    speed = resampled(cruises, LEAST, "cruises")
    top = np.inf if isinstance(speed, TooLittle) else speed.value
    drives = [(track, drive) for track in tracks for drive in _spans(track.speed, STANDS, track)]
    ups = [r for track, (a, b) in drives for r in _ramp(track, a, b, top, 1)]
    downs = [r for track, (a, b) in drives for r in _ramp(track, a, b, top, -1)]
    up, down = _of_ramps(ups, "ramps"), _of_ramps(downs, "ramps")
    rate, ramp, quarter = _turns(tracks)
    return Motion(speed, up, down, combined(both, up, down), rate, ramp, quarter)


def both(up: float, down: float) -> float:
    """Returns the harmonic mean of acceleration and braking [m/s²]. With it in place of both, runs
    from rest to rest of any length take as long: s/v + v/2 (1/a + 1/b), or √(2 s (1/a + 1/b))."""
    return 2 * up * down / (up + down)


def _of_ramps(ramps: list[Ramp], kind: str) -> Finding:
    """Returns the acceleration of ramps without a unit, if there are enough: a heavy one may limit
    it."""
    unloaded = [ramp.acceleration for ramp in ramps if not ramp.loaded]
    enough = len(unloaded) >= LEAST_UNLOADED
    values = unloaded if enough else [ramp.acceleration for ramp in ramps]
    return resampled(values, LEAST, f"{kind} without a unit" if enough else kind)


def _cruises(track: Track) -> Iterator[float]:
    """Yields the speed of each stretch in which it stays the same."""
    v = track.speed
    same = np.abs(np.diff(v)) <= EVEN * v[1:]
    near = np.diff(track.time) <= GAP
    going = same & near & (v[1:] > CREEPS) & (np.abs(np.diff(track.turning)) < TURNS)
    for begin, end in _stretches(going):
        if end - begin + 1 >= STEADY:
            yield float(np.median(v[begin : end + 1]))


def _stretches(mask: np.ndarray) -> Iterator[tuple[int, int]]:
    """Yields (first, one after the last) of each stretch of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], mask.astype(int), [0]))))
    yield from zip(edges[::2].tolist(), edges[1::2].tolist())


def _spans(rate: np.ndarray, least: float, track: Track) -> Iterator[tuple[int, int]]:
    """Yields the samples at rest (before, after) around each motion whose samples follow each
    other closely."""
    for begin, end in _stretches(np.abs(rate) > least):
        before, after = begin - 1, end
        if before >= 0 and after < len(track):
            times = np.diff(track.time[before : after + 1])
            if times[1:-1].max(initial=0.0) <= GAP:
                yield before, after


def _ramp(track: Track, before: int, after: int, top: float, sign: int) -> Iterator[Ramp]:
    """Yields the ramp at the begin (sign 1) or at the end (-1) of a drive."""
    inside = slice(before + 1, after)
    anchor = before if sign > 0 else after
    turned = np.abs(_wrapped(track.yaw[inside] - track.yaw[before + 1]))
    if turned.max(initial=0.0) > STRAIGHT:
        return
    way = np.hypot(track.x[inside] - track.x[anchor], track.y[inside] - track.y[anchor])[::sign]
    v = track.speed[inside][::sign]
    rising = int(np.argmax(np.append(np.diff(v) <= 0, True))) + 1  # up to the first fall
    highest = v[rising - 1] if np.isinf(top) else min(top, v[rising - 1] / RAMP[1])
    part = slice(0, rising)
    kept = (v[part] > RAMP[0] * highest) & (v[part] < RAMP[1] * highest) & (way[part] > LEAST_WAY)
    if not kept.any():
        return
    squares, ways = v[part][kept] ** 2, way[part][kept]
    if kept.sum() >= 3 and np.ptp(ways) > LEAST_WAY:
        # The slope alone: a robot that set out between two steps of its own has an offset.
        acceleration = float(np.polyfit(ways, squares, 1)[0]) / 2
    else:
        acceleration = float((squares / ways).mean()) / 2
    if acceleration > 0:
        yield Ramp(acceleration, bool(track.loaded[anchor]))


def _turns(tracks: list[Track]) -> tuple[Finding, Finding, Finding]:
    """Returns top rate [rad/s] and angular acceleration [rad/s²] of turns in place, and the time of
    a quarter turn [s]."""
    ramps: list[Ramp] = []
    tops: list[Middle] = []
    for track in tracks:
        turning = np.where(np.abs(track.speed) <= STANDS, track.turning, 0.0)
        for before, after in _spans(turning, TURNS, track):
            _turn(track, before, after, ramps, tops)
    ramp = _of_ramps(ramps, "samples in turns")
    if isinstance(ramp, TooLittle):
        return TooLittle(len(tops), LEAST, "turns"), ramp, ramp
    middle = [(top.rate, top.rate / math.sqrt(2 * ramp.value * top.angle)) for top in tops]
    kind = "samples in the middle of turns"
    share = resampled([part for _, part in middle], LEAST, kind)
    if isinstance(share, TooLittle):
        return share, ramp, share
    if share.value > CAPPED:
        peak = combined(lambda a: math.sqrt(a * QUARTER), ramp)
        return peak, ramp, combined(lambda a: 2 * math.sqrt(QUARTER / a), ramp)
    rate = resampled([rate for rate, _ in middle], LEAST, kind)
    return rate, ramp, combined(lambda w, a: QUARTER / w + w / a, rate, ramp)


def _turn(track: Track, before: int, after: int, ramps: list[Ramp], tops: list[Middle]) -> None:
    """Adds the samples of a quarter turn to those of ramps and of their middle."""
    moved = np.hypot(track.x[after] - track.x[before], track.y[after] - track.y[before])
    turned = abs(_wrapped(track.yaw[after] - track.yaw[before]))
    if moved > LEAST_WAY or abs(turned - QUARTER) > STRAIGHT:
        return
    loaded = bool(track.loaded[before])
    for i in range(before + 1, after):
        begun = abs(_wrapped(track.yaw[i] - track.yaw[before]))
        angle, w = min(begun, turned - begun), abs(track.turning[i])
        if LEAST_TURN < angle < TURN_RAMP * turned:
            ramps.append(Ramp(float(w**2 / (2 * angle)), loaded))
        elif angle > (0.5 - TURN_MIDDLE) * turned:
            tops.append(Middle(float(w), float(angle)))


def _wrapped(angle: np.ndarray) -> np.ndarray:
    return (angle + math.pi) % (2 * math.pi) - math.pi
