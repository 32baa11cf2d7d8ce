# SPDX-License-Identifier: Apache-2.0
"""The evaluation of a policy: whole episodes of RWARE's task, on the grid or with bodies."""

from collections.abc import Callable
from typing import Any

import numpy as np

from warehouse_learning.marl.planned import Planned
from warehouse_learning.marl.policy import GridPolicy
from warehouse_learning.rware.vector import RwareVectorEnv

Act = Callable[[np.ndarray], np.ndarray]


def episodes(
    make_act: Callable[[RwareVectorEnv], Act], count: int, seed: int = 0, **options: Any
) -> dict[str, np.ndarray]:
    """Plays `count` episodes side by side, from seeds seed + i.

    make_act(envs) returns what chooses actions (count, agents) from observations. Options as of
    RwareVectorEnv. Returns `returns` (count,), the sums of all robots' rewards, and where actions
    take time also `seconds` (count,) and `collisions` (count,).
    """
    envs = RwareVectorEnv(count, **options)
    observations, _ = envs.reset(seed=seed)
    act = make_act(envs)
    returns, over = np.zeros(count), np.zeros(count, bool)
    infos: dict[str, Any] = {}
    while not over.all():
        observations, rewards, ends, _, infos = envs.step(act(observations))
        returns += rewards.sum(1) * ~over
        over |= ends
    results = {"returns": returns}
    if "time" in infos:
        results["seconds"] = infos["time"]
    if "collisions" in infos:
        results["collisions"] = infos["collisions"].sum(1)
    return results


def by_policy(policy: GridPolicy, seed: int = 0) -> Callable[[RwareVectorEnv], Act]:
    """Returns what episodes() takes for a trained policy."""
    random = np.random.default_rng(seed)
    return lambda _envs: lambda observations: policy.act(observations, random).astype(np.int8)


def by_planner(envs: RwareVectorEnv) -> Act:
    """Chooses actions as the fleet's planner does, in each warehouse."""
    planned = [Planned(envs.task, envs.warehouses, i) for i in range(envs.num_envs)]
    return lambda _observations: np.stack([planner.act() for planner in planned])


def by_chance(envs: RwareVectorEnv) -> Act:
    """Chooses any action."""
    random = np.random.default_rng(0)
    shape = envs.num_envs, envs.task.n_agents
    return lambda _observations: random.integers(5, size=shape).astype(np.int8)
