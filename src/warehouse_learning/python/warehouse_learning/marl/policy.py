# SPDX-License-Identifier: Apache-2.0
"""Policies: one network that all robots share. That of RWARE's task is stored as a file.

The file is numpy's .npz, of a few hundred kilobytes; loading and using it needs numpy alone.
"""

import json
from pathlib import Path
from typing import Any

import numpy as np

from warehouse_layout.file import user_file
from warehouse_learning.marl.encoding import Encoder, Encoding
from warehouse_learning.marl.mlp import Mlp

FORMAT = "kiva-policy 1"
SHIPPED = Path(__file__).parent / "weights"
ACTIONS = 5
IMPOSSIBLE = np.float32(-1e9)  # the logit of an action without a chance


class PolicyError(ValueError):
    """A file that is not a policy; the message names it and what was expected."""


def drawn(logits: np.ndarray, random: np.random.Generator) -> np.ndarray:
    """Returns (m,) actions, each drawn with the chances that a row of logits (m, 5) means."""
    noise = random.standard_exponential(logits.shape, np.float32)
    return (logits - np.log(noise + 1e-20)).argmax(-1)  # Gumbel's trick


def masked(logits: np.ndarray, possible: np.ndarray | None) -> np.ndarray:
    """Returns logits (m, 5) by which an action that is not possible, (m, 5) bool, has no chance."""
    return logits if possible is None else np.where(possible, logits, IMPOSSIBLE)


class Policy:
    """Chooses each robot's action from what the robot observes."""

    def __init__(self, network: Mlp, encoder: Encoding) -> None:
        self.network, self.encoder = network, encoder

    def logits(self, observations: np.ndarray, possible: np.ndarray | None = None) -> np.ndarray:
        """Returns (…, agents, 5) of observations (…, agents, width) and masks (…, agents, 5)."""
        rows = self.encoder.encode(observations)
        out, _ = self.network.forward(rows.reshape(-1, rows.shape[-1]))
        return masked(out.reshape(*rows.shape[:-1], ACTIONS), possible)

    def act(
        self,
        observations: np.ndarray,
        random: np.random.Generator,
        possible: np.ndarray | None = None,
    ) -> np.ndarray:
        """Returns (…, agents) actions, drawn as they were in the training."""
        return drawn(self.logits(observations, possible), random)


class GridPolicy(Policy):
    """A policy of RWARE's task. `about`: the task, and how it was trained."""

    def __init__(self, network: Mlp, encoder: Encoder, about: dict[str, Any]) -> None:
        super().__init__(network, encoder)
        self.encoder: Encoder = encoder
        self.about = about

    def save(self, path: str | Path) -> None:
        """Writes it; load() reads it again. Weights are stored as float16."""
        encoder = self.encoder
        about = self.about | {
            "format": FORMAT,
            "floor": [encoder.width, encoder.height, encoder.agents],
        }
        weights = {f"p{i}": p.astype(np.float16) for i, p in enumerate(self.network.parameters)}
        np.savez_compressed(path, about=json.dumps(about), **weights)


def find(name: str) -> Path:
    """Returns the file of a policy: a path, or the name of one that is shipped.

    Raises PolicyError that lists those.
    """
    if Path(name).is_file():
        return Path(name)
    shipped = SHIPPED / f"{name}.npz"
    if shipped.is_file():
        return shipped
    known = ", ".join(sorted(path.stem for path in SHIPPED.glob("*.npz")))
    raise PolicyError(f"{name}: there is no such file, and no such policy; there are {known}")


def load(name: str | Path) -> GridPolicy:
    """Returns the policy of a file, or a shipped one by its name. Raises PolicyError."""
    path = find(str(name))
    try:
        with user_file.opened(path) as file, np.load(file, allow_pickle=False) as content:
            about = json.loads(str(content["about"]))
            parameters = [content[f"p{i}"].astype(np.float32) for i in range(len(content) - 1)]
        if about.pop("format", None) != FORMAT:
            raise PolicyError(f"{path}: its format is not {FORMAT!r}")
        return _assembled(parameters, about)
    except (OSError, KeyError, ValueError, EOFError) as error:
        if isinstance(error, PolicyError):
            raise
        raise PolicyError(f"{path} is not a policy: {error}") from error


def _assembled(parameters: list[np.ndarray], about: dict[str, Any]) -> GridPolicy:
    width, height, agents = about.pop("floor")
    network = Mlp([], 1.0, np.random.default_rng(0))
    network.parameters = parameters
    sizes = len(parameters[0])
    encoder = Encoder(width, height, agents, sizes - width - height - agents + 2)
    return GridPolicy(network, encoder, about)
