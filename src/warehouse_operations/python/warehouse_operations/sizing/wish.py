# SPDX-License-Identifier: Apache-2.0
"""The demand on a warehouse, and the points that are simulated for it."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from warehouse_layout.file import layout_file
from warehouse_layout.file.layout_file import LayoutFile
from warehouse_layout.place import file_check, placement
from warehouse_operations.runs import layout_site
from warehouse_operations.shift import kpis
from warehouse_operations.sizing import sites
from warehouse_operations.sizing.day import RUN_IN as DAY_RUN_IN
from warehouse_operations.sizing.day import Day
from warehouse_operations.sizing.point import Point
from warehouse_operations.stock import order_mix
from warehouse_operations.stock.order_file import read_csv
from warehouse_operations.stock.settings import UNITS_MOST

LINES, PIECES = 1.55, 1.05  # of an order, of a line: those of simulate's own orders
AT_WORK = 2  # robots per unit that may be on its way to stations; the other one is on its way back
RUN_IN = 120  # minutes in which an empty warehouse fills: the time until orders are due
MANY = 1e6  # pieces from a unit: beyond any that picking can reach


class WishError(ValueError):
    """Raised for an invalid wish."""


class ImpossibleError(Exception):
    """Raised where no number of robots and stations meets a wish; says why."""


@dataclass(frozen=True)
class Wish:
    """A rate of orders on a floor, of which a share `late` may be late.

    lines, pieces: means, of an order and of a line. orders_file: a CSV file whose orders come
    instead. hours: of each shift, after its run-in. seeds: shifts of a point, at least. Raises
    WishError.
    """

    file: LayoutFile
    orders_per_hour: float
    lines: float = LINES
    pieces: float = PIECES
    orders_file: str = ""
    late: float = 0.01
    hours: float = 8.0
    seeds: int = 5
    most_robots: int = 0  # 0: as the demand needs and the floor has room
    day: Day | None = None  # in place of a constant rate of orders
    realism: str = ""  # availability of robots: a preset or a file

    def __post_init__(self) -> None:
        faults = [fault for fault in file_check.faults(self.file) if not fault.is_of_bodies]
        if faults:
            raise WishError(f"{self.file.path or self.file.title}: {faults[0].text}")
        if not self.stations:
            raise WishError(f"{self.file.title}: there is no picking station")
        if not self.file.items and not self.file.stock:
            raise WishError(f"{self.file.title}: items is 0; there is nothing to pick")

    @cached_property
    def stations(self) -> list[str]:
        """The names of the picking stations, in the order in which they are opened."""
        return sites.picking_stations(self.file)

    @property
    def stock_file(self) -> str:
        """The absolute path of the layout's stock file, for other machines; "" without one."""
        return str(self.file.beside_file(self.file.stock).absolute()) if self.file.stock else ""

    @property
    def replenishing(self) -> int:
        """The number of replenishing stations; all of them are open."""
        return len(self.file.stations) - len(self.stations)

    @cached_property
    def units(self) -> int:
        """The number of storage units."""
        return len(placement.place(self.file).units)

    @property
    def orders(self) -> str:
        """The orders text of a shift: of order_mix, or of the day."""
        if self.day:
            return self.day.whole_text
        return order_mix.text_of(self.orders_per_hour, self.lines, self.pieces, self.orders_file)

    @cached_property
    def pieces_per_order(self) -> float:
        """Pieces of an order, on the average. Raises DemandError for a file that is wrong."""
        if self.day:
            return self.day.pieces_per_order
        if not self.orders_file:
            return self.lines * self.pieces
        orders = read_csv(self.orders_file)
        pieces = sum(n for order in orders for _, n in order.lines)
        return pieces / max(len(orders), 1)

    @property
    def run_in(self) -> int:
        """The minutes in which an empty warehouse fills."""
        return DAY_RUN_IN if self.day else RUN_IN

    @property
    def asked(self) -> str:
        """The wish in words."""
        return str(self.day) if self.day else f"{self.orders_per_hour:,.0f} orders an hour"

    @property
    def pieces_per_hour(self) -> float:
        """Requested pieces an hour."""
        return self.orders_per_hour * self.pieces_per_order

    def bound(self, stations: int) -> float:
        """Returns the most pieces an hour that the first `stations` can pick."""
        settings = layout_site.settings_of(self.file)
        return sum(self._bound_of(settings.of(name)) for name in self.stations[:stations])

    def _bound_of(self, settings: Any) -> float:
        return kpis.upper_bound(MANY, settings, kpis.Kinematics(), self.file.spacing)

    def least_stations(self) -> int:
        """Returns the fewest picking stations that can meet the wish. Raises ImpossibleError."""
        for count in range(1, len(self.stations) + 1):
            if self.bound(count) >= self.pieces_per_hour:
                return count
        raise ImpossibleError(
            f"{named(self.stations)} can do {self.bound(len(self.stations)):,.0f} pieces an hour;"
            f" {self.pieces_per_hour:,.0f} are asked for"
        )

    def robots(self, stations: int) -> int:
        """Returns the largest number of robots that is tried at some open picking stations."""
        useful = AT_WORK * UNITS_MOST * (stations + self.replenishing)
        return min(self.most_robots or self.room, self.room, useful)

    @cached_property
    def room(self) -> int:
        """The number of robots with room on the floor: on parking, and beneath storage units."""
        floor = self.file.floor
        parking = np.isin(floor, list(layout_file.PARKING + layout_file.CHARGING)).sum()
        return int(parking) + self.units

    def points(
        self, robots: int, stations: int, seeds: Sequence[int], physics_hours: float = 0.0
    ) -> list[Point]:
        """Returns the Point of each seed; physics_hours: of simulated robots, 0: ideal ones."""
        file = replace(self.file, robots=robots, name="", stock=self.stock_file)
        return [
            Point(
                robots,
                stations,
                seed,
                bool(physics_hours),
                layout_file.text_of(file),
                self.orders,
                self.run_in,
                math.ceil(60 * (self.hours if self.day else physics_hours or self.hours)),
                dict(self.file.policies),
                self.realism,
            )
            for seed in seeds
        ]


def named(stations: Sequence[str]) -> str:
    """Returns names for people: `pick1…pick4`."""
    if len(stations) < 3:
        return " and ".join(stations)
    return f"{stations[0]}…{stations[-1]}"


def count(number: int, noun: str) -> str:
    """Returns a number with its noun."""
    return f"{number:,} {noun}{'' if number == 1 else 's'}"
