# SPDX-License-Identifier: Apache-2.0
"""A scenario: what a person chooses in the page, and the file scenario.yaml that says the same."""

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from typing import Any

import yaml

from warehouse_layout.file.layout_file import SUFFIX
from warehouse_layout.file.request import LIMITS, MOST_STATIONS, PRESETS
from warehouse_operations.policies import ROLES
from warehouse_operations.runs import event_file
from warehouse_operations.stock import orders_text
from warehouse_operations.stock.order_file import DemandError
from warehouse_operations.stock.yaml_file import read_yaml

FILE = "scenario.yaml"
DEMAND = ".demand.yaml"  # a description of demand, as `demand` writes it
LAYOUTS, ORDERS = "layouts", "orders"  # folders beside the scenarios, of files that they share
DESIGNS = "designs"  # the folder of searches for layouts
REALISM = ("ideal", "typical", "bad_day")
MOST_MINUTES, MOST_SEEDS = 24 * 60.0, 50
NAME = re.compile(r"[^\W_][\w .,+=()-]{0,59}")
FILE_NAME = re.compile(r"[^\W_][\w .,+=()-]{0,79}")


class ScenarioError(ValueError):
    """Says what is wrong with a scenario, and what was expected."""


@dataclass(frozen=True)
class Scenario:
    """What is simulated, `seeds` times. layout: a preset, or a file in LAYOUTS; robots, stations:
    0 for as many as the layout has; realism: with physics, one of REALISM; orders: as simulate
    takes them, with files in ORDERS; policies: names by role; events: see event_file."""

    layout: str = "medium"
    robots: int = 0
    stations: int = 0
    orders: str = "fill"
    minutes: float = 60.0
    seeds: int = 5
    physics: bool = False
    realism: str = ""
    policies: Mapping[str, Any] = field(default_factory=dict)
    events: list[dict[str, Any]] = field(default_factory=list)

    @classmethod
    def of_json(cls, fields_of: object) -> "Scenario":
        """Returns the scenario that a page sends. Raises ScenarioError."""
        known = {field.name for field in fields(cls)}
        if not isinstance(fields_of, dict) or not fields_of.keys() <= known:
            raise ScenarioError(f"a scenario with {', '.join(sorted(known))} was expected")
        for key, value in fields_of.items():
            is_right, expected = EXPECTED[key]
            if key == "events":
                _check_events(value)
            if not is_right(value):
                raise ScenarioError(f"{key} is {value!r}; {expected} was expected")
        out = cls(**fields_of)
        if out.realism and not out.physics:
            raise ScenarioError("realism: ideal robots have none; physics was expected")
        return out

    def to_json(self) -> dict[str, Any]:
        """Returns what of_json() reads."""
        return asdict(self)

    def to_sweep(self) -> dict[str, Any]:
        """Returns the content of scenario.yaml."""
        has_file = self.layout.endswith(SUFFIX)
        out = self.to_json() | {
            "out": ".",
            "layout": f"../{LAYOUTS}/{self.layout}" if has_file else self.layout,
            "orders": orders_text.with_file(self.orders, _in_orders),
            "policies": dict(self.policies),
        }
        return {
            key: value
            for key, value in out.items()
            if isinstance(value, bool) or value not in (0, "", {}, [])
        }

    def write(self, folder: Path) -> None:
        """Writes scenario.yaml into a folder."""
        text = yaml.safe_dump(self.to_sweep(), sort_keys=False, allow_unicode=True)
        (folder / FILE).write_text(f"# rosrun warehouse_operations sweep {FILE}\n{text}", "utf-8")

    @classmethod
    def read(cls, folder: Path) -> "Scenario":
        """Returns the scenario of a folder. Raises ScenarioError, also for sweeps of others."""
        path = folder / FILE
        data = read_yaml(path, ScenarioError)
        if not isinstance(data, dict) or data.pop("out", "") != "." or "grid" in data:
            raise ScenarioError(f"{path}: `out: .` without a grid was expected")
        data.setdefault("physics", True)
        for key, below in (("layout", LAYOUTS), ("orders", ORDERS)):
            text = str(data.get(key, ""))
            data[key] = text.replace(f"../{below}/", "", 1) or getattr(cls, key)
        try:
            return cls.of_json(data)
        except ScenarioError as error:
            raise ScenarioError(f"{path}: {error}") from error


def _in_orders(file: str) -> str:
    """Returns a file of orders as it is seen from a scenario's folder."""
    return f"../{ORDERS}/{file}" if is_orders_file(file) else file


def is_orders_file(name: str) -> bool:
    """Returns whether it is a name of a file in ORDERS."""
    return any(is_file_name(name, suffix) for suffix in (".csv", DEMAND))


def _whole(least: int, most: int) -> tuple[Callable[[Any], bool], str]:
    def is_right(value: object) -> bool:
        return isinstance(value, int) and not isinstance(value, bool) and least <= value <= most

    return is_right, f"a whole number from {least} to {most}"


def _is_minutes(value: object) -> bool:
    if not isinstance(value, int | float) or isinstance(value, bool):
        return False
    return math.isfinite(value) and 0 < value <= MOST_MINUTES


def is_layout(value: object) -> bool:
    """Returns whether it is a preset, or the name of a file in LAYOUTS."""
    return isinstance(value, str) and (
        (value in PRESETS and value != "empty") or is_file_name(value, SUFFIX)
    )


def _is_orders(value: object) -> bool:
    if not isinstance(value, str) or len(value) > 200:
        return False
    try:
        file = orders_text.file_of(value)
    except DemandError:
        return False
    if file:
        return is_orders_file(file) and not value.startswith("mix:")
    return value.partition(":")[0] in ("fill", "poisson", "mix")


def _is_policies(value: object) -> bool:
    """Only names that are known: a page names no code."""
    return isinstance(value, dict) and all(
        role in ROLES and isinstance(name, str) and name in ROLES[role]
        for role, name in value.items()
    )


def _check_events(value: object) -> None:
    """Raises ScenarioError, which says which event is wrong."""
    try:
        event_file.events_of(value, Path("."))
    except event_file.EventError as error:
        raise ScenarioError(str(error)) from error


def _is_events(value: object) -> bool:
    """Only what names no files: a page names those in ORDERS alone."""
    return not any(event.kind == "orders" for event in event_file.events_of(value, Path(".")))


def is_file_name(name: str, suffix: str) -> bool:
    """Returns whether it is a name of a file of that kind, without a folder."""
    stem = name.removesuffix(suffix)
    return name != stem and bool(FILE_NAME.fullmatch(stem)) and ".." not in name


def checked_name(name: object) -> str:
    """Returns a scenario's name, which is that of its folder. Raises ScenarioError."""
    text = name.strip() if isinstance(name, str) else ""
    if not NAME.fullmatch(text) or text.endswith(".") or text in (LAYOUTS, ORDERS, DESIGNS):
        raise ScenarioError(
            f"the name is {name!r}; up to 60 letters, digits, spaces or any of .,+=()-_ were"
            f" expected, a letter or digit first; {LAYOUTS}, {ORDERS} and {DESIGNS} are taken"
        )
    return text


EXPECTED: dict[str, tuple[Callable[[Any], Any], str]] = {
    "layout": (is_layout, f"a preset, or the name of a {SUFFIX} file"),
    "robots": _whole(0, LIMITS["robots"]),
    "stations": _whole(0, MOST_STATIONS),
    "orders": (
        _is_orders,
        "fill, poisson:PER_HOUR, mix:PER_HOUR:LINESxPIECES, FILE.csv, day:FILE.csv or"
        " demand:FILE.demand.yaml, either of these with *1.3",
    ),
    "minutes": (_is_minutes, f"a number above 0, up to {MOST_MINUTES:g},"),
    "seeds": _whole(1, MOST_SEEDS),
    "physics": (lambda value: isinstance(value, bool), "true or false"),
    "realism": (lambda value: value in ("", *REALISM), f"one of {', '.join(REALISM)}"),
    "policies": (_is_policies, f"a known policy for some of {', '.join(ROLES)}"),
    "events": (_is_events, "events without files of orders"),
}
