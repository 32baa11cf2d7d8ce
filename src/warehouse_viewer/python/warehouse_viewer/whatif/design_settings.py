# SPDX-License-Identifier: Apache-2.0
"""A search for a layout: what a person chooses in the page, and the file design.yaml of it."""

import math
import os
import re
from collections.abc import Callable
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from warehouse_layout.file.layout_file import SUFFIX, LayoutFileError
from warehouse_layout.generate import layout_choice
from warehouse_operations.sizing.prices import PriceError
from warehouse_operations.stock import orders_text
from warehouse_operations.stock.order_file import DemandError
from warehouse_operations.stock.yaml_file import read_yaml
from warehouse_viewer.whatif.scenario import (
    DEMAND,
    LAYOUTS,
    ORDERS,
    ScenarioError,
    is_layout,
    is_orders_file,
)

if TYPE_CHECKING:
    from warehouse_operations.design.task import Task

FILE = "design.yaml"
COSTS = "costs.yaml"  # beside the file: those of the folder when the search was made
MOST_CPU_HOURS, MOST_PHYSICS, MOST_SEED = 1000.0, 24.0, 2**31 - 1
EDGES = re.compile(r"\d{1,4}x\d{1,4}")


class DesignError(ScenarioError):
    """Says which field of a search is wrong, and what was expected."""

    def __init__(self, field: str, text: str) -> None:
        super().__init__(text)
        self.field = field


@dataclass(frozen=True)
class DesignSettings:
    """A search. building: WxH in cells, a preset, whose edges count, or a file in LAYOUTS; demand:
    a file in ORDERS, with *1.3 or without; late: share of orders that may be; physics_hours: length
    of the last layouts' shifts with physics, 0: none."""

    building: str = "40x30"
    demand: str = ""
    late: float = 0.01
    cpu_hours: float = 0.25
    seed: int = 1
    physics_hours: float = 0.25

    @classmethod
    def of_json(cls, fields_of: object) -> "DesignSettings":
        """Returns the search that a page sends. Raises DesignError."""
        known = {field.name for field in fields(cls)}
        if not isinstance(fields_of, dict) or not fields_of.keys() <= known:
            raise DesignError("", f"a search with {', '.join(sorted(known))} was expected")
        for key, value in fields_of.items():
            is_right, expected = EXPECTED[key]
            if not is_right(value):
                raise DesignError(key, f"{key} is {value!r}; {expected} was expected")
        return cls(**fields_of)

    def to_json(self) -> dict[str, Any]:
        """Returns what of_json() reads."""
        return asdict(self)

    def write(self, folder: Path) -> None:
        """Writes design.yaml into a folder."""
        text = yaml.safe_dump(self.to_json(), sort_keys=False, allow_unicode=True)
        (folder / FILE).write_text(f"# {self._command()}\n{text}", "utf-8")

    def _command(self) -> str:
        """Returns the command of a terminal in the search's folder that does the same."""
        task = self.task(Path("../.."), Path(COSTS))
        return (
            f'rosrun warehouse_operations design --building "{task.building}" --demand'
            f' "{task.demand}" --costs {task.costs} --late {task.late:g} --cpu-hours'
            f" {task.hours:g} --seed {task.seed} --physics {task.physics:g} --out ."
        ).replace("--physics 0 ", "--no-physics ")

    @classmethod
    def read(cls, folder: Path) -> "DesignSettings":
        """Returns the search of a folder. Raises DesignError."""
        try:
            return cls.of_json(read_yaml(folder / FILE, ScenarioError))
        except DesignError as error:
            raise DesignError(error.field, f"{folder / FILE}: {error}") from error

    def task(self, kept: Path, costs: Path) -> "Task":
        """Returns the Task of the search. kept: the folder of LAYOUTS and ORDERS."""
        from warehouse_operations.design.task import Task

        if self.building.endswith(SUFFIX):
            building = str(kept / LAYOUTS / self.building)
        elif layout_choice.is_preset(self.building):
            rows, columns = layout_choice.chosen(self.building).floor.shape
            building = f"{columns}x{rows}"
        else:
            building = self.building
        file, star, factor = self.demand.partition("*")
        return Task(
            building,
            f"{kept / ORDERS / file}{star}{factor}",
            str(costs),
            self.late,
            self.cpu_hours,
            self.seed,
            physics=self.physics_hours,
        )


def checked(settings: DesignSettings, kept: Path, costs: Path) -> "Task":
    """Returns the Task of a search whose files can be read. Raises DesignError with the field."""
    from warehouse_operations.design.building import Building, BuildingError
    from warehouse_operations.sizing.day import Day

    if not settings.demand:
        raise DesignError("demand", "a file of orders, or a description of demand, was expected")
    if not costs.is_file():
        raise DesignError("costs", "what things cost is not known yet; open a costs.yaml")
    task = settings.task(kept, costs)
    try:
        Building.read(task.building)
    except (BuildingError, LayoutFileError) as error:
        raise DesignError("building", _own(error, kept)) from error
    try:
        Day.read(task.demand)
        task.space()
    except DemandError as error:
        raise DesignError("demand", _own(error, kept)) from error
    try:
        task.money()
    except PriceError as error:
        raise DesignError("costs", _own(error, kept)) from error
    return task


def _own(error: Exception, kept: Path) -> str:
    """Returns the text of an error with the names of files as they are within the folder."""
    return str(error).replace(f"{kept}{os.sep}", "")


def _number(most: float, zero: bool = False) -> tuple[Callable[[Any], bool], str]:
    def is_right(value: object) -> bool:
        if not isinstance(value, int | float) or isinstance(value, bool):
            return False
        return math.isfinite(value) and (0 < value <= most or (zero and value == 0))

    return is_right, f"a number {'from 0' if zero else 'above 0'}, up to {most:g},"


def _is_building(value: object) -> bool:
    return isinstance(value, str) and (bool(EDGES.fullmatch(value)) or is_layout(value))


def _is_demand(value: object) -> bool:
    if not isinstance(value, str) or len(value) > 200:
        return False
    if not value:
        return True  # none is chosen yet
    file = value.partition("*")[0]
    kind = orders_text.DEMAND if file.endswith(DEMAND) else orders_text.DAY
    try:
        return is_orders_file(file) and orders_text.day_of(f"{kind}:{value}") is not None
    except DemandError:
        return False


def _is_seed(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= MOST_SEED


EXPECTED: dict[str, tuple[Callable[[Any], Any], str]] = {
    "building": (_is_building, f"40x30, a preset, or the name of a {SUFFIX} file"),
    "demand": (_is_demand, "FILE.csv or FILE.demand.yaml, either of these with *1.3,"),
    "late": (
        lambda value: isinstance(value, float) and 0 < value < 1,
        "a share of the orders above 0 and below 100 %",
    ),
    "cpu_hours": _number(MOST_CPU_HOURS),
    "seed": (_is_seed, f"a whole number from 0 to {MOST_SEED}"),
    "physics_hours": _number(MOST_PHYSICS, zero=True),
}
