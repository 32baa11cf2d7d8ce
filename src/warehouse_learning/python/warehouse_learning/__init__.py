# SPDX-License-Identifier: Apache-2.0
"""Environments to learn in, on the warehouse's physics, without ROS.

    import gymnasium, warehouse_learning

    env = gymnasium.make("KivaWarehouse-tiny-v0")               # a dispatcher: which task to whom
    env = gymnasium.make("KivaRobots-tiny-v0")                  # one policy moves every robot
    envs = gymnasium.make_vec("KivaRobots-tiny-v0", num_envs=64)  # on all cores
    env = warehouse_learning.parallel_env(size="tiny")          # PettingZoo: each robot an agent

Importing registers KivaWarehouse-v0 and KivaRobots-v0, of size `small`, and KivaWarehouse-SIZE-v0
and KivaRobots-SIZE-v0 for each of SIZES. Options: help(warehouse_learning.Options).
"""

from typing import TYPE_CHECKING, Any

from warehouse_learning.options import REWARDS, SIZES, OptionError, Options
from warehouse_learning.warehouses import Action, ActionError, Warehouses

if TYPE_CHECKING:
    from pettingzoo import AECEnv

    from warehouse_learning.parallel import KivaParallelEnv

__all__ = [
    "REWARDS",
    "SIZES",
    "Action",
    "ActionError",
    "OptionError",
    "Options",
    "Warehouses",
    "env",
    "parallel_env",
]


def parallel_env(**options: Any) -> "KivaParallelEnv":
    """Returns a PettingZoo ParallelEnv, a KivaParallelEnv; options as in Options."""
    from warehouse_learning.parallel import KivaParallelEnv

    return KivaParallelEnv(**options)


def env(**options: object) -> "AECEnv":
    """Returns the same for PettingZoo's other interface, in which agents take turns."""
    from warehouse_learning.parallel import in_turns

    return in_turns(parallel_env(**options))


def _register() -> None:
    try:
        from gymnasium import register
    except ImportError:
        return  # Warehouses need none of it
    for size in ("", *SIZES):
        name, options = (f"-{size}", {"size": size}) if size else ("", {})
        register(
            id=f"KivaWarehouse{name}-v0",
            entry_point="warehouse_learning.dispatcher:KivaDispatcherEnv",
            kwargs=options,
        )
        register(
            id=f"KivaRobots{name}-v0",
            entry_point="warehouse_learning.robots_env:KivaRobotsEnv",
            vector_entry_point="warehouse_learning.robots_env:KivaRobotsVectorEnv",
            kwargs=options,
        )
    register(
        id="KivaOperations-v0",
        entry_point="warehouse_learning.operations_env:KivaOperationsEnv",
    )


_register()
