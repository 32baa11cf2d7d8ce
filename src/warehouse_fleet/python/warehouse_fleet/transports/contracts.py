# SPDX-License-Identifier: Apache-2.0
"""The contracts between the phases of the dispatcher and the rest of the fleet."""

from collections.abc import Sequence
from typing import Protocol

import numpy as np


class Clock(Protocol):
    """The simulated time."""

    @property
    def time(self) -> float:
        """The simulated time of the last reports [s]."""


class Roads(Protocol):
    """The cells that robots may use."""

    @property
    def closed(self) -> np.ndarray:
        """The cells that no robot may enter now."""

    @property
    def is_cut(self) -> np.ndarray:
        """(cells,) bool: in closed zones, held by robots that stand there for long, or cut off by
        either."""

    def set_units(self, cells: Sequence[int]) -> None:
        """Closes cells for loaded robots."""


class Drives(Protocol):
    """The drives of robots to their goals."""

    def arrived(self, among: np.ndarray) -> np.ndarray:
        """Returns the robots that stand at their goal, of those `among`, (n,) bool."""

    def journey(self, robot: int) -> tuple[float, float, int]:
        """Returns (seconds driven, seconds planned, cells) since the last call for that robot."""

    def shortest(self, begin: int, end: int, loaded: bool = False) -> int:
        """Returns the cells of the shortest path from `begin` to `end`."""
