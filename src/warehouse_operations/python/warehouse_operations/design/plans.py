# SPDX-License-Identifier: Apache-2.0
"""The parameters that the search varies, and the layout files built from them."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from warehouse_layout.file import layout_file as lf
from warehouse_layout.file.layout_file import LayoutFile
from warehouse_layout.file.request import ITEMS_A_UNIT, Request, RequestError
from warehouse_layout.generate import compact
from warehouse_operations.design import outline
from warehouse_operations.design.building import Building
from warehouse_operations.policies import DEFAULTS
from warehouse_operations.sizing.day import Day

PIECES_AN_HOUR = 360.0  # of a picking station, at most
SPARE_STATIONS = 2  # above the number that the busiest hour needs
ROBOTS_A_STATION = 8
FEW_ROBOTS, MANY_ROBOTS = 3, 6  # per station, in the first trials
BINS_A_SKU = 1.2  # at least, on the average
POLICY = "policy_"  # prefix of a role in a parameter's name
POLICIES = {
    "orders": ("pile-on", "due date", "fewest lines missing"),
    "units": ("most lines", "most work", "nearest"),
    "storage": ("nearest", "turnover classes", "cache"),
    "robots": ("nearest", "optimal"),
    "idle": ("wait", "likely unit"),
    "bins": ("emptiest", "turnover", "same sku"),
}
URGENT = {f"{POLICY}orders": "due date"}
ASPECTS = {"square": 1.0, "wide": 2.0, "tall": 0.5}  # length along x over that along y
BLOCKS, OUTLINE = "blocks", "outline"
BEHIND, NEAR = "behind", "near"

Chosen = Mapping[str, Any]  # parameters by name


class Trial(Protocol):
    """What Optuna offers to choose parameters."""

    def suggest_int(self, name: str, low: int, high: int) -> int:
        """Returns a whole number."""

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
        """The largest number of picking stations that is tried."""
        peak = self.day.peak * self.day.pieces_per_order
        return math.ceil(peak / PIECES_AN_HOUR) + SPARE_STATIONS

    @property
    def least_units(self) -> int:
        """The fewest storage units whose bins hold each SKU."""
        return max(math.ceil(BINS_A_SKU * self.skus / ITEMS_A_UNIT), 12)

    @cached_property
    def parameters(self) -> Mapping[str, range | tuple[Any, ...]]:
        """The parameters by name: a range of whole numbers, or choices, the usual one first."""
        stations = range(self.least_stations, self.most_stations + 1)
        return {
            "stations": stations,
            "robots": range(1, ROBOTS_A_STATION * self.most_stations + 1),
            # 0: bundles are put in at the picking stations.
            "replenish": range(max(1, self.most_stations // 2) + 1),
            "units": range(self.least_units, 2 * self.least_units + 21),
            "plan": (BLOCKS, OUTLINE),
            "room": range(len(self.building.rooms)),
            "sides": range(1, 5),
            "first_side": tuple(range(4)),
            "depth": range(1, 3),
            "length": range(2, 17),
            "one_way": (True, False),
            "aspect": tuple(ASPECTS),
            "more_queue": range(-3, 4),
            "parking": (BEHIND, NEAR),
            "shift": range(outline.SHIFTS),
            **{f"{POLICY}{role}": names for role, names in self.policies.items()},
        }

    def choose(self, trial: Trial) -> dict[str, Any]:
        """Returns the parameters of a trial."""
        return {
            name: trial.suggest_int(name, values[0], values[-1])
            if isinstance(values, range)
            else trial.suggest_categorical(name, list(values))
            for name, values in self.parameters.items()
        }

    def usual(self) -> dict[str, Any]:
        """Returns the parameters of a floor as `layout new` makes it, with the usual policies."""
        first = {name: values[0] for name, values in self.parameters.items()}
        roles = {f"{POLICY}{role}": DEFAULTS[role] for role in self.policies}
        # With these the pattern of streets differs least from that of the other plan.
        return first | {"depth": 2, "length": 8, "more_queue": 0} | roles

    def starts(self) -> Iterator[dict[str, Any]]:
        """Yields the first trials: usual floors with few and with many stations, which serve the
        most urgent order first: what is late rules a layout out."""
        stations = self.parameters["stations"]
        for more in range(min(3, len(stations))):
            count = stations[more]
            for replenish in sorted({0, math.ceil(count / 2)}):
                for each in (FEW_ROBOTS, MANY_ROBOTS):
                    counts = {"stations": count, "replenish": replenish, "robots": each * count}
                    yield self.usual() | URGENT | counts

    def neighbour(
        self, chosen: Chosen, rng: np.random.Generator, cheaper: bool, most: int = 2
    ) -> dict[str, Any]:
        """Returns a neighbour of parameters: one count changed, down if `cheaper`, else up, and up
        to `most` other parameters."""
        out = dict(chosen)
        counts = ("robots", "robots", "robots", "stations", "replenish", "units")
        name = str(rng.choice(counts))
        step = int(rng.integers(1, 4)) if name in ("robots", "units") else 1
        out[name] = self._clipped(name, out[name] + (-step if cheaper else step))
        if name == "stations" and cheaper:  # the remaining stations take over its work
            out["robots"] = self._clipped("robots", out["robots"] + int(rng.integers(0, 3)))
        others = [name for name in self.parameters if name not in counts]
        for name in rng.choice(others, int(rng.integers(0, most + 1)), replace=False):
            out[str(name)] = self._other(str(name), out[str(name)], rng)
        return out

    def _clipped(self, name: str, value: int) -> int:
        values = self.parameters[name]
        return int(min(max(value, values[0]), values[-1]))

    def _other(self, name: str, value: Any, rng: np.random.Generator) -> Any:
        """Returns another value of a parameter."""
        values = self.parameters[name]
        if isinstance(values, range):
            return self._clipped(name, value + int(rng.choice((-2, -1, 1, 2))))
        rest: Sequence[Any] = [other for other in values if other != value]
        return rest[int(rng.integers(len(rest)))] if rest else value

    def known_as(self, chosen: Chosen) -> str:
        """Returns a key of parameters, equal for equal layouts: parameters that the plan does not
        use are left out."""
        ignored = (
            {"room", "sides", "first_side", "depth", "length", "one_way", "aspect", "more_queue"}
            | {"parking"}
            if chosen["plan"] == OUTLINE
            else {"shift"}
        )
        return str({name: value for name, value in chosen.items() if name not in ignored})

    def file_of(self, chosen: Chosen) -> LayoutFile | None:
        """Returns the layout of parameters; None where it has no room or no fleet could work."""
        units = chosen["units"]
        request = Request(chosen["robots"], units, ITEMS_A_UNIT * units, chosen["stations"])
        pick_kind = "pick" if chosen["replenish"] else "both"
        if chosen["plan"] == OUTLINE:
            file = outline.filled(
                self.building, request, chosen["replenish"], pick_kind, chosen["shift"]
            )
        else:
            file = self._of_blocks(chosen, request, pick_kind)
        return file and replace(file, policies=policies_of(chosen))

    def _of_blocks(self, chosen: Chosen, request: Request, pick_kind: str) -> LayoutFile | None:
        room = self.building.rooms[chosen["room"]]
        style = compact.Style(
            chosen["sides"],
            (chosen["depth"], chosen["length"]),
            chosen["one_way"],
            chosen["first_side"],
            chosen["more_queue"],
            chosen["parking"] == NEAR,
            ASPECTS[chosen["aspect"]],
            pick_kind,
        )
        try:
            style.check()
            for floor in compact.fitting(request, chosen["replenish"], style, *room[2:]):
                file = self.building.filled(renamed(floor, self.building.file), room)
                if file is not None:
                    return file
        except RequestError:
            return None
        return None


def policies_of(chosen: Chosen) -> dict[str, str]:
    """Returns the policies among parameters, by role."""
    return {
        name.removeprefix(POLICY): value
        for name, value in chosen.items()
        if name.startswith(POLICY)
    }


def renamed(floor: LayoutFile, building: LayoutFile) -> LayoutFile:
    """Returns a floor with keys of its stations that the building does not use."""
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
