# SPDX-License-Identifier: Apache-2.0
"""What a warehouse costs: to buy, a year, an order and a piece, with all that its layout has.

    currency: EUR
    robot: {price: 25000, years: 8, a_year: 1500}    # a_year: maintenance
    station: {price: 40000, years: 10, a_year: 1000}
    replenish_station: {price: 30000, years: 10}
    charger: {price: 2000, years: 10}
    storage_unit: {price: 150, years: 15}
    person_hour: 28
    people: {station: 1, replenish_station: 1, floor: 0.5}   # at each, and for all of the floor
    square_metre_year: 80
    kwh: 0.25
    hours_a_year: 4000
    interest: 0.05
    instead: {order: 2.10}                           # what an order costs today, for the payback

Costs that are left out are zero; the defaults of years and hours_a_year are 8 and 4,000. A purchase
costs its annuity: the same amount in each year of its life, with interest.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from warehouse_layout.file import layout_file
from warehouse_layout.file.layout_file import LayoutFile
from warehouse_operations.sizing.prices import PriceError
from warehouse_operations.stock.lined_yaml import LinedYaml, Place, shown

THINGS = ("robot", "station", "replenish_station", "charger", "storage_unit")
PEOPLE = ("station", "replenish_station", "floor")
NUMBERS = ("person_hour", "square_metre_year", "kwh", "hours_a_year", "interest")
YEARS = 8.0  # of a thing's life
HOURS_A_YEAR = 4000.0  # two shifts on 250 days
WORKING, WAITING = 150.0, 80.0  # power of a robot with work, and without [W]
MOST = 1e12


@dataclass(frozen=True)
class Thing:
    """A purchase: its price, its life [years], and further costs a year."""

    price: float = 0.0
    years: float = YEARS
    a_year: float = 0.0

    def annual(self, interest: float) -> float:
        """Returns its costs a year: the annuity and the further costs."""
        if not interest:
            return self.price / self.years + self.a_year
        annuity = interest / (1 - (1 + interest) ** -self.years)
        return self.price * annuity + self.a_year


@dataclass(frozen=True)
class Costs:
    """Costs of things, people, floor and energy, in one currency. instead: of an order today."""

    things: Mapping[str, Thing] = field(default_factory=dict)
    people: Mapping[str, float] = field(default_factory=dict)
    person_hour: float = 0.0
    square_metre_year: float = 0.0
    kwh: float = 0.0
    hours_a_year: float = HOURS_A_YEAR
    interest: float = 0.0
    currency: str = ""
    instead: float = 0.0

    def thing(self, name: str) -> Thing:
        """Returns the purchase of a name in THINGS."""
        return self.things.get(name, Thing())


@dataclass(frozen=True)
class Bill:
    """The costs of a warehouse. years: to its payback; None: never, or without today's costs."""

    to_buy: float
    a_year: float
    an_order: float
    a_piece: float
    years: float | None
    currency: str

    def text(self) -> str:
        """Returns the costs as a sentence."""
        unit = f" {self.currency}" if self.currency else ""
        back = f"; it has paid for itself after {self.years:.1f} years" if self.years else ""
        return (
            f"It costs {self.to_buy:,.0f}{unit} to buy and {self.a_year:,.0f}{unit} a year:"
            f" {self.an_order:.3f}{unit} an order, {self.a_piece:.4f}{unit} a piece{back}."
        )

    def to_json(self) -> dict[str, Any]:
        """Returns the costs as figures."""
        return {
            "to_buy": round(self.to_buy, 2),
            "a_year": round(self.a_year, 2),
            "an_order": round(self.an_order, 5),
            "a_piece": round(self.a_piece, 6),
            "payback_years": None if self.years is None else round(self.years, 3),
            "currency": self.currency,
        }


class LayoutCosts:
    """Costs of a layout with a given number of robots and open picking stations."""

    def __init__(self, costs: Costs, file: LayoutFile, units: int) -> None:
        self.costs, self.units = costs, units
        self.replenishing = sum(station.kind == "replenish" for station in file.stations)
        self.chargers = int(np.isin(file.floor, list(layout_file.CHARGING)).sum())
        cells = int((~np.isin(file.floor, [layout_file.NO_FLOOR, layout_file.WALL])).sum())
        self.square_metres = cells * file.spacing**2

    def counts(self, robots: int, stations: int) -> dict[str, int]:
        """Returns the number of each of THINGS; stations: open picking ones."""
        numbers = (robots, stations, self.replenishing, self.chargers, self.units)
        return dict(zip(THINGS, numbers))

    def to_buy(self, robots: int, stations: int) -> float:
        """Returns the price of all purchases."""
        counts = self.counts(robots, stations).items()
        return sum(count * self.costs.thing(name).price for name, count in counts)

    def running(self, robots: int, stations: int, at_work: float = 1.0) -> float:
        """Returns the costs of a year without purchases. at_work: share of the robots' time."""
        costs, people = self.costs, self.costs.people
        things = sum(
            count * costs.thing(name).a_year
            for name, count in self.counts(robots, stations).items()
        )
        heads = people.get("station", 1.0) * stations + people.get("floor", 0.0)
        heads += people.get("replenish_station", 1.0) * self.replenishing
        watts = robots * (WAITING + (WORKING - WAITING) * at_work)
        return (
            things
            + costs.person_hour * costs.hours_a_year * heads
            + costs.square_metre_year * self.square_metres
            + costs.kwh * costs.hours_a_year * watts / 1000
        )

    def a_year(self, robots: int, stations: int, at_work: float = 1.0) -> float:
        """Returns all costs of a year."""
        things = sum(
            count * (self.costs.thing(name).annual(self.costs.interest))
            - count * self.costs.thing(name).a_year
            for name, count in self.counts(robots, stations).items()
        )
        return things + self.running(robots, stations, at_work)

    def per_hour(self, robots: int, stations: int, _units: int = 0) -> float:
        """Returns the costs of an hour; stations: picking and replenishing ones, as of Prices."""
        return self.a_year(robots, stations - self.replenishing) / self.costs.hours_a_year

    def bill(
        self,
        robots: int,
        stations: int,
        orders_per_hour: float,
        pieces_per_hour: float,
        at_work: float = 1.0,
    ) -> Bill:
        """Returns the Bill at a rate of orders and pieces an hour."""
        hours, year = self.costs.hours_a_year, self.a_year(robots, stations, at_work)
        orders, pieces = (max(rate * hours, 1e-9) for rate in (orders_per_hour, pieces_per_hour))
        buy, running = self.to_buy(robots, stations), self.running(robots, stations, at_work)
        saved = self.costs.instead * orders - running
        years = buy / saved if self.costs.instead and saved > 0 else None
        return Bill(buy, year, year / orders, year / pieces, years, self.costs.currency)

    def sentence(self, _replenishing: int) -> str:
        """Returns the assumptions."""
        costs = self.costs
        prices = ", ".join(
            f"{name.replace('_', ' ')} {thing.price:,g} for {thing.years:g} years"
            + (f" and {thing.a_year:,g} a year" if thing.a_year else "")
            for name, thing in costs.things.items()
        )
        return (
            f"Costs{f' [{costs.currency}]' if costs.currency else ''}: {prices or 'no things'};"
            f" {costs.person_hour:,g} an hour for a person,"
            f" {costs.square_metre_year:,g} a year for each of {self.square_metres:,.0f} m²,"
            f" {costs.kwh:g} a kWh, {100 * costs.interest:g} % interest,"
            f" {costs.hours_a_year:,g} hours a year. The answer is the cheapest point that does."
        )


def read(path: str | Path) -> Costs:
    """Reads a file of costs. Raises PriceError, which names file, line and field."""
    file = LinedYaml(path, PriceError)
    content = file.content
    known = (*THINGS, "people", *NUMBERS, "currency", "instead")
    if not isinstance(content, dict):
        raise file.fault((), f"keys with costs were expected: {', '.join(known)}")
    for key in content:
        if key not in known:
            raise file.fault((str(key),), f"is unknown; {', '.join(known)} were expected")
    numbers = {key: _number(file, (key,), content[key]) for key in NUMBERS if key in content}
    if numbers.get("hours_a_year", 1.0) == 0:
        raise file.fault(("hours_a_year",), "is 0; a number above 0 was expected")
    instead = _mapping(file, ("instead",), content.get("instead", {}), ("order",))
    return Costs(
        {name: _thing(file, name, content[name]) for name in THINGS if name in content},
        _mapping(file, ("people",), content.get("people", {}), PEOPLE),
        **numbers,
        currency=str(content.get("currency", "")),
        instead=instead.get("order", 0.0),
    )


def _thing(file: LinedYaml, name: str, value: Any) -> Thing:
    if not isinstance(value, dict):
        return Thing(_number(file, (name,), value))
    values = _mapping(file, (name,), value, ("price", "years", "a_year"))
    if values.get("years", 1.0) == 0:
        raise file.fault((name, "years"), "is 0; a number above 0 was expected")
    return Thing(**values)


def _mapping(file: LinedYaml, place: Place, value: Any, keys: tuple[str, ...]) -> dict[str, float]:
    if not isinstance(value, dict):
        raise file.fault(place, f"is {shown(value)}; {', '.join(keys)} were expected")
    for key in value:
        if key not in keys:
            raise file.fault((*place, str(key)), f"is unknown; {', '.join(keys)} were expected")
    return {key: _number(file, (*place, key), number) for key, number in value.items()}


def _number(file: LinedYaml, place: Place, value: Any) -> float:
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not number or not 0 <= value < MOST:
        raise file.fault(place, f"is {shown(value)}; a number of 0 or more was expected")
    return float(value)
