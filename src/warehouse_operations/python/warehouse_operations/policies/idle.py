# SPDX-License-Identifier: Apache-2.0
"""Where robots without work wait."""


class Wait:
    """Where it stored its last unit, beneath it."""

    def park(self, kiva_id, cell, view):
        return None


class Park:
    """Back to where it stood at first."""

    def park(self, kiva_id, cell, view):
        return view.first_cell_of_robot(kiva_id)


class LikelyUnit:
    """Beneath the unit that orders want most, of the nearest ones that are in storage.

    among: how many of the nearest are looked at.
    """

    def __init__(self, among=20):
        self.among = among

    def park(self, kiva_id, cell, view):
        units = view.stored_units_near(cell, self.among)
        best = max(units, key=lambda unit: (view.work(unit), -unit), default=None)
        return None if best is None or not view.work(best) else view.cell(best)


NAMES = {"wait": Wait, "park": Park, "likely unit": LikelyUnit}
