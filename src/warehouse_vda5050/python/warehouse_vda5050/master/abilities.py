# SPDX-License-Identifier: Apache-2.0
"""What a vehicle's factsheet allows, as the master's orders have to keep to it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from warehouse_vda5050.driver import Point
from warehouse_vda5050.master.commands import Follow, RefusedError, UnfitError
from warehouse_vda5050.master.load_fit import OWN_TYPE, LoadChoice, UnitMeasures, choose_load
from warehouse_vda5050.master.text_limits import nodes_within
from warehouse_vda5050.master.whereabouts import FASTEST
from warehouse_vda5050.model import (
    Action,
    BlockingType,
    Factsheet,
    Lengths,
    LoadSet,
    SupportedAction,
)

FASTER = 1.2  # a vehicle is at most this many times as fast as its factsheet says
# What a lift is best sent as, from left to right.
PREFERRED = (BlockingType.HARD, BlockingType.SOFT, BlockingType.SINGLE, BlockingType.NONE)
# Optional fields that orders have in any case, and those that they have where a vehicle requires
# them; by their last part, in 2.1.0 and in 3.0.0.
ALWAYS = frozenset({"nodePosition", "x", "y", "mapId", "actions", "startNodeId", "endNodeId"})
LENGTH, SPEED = frozenset({"length"}), frozenset({"maxSpeed", "maximumSpeed"})


@dataclass
class Abilities:
    """The abilities of one vehicle; without a `sheet` nothing is known and nothing is limited.
    `parameters` are its action_parameters in the file of robots."""

    parameters: Mapping[str, Any] = field(default_factory=dict)
    sheet: Factsheet | None = None
    loads: LoadSet | None = None  # by which it carries what it carries

    @property
    def max_nodes(self) -> int | None:
        """The most nodes of an order; None where there is no limit."""
        if not self.sheet:
            return None
        within = nodes_within(self.sheet.lengths)
        return self.sheet.max_nodes if within is None else min(self.sheet.max_nodes, within)

    @property
    def lengths(self) -> Lengths:
        """The longest strings and arrays that it takes."""
        return self.sheet.lengths if self.sheet else Lengths()

    @property
    def order_interval(self) -> float:
        """The least time between two orders [s]."""
        return self.sheet.order_interval if self.sheet else 0.0

    @property
    def top_speed(self) -> float:
        """The speed beyond which a vehicle can't have driven to where it says to be [m/s]."""
        said = self.sheet.max_speed * FASTER if self.sheet and self._says("speedMax") else 0.0
        return max(FASTEST, said)

    def check_path(self) -> None:
        """Raises RefusedError where the vehicle requires fields of paths that no order has."""
        lacking = sorted(self._required - ALWAYS - LENGTH - SPEED)
        if lacking:
            raise RefusedError(
                f"its factsheet requires {', '.join(lacking)} in orders, which this master does not"
                " send"
            )

    def check_speeds(self, command: Follow) -> None:
        """Raises RefusedError for speed limits that the vehicle does not say that it keeps."""
        if self.sheet is None or not command.is_limited:
            return
        if SPEED.isdisjoint(name.rsplit(".", 1)[-1] for name, *_ in self.sheet.parameters):
            raise RefusedError(
                "its factsheet does not name maxSpeed of edges among optionalParameters, so that"
                " speed limits may not be kept"
            )

    def edge_demands(self, start: Point, end: Point) -> tuple[tuple[str, float], ...]:
        """Returns the optional fields of an edge that the vehicle requires: no maxSpeed is above
        what it says that it can, with its load."""
        demands: list[tuple[str, float]] = []
        if self._required & SPEED and self.sheet:
            limits = [self.sheet.max_speed]
            if self.loads and self.loads.max_speed:
                limits.append(self.loads.max_speed)
            demands.append(("maxSpeed", min(limits)))
        if self._required & LENGTH:
            demands.append(("length", math.dist(start, end)))
        return tuple(demands)

    def check_unit(self, unit: int, measures: UnitMeasures) -> LoadChoice:
        """Returns the load set for a unit. Raises UnfitError where it has none."""
        if self.sheet is None:
            return LoadChoice()
        choice = choose_load(self.sheet, self.parameters, measures)
        if choice.why_not:
            raise UnfitError(f"it can't carry storage_unit{unit}: {choice.why_not}", unit)
        return choice

    def action(self, kind: str, name: str, unit: int, loads: LoadSet | None) -> Action:
        """Returns the action of a pick or drop. Raises RefusedError where the factsheet has no
        such action, or requires a parameter of it that nothing gives."""
        values: dict[str, Any] = {
            "stationType": "floor",
            "loadType": loads.load_type if loads else OWN_TYPE,
            "loadId": f"storage_unit{unit}",
        }
        known = self._at_nodes(kind)
        if known and known.parameters:
            names = {key for key, *_ in known.parameters}
            values = {key: value for key, value in values.items() if key in names}
        values |= self.parameters
        if known:
            _check_parameters(known, values)
        parameters = tuple(values.items())
        return Action(kind, name, _blocking(known), parameters)

    def _says(self, name: str) -> bool:
        return self.sheet is not None and name not in self.sheet.silent

    @property
    def _required(self) -> frozenset[str]:
        """The optional fields that it requires of nodes and edges, by the last part of each."""
        rows = self.sheet.parameters if self.sheet else ()
        required = [name for name, support, _ in rows if support == "REQUIRED"]
        return frozenset(name.rsplit(".", 1)[-1] for name in required if ".actions." not in name)

    def _at_nodes(self, kind: str) -> SupportedAction | None:
        """Returns an action at nodes as the factsheet has it; None if it says nothing of
        actions. Raises RefusedError if it has others alone."""
        actions = self.sheet.actions if self.sheet else ()
        if not actions:
            return None
        fit = [action for action in actions if action.type == kind and "NODE" in action.scopes]
        if not fit:
            raise RefusedError(f"its factsheet has no {kind} at nodes")
        return fit[0]


def _check_parameters(known: SupportedAction, values: Mapping[str, Any]) -> None:
    required = [key for key, _, is_optional, _ in known.parameters if not is_optional]
    lacking = [key for key in required if key not in values]
    if lacking:
        raise RefusedError(
            f"its factsheet requires {', '.join(lacking)} of each {known.type}: add it to"
            " action_parameters in the file of robots"
        )


def _blocking(known: SupportedAction | None) -> BlockingType:
    """Returns the blocking type to send: HARD where that is allowed or nothing is said."""
    allowed = known.blocking if known else ()
    return next((kind for kind in PREFERRED if kind in allowed), BlockingType.HARD)
