# SPDX-License-Identifier: Apache-2.0
"""The decisions of a shift's policies for the fleet."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from warehouse_operations.policies import Policies
from warehouse_operations.policies.view import View


class PolicyHooks:
    """Answers the fleet by policies that see a View; see protocols.Hooks."""

    def __init__(self, policies: Policies, view: View) -> None:
        self._policies, self._view = policies, view

    def choose_place(self, shelf_id: int, cells: np.ndarray, distances: np.ndarray) -> int:
        """Returns the cell in which a unit is stored, and notes it as the unit's place."""
        cell = int(self._policies.storage.choose(shelf_id, cells, distances, self._view))
        self._view.floor.cells[shelf_id] = cell
        return cell

    def match_robots(
        self, tasks: Sequence[Any], robots: Sequence[int], seconds: np.ndarray
    ) -> Iterable[tuple[int, int]]:
        """Returns pairs (index of the task, index of the robot)."""
        return self._policies.robots.match(tasks, robots, seconds, self._view)

    def park(self, kiva_id: int, cell: int) -> int | None:
        """Returns the cell to which a robot without work goes; None if it waits where it is."""
        return self._policies.idle.park(kiva_id, cell, self._view)

    @property
    def charging(self) -> Any:
        """The charging policy."""
        return self._policies.charging
