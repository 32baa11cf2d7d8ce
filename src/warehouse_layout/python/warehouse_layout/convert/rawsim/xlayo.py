# SPDX-License-Identifier: Apache-2.0
"""Reads layout configurations of RAWSim-O, `.xlayo`: the parameters of its generator.

The floor that they describe has its rows along y as the generator numbers them: what it calls north
has the lowest y, as in the instances that it writes. Which pod and which robot stands where is left
to chance there; here the file counts them.
"""

from dataclasses import dataclass, fields
from typing import Any
from xml.etree.ElementTree import Element

from warehouse_layout.convert import arrows
from warehouse_layout.convert.common import (
    PathName,
    cells_of_short_cuts,
    check_size,
    with_letters,
)
from warehouse_layout.convert.rawsim import stations as rawsim_stations
from warehouse_layout.convert.rawsim import xlayo_floor
from warehouse_layout.convert.rawsim.xlayo_floor import BLOCK_DEPTH, SIDES, Parameters
from warehouse_layout.convert.rawsim.xml_fields import InstanceError, read_root
from warehouse_layout.file import items as shelves
from warehouse_layout.file.layout_file import LayoutFile, StationEntry
from warehouse_layout.floor.stations import PICK, Station

BIN = 100.0  # of a pod's capacity, which one item stands for
MOST = 10_000  # of any number of aisles, blocks, stations
KINDS = ("Tim", "HighwayHallway")

# By the field of Parameters: the element that has it, and its value where there is none.
NUMBERS = {
    "rows": ("NrHorizontalAisles", 8, 2),
    "columns": ("NrVerticalAisles", 6, 2),
    "block": ("HorizontalLengthBlock", 4, 1),
    "hall": ("WidthHall", 6, 2),
    "buffer": ("WidthBuffer", 4, 2),
    "turn": ("DistanceEntryExitStation", 3, 1),
}
FLAGS = {
    "two_way": ("AislesTwoDirectional", False),
    "single": ("SingleLane", True),
    "counter_clockwise": ("CounterClockwiseRingwayDirection", True),
}


@dataclass(frozen=True)
class _Numbers:
    """Looks up the elements of a configuration; errors name them."""

    path: PathName
    root: Element

    def number(self, name: str, default: float, least: float = 0, most: float = MOST) -> float:
        text = self.root.findtext(name)
        try:
            value = default if text is None else float(text)
        except ValueError:
            value = float("nan")
        if not least <= value <= most:
            self.fail(f"{name} is '{text}'; a number from {least:g} to {most:g} was expected")
        return value

    def count(self, name: str, default: int, least: int = 0) -> int:
        value = self.number(name, default, least)
        if value != int(value):
            self.fail(f"{name} is '{self.root.findtext(name)}'; a whole number was expected")
        return int(value)

    def flag(self, name: str, default: bool) -> bool:
        text = self.root.findtext(name, str(default)).strip().lower()
        if text not in ("true", "false", "1", "0"):
            self.fail(f"{name} is '{text}'; true or false was expected")
        return text in ("true", "1")

    def fail(self, text: str) -> None:
        raise InstanceError(f"{self.path}: {text}")


def read(path: PathName) -> tuple[LayoutFile, list[str]]:
    """Returns the layout that an .xlayo file describes, and what it can't hold.

    Raises FormatError.
    """
    numbers = _Numbers(path, read_root(path, "LayoutConfiguration"))
    parameters = _parameters(numbers)
    check_size(path, "a floor", *parameters.shape)
    floor = xlayo_floor.of(parameters)
    drawn, notes = arrows.draw(floor.plan, floor.drawing)
    places = int(floor.plan.storage.sum())
    units = int(numbers.number("PodAmount", 0.85, 0, 1) * places + 1e-9)
    held = round(numbers.number("PodCapacity", 5 * BIN, 0, 1e9) / BIN)
    file = LayoutFile(
        floor=drawn,
        name=numbers.root.findtext("NameLayout", "").strip(),
        stations=tuple(
            _entry(numbers, station, parameters.shape[1]) for station in floor.plan.stations
        ),
        storage_units=units,
        robots=numbers.count("BotCount", 32),
        items=units * min(max(1, held), shelves.CAPACITY),
    )
    return with_letters(file), [*notes, *_unsaid(numbers)]


def _parameters(numbers: _Numbers) -> Parameters:
    _one_tier(numbers)
    values: dict[str, Any] = {k: numbers.count(*v) for k, v in NUMBERS.items()}
    values |= {k: numbers.flag(*v) for k, v in FLAGS.items()}
    kind = numbers.root.findtext("AisleLayoutType", KINDS[0]).strip()
    if kind not in KINDS:
        numbers.fail(f"AisleLayoutType is '{kind}'; {' or '.join(KINDS)} was expected")
    values["highways"] = kind == KINDS[1]
    values["picks"] = _at_sides(numbers, "NPickStation", {"East": 4})
    values["replenishments"] = _at_sides(numbers, "NReplenishmentStation", {"West": 4})
    assert values.keys() == {f.name for f in fields(Parameters)}
    parameters = Parameters(**values)
    _check(numbers, parameters)
    return parameters


def _one_tier(numbers: _Numbers) -> None:
    elevators = sum(_at_sides(numbers, "NElevators", {}).values())
    if numbers.count("TierCount", 1) != 1 or elevators:
        numbers.fail(
            "TierCount above 1, or elevators; one tier was expected: save the instance that"
            " RAWSim-O makes of it (.xinst), whose tiers and elevators are read"
        )


def _at_sides(numbers: _Numbers, name: str, default: dict[str, int]) -> dict[str, int]:
    # A file without any of them means the generator's defaults; each alone has its own.
    return {side: numbers.count(f"{name}{side}", default.get(side, 0)) for side in SIDES}


def _check(numbers: _Numbers, p: Parameters) -> None:
    """Raises InstanceError where the generator of RAWSim-O refuses as well."""
    if not p.two_way and (p.rows % 2 or p.columns % 2):
        numbers.fail(
            f"NrHorizontalAisles is {p.rows}, NrVerticalAisles {p.columns}; one-way aisles ask for"
            " even numbers"
        )
    for name, value in (("HorizontalLengthBlock", p.block), ("WidthHall", p.hall)):
        if value % 2:
            numbers.fail(f"{name} is {value}; an even number was expected")
    most = 2 * BLOCK_DEPTH + p.lanes
    if p.turn % 2 == 0 or p.turn > most:
        numbers.fail(
            f"DistanceEntryExitStation is {p.turn}; an odd number up to {most} was expected"
        )
    for side in SIDES:
        room = (p.rows if side in ("East", "West") else p.columns) // 2
        count = p.picks[side] + p.replenishments[side]
        if count > room:
            numbers.fail(f"{count} stations {side}; there is room for {room}")
    if not sum(p.picks.values()) or not sum(p.replenishments.values()):
        numbers.fail("a station to pick and one to replenish, or more, were expected")


def _entry(numbers: _Numbers, station: Station, width: int) -> StationEntry:
    cells = [(int(cell) % width, int(cell) // width) for cell in station.cells]
    is_pick = station.kind == PICK
    names = {"Capacity": "OStationCapacity"}
    look_up = lambda name, default: numbers.number(name, default, 0, 1e9)  # noqa: E731
    return StationEntry(
        key=station.name,
        service=cells[station.service],
        name=station.name,
        kind="pick" if is_pick else "replenish",
        queue=tuple(cells[: station.service]),
        short_cuts=cells_of_short_cuts(station, width),
        exit=tuple(cells[station.service + 1 :]),
        settings=rawsim_stations.settings(look_up, names) if is_pick else {},
    )


def _unsaid(numbers: _Numbers) -> list[str]:
    out = rawsim_stations.unlike_ours(lambda name, usual: numbers.number(name, usual, 0, 1e9))
    bundle = numbers.number("ItemBundleTransferTime", rawsim_stations.BUNDLE, 0, 1e9)
    if bundle != rawsim_stations.BUNDLE:
        out.append(f"a layout does not hold {bundle:g} s a bundle")
    return out
