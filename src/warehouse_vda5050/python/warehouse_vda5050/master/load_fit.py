# SPDX-License-Identifier: Apache-2.0
"""Whether a vehicle may carry a storage unit: its mass and size, by the vehicle's factsheet."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from warehouse_vda5050.model import Factsheet, LoadSet

EQUAL = 1e-3  # by which a unit may be larger than a load set says [m, kg]
OWN_TYPE = "unit"  # the loadType of our units where a factsheet names none


@dataclass(frozen=True)
class UnitMeasures:
    """A storage unit with all that lies on it [kg, m]; None where that is not known."""

    mass: float | None = None
    length: float | None = None
    width: float | None = None
    height: float | None = None


Measure = Callable[[int], UnitMeasures]  # by the number of a unit


def unknown(_unit: int) -> UnitMeasures:
    """Returns the measures of a unit of which nothing is known."""
    return UnitMeasures()


@dataclass(frozen=True)
class LoadChoice:
    """The load set by which a unit is carried, or why none fits; `loads` is None where the
    factsheet names no load sets."""

    loads: LoadSet | None = None
    why_not: str = ""


def choose_load(
    sheet: Factsheet, parameters: Mapping[str, Any], measures: UnitMeasures
) -> LoadChoice:
    """Returns the load set for a unit: of the loadType that the file of robots gives, else the
    first that fits, preferably of the type `unit`."""
    if why := _too_heavy(measures, sheet.max_load_mass or None, "it"):
        return LoadChoice(why_not=why)
    if not sheet.load_sets:
        return LoadChoice()
    sets = sheet.load_sets
    if asked := parameters.get("loadType"):
        sets = tuple(loads for loads in sets if loads.load_type == asked)
        if not sets:
            types = ", ".join(dict.fromkeys(loads.load_type for loads in sheet.load_sets))
            return LoadChoice(
                why_not=f"its factsheet has no loadType {asked!r}, which the file of robots gives;"
                f" it has {types}"
            )
    sets = tuple(sorted(sets, key=lambda loads: loads.load_type != OWN_TYPE))
    reasons = []
    for loads in sets:
        why = next(_misfits(loads, measures), "")
        if not why:
            return LoadChoice(loads)
        reasons.append(why)
    return LoadChoice(why_not=reasons[0])


def _misfits(loads: LoadSet, measures: UnitMeasures) -> Iterator[str]:
    name = f"its load set {loads.name or loads.load_type!r}"
    if why := _too_heavy(measures, loads.max_mass, name):
        yield why
    unit, room = _sides(measures), _sides(loads)
    if unit and room and (unit[0] > room[0] + EQUAL or unit[1] > room[1] + EQUAL):
        yield (
            f"the unit is {measures.length:g} x {measures.width:g} m, and {name} takes"
            f" {loads.length:g} x {loads.width:g} m"
        )
    high = measures.height or 0.0
    if loads.height and high > loads.height + EQUAL:
        yield f"the unit is {high:g} m high, and {name} takes {loads.height:g} m"


def _sides(of: UnitMeasures | LoadSet) -> tuple[float, float] | None:
    """Returns the shorter and the longer side [m]; None where one is not known."""
    if of.length is None or of.width is None:
        return None
    return min(of.length, of.width), max(of.length, of.width)


def _too_heavy(measures: UnitMeasures, limit: float | None, name: str) -> str:
    if measures.mass is None or limit is None or measures.mass <= limit + EQUAL:
        return ""
    return f"the unit weighs {measures.mass:.1f} kg, and {name} carries {limit:g} kg"
