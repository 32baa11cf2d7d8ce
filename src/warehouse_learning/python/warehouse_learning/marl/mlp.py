# SPDX-License-Identifier: Apache-2.0
"""Perceptrons and Adam in numpy, for small networks and large batches: there the time goes into
products of matrices, which numpy's BLAS does as fast as any library."""

from collections.abc import Sequence

import numpy as np


class Mlp:
    """Layers of rectified linear units and a linear last one.

    sizes: of the input, each hidden layer and the output. `parameters` are weights and biases in
    turns, float32; weights are orthogonal at first (Saxe et al., 2014), the last ones times `gain`.
    """

    def __init__(self, sizes: Sequence[int], gain: float, random: np.random.Generator) -> None:
        self.parameters: list[np.ndarray] = []
        for i, (rows, columns) in enumerate(zip(sizes, sizes[1:])):
            scale = gain if i == len(sizes) - 2 else 2**0.5
            self.parameters += [_orthogonal(rows, columns, scale, random)]
            self.parameters += [np.zeros(columns, np.float32)]

    def forward(self, x: np.ndarray) -> tuple[np.ndarray, list[np.ndarray]]:
        """Returns what comes out of (m, inputs), and what backward needs of it."""
        kept = [x]
        last = len(self.parameters) - 2
        for i in range(0, len(self.parameters), 2):
            x = x @ self.parameters[i]
            x += self.parameters[i + 1]
            if i < last:
                np.maximum(x, 0, out=x)
                kept.append(x)
        return x, kept

    def backward(self, kept: list[np.ndarray], slopes: np.ndarray) -> list[np.ndarray]:
        """Returns a loss's slopes by each parameter, from those by the output, (m, outputs)."""
        out: list[np.ndarray] = []
        for i in range(len(kept) - 1, -1, -1):
            out = [kept[i].T @ slopes, slopes.sum(0), *out]
            if i:
                slopes = slopes @ self.parameters[2 * i].T
                slopes *= kept[i] > 0
        return out


def log_softmax(logits: np.ndarray) -> np.ndarray:
    """Returns the logarithms of the chances that rows of logits (m, n) mean."""
    shifted = logits - logits.max(1, keepdims=True)
    return shifted - np.log(np.exp(shifted).sum(1, keepdims=True))


def _orthogonal(rows: int, columns: int, gain: float, random: np.random.Generator) -> np.ndarray:
    q, _ = np.linalg.qr(random.standard_normal((max(rows, columns), min(rows, columns))))
    return np.ascontiguousarray(gain * (q if rows >= columns else q.T), np.float32)


class Adam:
    """Adam (Kingma and Ba, 2015) with slopes clipped to a norm; changes parameters in place."""

    def __init__(self, parameters: list[np.ndarray], norm: float = 0.5) -> None:
        self.parameters, self.norm, self.steps = parameters, norm, 0
        self.mean = [np.zeros_like(p) for p in parameters]
        self.square = [np.zeros_like(p) for p in parameters]

    def step(self, slopes: Sequence[np.ndarray], rate: float) -> None:
        """Moves the parameters against the slopes."""
        norm = np.sqrt(sum(float(np.vdot(g, g)) for g in slopes))
        scale = np.float32(min(1.0, self.norm / (norm + 1e-8)))
        self.steps += 1
        c1, c2 = 1 - 0.9**self.steps, 1 - 0.999**self.steps
        for i, slope in enumerate(slopes):
            scaled, mean, square = slope * scale, self.mean[i], self.square[i]
            mean += np.float32(0.1) * (scaled - mean)
            square += np.float32(0.001) * (scaled * scaled - square)
            step = mean / (np.sqrt(square / np.float32(c2)) + 1e-8)
            self.parameters[i] -= np.float32(rate / c1) * step
