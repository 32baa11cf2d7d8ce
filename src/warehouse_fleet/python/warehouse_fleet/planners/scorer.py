# SPDX-License-Identifier: Apache-2.0
"""Small networks that score candidates, and their files: what learned policies and planners are."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from warehouse_layout.file import user_file

FORMAT = "kiva-dispatcher 1"


class Scorer:
    """A network that scores candidates: a row of numbers, a layer of tanh, a score.

    weights: (features, hidden), (hidden,), (hidden,): into the layer, its biases, out of it; and
    (features,), from a row straight to its score.
    """

    def __init__(self, weights: Sequence[np.ndarray]) -> None:
        self.into, self.bias, self.out, self.straight = weights

    def scores(self, rows: np.ndarray) -> np.ndarray:
        """Returns (…,) of rows (…, features)."""
        return np.tanh(rows @ self.into + self.bias) @ self.out + rows @ self.straight

    def save(self, path: str | Path, role: str, about: str = "") -> None:
        """Writes it for a role; `about`: how it was made."""
        np.savez_compressed(
            path,
            format=FORMAT,
            role=role,
            about=about,
            into=self.into,
            bias=self.bias,
            out=self.out,
            straight=self.straight,
        )


def linear(weights: Sequence[float]) -> Scorer:
    """Returns a Scorer whose scores are linear in what a candidate is like, (features,) weights."""
    nothing = np.zeros((len(weights), 1)), np.zeros(1), np.zeros(1)
    return Scorer([*nothing, np.array(weights, float)])


def load(path: str | Path, role: str, features: int) -> Scorer:
    """Returns the Scorer of a file for a role. Raises ValueError that names what is wrong."""
    shapes = {"into": (features, -1), "bias": (-1,), "out": (-1,), "straight": (features,)}
    try:
        with user_file.opened(path) as file, np.load(file, allow_pickle=False) as content:
            if str(content["format"]) != FORMAT:
                raise ValueError(f"its format is not {FORMAT!r}")
            if str(content["role"]) != role:
                raise ValueError(f"it was learnt for the role {content['role']}, not {role}")
            return Scorer([_checked(content[name], name, shapes[name]) for name in shapes])
    except (OSError, KeyError, EOFError, ValueError) as error:
        raise ValueError(f"file: {path}: {error}") from error


def _checked(array: np.ndarray, name: str, expected: tuple[int, ...]) -> np.ndarray:
    fits = array.ndim == len(expected) and array.dtype.kind == "f" and np.isfinite(array).all()
    if not fits or (expected[0] > 0 and array.shape[0] != expected[0]):
        raise ValueError(f"{name} is {array.dtype} of shape {array.shape}, not numbers {expected}")
    return array
