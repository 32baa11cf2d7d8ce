# SPDX-License-Identifier: Apache-2.0
"""What several trainings say together: intervals by the stratified bootstrap (Agarwal et al.,
"Deep Reinforcement Learning at the Edge of the Statistical Precipice", NeurIPS 2021): seeds
are drawn with replacement within each task, and the statistic of each draw is looked at."""

from collections.abc import Callable, Sequence

import numpy as np

DRAWS = 2000
LEVEL = 0.95


def interquartile_mean(scores: np.ndarray) -> np.ndarray:
    """Returns the mean of the middle half of (…, n) scores, (…,)."""
    ordered = np.sort(scores, axis=-1)
    n = ordered.shape[-1]
    # Where n is not a multiple of 4 scores at the quarters count by part.
    edge = np.clip(np.minimum(np.arange(1, n + 1), np.arange(n, 0, -1)) - n / 4, 0, 1)
    return (ordered * edge).sum(-1) / edge.sum()


def interval(
    strata: Sequence[np.ndarray],
    statistic: Callable[[np.ndarray], np.ndarray] = interquartile_mean,
    draws: int = DRAWS,
    level: float = LEVEL,
    seed: int = 0,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns (statistic, low, high) of the scores of all tasks, each (…,).

    strata: of each task (…, seeds): leading axes, such as points of a curve, are alike. A seed is
    drawn as a whole curve.
    """
    random = np.random.default_rng(seed)
    statistics = []
    for _ in range(draws):
        drawn = [s[..., random.integers(s.shape[-1], size=s.shape[-1])] for s in strata]
        statistics.append(statistic(np.concatenate(drawn, axis=-1)))
    low, high = np.quantile(statistics, [(1 - level) / 2, (1 + level) / 2], axis=0)
    return statistic(np.concatenate(list(strata), axis=-1)), low, high


def aligned(curves: Sequence[Sequence[tuple[float, float]]], at: np.ndarray) -> np.ndarray:
    """Returns (points, seeds): curves of (steps, return) at the same steps, by the mean of the
    episodes since the point before."""
    out = np.empty((len(at), len(curves)))
    for seed, curve in enumerate(curves):
        steps, values = np.array(curve, float).T
        sums = np.concatenate([[0], np.cumsum(values)])
        ends = np.searchsorted(steps, at, side="right")
        begins = np.concatenate([[0], ends[:-1]])
        mean = (sums[ends] - sums[begins]) / np.maximum(ends - begins, 1)
        out[:, seed] = np.where(ends > begins, mean, np.interp(at, steps, values))
    return out
