# SPDX-License-Identifier: Apache-2.0
"""A network learns what the fleet's planner would do, in states that it reaches itself: DAgger
(Ross et al., 2011). So a training can begin with robots that deliver, where chance hardly ever
does."""

import time
from typing import TYPE_CHECKING

import numpy as np

from warehouse_learning.marl.encoding import Encoder
from warehouse_learning.marl.mlp import Adam, Mlp, log_softmax
from warehouse_learning.marl.planned import Planned
from warehouse_learning.marl.policy import drawn

if TYPE_CHECKING:
    from warehouse_learning.rware.task import Task

ENVIRONMENTS = 16
ROUND = 50  # steps of each between two times of learning
BATCH, RATE = 1024, 2e-3
PASSES = 4  # over the samples, a round
LATE_PASSES = 12  # after the last round


def imitate(actor: Mlp, encoder: Encoder, task: "Task", steps: int, seed: int) -> float:
    """Lets an actor imitate the planner in a number of steps of RWARE's task, all environments'.

    In the first round the planner drives, then the network more and more. Returns the seconds of
    CPU that it took.
    """
    from warehouse_learning.rware.vector import RwareVectorEnv

    begin = time.process_time()
    random = np.random.default_rng(seed)
    envs = RwareVectorEnv.of_task(ENVIRONMENTS, task)
    inputs, targets = [], []
    observations, _ = envs.reset(seed=seed)
    planned = [Planned(task, envs.warehouses, i) for i in range(ENVIRONMENTS)]
    adam = Adam(actor.parameters)
    rounds = max(1, steps // (ROUND * ENVIRONMENTS))
    for number in range(rounds):
        for _ in range(ROUND):
            rows = encoder.encode(observations)
            chosen = np.stack([planner.act() for planner in planned])
            inputs.append(rows.reshape(-1, encoder.size))
            targets.append(chosen.ravel())
            own = drawn(actor.forward(inputs[-1])[0], random).reshape(chosen.shape)
            leads = random.random(ENVIRONMENTS) < number / rounds
            actions = np.where(leads[:, None], own, chosen).astype(np.int8)
            observations = envs.step(actions)[0]
        passes = LATE_PASSES if number == rounds - 1 else PASSES
        _learn(actor, adam, np.concatenate(inputs), np.concatenate(targets), passes, random)
    return time.process_time() - begin


def _learn(
    actor: Mlp,
    adam: Adam,
    inputs: np.ndarray,
    targets: np.ndarray,
    passes: int,
    random: np.random.Generator,
) -> None:
    """Makes the planner's actions more likely, by cross entropy."""
    for _ in range(passes * min(len(targets), 20 * BATCH) // BATCH):
        rows = random.integers(len(targets), size=BATCH)
        logits, kept = actor.forward(inputs[rows])
        slopes = np.exp(log_softmax(logits))
        slopes[np.arange(BATCH), targets[rows]] -= 1
        adam.step(actor.backward(kept, slopes / np.float32(BATCH)), RATE)
