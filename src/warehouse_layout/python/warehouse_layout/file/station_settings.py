# SPDX-License-Identifier: Apache-2.0
"""How work is done at a station, as a layout file may set it for each."""

import math
from typing import Any, NamedTuple


class StationSettingError(ValueError):
    """Says which values a setting takes."""


class Range(NamedTuple):
    """The least and the greatest value of a setting, and its unit."""

    low: float
    high: float
    unit: str


SETTINGS = {
    "capacity": Range(1, 1000, "open orders"),
    "seconds_a_piece": Range(0.1, 3600, "s"),
    "pick_seconds": Range(0, 3600, "s"),
    "seconds_a_line": Range(0, 3600, "s"),
    "pickers": Range(1, 20, "people"),
    "hours": Range(0, 24 * 365, "h"),
    "breaks": Range(0, 24 * 365, "h"),
    "roster": Range(0, 20, "people"),
}
WHOLE = ("capacity", "pickers", "roster")
PACE = "seconds_a_piece"  # a number, or {mean, sd} where it differs from piece to piece
Hours = tuple[tuple[float, float], ...]  # from and to [h]
Pace = tuple[float, float]  # mean and standard deviation [s]
Roster = tuple[int, ...]  # pickers, hour by hour


def check_setting(name: str, value: Any) -> float | Hours | Pace | Roster:
    """Returns the value of a setting. Raises StationSettingError if it takes none such."""
    if name in ("hours", "breaks"):
        return _hours(name, value)
    if name == "roster":
        return _roster(value)
    if name == PACE and isinstance(value, dict):
        return _pace(value)
    if name in WHOLE and not isinstance(value, int):
        raise StationSettingError(f"{name} is {value!r}; a whole number was expected")
    return _number(name, value)


def _number(name: str, value: Any) -> float:
    low, high, unit = SETTINGS[name]
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not is_number or not math.isfinite(value) or not low <= value <= high:
        raise StationSettingError(
            f"{name} is {value!r}; a number from {low:g} to {high:g} {unit} was expected"
        )
    return value


def _pace(value: dict[Any, Any]) -> Pace:
    """Returns mean and standard deviation [s]."""
    if value.keys() != {"mean", "sd"}:
        raise StationSettingError(
            f"{PACE} is {value!r}; a number, or {{mean: 10, sd: 3}} was expected"
        )
    deviation = value["sd"]
    mean = _number(PACE, value["mean"])
    is_number = isinstance(deviation, (int, float)) and not isinstance(deviation, bool)
    if not is_number or not 0 <= deviation <= 10 * mean:
        raise StationSettingError(
            f"{PACE}: sd is {deviation!r}; a number from 0 to ten times the mean was expected"
        )
    return float(mean), float(deviation)


def _roster(value: Any) -> Roster:
    """Returns how many people pick in each hour."""
    if not isinstance(value, list) or not 0 < len(value) <= 24 * 365:
        raise StationSettingError(
            f"roster is {value!r}; people hour by hour, as in [1, 2, 2, 1], were expected"
        )
    for people in value:
        if not isinstance(people, int):
            raise StationSettingError(f"roster has {people!r}; whole numbers were expected")
        _number("roster", people)
    return tuple(value)


def _hours(name: str, value: Any) -> Hours:
    """Returns pairs of hours, each later than the one before."""
    is_pairs = isinstance(value, list) and all(isinstance(v, list) and len(v) == 2 for v in value)
    if not is_pairs or not value:
        raise StationSettingError(
            f"{name} is {value!r}; pairs [from, to] in hours since the shift began were"
            " expected, as in [[0, 4], [5, 8]]"
        )
    edges = [_number(name, edge) for pair in value for edge in pair]
    if any(later <= edge for edge, later in zip(edges, edges[1:])):
        raise StationSettingError(
            f"{name} is {value!r}; each hour must be later than the one before"
        )
    return tuple((float(a), float(b)) for a, b in zip(edges[::2], edges[1::2]))
