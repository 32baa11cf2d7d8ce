# SPDX-License-Identifier: Apache-2.0
"""Floors of instances for robots with bodies, which can't pass each other in a street."""

from dataclasses import replace

import numpy as np

from warehouse_layout import FloorError
from warehouse_layout.floor.landings import Landings
from warehouse_layout.floor.served_part import with_ways_back
from warehouse_layout.place import file_check
from warehouse_operations.stock.site import Site

NAMED = 6  # steps that a sentence names, at most


def floor_for(site: Site) -> tuple[Site, np.ndarray]:
    """Returns a Site whose robots have bodies, and the steps that its floor lacks for that reason:
    see with_ways_back()."""
    plan, steps = with_ways_back(site.plan)
    return (replace(site, plan=plan), steps) if len(steps) else (site, steps)


def not_driven(path: str, site: Site, steps: np.ndarray) -> list[str]:
    """Returns a sentence about the steps that robots with bodies leave out."""
    if not len(steps):
        return []
    points = np.column_stack(site.plan.point_of(steps[:NAMED].ravel())).reshape(-1, 4)
    named = ", ".join(f"({a:g}, {b:g}) to ({c:g}, {d:g})" for a, b, c, d in points)
    more = f" and {len(steps) - NAMED} more" if len(steps) > NAMED else ""
    return [
        f"{path}: robots with bodies do not drive from {named}{more}: they could only come back the"
        " same way there, against others"
    ]


def jams(path: str, site: Site) -> str:
    """Returns a sentence about where robots with bodies could be stuck; "" where they can't."""
    try:
        site.plan.check()
        Landings(site.plan).check()
    except FloorError as error:
        return f"{path}: {error}"
    if site.plan.spacing < file_check.LEAST_SPACING:
        return (
            f"{path}: waypoints are {site.plan.spacing:g} m apart;"
            f" {file_check.LEAST_SPACING:g} m or more were expected: a storage"
            " unit that turns needs it beside another one"
        )
    return ""
