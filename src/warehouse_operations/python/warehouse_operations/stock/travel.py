# SPDX-License-Identifier: Apache-2.0
"""Travel times of robots without traffic, in closed form on a floor plan.

A run of n cells takes n * spacing / speed plus one start and stop (speed / acceleration); a quarter
turn takes its time, and a start and stop more. Between tiers, ways have rides of elevators
(floor/rides.py). And the lead times of stations, as they were.
"""

import math
from collections import OrderedDict
from collections.abc import Callable, Iterator
from typing import TypeVar

import numpy as np

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_layout._core import routes, ways
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.floor.rides import Chains, JoinedTable, Leg, Option, Ride, rides_of
from warehouse_layout.floor.way_graph import WayGraph, lanes_of

HEADINGS = 4
TABLES = 400  # most tables kept; the least recently used is dropped
PLACE_TABLES = 4000  # most tables of storage places: a floor of 50,000 cells has a thousand
# By how much longer policies take a way with rides to be [s]: more than any drive, so that robots
# and units change tiers only where nothing else is left, as by RAWSim-O's default.
CHANGE = 1000.0

_Key = TypeVar("_Key")
_Value = TypeVar("_Value")


class Table:
    """Routes from one cell to all others, or back: time [s] and length [m] by cell; or inf."""

    def __init__(
        self, seconds: np.ndarray, metres: np.ndarray, cells: np.ndarray, heading: np.ndarray
    ) -> None:
        self.seconds, self.metres = seconds, metres
        self._cells, self._heading = cells, heading

    @property
    def distance(self) -> np.ndarray:
        """What policies compare: metres; a way with rides counts as much longer."""
        return self.metres

    def cells(self, cell: int) -> list[int]:
        """Returns the cells of the route between the table's cell and another, both included."""
        node, way = cell * HEADINGS + self._heading[cell], [cell]
        while (node := self._cells[node]) >= 0:
            if node // HEADINGS != way[-1]:
                way.append(node // HEADINGS)
        return way

    def options(self, cell: int) -> Iterator[Option]:
        """Yields the ways to or from a cell with one ride: none."""
        yield from ()

    def runs(self, cell: int, via: Ride | None = None) -> list[list[int]]:
        """Returns the cells of each drive between rides; here of one."""
        return [self.cells(cell)]

    def legs(self, cell: int, own: int, via: Ride | None = None) -> list[Leg]:
        """Returns the drives and rides of the route between the table's own cell and another; here
        the one drive."""
        return [Leg(float(self.seconds[cell]), float(self.metres[cell]), own)]


class Travel:
    """Times and lengths of routes on a FloorPlan."""

    def __init__(self, plan: FloorPlan, kinematics: Kinematics) -> None:
        self.plan, self.kinematics = plan, kinematics
        self.width = plan.passable.shape[1]
        # Storage places are ends of ways, never inside one.
        self._ends = np.asarray(plan.storage | plan.parking, np.uint8).ravel()
        steps, self._lane_of = _steps(plan, self._ends.astype(bool)), lanes_of(plan)
        self._forward, self._backward = (WayGraph(each, self._lane_of) for each in steps)
        self._tables: OrderedDict[tuple[int, bool], Table | JoinedTable] = OrderedDict()
        self._rides = rides_of(plan.elevators)
        self._of_landings: dict[tuple[int, bool], Table] = {}
        self._places = np.flatnonzero(plan.storage)
        self._place = np.full(plan.passable.size, -1, np.int32)  # index into them, by cell
        self._place[self._places] = np.arange(len(self._places))
        self._numbered = _Numbered(plan, self._ends, steps, self._lane_of, self._places)
        self._of_places: OrderedDict[tuple[int, bool], tuple[np.ndarray, np.ndarray]] = (
            OrderedDict()
        )
        turn = kinematics.quarter_turn + kinematics.start_stop
        self._costs = plan.spacing / kinematics.speed, turn  # of a step, of a quarter [s]
        tier = plan.tier.ravel() if self._rides else np.zeros(0, int)
        self._chains = Chains(self._rides, tier, self._along_axes) if self._rides else None

    def loaded_from(self, cell: int) -> Table | JoinedTable:
        """Returns the routes of a loaded robot from a cell to all others."""
        return self._table(int(cell), True)

    def loaded_to(self, cell: int) -> Table | JoinedTable:
        """Returns the routes of a loaded robot to a cell from all others."""
        return self._table(int(cell), False)

    def metres_to_places(self, cell: int, places: np.ndarray) -> np.ndarray:
        """Returns the distances of a loaded robot from a cell to storage places, (n,) [m]; those of
        other tiers are much farther."""
        seconds, steps = self._of_storage(int(cell), True)
        of = self._place[places]
        return np.where(np.isfinite(seconds[of]), steps[of] * self.plan.spacing, np.inf)

    def seconds_from_all(self, starts: np.ndarray, cell: int) -> np.ndarray:
        """Returns the times of a loaded robot to a cell from others, most often storage places,
        (n,) [s]; undefined without a way."""
        places = self._place[starts]
        seconds = self._of_storage(cell, False)[0][places]
        if (off := (places < 0) & (starts >= 0)).any():
            seconds[off] = self.loaded_to(cell).seconds[starts[off]]
        return seconds

    def _of_storage(self, cell: int, forward: bool) -> tuple[np.ndarray, np.ndarray]:
        """Returns (seconds, steps) of the ways to or from storage places, (n,) each: at most a
        seventh of the cells."""
        key = cell, forward
        return _remembered(self._of_places, PLACE_TABLES, key, lambda: self._ways(cell, forward))

    def _ways(self, cell: int, forward: bool) -> tuple[np.ndarray, np.ndarray]:
        if self._rides:
            table = self._table(cell, forward)
            steps = table.distance[self._places] / self.plan.spacing
            return table.seconds[self._places], steps
        seconds, steps = self._numbered.ways(cell, forward, *self._costs)
        return np.where(self._places == cell, 0.0, self._from_standstill(seconds)), steps

    def _from_standstill(self, seconds: np.ndarray) -> np.ndarray:
        """Adds the start and stop of the first run, and the turn into it."""
        return seconds + self.kinematics.start_stop + self.kinematics.quarter_turn

    def unloaded(self, cells: np.ndarray, to: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Returns time [s] and length [m] for robots without a load, which drive under the units.

        cells: (n,); to: (m,); both results: (n, m).
        """
        cells, to = np.asarray(cells), np.asarray(to)
        if self._chains:
            return self._chains.joined(cells, to)
        return self._along_axes(cells[:, None], to[None, :])

    def unloaded_options(self, cell: int, to: int) -> Iterator[Option]:
        """Yields the ways of an unloaded robot between two cells with one ride, if they are on two
        tiers."""
        if self._chains:
            yield from self._chains.options(cell, to)

    def unloaded_legs(self, cell: int, to: int, via: Ride | None = None) -> list[Leg]:
        """Returns the drives and rides of unloaded() between two cells; via: the only ride."""
        if self._chains:
            return self._chains.legs(cell, to, via)
        seconds, metres = self._along_axes(np.array(cell), np.array(to))
        return [Leg(float(seconds), float(metres), to)]

    def apart(self, cell: int, cells: np.ndarray) -> np.ndarray:
        """Returns the metres along the axes between a cell and others, (n,); much more to those of
        another tier."""
        dx, dy = cells % self.width - cell % self.width, cells // self.width - cell // self.width
        metres = (np.abs(dx) + np.abs(dy)) * self.plan.spacing
        return metres + self.changes(np.array(cell), cells) * self.kinematics.speed

    def changes(self, cells: np.ndarray, to: np.ndarray) -> np.ndarray:
        """Returns by how much longer policies take ways between cells to be [s]: CHANGE from one
        tier to another, else 0."""
        if not self._chains:
            return np.zeros(np.broadcast_shapes(cells.shape, to.shape))
        tier = self.plan.tier.ravel()
        return np.where(tier[cells] != tier[to], CHANGE, 0.0)

    def _along_axes(self, cells: np.ndarray, to: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Returns time [s] and length [m] of drives along both axes."""
        dx = np.abs(cells % self.width - to % self.width) * self.plan.spacing
        dy = np.abs(cells // self.width - to // self.width) * self.plan.spacing
        turns = 1.0 * ((dx > 0) | (dy > 0)) + ((dx > 0) & (dy > 0))  # to start, and at the corner
        run = self.kinematics.run
        return run(dx) + run(dy) + turns * self.kinematics.quarter_turn, dx + dy

    def _table(self, cell: int, forward: bool) -> Table | JoinedTable:
        key = cell, forward
        return _remembered(self._tables, TABLES, key, lambda: self._joined(cell, forward))

    def _joined(self, cell: int, forward: bool) -> Table | JoinedTable:
        table = self._search(cell, forward)
        if not self._rides:
            return table
        change = CHANGE * self.kinematics.speed
        return JoinedTable(
            table, self._rides, lambda landing: self._of_landing(landing, forward), forward, change
        )

    def _of_landing(self, cell: int, forward: bool) -> Table:
        """Returns the routes from a cell of an elevator to all others, or back, without rides."""
        key = cell, forward
        if key not in self._of_landings:
            self._of_landings[key] = self._search(cell, forward)
        return self._of_landings[key]

    def _search(self, cell: int, forward: bool) -> Table:
        graph = self._forward if forward else self._backward
        with graph.open(self._lane_of[cell]) as following:
            seconds, steps, before = routes(following, self._ends, cell, *self._costs)
        heading = np.argmin(seconds.reshape(-1, HEADINGS), axis=1)
        nodes = np.arange(len(heading)) * HEADINGS + heading
        seconds = self._from_standstill(seconds[nodes])
        seconds[cell] = 0.0
        metres = np.where(np.isfinite(seconds), steps[nodes] * self.plan.spacing, np.inf)
        return Table(seconds, metres, before, heading)


class _Numbered:
    """The graph of the passable cells, numbered consecutively: around a hole, they may be half of a
    floor."""

    def __init__(
        self,
        plan: FloorPlan,
        ends: np.ndarray,
        graphs: tuple[np.ndarray, np.ndarray],
        lane_of: np.ndarray,
        places: np.ndarray,
    ) -> None:
        cells = np.flatnonzero(plan.passable)
        self._number = np.full(plan.passable.size + 1, -1, np.int32)  # by cell; of -1: -1
        self._number[cells] = np.arange(len(cells), dtype=np.int32)
        self._ends, self._places, self._lane_of = ends[cells], self._number[places], lane_of
        self._forward, self._backward = (
            WayGraph(self._number[graph[cells]], lane_of[cells]) for graph in graphs
        )

    def ways(
        self, cell: int, forward: bool, step: float, turn: float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Returns (seconds, steps) of the ways from a cell to all storage places, or back."""
        graph, number = self._forward if forward else self._backward, int(self._number[cell])
        with graph.open(self._lane_of[cell]) as following:
            return ways(following, self._ends, number, step, turn, self._places)


def _remembered(
    known: OrderedDict[_Key, _Value], most: int, key: _Key, make: Callable[[], _Value]
) -> _Value:
    """Returns the value of a key, which it makes if unknown; drops the least recently used."""
    if key in known:
        known.move_to_end(key)
        return known[key]
    value = known[key] = make()
    if len(known) > most:
        known.popitem(last=False)
    return value


def _steps(plan: FloorPlan, keep_out: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns (next, before), (cells, 4) int32 each, by cell and heading: the cell to which a
    loaded robot may step, and the cell from which it may come; or -1."""
    following = np.asarray(plan.floor().edges(False)).reshape(-1, HEADINGS)
    lane = np.asarray(plan.lane, bool).ravel()
    cells, headings = np.nonzero(following >= 0)
    to = following[cells, headings]
    allowed = ~(keep_out[cells] & (keep_out[to] | lane[to])) & ~(lane[cells] & keep_out[to])
    cells, headings, to = cells[allowed], headings[allowed], to[allowed]
    out = np.full((2, *following.shape), -1, np.int32)
    out[0, cells, headings] = to
    out[1, to, headings] = cells
    return out[0], out[1]


class LeadTime:
    """The lead time of a station's units as it was lately [s]: a smoothed mean, and its smoothed
    mean deviation, with the gains of RFC 6298 (Jacobson, SIGCOMM 1988). Infinite until the first
    unit was lifted."""

    GAIN, GAIN_OF_DEVIATION = 1 / 8, 1 / 4

    def __init__(self) -> None:
        self.mean = self.deviation = math.inf

    def note(self, seconds: float) -> None:
        """Takes a unit's lead time into account [s]."""
        if math.isinf(self.mean):
            self.mean, self.deviation = seconds, seconds / 2
            return
        self.deviation += self.GAIN_OF_DEVIATION * (abs(seconds - self.mean) - self.deviation)
        self.mean += self.GAIN * (seconds - self.mean)

    @property
    def horizon(self) -> float:
        """How long before it is needed a unit has to be asked for [s]: most are in time then."""
        return self.mean + self.deviation
