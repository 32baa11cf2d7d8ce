# SPDX-License-Identifier: Apache-2.0
"""Generates the warehouse that a Request asks for: regular as the presets, or compact with stations
on all sides where one side is too short for them."""

from warehouse_layout.file.layout_file import LayoutFile
from warehouse_layout.file.request import MOST_ON_A_SIDE, Request
from warehouse_layout.generate import compact, generator
from warehouse_layout.place import layout, placement
from warehouse_layout.place.layout import SEED, Layout

# Short blocks: a street to a side for every few of its stations.
STYLE = compact.Style(sides=4, block=(2, 4))


def file_of(request: Request, name: str = "") -> LayoutFile:
    """Returns the layout file of a resolved Request."""
    if is_regular(request):
        return generator.of_request(request, name)
    return compact.of_request(request, replenishing(request), STYLE, name)


def plan(request: Request, seed: int = SEED) -> Layout:
    """Returns the Layout of a resolved Request; see layout.plan() for what the seed decides."""
    if is_regular(request):
        return layout.plan(request, seed)
    return placement.place(file_of(request), seed)


def is_regular(request: Request) -> bool:
    """Tells whether all picking stations have room on one side of the floor."""
    return request.belts <= MOST_ON_A_SIDE


def replenishing(request: Request) -> int:
    """Returns how many stations for replenishing a compact floor has, unless they are told: enough
    where all of them are at work, more where one may be far from a unit."""
    return -(-request.belts // (2 if is_regular(request) else 4))
