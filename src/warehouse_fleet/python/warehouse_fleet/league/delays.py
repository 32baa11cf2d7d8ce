# SPDX-License-Identifier: Apache-2.0
"""Delays of robots as problems of the League of Robot Runners of 2026 describe them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

EVENTS, DURATIONS = ("bernoulli", "poisson"), ("uniform", "gaussian")


@dataclass(frozen=True)
class DelayModel:
    """When robots are delayed, and for how long; the names are those of `delayConfig`.

    `action_ticks` (`agentCounter`): ticks that an action takes; delays are in ticks as well."""

    seed: int = 0
    least: int = 1  # ticks
    most: int = 1  # ticks
    events: str = "bernoulli"  # each robot with `chance` a tick, or in all a Poisson number
    chance: float = 0.0  # a robot and tick
    durations: str = "uniform"  # from `least` to `most`, or Gaussian and limited to those
    mean_ratio: float = 0.5  # of a Gaussian: where from `least` to `most` its mean lies
    std_ratio: float = 0.2  # its standard deviation, of `most` - `least`
    action_ticks: int = 1


class Delays:
    """The delays of a run, action by action. Equal models give equal delays."""

    def __init__(self, model: DelayModel, robots: int) -> None:
        self._model, self._robots = model, robots
        self._rng = np.random.default_rng(model.seed)
        self._left = np.zeros(robots, int)  # ticks

    def step(self) -> NDArray[np.bool_]:
        """Draws the ticks of one action. Returns which robots stand for it, (robots,)."""
        stands = np.zeros(self._robots, bool)
        for _ in range(self._model.action_ticks):
            self._left = np.maximum(self._left - 1, 0)
            free = np.flatnonzero(self._left == 0)
            struck = self._strike(free)
            self._left[struck] = self._durations(len(struck))
            stands |= self._left > 0
        return stands

    def _strike(self, free: NDArray[np.intp]) -> NDArray[np.intp]:
        if self._model.events == "bernoulli":
            return free[self._rng.random(len(free)) < self._model.chance]
        count = self._rng.poisson(self._robots * self._model.chance)
        return self._rng.permutation(free)[:count]

    def _durations(self, count: int) -> NDArray[np.integer]:
        least, most = self._model.least, self._model.most
        if self._model.durations == "uniform":
            return self._rng.integers(least, most + 1, count)
        span = most - least
        drawn = self._rng.normal(
            least + span * self._model.mean_ratio, span * self._model.std_ratio, count
        )
        return np.clip(np.rint(drawn), least, most).astype(int)
