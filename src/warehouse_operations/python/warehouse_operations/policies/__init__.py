# SPDX-License-Identifier: Apache-2.0
"""The policies that make the decisions of a shift, small classes that are chosen in YAML:

    orders: pile-on                                   # by name, or
    units: {name: most lines}                         # by name with options, or
    storage: {name: my_module:ByWeight, heavy: 40}    # a class of your own with options

Roles that are left out have the policies of DEFAULTS. A class of your own has the methods of the
protocol of its role; its constructor takes the options. In Python an object with those methods is
accepted, too. `view` is a view.View of the shift.
"""

import importlib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from warehouse_fleet.transports import charging
from warehouse_layout.convert.rawsim.xml_fields import InstanceError
from warehouse_operations.policies import (
    batches,
    bins,
    idle,
    learned,
    order_assignment,
    rawsim_policies,
    replenishment,
    robots,
    storage,
    unit_choice,
)
from warehouse_operations.stock.inventory import Bin
from warehouse_operations.stock.orders import Bundle, Line, Order
from warehouse_operations.stock.protocols import Task
from warehouse_operations.stock.stations import WorkStation
from warehouse_operations.stock.yaml_file import read_yaml

if TYPE_CHECKING:
    from warehouse_operations.policies.view import View


class OrderAssignment(Protocol):
    """Chooses orders for picking stations."""

    def choose(self, station: WorkStation, view: "View") -> Order | None:
        """Returns the order of view.backlog for a picking station with a free slot, or None."""


class UnitChoice(Protocol):
    """Chooses units for picking stations."""

    def choose(
        self, station: WorkStation, candidates: Mapping[int, Mapping[Line, int]], view: "View"
    ) -> int:
        """Returns the unit, one of candidates, to be brought for missing lines of a station.

        candidates: {unit: {line: pieces}}, what each free unit could serve; not empty. It is a
        candidates.Candidates, which has the same data in arrays.
        """


class StoragePlace(Protocol):
    """Chooses storage places for units."""

    def choose(self, unit: int, cells: np.ndarray, distances: np.ndarray, view: "View") -> int:
        """Returns the cell, one of cells (n,), in which a unit is stored.

        distances: the way to each cell from where the unit is [m], (n,).
        """


class BinChoice(Protocol):
    """Chooses bins for bundles."""

    def choose(self, bundle: Bundle, candidates: Sequence[Bin], view: "View") -> Bin:
        """Returns the bin that a bundle goes to: one of candidates, which have room for it."""


class Batches(Protocol):
    """Says how many bundles are worth the trip of a unit."""

    def least(self, view: "View") -> int:
        """Returns the fewest bundles with which a unit is fetched now. Bundles that orders lack, or
        that have waited for long, are fetched for all the same."""


class Replenishment(Protocol):
    """Orders bundles to refill the stock."""

    def bundles(self, view: "View") -> Iterable[tuple[str, int]]:
        """Yields (sku, pieces) of new bundles to be ordered now."""


class TaskMatching(Protocol):
    """Matches robots to transports."""

    def match(
        self, tasks: Sequence[Task], robots: Sequence[int], seconds: np.ndarray, view: "View"
    ) -> Iterable[tuple[int, int]]:
        """Returns pairs (index of the task, index of the robot).

        See protocols.Hooks.match_robots.
        """


class Idle(Protocol):
    """Chooses where robots without work wait."""

    def park(self, kiva_id: int, cell: int, view: "View") -> int | None:
        """Returns the cell to which a robot without work goes; None: it waits where it is."""


class ChargingPolicy(Protocol):
    """Decides when robots charge.

    charge: the state of charge of batteries, (n,), 0…1. Results are (n,) bool.
    """

    low: float  # charge below which a robot may take the place of one that could work

    def sends(self, charge: np.ndarray, is_wanted: bool) -> np.ndarray:
        """Returns which robots without work are to charge.

        is_wanted: whether transports wait for robots.
        """

    def frees(self, charge: np.ndarray) -> np.ndarray:
        """Returns which charging robots may get work."""

    def spares(self, charge: np.ndarray) -> np.ndarray:
        """Returns which robots get no work, even without a free charging place."""


ROLES: dict[str, dict[str, Any]] = {
    "orders": order_assignment.NAMES | {"learned": learned.LearnedOrders},
    "units": unit_choice.NAMES | {"learned": learned.LearnedUnits},
    "storage": storage.NAMES,
    "bins": bins.NAMES,
    "batches": batches.NAMES,
    "replenishment": replenishment.NAMES,
    "robots": robots.NAMES | {"learned": learned.LearnedRobots},
    "idle": idle.NAMES,
    "charging": charging.NAMES,
}
METHODS = {
    "orders": "choose",
    "units": "choose",
    "storage": "choose",
    "bins": "choose",
    "batches": "least",
    "replenishment": "bundles",
    "robots": "match",
    "idle": "park",
    "charging": "sends",
}
DEFAULTS = {
    "orders": "pile-on",
    "units": "most lines",
    "storage": "nearest",
    "bins": "emptiest",
    "batches": "at once",
    "replenishment": "threshold",
    "robots": "nearest",
    "idle": "wait",
    "charging": "opportunity",
}


class PolicyError(ValueError):
    """Raised for an unknown policy; names the file and key and what was expected."""


class Policies:
    """Holds one policy for each of ROLES, as attributes.

    chosen: policies by role, each a name, a mapping with `name` and options, or an object that
    decides. source: where they come from, for errors. Raises PolicyError.
    """

    orders: OrderAssignment
    units: UnitChoice
    storage: StoragePlace
    bins: BinChoice
    batches: Batches
    replenishment: Replenishment
    robots: TaskMatching
    idle: Idle
    charging: ChargingPolicy

    def __init__(self, chosen: Mapping[str, Any] | None = None, source: str = "policies") -> None:
        chosen = {} if chosen is None else chosen
        if not isinstance(chosen, dict):
            raise PolicyError(f"{source}: roles with a policy each were expected")
        for role in chosen:
            if role not in ROLES:
                raise PolicyError(f"{source}: '{role}' is not a role; expected {', '.join(ROLES)}")
        self.choices = chosen
        self.chosen: dict[str, Any] = {}  # in the form of a file
        for role in ROLES:
            what = chosen.get(role, DEFAULTS[role])
            policy = _make(role, what, source)
            setattr(self, role, policy)
            self.chosen[role] = _name_of(policy) if policy is what else what

    def change(self, chosen: Mapping[str, Any]) -> None:
        """Has other policies decide from now on, for the roles that are named. Raises
        PolicyError."""
        others = Policies(dict(chosen))
        for role in chosen:
            setattr(self, role, getattr(others, role))
            self.chosen[role] = others.chosen[role]

    @classmethod
    def read(cls, path: str | Path) -> "Policies":
        """Returns the policies of a YAML file, beside which their files lie, or of a controller of
        RAWSim-O (.xconf). Raises PolicyError."""
        if rawsim_policies.is_controller(path):
            try:
                return cls(rawsim_policies.read(path)[0], str(path))
            except InstanceError as error:
                raise PolicyError(str(error)) from error
        return cls(beside(read_yaml(path, PolicyError), Path(path).parent), str(path))


def beside(chosen: Any, folder: Path) -> Any:
    """Returns policies by role, a relative option `file` resolved against a folder: ROS nodes run
    in another one."""
    if not isinstance(chosen, dict):
        return chosen
    return {role: _beside(what, folder) for role, what in chosen.items()}


def _beside(what: Any, folder: Path) -> Any:
    if not isinstance(what, dict) or not isinstance(what.get("file"), str):
        return what
    return what | {"file": str(folder.absolute() / Path(what["file"]).expanduser())}


def _name_of(policy: Any) -> str:
    """Returns the name of an object's class for a file."""
    return f"{type(policy).__module__}:{type(policy).__qualname__}"


def _make(role: str, what: Any, source: str) -> Any:
    if callable(getattr(what, METHODS[role], None)):
        return what
    options = dict(what) if isinstance(what, dict) else {"name": what}
    name = options.pop("name", None)
    if not isinstance(name, str):
        raise PolicyError(f"{source}: {role}: a name, or a mapping with `name`, was expected")
    cls = ROLES[role].get(name) or _own(role, name, source)
    try:
        policy = cls(**options)
    except (TypeError, ValueError) as error:
        raise PolicyError(f"{source}: {role}: {name}: {error}") from error
    if not callable(getattr(policy, METHODS[role], None)):
        raise PolicyError(f"{source}: {role}: {name} has no method {METHODS[role]}")
    return policy


def _own(role: str, name: str, source: str) -> Any:
    module, colon, attribute = name.partition(":")
    if not colon:
        known = ", ".join(ROLES[role])
        raise PolicyError(
            f"{source}: {role}: there is no '{name}'; {known}, or module:Class was expected"
        )
    try:
        return getattr(importlib.import_module(module), attribute)
    except (ImportError, AttributeError, ValueError, SyntaxError) as error:
        raise PolicyError(f"{source}: {role}: {name}: {error}") from error
