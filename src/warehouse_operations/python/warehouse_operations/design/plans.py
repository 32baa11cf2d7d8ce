# SPDX-License-Identifier: Apache-2.0
"""What the search may vary of a layout, and the layout file that comes of it."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np

from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import LayoutFile
from warehouse_layout.file.request import ITEMS_A_UNIT, Request, RequestError
from warehouse_layout.generate import compact
from warehouse_operations.design.building import Building
from warehouse_operations.sizing.day import Day

PIECES_AN_HOUR = 360.0  # of a picking station, at most
SPARE_STATIONS = 2  # beyond those that the busiest hour takes at most
ROBOTS_A_STATION = 8
BINS_A_SKU = 1.2  # at least, on the average
POLICIES = {
    "orders": ("pile-on", "due date"),
    "storage": ("nearest", "turnover classes"),
}


class Trial(Protocol):
    """What Optuna offers to choose parameters."""

    def suggest_int(self, name: str, low: int, high: int) -> int:
        """Returns a whole number."""

    def suggest_float(self, name: str, low: float, high: float) -> float:
        """Returns a number."""

    def suggest_categorical(self, name: str, choices: Any) -> Any:
        """Returns one of some choices."""


@dataclass(frozen=True)
class Space:
    """The range of each parameter for a building and a day. skus: that the stock has to hold."""

    building: Building
    day: Day
    skus: int
    policies: Mapping[str, tuple[str, ...]]

    @property
    def least_stations(self) -> int:
        """The fewest picking stations that can pick the day's pieces at all."""
        hours = sum(count > 0 for count in self.day.by_hour)
        pieces = self.day.orders * self.day.pieces_per_order
        return max(math.ceil(pieces / hours / PIECES_AN_HOUR), 1)

    @property
    def most_stations(self) -> int:
        """The most picking stations that are tried."""
        peak = self.day.peak * self.day.pieces_per_order
        return math.ceil(peak / PIECES_AN_HOUR) + SPARE_STATIONS

    @property
    def least_units(self) -> int:
        """The fewest storage units whose bins hold each SKU."""
        return max(math.ceil(BINS_A_SKU * self.skus / ITEMS_A_UNIT), 12)

    def choose(self, trial: Trial) -> dict[str, Any]:
        """Returns the parameters of a trial."""
        stations = trial.suggest_int("stations", self.least_stations, self.most_stations)
        return {
            "stations": stations,
            "robots": trial.suggest_int("robots", 1, ROBOTS_A_STATION * self.most_stations),
            "replenish": trial.suggest_int("replenish", 1, max(1, self.most_stations // 2)),
            "units": self.least_units + trial.suggest_int("more_units", 0, self.least_units + 20),
            "sides": trial.suggest_int("sides", 1, 4),
            "depth": trial.suggest_int("depth", 1, 2),
            "length": trial.suggest_int("length", 2, 16),
            "one_way": trial.suggest_categorical("one_way", [True, False]),
            "policies": {
                role: trial.suggest_categorical(f"policy_{role}", list(names))
                for role, names in self.policies.items()
            },
        }

    def file_of(self, chosen: Mapping[str, Any]) -> LayoutFile | None:
        """Returns the layout of parameters; None where it has no room or no fleet could work."""
        _, _, width, height = self.building.room()
        style = compact.Style(
            chosen["sides"], (chosen["depth"], chosen["length"]), chosen["one_way"]
        )
        units = chosen["units"]
        request = Request(chosen["robots"], units, ITEMS_A_UNIT * units, chosen["stations"])
        try:
            style.check()
            for floor in compact.fitting(request, chosen["replenish"], style, width, height):
                file = self.building.filled(_renamed(floor, self.building.file))
                if file is not None:
                    return replace(file, policies=dict(chosen["policies"]))
        except RequestError:
            return None
        return None


def _renamed(floor: LayoutFile, building: LayoutFile) -> LayoutFile:
    """Returns a floor whose stations have keys that the building's own have not."""
    taken = {station.key for station in building.stations}
    if not taken:
        return floor
    free: Iterator[str] = (letter for letter in lf.SERVICE if letter not in taken)
    cells, stations = floor.floor.copy(), []
    for station in floor.stations:
        key = next(free, "")
        if len(station.key) == 1 and key:
            cells[np.asarray(floor.floor == station.key)] = key
            stations.append(replace(station, key=key, name=f"{station.name}-{key}"))
        else:
            stations.append(station)
    return replace(floor, floor=cells, stations=tuple(stations))
