# SPDX-License-Identifier: Apache-2.0
"""How stations of RAWSim-O work, in the words of a layout file."""

from collections.abc import Callable
from typing import Any

from warehouse_layout.file.station_settings import SETTINGS

# By the setting: RAWSim-O's name for it, and the value that a file without it has.
PICKING = {
    "capacity": ("Capacity", 12.0),
    "seconds_a_piece": ("ItemTransferTime", 10.0),
    "pick_seconds": ("ItemPickTime", 3.0),
}
BUNDLE = 10.0  # seconds for a bundle at a replenishing station, by default

# Robots of RAWSim-O whose values differ from these drive otherwise than ours.
ROBOT = {"MaxVelocity": 1.5, "MaxAcceleration": 1.0, "TurnSpeed": 2.5, "PodTransferTime": 2.2}


def settings(number: Callable[[str, float], float], names: dict[str, str]) -> dict[str, Any]:
    """Returns the settings of a picking station that a file may hold.

    `number(name, default)` looks a value up; `names` replaces RAWSim-O's names for them.
    """
    out: dict[str, Any] = {}
    for setting, (name, default) in PICKING.items():
        value = number(names.get(name, name), default)
        low, high, _ = SETTINGS[setting]
        out[setting] = min(max(value, low), high)
    out["pick_seconds"] = min(out["pick_seconds"], out["seconds_a_piece"])
    out["capacity"] = round(out["capacity"])
    return out


def unlike_ours(number: Callable[[str, float], float]) -> list[str]:
    """Returns a sentence for the values of robots that a layout does not hold, if they differ."""
    odd = [
        f"{name} {number(name, usual):g}"
        for name, usual in ROBOT.items()
        if abs(number(name, usual) - usual) > 1e-9
    ]
    return [f"a layout does not say how robots move: {', '.join(odd)}"] if odd else []
