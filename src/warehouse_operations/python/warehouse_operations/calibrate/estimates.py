# SPDX-License-Identifier: Apache-2.0
"""Robust estimates with 95 % intervals.

Samples of a recording are not all of what is sought: a robot in traffic does not reach its speed,
a picker pauses. So most estimates are of the densest half of the samples, and their intervals
resample it.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.stats import chi2

CONFIDENCE = 0.95
RESAMPLES = 400
SEED = 1
REWEIGHTED = 50
NEAR = 1e-3  # of a line, residuals that are none
REJECTED = 6.0  # scaled MADs from the median beyond which a sample is another matter
MAD = 1.4826  # of a normal distribution's deviation over its median absolute deviation


@dataclass(frozen=True)
class Estimate:
    """A parameter with its 95 % interval, from a number of samples (of which kind)."""

    value: float
    low: float
    high: float
    count: int
    kind: str = "samples"


@dataclass(frozen=True)
class TooLittle:
    """A parameter that the samples do not determine: how many there are, how many it takes."""

    count: int
    least: int
    kind: str = "samples"

    def __str__(self) -> str:
        return f"too little to say: {self.count} {self.kind}, {self.least} were expected"


Finding = Estimate | TooLittle


def shorth(values: ArrayLike) -> float:
    """Returns the mean of the shortest interval that holds half of the values (Andrews, Bickel,
    Hampel, Huber, Rogers, Tukey: Robust Estimates of Location, 1972). Up to half of the values may
    be anything."""
    ordered = np.sort(np.asarray(values, float))
    half = len(ordered) // 2 + 1
    widths = ordered[half - 1 :] - ordered[: len(ordered) - half + 1]
    # Of equal widths the middle one, so that rounded values lead nowhere.
    narrowest = np.flatnonzero(widths <= widths.min() + 1e-12)
    begin = int(narrowest[len(narrowest) // 2])
    return float(ordered[begin : begin + half].mean())


def edited(values: ArrayLike) -> np.ndarray:
    """Returns the values without those farther than REJECTED scaled median absolute deviations from
    the median (Hampel, Journal of the American Statistical Association 69, 1974)."""
    array = np.asarray(values, float)
    if not len(array):
        return array
    away = np.abs(array - np.median(array))
    return array[away <= max(REJECTED * MAD * float(np.median(away)), 1e-6 * float(away.max()))]


def edited_mean(values: ArrayLike) -> float:
    """Returns the mean of the edited values."""
    return float(edited(values).mean())


def resampled(
    values: ArrayLike,
    least: int,
    kind: str = "samples",
    of: Callable[[np.ndarray], float] = shorth,
) -> Finding:
    """Returns an estimate with a percentile interval of the bootstrap (Efron, Tibshirani: An
    Introduction to the Bootstrap, 1993, chapter 13). values: rows, one a sample."""
    array = np.asarray(values, float)
    if len(array) < least:
        return TooLittle(len(array), least, kind)
    rng = np.random.default_rng(SEED)
    draws = [of(array[rng.integers(len(array), size=len(array))]) for _ in range(RESAMPLES)]
    low, high = np.quantile(draws, [(1 - CONFIDENCE) / 2, (1 + CONFIDENCE) / 2])
    value = of(array)
    return Estimate(value, min(low, value), max(high, value), len(array), kind)


def fitted(
    rows: Sequence[Sequence[float]], least: int, kind: str
) -> tuple[np.ndarray, np.ndarray, int] | TooLittle:
    """Returns coefficients of a linear fit, their covariance, and the number of rows in it.

    rows: the regressors, then the value. Least squares of the rows that the line of least absolute
    deviations does not leave aside as `edited` does; the covariance is that of independent errors.
    """
    table = np.asarray(rows, float)
    if len(table) < least:
        return TooLittle(len(table), least, kind)
    x, y = table[:, :-1], table[:, -1]
    residuals = y - x @ _least_absolute(x, y)
    away = np.abs(residuals - np.median(residuals))
    table = table[away <= max(REJECTED * MAD * float(np.median(away)), NEAR)]
    x, y = table[:, :-1], table[:, -1]
    coefficients, *_ = np.linalg.lstsq(x, y, rcond=None)
    free = max(len(table) - x.shape[1], 1)
    variance = float(((y - x @ coefficients) ** 2).sum()) / free
    return coefficients, variance * np.linalg.pinv(x.T @ x), len(table)


def _least_absolute(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Returns the coefficients of least absolute deviations, by least squares with weights that
    follow the residuals (Schlossmacher, JASA 68, 1973)."""
    weights = np.ones(len(y))
    for _ in range(REWEIGHTED):
        root = np.sqrt(weights)
        coefficients, *_ = np.linalg.lstsq(x * root[:, None], y * root, rcond=None)
        weights = 1 / np.maximum(np.abs(y - x @ coefficients), NEAR)
    return np.asarray(coefficients, float)


def rate(count: int, exposure: float, kind: str) -> Finding:
    """Returns a rate of events of a Poisson process, with the exact interval of Garwood
    (Biometrika 28, 1936)."""
    if exposure <= 0 or count < 1:
        return TooLittle(count, 1, kind)
    tail = (1 - CONFIDENCE) / 2
    low = float(chi2.ppf(tail, 2 * count)) / 2
    high = float(chi2.ppf(1 - tail, 2 * count + 2)) / 2
    return Estimate(count / exposure, low / exposure, high / exposure, count, kind)


def mean_duration(durations: Sequence[float], unfinished: float, kind: str) -> Finding:
    """Returns the mean of exponentially distributed durations, of which some are not over:
    total time over ends, with the interval of Epstein and Sobel (Journal of the American
    Statistical Association 48, 1953). unfinished: the time of those so far."""
    count = len(durations)
    if not count:
        return TooLittle(0, 1, kind)
    total, tail = sum(durations) + unfinished, (1 - CONFIDENCE) / 2
    low = 2 * total / float(chi2.ppf(1 - tail, 2 * count))
    high = 2 * total / float(chi2.ppf(tail, 2 * count))
    return Estimate(total / count, low, high, count, kind)


def combined(of: Callable[..., float], *findings: Finding) -> Finding:
    """Returns a function of independent estimates, its interval by their extremes' root sum of
    squares (first-order propagation, JCGM 100:2008, 5.1.2)."""
    for finding in findings:
        if isinstance(finding, TooLittle):
            return finding
    estimates: list[Any] = list(findings)
    middle = [estimate.value for estimate in estimates]
    value, squares = of(*middle), 0.0
    for i, estimate in enumerate(estimates):
        ends = [of(*middle[:i], end, *middle[i + 1 :]) for end in (estimate.low, estimate.high)]
        squares += max(abs(end - value) for end in ends) ** 2
    half = math.sqrt(squares)
    count, kind = min((estimate.count, estimate.kind) for estimate in estimates)
    return Estimate(value, value - half, value + half, count, kind)
