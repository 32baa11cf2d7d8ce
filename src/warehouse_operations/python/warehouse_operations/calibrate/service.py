# SPDX-License-Identifier: Apache-2.0
"""The pace of stations: seconds a piece, a line, a bundle, and of the handover of a unit.

A piece is out of its bin `pick` after it was begun, and the next one is begun `piece` after it; the
first piece of a line takes `line` more (see Settings). So pieces that follow each other leave their
bins at gaps of `piece` or `piece + line`, and the first piece of a unit that finds idle hands
leaves its bin `pick + line` after the unit came.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from warehouse_operations.calibrate.estimates import (
    Estimate,
    Finding,
    TooLittle,
    edited,
    fitted,
    resampled,
)
from warehouse_operations.calibrate.recording import Arrival, Piece, Recording

LEAST = 10
LEAST_OF_STATION = 20  # pieces of a station that is named
NORMAL = 1.959964  # 97.5 % quantile
STEADY = 0.02  # deviation over mean below which the time of pieces is taken for constant
APART = 0.02  # by which the pace of a station differs from that of all


@dataclass(frozen=True)
class Pace:
    """The pace of people at stations [s]. deviation: of a piece from piece to piece."""

    piece: Finding
    deviation: Finding
    line: Finding
    pick: Finding
    bundle: Finding
    exchange: Finding


def of_recording(recording: Recording) -> tuple[Pace, dict[str, Pace]]:
    """Returns the Pace of all stations together, and of those that differ from it."""
    whole = _pace(recording.pieces, recording.arrivals, recording.bundles)
    stations = {piece.station for piece in recording.pieces}
    by_station = {}
    for name in sorted(stations):
        pieces = [piece for piece in recording.pieces if piece.station == name]
        arrivals = [arrival for arrival in recording.arrivals if arrival.station == name]
        pace = _pace(pieces, arrivals, [])
        if len(pieces) >= LEAST_OF_STATION and _differs(pace.piece, whole.piece):
            by_station[name] = pace
    return whole, by_station


def _differs(one_station: Finding, all_of_them: Finding) -> bool:
    if isinstance(one_station, TooLittle) or isinstance(all_of_them, TooLittle):
        return False
    middle = all_of_them.value
    outside = not one_station.low <= middle <= one_station.high
    return outside and abs(one_station.value / middle - 1) > APART


def _pace(pieces: Sequence[Piece], arrivals: Sequence[Arrival], bundles: Sequence[Piece]) -> Pace:
    piece, line, spread = _pieces(pieces)
    pick = _pick(arrivals, piece, line)
    deviation = _deviation(spread, piece, pick)
    bundle = resampled([piece.gap for piece in bundles], LEAST, "bundles")
    exchanges = [a.exchange for a in arrivals if np.isfinite(a.exchange)]
    return Pace(piece, deviation, line, pick, bundle, resampled(exchanges, LEAST, "exchanges"))


def _pieces(pieces: Sequence[Piece]) -> tuple[Finding, Finding, float]:
    """Returns seconds a piece and a line by least squares of gaps, and the deviation of gaps."""
    lines = sum(p.new_line for p in pieces)
    tells_lines = LEAST <= lines <= len(pieces) - LEAST
    if tells_lines:
        rows = [(p.quantity, float(p.new_line), p.gap) for p in pieces]
    else:
        rows = [(p.quantity, 0.0, p.gap) for p in pieces if not p.new_line]
    fit = fitted(rows, LEAST, "pieces of the same line")
    if isinstance(fit, TooLittle):
        return fit, TooLittle(lines, LEAST, "lines"), 0.0
    coefficients, covariance, count = fit
    wide = NORMAL * np.sqrt(np.maximum(np.diag(covariance), 0.0))
    piece = _normal(coefficients[0], wide[0], count, "pieces")
    line: Finding = TooLittle(lines, LEAST, "lines")
    if tells_lines:
        line = _normal(coefficients[1], wide[1], lines, "lines", 0.0)
    return piece, line, _scatter(rows, coefficients)


def _scatter(rows: Sequence[Sequence[float]], coefficients: np.ndarray) -> float:
    """Returns the deviation of single pieces from a fit."""
    table = np.asarray(rows, float)
    residuals = table[:, -1] - table[:, :-1] @ coefficients
    singles = edited(residuals[table[:, 0] == 1])
    return float(singles.std()) if len(singles) > 1 else 0.0


def _normal(value: float, wide: float, count: int, kind: str, least: float = -np.inf) -> Estimate:
    value = max(float(value), least)
    return Estimate(value, max(value - wide, least), value + wide, count, kind)


def _pick(arrivals: Sequence[Arrival], piece: Finding, line: Finding) -> Finding:
    """Returns the time until the first piece is out of its bin, where hands were idle."""
    if isinstance(piece, TooLittle):
        return piece
    more = line.value if isinstance(line, Estimate) else 0.0
    waits = [
        arrival.wait - more * arrival.new_line
        for arrival in arrivals
        if arrival.quantity == 1 and arrival.idle > piece.value
    ]
    return resampled(waits, LEAST, "units that found idle hands")


def _deviation(spread: float, piece: Finding, pick: Finding) -> Finding:
    """Returns the deviation of a piece's time. A gap holds the rest of one piece and the first part
    of the next, which vary each by itself."""
    if isinstance(piece, TooLittle):
        return piece
    first = pick.value / piece.value if isinstance(pick, Estimate) else 0.3
    first = min(max(first, 0.0), 1.0)
    deviation = spread / math.sqrt((1 - first) ** 2 + first**2)
    wide = NORMAL * deviation / math.sqrt(2 * max(piece.count - 1, 1))  # of a normal sample
    return Estimate(deviation, max(deviation - wide, 0.0), deviation + wide, piece.count, "pieces")
