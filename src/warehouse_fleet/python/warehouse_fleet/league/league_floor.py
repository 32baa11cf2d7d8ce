# SPDX-License-Identifier: Apache-2.0
"""Lays out a League plan's floor as a warehouse: robots at their starts, obstacles as walls."""

from dataclasses import replace

import numpy as np

from warehouse_fleet.league.league_plan import LeaguePlan
from warehouse_layout.file.layout_data import FLOOR, KEEP_OUT, WALL, LayoutFile
from warehouse_layout.place import placement
from warehouse_layout.place.layout import Layout

OBSTACLES = {"walls": WALL, "marked": KEEP_OUT}


def layout_of(plan: LeaguePlan, obstacles: str = "walls") -> Layout:
    """Returns the Layout of a plan's map, its first row at the top, with kiva k + 1 where robot k
    starts. obstacles: of OBSTACLES, boxes a metre high or paint on the floor."""
    drawn = np.where(plan.passable[::-1], FLOOR, OBSTACLES[obstacles])
    rows, columns = np.divmod(plan.start, plan.passable.shape[1])
    cells = np.column_stack([columns, len(drawn) - 1 - rows])
    file = LayoutFile(floor=drawn, robots=tuple(map(tuple, cells.tolist())), storage_units=0)
    laid = placement.place(file)
    yaw = -np.pi / 2 * plan.heading  # League headings count clockwise
    return replace(laid, robots=np.column_stack([laid.robots[:, :2], yaw]))
