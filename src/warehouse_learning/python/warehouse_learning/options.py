# SPDX-License-Identifier: Apache-2.0
"""What a task is like: sizes, times, rewards. Checked whole before a world is built."""

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from warehouse_layout.file.layout_file import LayoutFileError
from warehouse_layout.generate import layout_choice
from warehouse_layout.place import placement

REWARDS = {
    "delivered": 1.0,  # a requested unit stands at a station: its robot
    "lifted": 0.0,  # a robot has lifted a requested unit
    "dropped": 0.0,  # a robot has put down a requested unit
    "stored": 0.0,  # a robot has put back a unit that was delivered
    "approached": 0.0,  # a cell nearer to the goal; minus as much for a cell farther
    "refused": 0.0,  # an action that was not possible
    "collided": 0.0,  # a contact with another body
    "step": 0.0,  # every decision of every robot
}


@dataclass(frozen=True)
class Size:
    """Counts of a registered size."""

    robots: int
    shelves: int


SIZES = {
    "tiny": Size(3, 12),
    "small": Size(4, 24),
    "medium": Size(20, 160),
    "large": Size(100, 800),
}


class OptionError(ValueError):
    """An option that can't be met; the message names it and what was expected."""


@dataclass(frozen=True)
class Options:
    """Options of an environment; all by name.

    size: of SIZES, or robots and shelves (storage units) as counts, or layout: a layout file,
    NAME.layout.yaml, with its own shelves, and its own robots unless `robots` says how many.
    requests: count of units requested at any time; by default that of robots.
    max_cycles: decisions an episode.

    decision: "action", a decision lasts until every robot has ended its action; a number is its
    duration [s, simulated], and robots that have not ended an action continue it. continuous:
    actions are wheel speeds; a decision needs a duration.

    physics_step [s]; acceleration [m/s²], 0 = speeds change at once; lift_time [s]. lasers: robots
    see and stop before obstacles by themselves, and their ranges are observed. reserve: forward is
    refused where another robot stands or goes; else only physics keeps robots apart. radius: of the
    neighbourhood that is observed, in cells. rewards: replaces some of REWARDS. seed: of episodes
    that are reset without one.
    """

    size: str = "small"
    robots: int = 0
    shelves: int = 0
    layout: str = ""
    requests: int = 0
    max_cycles: int = 500
    decision: float | str = "action"
    continuous: bool = False
    physics_step: float = 0.05
    acceleration: float = 1.0
    lift_time: float = 2.2
    lasers: bool = False
    reserve: bool = True
    radius: int = 2
    rewards: dict = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.layout:
            self._count_of_layout()
        elif self.robots or self.shelves:
            _whole("robots", self.robots, 1, 5000)
            _whole("shelves", self.shelves, 2, 20000)
        elif self.size not in SIZES:
            raise OptionError(f"size is {self.size!r}; one of {', '.join(SIZES)} was expected")
        else:
            object.__setattr__(self, "robots", SIZES[self.size].robots)
            object.__setattr__(self, "shelves", SIZES[self.size].shelves)
        if not self.requests:
            object.__setattr__(self, "requests", min(self.robots, self.shelves - 1))
        _whole("requests", self.requests, 1, self.shelves - 1)
        _whole("max_cycles", self.max_cycles, 1, 10**9)
        _whole("radius", self.radius, 1, 10)
        _real("physics_step", self.physics_step, 1e-4, 0.1)
        _real("acceleration", self.acceleration, 0, 100)
        _real("lift_time", self.lift_time, 0, 60)
        if self.continuous and self.decision == "action":
            object.__setattr__(self, "decision", 0.2)
        if self.decision != "action":
            _real("decision", self.decision, self.physics_step, 60)
        unknown = [name for name in self.rewards if name not in REWARDS]
        if unknown:
            raise OptionError(f"rewards has {unknown[0]!r}; {', '.join(REWARDS)} are known")
        for name, value in self.rewards.items():
            _real(f"rewards[{name!r}]", value, -1e9, 1e9)
        object.__setattr__(self, "rewards", REWARDS | self.rewards)

    def _count_of_layout(self) -> None:
        if self.shelves:
            raise OptionError(f"shelves is {self.shelves}; a layout has its own")
        try:
            file = layout_choice.chosen(self.layout)
            layout_choice.check(file, self.robots or None)
            laid = placement.place(file, robots=self.robots or None)
        except LayoutFileError as error:
            raise OptionError(f"layout: {error}") from error
        object.__setattr__(self, "robots", len(laid.robots))
        object.__setattr__(self, "shelves", len(laid.units))
        _whole("the layout's number of robots", self.robots, 1, 5000)
        _whole("the layout's number of storage units", self.shelves, 2, 20000)

    @property
    def title(self) -> str:
        """What the page calls the warehouse."""
        if self.layout:
            return layout_choice.chosen(self.layout).title
        own = SIZES.get(self.size) == Size(self.robots, self.shelves)
        return self.size if own else f"{self.robots} robots, {self.shelves} units"

    @classmethod
    def of(cls, values: Mapping[str, Any]) -> "Options":
        """Returns Options from keyword arguments. Raises OptionError for an unknown one."""
        known = [f.name for f in dataclasses.fields(cls)]
        for name in values:
            if name not in known:
                raise OptionError(f"{name} is not an option; there are {', '.join(known)}")
        return cls(**values)


def _whole(name: str, value: object, least: int, most: int) -> None:
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        raise OptionError(f"{name} is {value!r}; a whole number from {least} to {most}")


def _real(name: str, value: object, least: float, most: float) -> None:
    good = isinstance(value, int | float) and math.isfinite(value) and least <= value <= most
    if not good or isinstance(value, bool):
        raise OptionError(f"{name} is {value!r}; a number from {least:g} to {most:g}")
