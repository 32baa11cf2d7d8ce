# SPDX-License-Identifier: Apache-2.0
"""Requests for warehouses: how many of each kind, presets and limits."""

import math
from dataclasses import dataclass

from warehouse_layout.file.items import CAPACITY


class RequestError(ValueError):
    """Says why a request can't be met."""


@dataclass(frozen=True)
class Request:
    """Counts of what shall stand in a warehouse."""

    robots: int = 0
    shelves: int = 0
    items: int = 0
    belts: int = 0

    def __str__(self) -> str:
        counts = (
            (self.robots, "robot"),
            (self.shelves, "storage unit"),
            (self.items, "item"),
            (self.belts, "conveyor belt"),
        )
        return ", ".join(f"{n} {noun}{'' if n == 1 else 's'}" for n, noun in counts)


PRESETS = {
    "empty": Request(0, 0, 0, 0),
    "small": Request(4, 24, 96, 2),
    "medium": Request(20, 160, 800, 4),
    "large": Request(100, 800, 4000, 10),
    "huge": Request(1000, 4000, 20000, 40),
}

# A warehouse of all of these was built; larger ones were never tried.
LIMITS = {"robots": 20_000, "shelves": 100_000, "items": 500_000}
REASONS = {
    "robots": "larger fleets were never driven",
    "shelves": "larger floors were never built",
    "items": "more were never laid out",
}
MOST_STATIONS = 1000  # for picking; as many again for replenishing
MOST_ON_A_SIDE = 60  # picking stations of a regular floor, which has them all on one side
ITEMS_A_UNIT = 4

# The size that takes all the room of a given world.
FIT = "fit"
SPARE, TIGHT = 0.15, 20  # share of places that stay empty; of fewer places none does


def proportioned(places: int, most_robots: int = LIMITS["robots"], belts: int = 0) -> Request:
    """Returns the Request of a warehouse in sensible proportions.

    Its robots and storage units take up to `places` places. `belts` is the number of belts; 0: as
    many as it needs.
    """
    robots = min(places // 8 + 2, max(1, places // 3), most_robots, LIMITS["robots"])
    spare = int(SPARE * places) if places >= TIGHT else 0
    units = max(0, min(places - robots - spare, LIMITS["shelves"]))
    items = items_for(units)
    return Request(robots, units, items, belts or _belts_for(robots, units))


def resolve(name: str, robots: int = 0, items: int = 0, shelves: int = 0) -> Request:
    """Returns the Request for a preset's name (all counts 0) or for explicit counts.

    Raises RequestError for an unknown preset, a negative count, a count above LIMITS, and more
    items than the storage units hold: CAPACITY each.
    """
    counts = {"robots": robots, "shelves": shelves, "items": items}
    if not any(counts.values()):
        return _preset(name)
    _check_counts(counts)
    _check_items(items, shelves)
    return Request(robots, shelves, items, _belts_for(robots, shelves))


def items_for(units: int) -> int:
    """Returns the default count of items on a number of storage units."""
    return min(ITEMS_A_UNIT * units, LIMITS["items"])


def _preset(name: str) -> Request:
    try:
        return PRESETS[name]
    except KeyError:
        known = ", ".join(PRESETS)
        raise RequestError(
            f"'{name}' is not a preset and all counts are 0; give counts, or one of: {known}"
        ) from None


def _check_counts(counts: dict[str, int]) -> None:
    for what, count in counts.items():
        if count < 0:
            raise RequestError(f"{what} is {count}; it can't be negative")
        if count > LIMITS[what]:
            raise RequestError(f"{what} is {count}; the limit is {LIMITS[what]}: {REASONS[what]}")


def check_stations(picking: int, replenishing: int) -> None:
    """Raises RequestError for numbers of stations that no warehouse can have."""
    for what, count in (("stations", picking), ("replenish", replenishing)):
        if not 0 <= count <= MOST_STATIONS:
            raise RequestError(
                f"{what} is {count}; 0 to {MOST_STATIONS} were expected: their lanes make a floor"
                " longer than storage and streets need"
            )


def _check_items(items: int, shelves: int) -> None:
    if items and not shelves:
        raise RequestError(f"{items} items, but no shelves to lay them on")
    if items > shelves * CAPACITY:
        needed = math.ceil(items / CAPACITY)
        raise RequestError(
            f"{items} items don't fit on {shelves} shelves: one holds {CAPACITY},"
            f" so {needed} shelves are needed"
        )


def _belts_for(robots: int, shelves: int) -> int:
    """Returns one belt for every 100 storage units or every 25 robots, the larger of both."""
    return min(MOST_STATIONS, max(1, math.ceil(shelves / 100), math.ceil(robots / 25)))
