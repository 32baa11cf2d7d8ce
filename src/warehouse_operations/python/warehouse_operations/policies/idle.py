# SPDX-License-Identifier: Apache-2.0
"""Policies that choose where robots without work wait."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from warehouse_operations.policies.view import View


class Wait:
    """Leaves a robot where it stored its last unit, beneath it."""

    def park(self, kiva_id: int, cell: int, view: "View") -> int | None:
        """Returns the cell to which a robot goes; None: it waits where it is."""
        return None


class Park:
    """Sends a robot back to where it stood at first."""

    def park(self, kiva_id: int, cell: int, view: "View") -> int | None:
        """Returns the cell to which a robot goes; None: it waits where it is."""
        return view.first_cell_of_robot(kiva_id)


class LikelyUnit:
    """Sends a robot beneath the unit that orders want most, of the nearest ones in storage.

    among: how many of the nearest units are compared.
    """

    def __init__(self, among: int = 20) -> None:
        self.among = among

    def park(self, kiva_id: int, cell: int, view: "View") -> int | None:
        """Returns the cell to which a robot goes; None: it waits where it is."""
        units = view.stored_units_near(cell, self.among)
        best = max(units, key=lambda unit: (view.work(unit), -unit), default=None)
        return None if best is None or not view.work(best) else view.cell(best)


NAMES: dict[str, type] = {"wait": Wait, "park": Park, "likely unit": LikelyUnit}
