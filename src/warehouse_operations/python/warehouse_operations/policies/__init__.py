# SPDX-License-Identifier: Apache-2.0
"""The decisions of a shift, each one small class, chosen in YAML:

    orders: pile-on                                   # by name, or
    units: {name: most lines}                         # by name with options, or
    storage: {name: my_module:ByWeight, heavy: 40}    # a class of your own with options

What is left out is as in DEFAULTS. A class of your own has the methods of the protocol of its role;
its constructor takes the options. `view` is a view.View of the shift.
"""

import importlib
from typing import Any, Protocol

from warehouse_fleet import charging
from warehouse_operations.policies import (
    bins,
    idle,
    order_assignment,
    replenishment,
    robots,
    storage,
    unit_choice,
)
from warehouse_operations.yaml_file import read_yaml


class OrderAssignment(Protocol):
    def choose(self, station, view):
        """The order of view.backlog that a picking station with a free slot gets, or None."""


class UnitChoice(Protocol):
    def choose(self, station, candidates, view):
        """The unit that is brought for missing lines of the station's orders, one of candidates.

        candidates: {unit: {line: pieces}}, what each unit that is free could serve; not empty.
        """


class StoragePlace(Protocol):
    def choose(self, unit, cells, distances, view):
        """The cell to store a unit in, one of cells (n,), with metres from where it is."""


class BinChoice(Protocol):
    def choose(self, bundle, candidates, view):
        """The bin that a bundle goes to, one of candidates (not empty; each has room for it)."""


class Replenishment(Protocol):
    def bundles(self, view):
        """Yields (sku, pieces) of new bundles to be ordered now."""


class TaskMatching(Protocol):
    def match(self, tasks, robots, seconds, view):
        """Pairs (index of the task, index of the robot); see protocols.Hooks.match_robots."""


class Idle(Protocol):
    def park(self, kiva_id, cell, view):
        """The cell that a robot without work goes to; None: it waits where it is."""


class ChargingPolicy(Protocol):
    """charge: state of charge of batteries, (n,), 0…1; answers are (n,) bool."""

    low: float  # who is below comes before who charges though it need not

    def sends(self, charge, is_wanted):
        """Which robots without work are to charge; is_wanted: transports wait for robots."""

    def frees(self, charge):
        """Which of those that charge may be given work."""

    def spares(self, charge):
        """Which robots get no work even if no place to charge at is free."""


ROLES = {
    "orders": order_assignment.NAMES,
    "units": unit_choice.NAMES,
    "storage": storage.NAMES,
    "bins": bins.NAMES,
    "replenishment": replenishment.NAMES,
    "robots": robots.NAMES,
    "idle": idle.NAMES,
    "charging": charging.NAMES,
}
METHODS = {
    "orders": "choose",
    "units": "choose",
    "storage": "choose",
    "bins": "choose",
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
    "replenishment": "threshold",
    "robots": "nearest",
    "idle": "wait",
    "charging": "opportunity",
}


class PolicyError(ValueError):
    """There is no such policy; the text names the file and key and what was expected."""


class Policies:
    """One policy a role of ROLES, as attributes."""

    orders: Any
    units: Any
    storage: Any
    bins: Any
    replenishment: Any
    robots: Any
    idle: Any
    charging: Any

    def __init__(self, chosen=None, source="policies"):
        chosen = {} if chosen is None else chosen
        if not isinstance(chosen, dict):
            raise PolicyError(f"{source}: roles with a policy each were expected")
        for role in chosen:
            if role not in ROLES:
                raise PolicyError(f"{source}: '{role}' is no role; expected {', '.join(ROLES)}")
        self.given = chosen
        self.chosen = {role: chosen.get(role, DEFAULTS[role]) for role in ROLES}
        for role, what in self.chosen.items():
            setattr(self, role, _make(role, what, source))

    @classmethod
    def read(cls, path):
        """Those of a YAML file; raises PolicyError."""
        return cls(read_yaml(path, PolicyError), str(path))


def _make(role, what, source):
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


def _own(role, name, source):
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
