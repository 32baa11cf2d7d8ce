# SPDX-License-Identifier: Apache-2.0
"""Trainings as files, from which they resume."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from warehouse_layout.file import user_file
from warehouse_learning.marl.mlp import Adam

KINDS = "weight", "mean", "square"


def save(path: Path, state: dict[str, Any], optimisers: Sequence[Adam]) -> None:
    """Writes a state, and networks with their optimisers, at once or not at all."""
    arrays: dict[str, np.ndarray] = {}
    for number, optimiser in enumerate(optimisers):
        parts = optimiser.parameters, optimiser.mean, optimiser.square
        for kind, list_of in zip(KINDS, parts):
            arrays |= {f"{number}_{kind}_{i}": array for i, array in enumerate(list_of)}
    state = state | {"updates": [optimiser.steps for optimiser in optimisers]}
    half = path.with_suffix(".part.npz")
    np.savez(half, state=json.dumps(state), **arrays)
    half.replace(path)


def load(path: Path, settings: dict[str, Any], optimisers: Sequence[Adam]) -> dict[str, Any]:
    """Returns a state, and fills networks and optimisers in place.

    Raises ValueError for what was made with other settings.
    """
    with user_file.opened(path, None) as file, np.load(file, allow_pickle=False) as content:
        state = json.loads(str(content["state"]))
        for name, value in state["settings"].items():
            if settings.get(name) != value:
                raise ValueError(f"{path}: its {name} is {value}, not {settings.get(name)}")
        for number, (optimiser, steps) in enumerate(zip(optimisers, state["updates"])):
            parts = optimiser.parameters, optimiser.mean, optimiser.square
            for kind, list_of in zip(KINDS, parts):
                for i, array in enumerate(list_of):
                    array[:] = content[f"{number}_{kind}_{i}"]
            optimiser.steps = steps
    return state
