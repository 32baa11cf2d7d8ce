# SPDX-License-Identifier: Apache-2.0
"""RWARE, the multi-robot warehouse benchmark, to the bit and many times as fast.

    import gymnasium, warehouse_learning.rware

    env = gymnasium.make("kiva-rware-tiny-2ag-v2")                      # as rware-tiny-2ag-v2
    envs = gymnasium.make_vec("kiva-rware-tiny-2ag-v2", num_envs=64)    # in arrays, on all cores
    env = warehouse_learning.rware.parallel_env("rware-tiny-2ag-v2")    # PettingZoo

Same seed and actions give the same observations, rewards, ends and infos as the package rware
2.0.0 (Papoudakis et al., "Benchmarking Multi-Agent Deep Reinforcement Learning Algorithms in
Cooperative Tasks", NeurIPS 2021) with networkx 3. Importing this registers what importing rware
does; image_registration() and full_registration() add what they add there.
"""

from typing import TYPE_CHECKING, Any

from warehouse_learning.rware import ids
from warehouse_learning.rware.env import Warehouse
from warehouse_learning.rware.task import (
    Action,
    Direction,
    ImageLayer,
    ObservationType,
    RewardType,
)
from warehouse_learning.rware.vector import RwareVectorEnv

if TYPE_CHECKING:
    from warehouse_learning.rware.parallel import RwareParallelEnv

__all__ = [
    "Action",
    "Direction",
    "ImageLayer",
    "ObservationType",
    "RewardType",
    "RwareVectorEnv",
    "Warehouse",
    "full_registration",
    "image_registration",
    "options_of",
    "parallel_env",
]


def image_registration() -> None:
    """Registers the tasks with pictures: kiva-rware-img-…, -imgdict-…, each also with -Nd."""
    ids.register_all(ids.of_images())


def full_registration() -> None:
    """Registers every combination that RWARE knows; takes some seconds."""
    ids.register_all(ids.full())


def parallel_env(name: str | None = None, **options: Any) -> "RwareParallelEnv":
    """A PettingZoo ParallelEnv of a registered task, by RWARE's name or with kiva- before it, or of
    options as of Warehouse; an option beside a name replaces the task's."""
    from warehouse_learning.rware.parallel import RwareParallelEnv

    return RwareParallelEnv(**(options_of(name) if name else {}) | options)


def options_of(name: str) -> dict[str, Any]:
    """Returns the options of a registered task, as Warehouse takes them: kiva-rware-tiny-4ag-v2,
    rware-tiny-4ag-v2 or tiny-4ag."""
    import gymnasium

    if "rware-" not in name:
        name = f"rware-{name}-v2"
    return dict(gymnasium.spec(name if name.startswith("kiva-") else f"kiva-{name}").kwargs)


ids.register_all(ids.plain())
