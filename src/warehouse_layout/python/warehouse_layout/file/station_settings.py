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
}
WHOLE = ("capacity", "pickers")
Hours = tuple[tuple[float, float], ...]  # from and to [h]


def check_setting(name: str, value: Any) -> float | Hours:
    """Returns the value of a setting. Raises StationSettingError if it takes none such."""
    if name == "hours":
        return _hours(value)
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


def _hours(value: Any) -> Hours:
    """Returns pairs of hours, each later than the one before."""
    is_pairs = isinstance(value, list) and all(isinstance(v, list) and len(v) == 2 for v in value)
    if not is_pairs or not value:
        raise StationSettingError(
            f"hours is {value!r}; pairs [from, to] in hours since the shift began were"
            " expected, as in [[0, 4], [5, 8]]"
        )
    edges = [_number("hours", edge) for pair in value for edge in pair]
    if any(later <= edge for edge, later in zip(edges, edges[1:])):
        raise StationSettingError(
            f"hours is {value!r}; each hour must be later than the one before"
        )
    return tuple((float(a), float(b)) for a, b in zip(edges[::2], edges[1::2]))
