# SPDX-License-Identifier: Apache-2.0
"""Floors of instances for robots with bodies, which can't pass each other in a street."""

from dataclasses import replace

import numpy as np

from warehouse_layout import FloorError
from warehouse_layout.floor import served_part
from warehouse_layout.floor.landings import Landings
from warehouse_layout.place import file_check
from warehouse_operations.stock.site import Site


def floor_for(site: Site) -> tuple[Site, np.ndarray]:
    """Returns a Site whose robots have bodies, and the steps that its floor lacks for that reason:
    see with_ways_back()."""
    plan, steps = served_part.with_ways_back(site.plan)
    return (replace(site, plan=plan), steps) if len(steps) else (site, steps)


def not_driven(path: str, site: Site, steps: np.ndarray) -> list[str]:
    """Returns a sentence about the steps that robots with bodies leave out."""
    sentence = served_part.not_driven(site.plan, steps)
    return [f"{path}: {sentence}"] if sentence else []


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
