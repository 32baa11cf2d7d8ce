# SPDX-License-Identifier: Apache-2.0
"""A robot on paper: drives a cell a step, lifts in two, and hears as well as it is told to."""

from dataclasses import replace

from warehouse_vda5050.driver import Driver, Report
from warehouse_vda5050.grid import Grid
from warehouse_vda5050.model import (
    Action,
    BlockingType,
    Edge,
    Factsheet,
    InstantActions,
    Node,
    Position,
    VehicleOrder,
)
from warehouse_vda5050.vehicle import Vehicle, VehicleSettings

GRID = Grid(0.0, 0.0, 1.0, 10, 10, frozenset({(5, 5)}))


class GridRobot(Driver):
    """Begins at a cell. `units` maps an id to the cell it stands at; `events` tells what it did."""

    def __init__(self, cell=(0, 0), units=None):
        self.cell = cell
        self.units = dict(units or {})
        self.path, self.path_id, self.reached, self.released = [], 0, 0, 0
        self.busy, self.load, self.refusal = False, "", ""
        self.lifting = None
        self.stopped = self.cancelling = False
        self.deaf = False  # hears nothing
        self.extra = {}  # fields of Report
        self.taken = False
        self.events = []
        self.limits = {}  # speeds of the ways to points of the path, by number

    def follow(self, path_id, first, points, released):
        if self.deaf:
            return
        self.refusal = ""
        cells = [(round(x), round(y)) for x, y in points]
        if path_id == self.path_id and self.busy and first:
            if first > len(self.path):
                self.refusal = "the path has a gap"
            else:
                self.path[first:] = cells
        elif path_id == self.path_id and self.busy:
            return  # the same once more
        elif self.busy or first or cells[0] != self.cell:
            self.refusal = "not now"
        else:
            self.path, self.path_id, self.reached, self.busy = cells, path_id, 1, True
            self.limits = {}

    def lift(self, unit, up):
        if self.deaf:
            return
        self.refusal = ""
        if self.busy:
            self.refusal = "busy"
        elif up and (unit and self.units.get(unit) != self.cell):
            self.refusal = f"unit {unit} does not stand here"
        else:
            self.busy, self.lifting = True, [up, unit, 2]

    def cancel(self):
        if not self.deaf and self.busy:
            self.cancelling = True

    def stop(self, stopped):
        self.stopped = stopped

    def take(self):
        self.taken = True
        return ""

    def give_back(self):
        self.taken = False

    def is_taken(self):
        return self.taken

    def report(self):
        moving = self.busy and not self.lifting and not self.stopped
        status = Report(
            *map(float, self.cell),
            0.0,
            busy=self.busy,
            moving=moving,
            path_id=self.path_id,
            reached=self.reached,
            load=self.load,
            refusal=self.refusal,
        )
        return replace(status, **self.extra)

    def factsheet(self):
        return Factsheet()

    def step(self):
        """Goes on by a cell, or half a lift."""
        if not self.busy or self.stopped:
            return
        if self.lifting:
            self._lift()
        elif self.cancelling or self.reached == len(self.path):
            self.busy = self.cancelling = False
        else:
            self._drive()

    def _lift(self):
        self.lifting[2] -= 1
        if self.lifting[2]:
            return
        up, unit, _ = self.lifting
        at = next((u for u, c in self.units.items() if c == self.cell), "")
        self.events.append(("pick" if up else "drop", unit or at or self.load, self.cell))
        if up:
            self.load = unit or at
            self.units.pop(self.load, None)
        else:
            self.units[self.load], self.load = self.cell, ""
        self.busy, self.lifting, self.cancelling = False, None, False

    def _drive(self):
        goal = self.path[self.reached]
        dx = (goal[0] > self.cell[0]) - (goal[0] < self.cell[0])
        dy = (goal[1] > self.cell[1]) - (goal[1] < self.cell[1])
        self.cell = (self.cell[0] + dx, self.cell[1] + dy)
        if self.cell == goal:
            self.reached += 1
            self.events.append(("at", "", goal))


class LimitedRobot(GridRobot):
    """A GridRobot that keeps speed limits."""

    keeps_speeds = True

    def follow(self, path_id, first, points, released, speeds=()):
        super().follow(path_id, first, points, released)
        if not (self.deaf or self.refusal):
            self.limits.update(enumerate(speeds, first))


class Bench:
    """A vehicle with a GridRobot, and a clock of its own: a step is 1 s."""

    robot_type = GridRobot

    def __init__(self, cell=(0, 0), units=None, **settings):
        self.robot = self.robot_type(cell, units)
        self.vehicle = Vehicle(self.robot, GRID, VehicleSettings(**settings))
        self.now = 0.0
        self.states = []
        self.tick()

    @classmethod
    def of(cls, robot, **settings):
        """Returns the bench of a program that begins beside a robot which is there already."""
        bench = cls(robot.cell, **settings)
        bench.robot = robot
        bench.vehicle = Vehicle(robot, GRID, VehicleSettings(first_path=1000, **settings))
        bench.tick()
        return bench

    def tick(self, count=1):
        """Goes on by some seconds; returns the newest state."""
        for _ in range(count):
            self.robot.step()
            self.now += 1.0
            self.vehicle.update(self.now)
            state = self.vehicle.take_state(self.now)
            if state:
                self.states.append(state)
        return self.vehicle.state()

    def until(self, condition, seconds=200):
        """Goes on until condition(state); returns that state."""
        for _ in range(seconds):
            state = self.tick()
            if condition(state):
                return state
        raise AssertionError(f"still {self.vehicle.state()}")

    def order(self, *args, **kwargs):
        """Sends an order; returns whether it was accepted."""
        accepted = self.vehicle.on_order(order(*args, **kwargs), self.now)
        self.tick()
        return accepted

    def instant(self, type, id="i1", **parameters):
        """Sends an instant action; returns the state after a step."""
        action = Action(type, id, BlockingType.NONE, tuple(parameters.items()))
        self.vehicle.on_instant_actions(InstantActions((action,)), self.now)
        return self.tick()


def order(id, cells, released=None, update=0, first=0, actions=None, positions=True):
    """Returns an order through cells; `released` counts the nodes of its base, `first` is the
    number of its first node in the order, `actions` maps an index to actions."""
    released = len(cells) if released is None else released
    actions = actions or {}
    nodes = tuple(
        Node(
            f"c{x}_{y}",
            2 * (first + k),
            k < released,
            Position(float(x), float(y), None, "warehouse") if positions else None,
            tuple(actions.get(k, ())),
        )
        for k, (x, y) in enumerate(cells)
    )
    edges = tuple(
        Edge(f"e{2 * (first + k) + 1}", a.sequence + 1, b.released, a.id, b.id)
        for k, (a, b) in enumerate(zip(nodes, nodes[1:]))
    )
    return VehicleOrder(id, update, nodes, edges)


def pick(unit="7", id="p1"):
    """Returns the action that lifts a unit."""
    return Action("pick", id, BlockingType.HARD, (("loadId", unit), ("stationType", "place")))


def drop(id="d1"):
    """Returns the action that puts the unit down."""
    return Action("drop", id, BlockingType.HARD, (("stationType", "place"),))


def row(begin, end, y=0):
    """Returns the cells of a row from column `begin` to `end`, both included."""
    step = 1 if end >= begin else -1
    return [(x, y) for x in range(begin, end + step, step)]


def is_over(state):
    """Returns whether a state tells of no order under way."""
    over = all(action.status.is_over for action in state.actions)
    return not state.nodes and over and not state.driving
