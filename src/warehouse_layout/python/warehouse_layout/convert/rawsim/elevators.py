# SPDX-License-Identifier: Apache-2.0
"""The elevators of a RAWSim-O instance: a Waypoint a tier, and a Timing for each way."""

import math
from collections.abc import Mapping, Sequence
from itertools import permutations
from xml.etree.ElementTree import Element

from warehouse_layout.convert.common import PathName
from warehouse_layout.convert.rawsim.grid import Grid, Waypoint
from warehouse_layout.convert.rawsim.xml_fields import MOST, InstanceError, children
from warehouse_layout.floor.elevators import Elevator

TIMING = "a/b/s, the numbers of two of its Waypoints and the seconds of the way, was expected"


def read_elevators(
    path: PathName, root: Element, waypoints: Mapping[str, Waypoint], grid: Grid
) -> list[Elevator]:
    """Returns the elevators of an instance; one with a single Waypoint leads nowhere, and is left
    out. Raises InstanceError."""
    out: list[Elevator] = []
    owner: dict[str, str] = {}
    joined: list[set[str]] = []  # tiers, by elevator
    for element in children(root, "Elevators", "Elevator"):
        name = f"elevator{element.get('ID')}"
        what = f"{path}: Elevator {element.get('ID')}"
        ends = [(end.text or "").strip() for end in element.findall("Waypoints/Waypoint")]
        for end in ends:
            if end not in waypoints:
                raise InstanceError(f"{what} names Waypoint {end}: not there")
            if owner.setdefault(end, name) != name or ends.count(end) > 1:
                raise InstanceError(f"{what}: Waypoint {end} is named twice")
        of_tier = [waypoints[end].tier for end in ends]
        if len(set(of_tier)) < len(ends):
            raise InstanceError(f"{what}: a Waypoint on each of its tiers was expected")
        if len(ends) > 1:
            cells = tuple(grid.cell[end] for end in ends)
            out.append(Elevator(name, cells, _seconds(what, element, ends)))
            joined.append(set(of_tier))
    _check_joined(path, {waypoint.tier for waypoint in waypoints.values()}, joined)
    return out


def _check_joined(path: PathName, tiers: set[str], joined: Sequence[set[str]]) -> None:
    """Raises InstanceError unless elevators lead from each tier to each other one."""
    reached, before = {min(tiers)}, set[str]()
    while reached != before:
        before = reached
        reached = reached.union(*(some for some in joined if some & reached))
    if left := sorted(tiers - reached):
        raise InstanceError(
            f"{path}: no Elevator joins Tier {left[0]} with Tier {min(tiers)}; robots of one could"
            " not come to the other"
        )


def _seconds(what: str, element: Element, ends: list[str]) -> tuple[tuple[float, ...], ...]:
    """Returns the time of each ride, as Elevator has them."""
    times = dict(_timing(what, timing, ends) for timing in element.findall("Timings/Timing"))
    for start, end in permutations(ends, 2):
        if (start, end) not in times:
            raise InstanceError(f"{what} has no Timing from Waypoint {start} to {end}")
    return tuple(tuple(times.get((start, end), 0.0) for end in ends) for start in ends)


def _timing(what: str, timing: Element, ends: list[str]) -> tuple[tuple[str, str], float]:
    start, _, rest = (timing.text or "").strip().partition("/")
    end, _, text = rest.partition("/")
    try:
        seconds = float(text)
    except ValueError:
        seconds = math.nan
    if start not in ends or end not in ends or not 0 <= seconds <= MOST:
        raise InstanceError(f"{what}: Timing is '{timing.text}'; {TIMING}")
    return (start, end), seconds
