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
}


def check_setting(name: str, value: Any) -> float:
    """Returns the value of a setting. Raises StationSettingError if it takes none such."""
    low, high, unit = SETTINGS[name]
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not is_number or not math.isfinite(value) or not low <= value <= high:
        raise StationSettingError(
            f"{name} is {value!r}; a number from {low:g} to {high:g} {unit} was expected"
        )
    if name == "capacity" and value != int(value):
        raise StationSettingError(f"{name} is {value!r}; a whole number was expected")
    return value
