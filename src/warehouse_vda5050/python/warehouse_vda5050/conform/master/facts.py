# SPDX-License-Identifier: Apache-2.0
"""What holds of a vehicle, and since when."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple


class Fact(NamedTuple):
    """A value, and the time since which it holds [s]."""

    value: Any
    since: float


Scene = Mapping[str, Fact]


class Facts:
    """The facts of one vehicle by name. order, update: of the order that it has; busy: whether that
    is under way; node, sequence: the last traversed; at: position [m]; fatal, localized, mode,
    charge, loaded: of its state; online: by the topic connection; sheet: its factsheet, with the
    names of 2.1.0; cancel: the status of the newest cancelOrder; pushed: how often a person put it
    elsewhere; zone_sets: whether each zone set that it has is enabled, by id; zones: the id of the
    one that is."""

    def __init__(self) -> None:
        self._facts: dict[str, Fact] = {}

    def note(self, now: float, **values: Any) -> None:
        """Takes values over; those that are as before keep their time."""
        for name, value in values.items():
            if name not in self._facts or self._facts[name].value != value:
                self._facts[name] = Fact(value, now)

    def scene(self, **more: Fact) -> Scene:
        """Returns the facts as they are now."""
        return {**self._facts, **more}


def value_of(scene: Scene, name: str, default: Any = None) -> Any:
    """Returns the value of a fact."""
    return scene[name].value if name in scene else default


def held_for(scene: Scene, name: str, now: float) -> float:
    """Returns for how long a fact has held [s]."""
    return now - scene[name].since if name in scene else 0.0
