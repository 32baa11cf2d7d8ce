# SPDX-License-Identifier: Apache-2.0
"""Prices of robots, stations and units, for the cost of a piece.

    robot: 25000      # one of them [money]
    station: 40000    # a picking or a replenishing one
    unit: 150         # a storage unit
    hour: 28          # of a person at a station
    hours: 20000      # life of robots, stations and units; 5 years of two shifts, if left out

A price that is left out is zero.
"""

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Protocol

from warehouse_operations.stock.yaml_file import read_yaml


class PriceError(Exception):
    """Raised for an invalid file of prices; names the file and the key."""


class Pricing(Protocol):
    """The interface of Prices and costs.LayoutCosts, which price a point."""

    def per_hour(self, robots: int, stations: int, units: int, /) -> float:
        """Returns the cost an hour; stations: picking and replenishing stations."""

    def sentence(self, replenishing: int, /) -> str:
        """Returns what was assumed."""


@dataclass(frozen=True)
class Prices:
    """Prices in one currency. hours: in which robots, stations and units are used up."""

    robot: float = 0.0
    station: float = 0.0
    unit: float = 0.0
    hour: float = 0.0
    hours: float = 20_000.0

    def per_hour(self, robots: int, stations: int, units: int) -> float:
        """Returns the cost of these counts an hour; stations: picking and replenishing stations."""
        bought = self.robot * robots + self.station * stations + self.unit * units
        return bought / self.hours + self.hour * stations

    def sentence(self, replenishing: int) -> str:
        """Returns what was assumed."""
        each = f"each of {replenishing:,} replenishing station{'' if replenishing == 1 else 's'}"
        return (
            f"Prices: robot {self.robot:,g}, station {self.station:,g}, storage unit"
            f" {self.unit:,g}, used up in {self.hours:,g} hours; {self.hour:,g} an hour for"
            f" the person at each open picking station and at {each}."
            " The answer is the cheapest point that does."
        )


def read(path: str | Path) -> Prices:
    """Reads a YAML file of prices. Raises PriceError."""
    data = read_yaml(path, PriceError)
    names = [field.name for field in fields(Prices)]
    if not isinstance(data, dict):
        raise PriceError(f"{path}: keys with prices were expected: {', '.join(names)}")
    for key, value in data.items():
        if key not in names:
            raise PriceError(f"{path}: '{key}' is unknown; {', '.join(names)} were expected")
        number = isinstance(value, (int, float)) and not isinstance(value, bool)
        if not number or not 0 <= value < 1e12 or (key == "hours" and not value):
            raise PriceError(f"{path}: {key} is {value!r}; a number of 0 or more was expected")
    return Prices(**data)
