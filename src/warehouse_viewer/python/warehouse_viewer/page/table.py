# SPDX-License-Identifier: Apache-2.0
"""Rows that remember when they last changed, so that a reader gets only what is new to it."""

from typing import Any

import numpy as np


class Table:
    """Rows of a dtype whose first field is `index`; row i has index i."""

    def __init__(self, dtype: np.dtype) -> None:
        self.rows = np.zeros(0, dtype)
        self._changed = np.zeros(0, np.int64)

    def resize(self, size: int, tick: int) -> None:
        """Drops all rows and adds `size` empty ones, which are new at `tick`."""
        self.rows = np.zeros(size, self.rows.dtype)
        self.rows["index"] = np.arange(size)
        self._changed = np.full(size, tick, np.int64)

    def set(self, tick: int, **columns: Any) -> bool:
        """Sets whole columns. Returns whether any row differs from before."""
        differs = np.zeros(len(self.rows), bool)
        for name, values in columns.items():
            old = self.rows[name]
            new = np.asarray(values).astype(old.dtype)
            unequal = old != new
            differs |= unequal.any(axis=1) if unequal.ndim == 2 else unequal
            self.rows[name] = new
        self._changed[differs] = tick
        return bool(differs.any())

    def since(self, tick: int) -> np.ndarray:
        """Returns the rows that changed after that tick."""
        return self.rows[self._changed > tick]
