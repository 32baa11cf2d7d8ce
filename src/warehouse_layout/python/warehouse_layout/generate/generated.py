# SPDX-License-Identifier: Apache-2.0
"""Generates the warehouse that a Request asks for: regular as the presets, or compact with stations
on all sides where one side is too short for them."""

import numpy as np

from warehouse_layout.file.layout_file import LayoutFile
from warehouse_layout.file.request import MOST_ON_A_SIDE, Request
from warehouse_layout.generate import compact, generator
from warehouse_layout.place import placement
from warehouse_layout.place.layout import SEED, Floor, Layout, chance

EMPTY_FLOOR = 101.0  # edge of a floor without anything on it [m]

# Short blocks: a street to a side for every few of its stations.
STYLE = compact.Style(sides=4, block=(2, 4))


def file_of(request: Request, name: str = "", rng: np.random.Generator | None = None) -> LayoutFile:
    """Returns the layout file of a resolved Request; see generator.of_request() for `rng`."""
    if is_regular(request):
        return generator.of_request(request, name, rng)
    return compact.of_request(request, replenishing(request), STYLE, name)


def plan(request: Request, seed: int = SEED) -> Layout:
    """Returns the Layout of a resolved Request: of its layout file, or an empty floor.

    The seed decides which robot parks where, on which place each unit stands and which items it
    holds; streets, places, stations and belts are the same for all.
    """
    if not (request.robots or request.shelves):
        edge = EMPTY_FLOOR / 2
        return Layout(Floor(-edge, edge, -edge, edge))
    rng = chance(seed)
    return placement.place_by_chance(file_of(request, rng=rng), rng)


def is_regular(request: Request) -> bool:
    """Returns whether all picking stations have room on one side of the floor."""
    return request.belts <= MOST_ON_A_SIDE


def replenishing(request: Request) -> int:
    """Returns the default count of stations for replenishing on a compact floor: enough
    where all of them are at work, more where one may be far from a unit."""
    return -(-request.belts // (2 if is_regular(request) else 4))
