# SPDX-License-Identifier: Apache-2.0
"""Loads planners by name, and checks their plans before robots drive them.

A planner of your own is a class with two methods:

    class Mine:
        def start(self, floor, rules, seed): ...   # once
        def plan(self, fleet): ...                 # each tick: the cell that each robot enters next

`plan` gets a Fleet (numpy arrays, one element a robot) and returns the next cell of each robot, an
integer array: the cell it is in, or a neighbour. A robot that doesn't face its next cell turns
towards it, a quarter a tick, and stays in its cell meanwhile. It may return what each robot does
instead, (robots, ticks) of Action, as far ahead as it likes. A YAML file names the planner:

    planner: my_package.my_module:Mine      # Python
    planner: /path/to/libmine.so:Mine       # C++: a registered fleet::Planner
    planner: epibt                          # the built-in planner, the default
    planner: learned                        # a network and PIBT, see learned_planner
    options: {depth: 5}                     # for epibt, or for the Python class
"""

import importlib
import math
from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import yaml
from numpy.typing import ArrayLike, NDArray

from warehouse_fleet._core import Fleet, Planner, Rules, epibt, load_planner, validate
from warehouse_layout import Floor
from warehouse_layout.file import user_file

MANOEUVRE = 3  # ticks in which a robot reaches any neighbouring cell
# (4, MANOEUVRE) of Action: forward after `row` quarter turns, the shorter way round.
TURNS = np.array([[1, 0, 0], [2, 1, 0], [2, 2, 1], [3, 1, 0]], np.uint8)
ACTIONS = 4  # waits, forward, and turns both ways
NAMES = {"learned": "warehouse_fleet.planners.learned_planner:Learned"}
FREE = 0xFF  # in Fleet.committed: no commitment


class PlanRefusedError(Exception):
    """A plan can't be driven; the text names the robots."""


class PlannerError(Exception):
    """There is no such planner, or its options are wrong; the text says what was expected."""


class CellPlanner(Protocol):
    """A planner that answers with next cells: the methods of a planner class of your own."""

    def start(self, floor: Floor, rules: Rules, seed: int) -> None:
        """Prepares for planning on a floor; called once, before plan()."""
        ...

    def plan(self, fleet: Fleet) -> ArrayLike:
        """Returns the next cell of each robot, (robots,) of int, or the plan, (robots, ticks) of
        Action."""
        ...


class ActionPlanner(Protocol):
    """A planner that answers with actions."""

    def prepare(self, seconds: float = ...) -> None:
        """Makes what every plan needs, ahead of the first, in at most `seconds` by the clock."""
        ...

    def plan(self, fleet: Fleet, seconds: float, attempts: int) -> NDArray[np.uint8]:
        """Returns the plan, (robots, ticks) of Action.

        seconds: computing time of the calling thread for all of it [s], 0: that of the first plan;
        attempts: how often the planner may try to improve the first plan, -1: as often as
        `seconds` allow. With a number of attempts and 0 seconds plans are reproducible."""
        ...


class ValidatedPlanner:
    """A planner whose plans are validated before they are returned.

    `names`: of the robots, for messages; `ticks`: how many leading ticks of each plan are
    validated, -1: all.
    """

    def __init__(
        self,
        planner: ActionPlanner,
        floor: Floor,
        rules: Rules,
        names: Sequence[str] | None = None,
        ticks: int = -1,
    ) -> None:
        self.planner, self.floor, self.rules, self.names = planner, floor, rules, names or []
        self.ticks = ticks

    def prepare(self, seconds: float = math.inf) -> None:
        """Makes what every plan needs, ahead of the first, in at most `seconds` by the clock."""
        self.planner.prepare(seconds)

    def plan(self, fleet: Fleet, seconds: float = 0.0, attempts: int = -1) -> NDArray[np.uint8]:
        """Returns the plan, (robots, ticks) of Action; raises PlanRefusedError."""
        actions = self.planner.plan(fleet, seconds, attempts)
        violations = validate(self.floor, fleet, actions, self.rules, self.ticks)
        if violations:
            first = {
                tuple(violation.robots): violation for violation in reversed(violations)
            }  # one for the same robots
            texts = [v.describe(self.floor, self.names) for v in reversed(first.values())]
            raise PlanRefusedError("; ".join(texts[:5]))
        return actions


class PythonPlanner:
    """Makes an ActionPlanner of a CellPlanner."""

    def __init__(self, planner: CellPlanner, floor: Floor, rules: Rules, seed: int) -> None:
        self.planner, self.floor = planner, floor
        planner.start(floor, rules, seed)

    def prepare(self, seconds: float = math.inf) -> None:
        """Does nothing: there is no such method in a planner of cells."""

    def plan(self, fleet: Fleet, seconds: float = 0.0, attempts: int = -1) -> NDArray[np.uint8]:
        """Returns the plan, (robots, ticks) of Action; raises PlanRefusedError.

        A robot with committed actions performs them, whatever the planner answers for it; the cells
        of those actions are closed to all others. `seconds` and `attempts` have no effect."""
        committed = fleet.committed  # (robots, ticks); no ticks if no robot is committed
        kept = committed != FREE
        narrowed: Any = _Narrowed(fleet, _ahead(self.floor, fleet)) if kept.any() else fleet
        answer = np.asarray(self.planner.plan(narrowed))
        if answer.ndim == 2:
            actions = self._checked(answer, len(fleet))
        else:
            actions = np.where(kept.any(axis=1)[:, None], 0, self._towards(narrowed, answer))
        ticks = max(actions.shape[1], committed.shape[1])
        plan = np.zeros((len(fleet), ticks), np.uint8)
        plan[:, : actions.shape[1]] = actions
        plan[:, : committed.shape[1]][kept] = committed[kept]
        return plan

    def _checked(self, actions: NDArray[Any], robots: int) -> NDArray[np.uint8]:
        is_plan = len(actions) == robots and actions.dtype.kind in "iu" and actions.shape[1] > 0
        if not is_plan or not ((actions >= 0) & (actions < ACTIONS)).all():
            raise PlanRefusedError(
                f"the planner answered an array of {actions.dtype} with shape {actions.shape}; "
                f"a plan of Actions with shape ({robots}, ticks) was expected"
            )
        return actions.astype(np.uint8)

    def _towards(self, fleet: Fleet, cells: NDArray[Any]) -> NDArray[np.uint8]:
        if cells.shape != (len(fleet),) or cells.dtype.kind not in "iu":
            raise PlanRefusedError(
                f"the planner answered an array of {cells.dtype} with shape {cells.shape}; "
                f"integers with shape ({len(fleet)},), a next cell for each robot, were expected"
            )
        return actions_towards(self.floor, fleet, cells)


class _Narrowed:
    """A Fleet with more cells closed; `obstacles`: those of the fleet itself."""

    def __init__(self, fleet: Fleet, cells: NDArray[np.int32]) -> None:
        self._fleet, self.obstacles = fleet, fleet.closed
        self.closed = np.union1d(fleet.closed, cells)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._fleet, name)

    def __len__(self) -> int:
        return len(self._fleet)


def _ahead(floor: Floor, fleet: Fleet) -> NDArray[np.int32]:
    """Returns the cells that robots are committed to enter."""
    cell, heading = fleet.cell.copy(), fleet.heading.copy()
    step, cells = np.array([1, floor.width, -1, -floor.width]), []
    for actions in fleet.committed.T:
        cell = np.where(actions == 1, cell + step[heading], cell)
        heading = (heading + (actions == 2) - (actions == 3)) & 3
        cells.append(cell[actions == 1])
    return np.concatenate(cells)


def actions_towards(
    floor: Floor, fleet: Fleet, cells: NDArray[np.integer[Any]]
) -> NDArray[np.uint8]:
    """Returns the actions that bring each robot to its next cell, (robots, MANOEUVRE) of Action.
    cells: the next cells, (robots,).

    Raises PlanRefusedError for a cell that is neither the robot's own nor a neighbour of it."""
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


def make_planner(
    floor: Floor,
    rules: Rules,
    seed: int,
    spec: Mapping[str, Any] | None = None,
    names: Sequence[str] | None = None,
    ticks: int = -1,
) -> ValidatedPlanner:
    """Returns the planner that `spec` names; for `names` and `ticks` see ValidatedPlanner.
    spec: the content of a YAML file; None: epibt.

    Raises PlannerError."""
    spec = dict(spec or {})
    name, options = spec.pop("planner", "epibt"), spec.pop("options", None) or {}
    if spec:
        raise PlannerError(f"unknown key '{next(iter(spec))}'; planner, options were expected")
    planner = _started(str(name), options, floor, rules, seed)
    return ValidatedPlanner(planner, floor, rules, names, ticks)


def _started(
    name: str, options: dict[str, Any], floor: Floor, rules: Rules, seed: int
) -> ActionPlanner:
    if name == "epibt":
        return _built_in(options, floor, rules, seed)
    name = NAMES.get(name, name)
    source, colon, class_name = name.rpartition(":")
    if not colon:
        raise PlannerError(
            f"planner '{name}'; epibt, learned, MODULE:CLASS or LIBRARY.so:CLASS expected"
        )
    if source.endswith(".so"):
        return _from_library(source, class_name, floor, rules, seed)
    try:
        planner = getattr(importlib.import_module(source), class_name)
    except (ImportError, AttributeError) as error:
        raise PlannerError(f"planner '{name}': {error}") from error
    try:
        return PythonPlanner(planner(**options), floor, rules, seed)
    except (TypeError, ValueError) as error:
        raise PlannerError(f"planner '{name}': {error}") from error


def _built_in(options: dict[str, Any], floor: Floor, rules: Rules, seed: int) -> Planner:
    try:
        return epibt(floor, rules, seed, **options)
    except TypeError as error:
        raise PlannerError(f"epibt: {error}") from error


def _from_library(path: str, class_name: str, floor: Floor, rules: Rules, seed: int) -> Planner:
    try:
        return load_planner(path, class_name, floor, rules, seed)
    except RuntimeError as error:
        raise PlannerError(str(error)) from error


def read_spec(path: str | PathLike[str]) -> dict[str, Any]:
    """Returns the content of a YAML file that names a planner; raises PlannerError. An option
    `file`, if it is relative, is one beside it: nodes of ROS run in another folder."""
    try:
        spec = yaml.safe_load(user_file.read_text(path))
    except (OSError, yaml.YAMLError) as error:
        raise PlannerError(f"{path}: {error}") from error
    if not isinstance(spec, dict):
        raise PlannerError(f"{path}: a mapping with the key 'planner' was expected")
    options = spec.get("options")
    if isinstance(options, dict) and isinstance(options.get("file"), str):
        whole = Path(path).absolute().parent / Path(options["file"]).expanduser()
        spec["options"] = options | {"file": str(whole)}
    return spec
