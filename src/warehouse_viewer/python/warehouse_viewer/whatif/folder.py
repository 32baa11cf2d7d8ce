# SPDX-License-Identifier: Apache-2.0
"""The folder of scenarios, and of the layouts and orders that they share."""

import contextlib
import itertools
import os
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from warehouse_layout.file import layout_file, sku_master, stock_file
from warehouse_layout.file.layout_file import SUFFIX, LayoutFileError
from warehouse_layout.file.request import LIMITS
from warehouse_layout.file.sku_master import SkuMasterError
from warehouse_layout.file.stock_file import StockFileError
from warehouse_layout.generate import layout_choice
from warehouse_operations.runs import early_check, event_file
from warehouse_operations.runs.simulation import ERRORS, Description
from warehouse_operations.sizing import costs
from warehouse_operations.sizing.costs import Costs
from warehouse_operations.sizing.prices import PriceError
from warehouse_operations.stock import demand_file, orders_text
from warehouse_operations.stock.assortment import Assortment
from warehouse_operations.stock.demand import make_demand
from warehouse_operations.stock.order_file import DemandError, read_csv
from warehouse_viewer.whatif.scenario import (
    DEMAND,
    FILE,
    LAYOUTS,
    ORDERS,
    Scenario,
    ScenarioError,
    checked_name,
    is_file_name,
)
from warehouse_viewer.whatif.stored import States

MOST_SCENARIOS, MOST_FILES = 200, 500
COSTS = "costs.yaml"  # beside the scenarios, of all of them


class Folder:
    """Scenarios by name, a folder each. Paths never lead out of it."""

    def __init__(self, path: Path) -> None:
        self.path = path

    # --- scenarios
    def names(self) -> list[str]:
        """Returns the names of all scenarios."""
        names = (file.parent.name for file in self.path.glob(f"*/{FILE}"))
        return sorted((name for name in names if not name.startswith(".")), key=str.casefold)

    def of(self, name: str) -> Path:
        """Returns the folder of a scenario. Raises ScenarioError if there is none."""
        folder = self.path / checked_name(name)
        if folder.is_symlink() or not (folder / FILE).is_file():
            raise ScenarioError(f"there is no scenario '{name}'")
        return folder

    def read(self, name: str) -> Scenario:
        """Returns a scenario. Raises ScenarioError."""
        return Scenario.read(self.of(name))

    def create(self, name: str, scenario: Scenario) -> str:
        """Makes a folder for a scenario; returns its name. Raises ScenarioError."""
        name = checked_name(name)
        if len(self.names()) >= MOST_SCENARIOS:
            raise ScenarioError(f"there are {MOST_SCENARIOS} scenarios; delete some first")
        if (self.path / name).exists():
            raise ScenarioError(f"'{name}' is there already; another name was expected")
        with self._draft(scenario) as draft:
            draft.rename(self.path / name)
        return name

    def change(self, name: str, scenario: Scenario) -> None:
        """Changes a scenario; runs stay where they are. Raises ScenarioError."""
        folder = self.of(name)
        with self._draft(scenario) as draft:
            os.replace(draft / FILE, folder / FILE)
        States(folder).clear()

    def duplicate(self, name: str) -> str:
        """Copies a scenario without its runs; returns the copy's name."""
        stem = name.rstrip("0123456789").rstrip() or name
        tries = (f"{stem[:55].rstrip()} {n}" for n in itertools.count(2))
        copy = next(candidate for candidate in tries if not (self.path / candidate).exists())
        return self.create(copy, self.read(name))

    def rename(self, name: str, to: str) -> str:
        """Gives a scenario and its folder another name, which is returned."""
        folder, to = self.of(name), checked_name(to)
        if to != name:
            if (self.path / to).exists():
                raise ScenarioError(f"'{to}' is there already; another name was expected")
            folder.rename(self.path / to)
        return to

    def delete(self, name: str) -> None:
        """Deletes a scenario with its runs."""
        shutil.rmtree(self.of(name))

    @contextlib.contextmanager
    def _draft(self, scenario: Scenario) -> Iterator[Path]:
        """Writes a scenario beside the others, and checks it as a sweep would."""
        with tempfile.TemporaryDirectory(
            prefix=".draft-", dir=self.path, ignore_cleanup_errors=True
        ) as made:
            draft = Path(made, "scenario")
            draft.mkdir()
            scenario.write(draft)
            # A level deeper than a scenario: checked where it will be.
            check(scenario, self.path)
            yield draft

    # --- files
    def layouts(self) -> list[str]:
        """Returns the names of layouts that are not presets."""
        return sorted(file.name for file in (self.path / LAYOUTS).glob(f"*{SUFFIX}"))

    def orders(self) -> list[str]:
        """Returns the names of files of orders."""
        folder = self.path / ORDERS
        return sorted(file.name for end in (".csv", DEMAND) for file in folder.glob(f"*{end}"))

    def add_layout(self, name: str, text: str) -> str:
        """Keeps the text of a layout file; returns its name here. Raises LayoutFileError."""
        file = layout_file.parse(text, name)
        _check_layout(file)
        for what, named in (("stock", file.stock), ("SKU master", file.skus)):
            if named and not (self.path / LAYOUTS / named).is_file():
                raise LayoutFileError(
                    f"{name}: items: the {what} {named} is not here yet: open both files together"
                )
        return self._add(LAYOUTS, name, SUFFIX, text)

    def add_stock(self, name: str, text: str) -> str:
        """Keeps the text of a stock file, or of a SKU master, beside the layouts that name it.
        Raises LayoutFileError, and ScenarioError where another one has its name."""
        is_stock = "quantity" in text.partition("\n")[0]
        with tempfile.TemporaryDirectory() as made:
            file = Path(made, "stock.csv")
            file.write_text(text, "utf-8")
            try:
                stock_file.read(file, LIMITS["shelves"]) if is_stock else sku_master.read(file)
            except (StockFileError, SkuMasterError) as error:
                raise LayoutFileError(str(error).replace(str(file), name)) from error
        kept = self.path / LAYOUTS / name
        if is_file_name(name, ".csv") and kept.exists() and kept.read_text("utf-8") != text:
            raise ScenarioError(
                f"{name} is there already and says something else; another name was expected, in"
                " the layout too"
            )
        return self._add(LAYOUTS, name, ".csv", text)

    def add_orders(self, name: str, text: str) -> str:
        """Keeps the text of a file of orders, or of a description of demand; returns its name
        here. Raises DemandError."""
        suffix = DEMAND if name.endswith(DEMAND) else ".csv"
        with tempfile.TemporaryDirectory() as made:
            file = Path(made, f"orders{suffix}")
            file.write_text(text, "utf-8")
            try:
                demand_file.read(file) if suffix == DEMAND else read_csv(file)
            except DemandError as error:
                raise DemandError(str(error).replace(str(file), name)) from error
        return self._add(ORDERS, name, suffix, text)

    @property
    def costs_file(self) -> Path:
        """The file of costs, which may be missing."""
        return self.path / COSTS

    def costs(self) -> Costs | None:
        """Returns the costs of the folder; None where it has none. Raises PriceError."""
        return costs.read(self.costs_file) if self.costs_file.is_file() else None

    def set_costs(self, name: str, text: str) -> None:
        """Keeps a file of costs in place of the last one. Raises PriceError."""
        with tempfile.TemporaryDirectory(prefix=".draft-", dir=self.path) as made:
            draft = Path(made, COSTS)
            draft.write_text(text, "utf-8")
            try:
                costs.read(draft)
            except PriceError as error:
                raise PriceError(str(error).replace(str(draft), name)) from error
            os.replace(draft, self.costs_file)

    def _add(self, below: str, name: str, suffix: str, text: str) -> str:
        """Writes a file. One of that name that says something else stays, under its own name."""
        if not is_file_name(name, suffix):
            raise ScenarioError(f"the file is called {name!r}; NAME{suffix} was expected")
        folder = self.path / below
        folder.mkdir(exist_ok=True)
        if len(list(folder.iterdir())) >= MOST_FILES:
            raise ScenarioError(f"there are {MOST_FILES} files in {below}; delete some first")
        stem = name.removesuffix(suffix)
        for free in itertools.chain([name], (f"{stem}-{n}{suffix}" for n in itertools.count(2))):
            path = folder / free
            if not path.exists():
                path.write_text(text, "utf-8")
            if path.read_text("utf-8") == text:
                return free
        raise AssertionError("unreachable")


def check(scenario: Scenario, path: Path) -> Description:
    """Returns the shift of a scenario in the folder `path`. Raises ScenarioError where a fleet
    could not work there, or orders can't be read."""
    sweep_file = scenario.to_sweep()
    beside = path / LAYOUTS  # for what begins with ../
    try:
        layout = sweep_file["layout"]
        if layout.endswith(SUFFIX):
            layout = os.path.normpath(beside / layout)
        orders = orders_text.with_file(
            sweep_file["orders"],
            lambda file: os.path.normpath(beside / file) if file.startswith("../") else file,
        )
        description = Description(
            layout=layout,
            robots=scenario.robots,
            stations=scenario.stations,
            orders=orders,
            seconds=60 * scenario.minutes,
            policies=dict(scenario.policies),
            physics=scenario.physics,
            realism=scenario.realism,
            events=event_file.events_of(scenario.events, path),
        )
        _check_floor(description)
        _check_orders(orders)
        description.config  # noqa: B018 - raises for policies of the layout that don't exist
        early_check.check(description)
    except (*ERRORS, OSError) as error:
        raise ScenarioError(str(error).replace(f"{path}/", "")) from error
    return description


def _check_orders(orders: str) -> None:
    """Raises DemandError for orders that can't be read; their SKUs are checked with the stock."""
    rng = np.random.default_rng(1)
    assortment = None if orders_text.file_of(orders) else Assortment.draw(2, rng)
    make_demand(orders, assortment, (1, 1), rng)


def _check_floor(description: Description) -> None:
    file = layout_choice.chosen(description.layout)
    layout_choice.check(file, description.robots or None)
    count = sum(station.kind != "replenish" for station in file.stations)
    if not count:
        raise ScenarioError(f"{file.title}: there is no picking station")
    if description.stations > count:
        raise ScenarioError(
            f"{description.stations:,} picking stations open; {file.title} has {count}"
        )


def _check_layout(file: layout_file.LayoutFile) -> None:
    """Raises LayoutFileError for a layout that names files elsewhere."""
    for key, named in (("stock", file.stock), ("skus", file.skus)):
        if named and not is_file_name(named, ".csv"):
            raise LayoutFileError(
                f"{file.path}: items: {key} is {named!r}; the name of a CSV file was expected,"
                " which is opened together with the layout"
            )
    if not all(char.isalnum() or char in "_-" for char in file.building):
        raise LayoutFileError(f"{file.path}: building: the name of a world was expected")
