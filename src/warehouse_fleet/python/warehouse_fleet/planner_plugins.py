# SPDX-License-Identifier: Apache-2.0
"""Planners of any origin, and the door at which their plans are checked before anybody drives.

A planner of your own is a class with two methods:

    class Mine:
        def start(self, floor, rules, seed): ...   # once
        def plan(self, fleet): ...                 # at each tick: the cell each robot goes to next

`plan` gets a Fleet (numpy arrays, one element a robot) and returns an integer array of the
robots' next cells: the one it is in, or a neighbour. A robot that doesn't face its next cell turns
towards it, a quarter a tick, and does not leave its cell meanwhile. A YAML file names it:

    planner: my_package.my_module:Mine      # Python
    planner: /path/to/libmine.so:Mine       # C++: a fleet::Planner, registered by ignition-plugin
    planner: epibt                          # the one of the house, which is the default
    options: {depth: 5}                     # for epibt, or for the Python class
"""

import importlib

import numpy as np
import yaml

from warehouse_fleet import _core

MANOEUVRE = 3  # ticks in which a robot comes to any neighbour
# Forward after so many quarter turns, by the shorter way.
TURNS = np.array([[1, 0, 0], [2, 1, 0], [2, 2, 1], [3, 1, 0]], np.uint8)
FREE = 0xFF  # in Fleet.committed: no commitment


class PlanRefusedError(Exception):
    """A plan that can't be driven; the text names the robots."""


class PlannerError(Exception):
    """There is no such planner; the text says what was expected."""


class Door:
    """A planner whose plans are checked before they are handed on: so many ticks, -1: all."""

    def __init__(self, planner, floor, rules, names=None, ticks=-1):
        self.planner, self.floor, self.rules, self.names = planner, floor, rules, names or []
        self.ticks = ticks

    def plan(self, fleet, seconds=0.0, attempts=-1):
        """The plan, (robots, ticks) of Action; raises PlanRefusedError."""
        actions = self.planner.plan(fleet, seconds, attempts)
        found = _core.validate(self.floor, fleet, actions, self.rules, self.ticks)
        if found:
            first = {tuple(one.robots): one for one in reversed(found)}  # of the same robots
            texts = [one.describe(self.floor, self.names) for one in reversed(first.values())]
            raise PlanRefusedError("; ".join(texts[:5]))
        return actions


class PythonPlanner:
    """A Python class that says next cells, as a planner that says actions."""

    def __init__(self, planner, floor, rules, seed):
        self.planner, self.floor = planner, floor
        planner.start(floor, rules, seed)

    def plan(self, fleet, seconds=0.0, attempts=-1):
        """Robots that can't take back what they do next keep to it, whatever the planner says; what
        is before them is closed to all others."""
        committed = fleet.committed  # (robots, ticks); no ticks if nobody is
        kept = committed != FREE
        if kept.any():
            fleet = _Narrowed(fleet, _ahead(self.floor, fleet))
        plan = np.zeros((len(fleet), max(MANOEUVRE, committed.shape[1])), np.uint8)
        plan[:, :MANOEUVRE] = np.where(kept.any(axis=1)[:, None], 0, self._ask(fleet))
        plan[:, : committed.shape[1]][kept] = committed[kept]
        return plan

    def _ask(self, fleet):
        cells = np.asarray(self.planner.plan(fleet))
        if cells.shape != (len(fleet),) or cells.dtype.kind not in "iu":
            raise PlanRefusedError(
                f"the planner answered an array of {cells.dtype} with shape {cells.shape}; "
                f"integers with shape ({len(fleet)},), a next cell for each robot, were expected"
            )
        return actions_towards(self.floor, fleet, cells)


class _Narrowed:
    """A Fleet with more cells closed."""

    def __init__(self, fleet, cells):
        self._fleet = fleet
        self.closed = np.union1d(fleet.closed, cells)

    def __getattr__(self, name):
        return getattr(self._fleet, name)

    def __len__(self):
        return len(self._fleet)


def _ahead(floor, fleet):
    """The cells that robots are committed to come to."""
    cell, heading = fleet.cell.copy(), fleet.heading.copy()
    step, cells = np.array([1, floor.width, -1, -floor.width]), []
    for actions in fleet.committed.T:
        cell = np.where(actions == 1, cell + step[heading], cell)
        heading = (heading + (actions == 2) - (actions == 3)) & 3
        cells.append(cell[actions == 1])
    return np.concatenate(cells)


def actions_towards(floor, fleet, cells):
    """(robots, MANOEUVRE) of Action: how each comes to its next cell; raises PlanRefusedError."""
    step = cells - fleet.cell
    directions = np.array([1, floor.width, -1, -floor.width])
    facing = step[:, None] == directions
    wraps = (facing[:, 0] & (fleet.cell % floor.width == floor.width - 1)) | (
        facing[:, 2] & (fleet.cell % floor.width == 0)
    )
    stays = step == 0
    wrong = np.flatnonzero(wraps | ~(facing.any(axis=1) | stays))
    if wrong.size:
        robot = wrong[0]
        raise PlanRefusedError(
            f"robot {robot} stands at {floor.name(fleet.cell[robot])} and is sent to "
            f"{floor.name(int(cells[robot]))}; that cell or a neighbour was expected"
        )
    quarters = (facing.argmax(axis=1) - fleet.heading) & 3
    return np.where(stays[:, None], 0, TURNS[quarters])


def make_planner(floor, rules, seed, spec=None, names=None, ticks=-1):
    """The planner that `spec` (the content of a YAML file, None: epibt) names, behind a Door."""
    spec = dict(spec or {})
    name, options = spec.pop("planner", "epibt"), spec.pop("options", None) or {}
    if spec:
        raise PlannerError(f"unknown key '{next(iter(spec))}'; planner, options were expected")
    planner = _started(str(name), options, floor, rules, seed)
    return Door(planner, floor, rules, names, ticks)


def _started(name, options, floor, rules, seed):
    if name == "epibt":
        try:
            return _core.epibt(floor, rules, seed, **options)
        except TypeError as error:
            raise PlannerError(f"epibt: {error}") from error
    source, colon, class_name = name.rpartition(":")
    if not colon:
        raise PlannerError(f"planner '{name}'; epibt, MODULE:CLASS or LIBRARY.so:CLASS expected")
    if source.endswith(".so"):
        try:
            return _core.load_planner(source, class_name, floor, rules, seed)
        except RuntimeError as error:
            raise PlannerError(str(error)) from error
    try:
        planner = getattr(importlib.import_module(source), class_name)
    except (ImportError, AttributeError) as error:
        raise PlannerError(f"planner '{name}': {error}") from error
    return PythonPlanner(planner(**options), floor, rules, seed)


def read_spec(path):
    """What a YAML file says about the planner; raises PlannerError."""
    try:
        with open(path, encoding="utf-8") as file:
            spec = yaml.safe_load(file)
    except (OSError, yaml.YAMLError) as error:
        raise PlannerError(f"{path}: {error}") from error
    if not isinstance(spec, dict):
        raise PlannerError(f"{path}: a mapping with the key 'planner' was expected")
    return spec
