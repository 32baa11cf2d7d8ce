# SPDX-License-Identifier: Apache-2.0
"""The task itself, in many warehouses at once: n worlds of equally many robots.

A unit that is requested is to be fetched from beneath, brought to a station (a picking station's
service cell) and then put back on any free storage place. Arrays have the leading dimensions
(n, robots). Everything is decided by what the physics says: where robots stand, what they carry.
"""

from enum import IntEnum

import numpy as np

from kiva_plugin_cpp import COMMAND, EventKind, Kind, Status
from warehouse_fleet.floor_plan import FloorPlan
from warehouse_learning import building
from warehouse_learning.goals import Goals
from warehouse_learning.grid import Grid

LONGEST_ACTION = 20.0  # a decision ends then, whatever robots are at [s]
LEFT, RIGHT = 1, -1
TOP_SPEED, WHEEL_RADIUS = 1.5, 0.1  # of the Kiva in worlds/models [m/s, m]
STANDS = 0.02  # and slower: it can lift [m/s]


class Action(IntEnum):
    """Of a robot; numbered as in RWARE."""

    WAIT = 0
    FORWARD = 1  # one cell
    LEFT = 2  # a quarter turn
    RIGHT = 3
    LIFT = 4  # lift the unit above, or put down the one that is carried


# Of commands, by action and heading.
KIND = np.full((5, 4), Kind.ROTATE)
KIND[Action.FORWARD] = [Kind.MOVE_X, Kind.MOVE_Y, Kind.MOVE_X, Kind.MOVE_Y]
KIND[Action.LIFT] = Kind.LIFT


class ActionError(ValueError):
    """Actions that are none; the message names the robot and what was expected."""


class Warehouses:
    """n warehouses of the same Options. `threads` as of kiva_plugin_cpp.Worlds."""

    def __init__(self, n, options, threads=0):
        self.n, self.options = n, options
        self.worlds, self._checkpoint = building.build(n, options, threads)
        plan = FloorPlan.of_world(self.worlds[0])
        self.grid = grid = Grid(plan, options.radius)
        if not len(grid.stations):
            raise ValueError("there is no picking station on this floor")
        self.robots, self.units = options.robots, options.shelves
        self._kiva_id = self.worlds[0].fleet.kiva_id
        units = self.worlds.storage_units[0]
        self._shelf_id = units["shelf_id"].copy()
        self._unit_of = np.full(self._shelf_id.max() + 1, -1, np.int32)
        self._unit_of[self._shelf_id] = np.arange(self.units)
        self._first_cells = grid.cell_of(units["x"], units["y"])
        self._w = np.arange(n)[:, None]  # rows, beside arrays of (n, robots)
        self._floor = grid.cells * self._w  # and where theirs begin in arrays of (n, cells)
        self._masks = None  # of now, once somebody has asked
        shape = (n, self.robots)
        self.cell = np.zeros(shape, np.int32)
        self.heading = np.zeros(shape, np.int8)
        self.busy = np.zeros(shape, bool)
        self.load = np.full(shape, -1, np.int32)  # index of the carried unit, -1 = none
        self.bound_for = np.zeros(shape, np.int32)  # cell that it drives to, else its own
        self.turning = np.zeros(shape, bool)
        self.unit_cell = np.zeros((n, self.units), np.int32)  # -1 = carried
        self.unit_at = np.zeros((n, grid.cells), np.int32)  # standing there, -1 = none
        self.requested = np.zeros((n, self.units), bool)
        self._served = np.zeros((n, self.units), bool)  # and not yet put back
        self.cycle = np.zeros(n, np.int64)
        self.delivered = np.zeros(shape, np.int64)  # in this episode
        self.goals = Goals(self)
        self._random = [None] * n
        self._limit = max(1, round(LONGEST_ACTION / options.physics_step))
        self._fixed = (
            0
            if options.decision == "action"
            else max(1, round(options.decision / options.physics_step))
        )
        seconds = 0 if not self._fixed else self._fixed * options.physics_step
        self.decision_seconds = seconds  # 0: as long as it takes
        self._rewards = options.rewards
        self._way_x = grid.spacing * np.array([1.0, 0.0, -1.0, 0.0])  # a cell, by heading [m]
        self._way_y = grid.spacing * np.array([0.0, 1.0, 0.0, -1.0])
        self.top_wheel_speed = TOP_SPEED / WHEEL_RADIUS  # [rad/s]

    # --- episodes

    def reset(self, which, seeds):
        """Begins new episodes in worlds `which`, (k,) indices, from k seeds."""
        which = np.asarray(which, np.int32)
        grid, robots = self.grid, self.robots
        self.worlds.restore(which, self._checkpoint)
        street = np.flatnonzero(grid.street)
        cells = np.empty((len(which), robots), np.int32)
        headings = np.empty((len(which), robots), np.int32)
        for i, (w, seed) in enumerate(zip(which.tolist(), seeds)):
            self._random[w] = random = np.random.default_rng(seed)
            cells[i] = random.choice(street, robots, replace=len(street) < robots)
            headings[i] = random.integers(4, size=robots)
            self.requested[w] = False
            asked = random.choice(self.units, self.options.requests, replace=False)
            self.requested[w, asked] = True
        x, y = grid.point_of(cells)
        # Nobody is put where somebody still stands: all leave first.
        ids = np.tile(self._kiva_id, (len(which), 1))
        rows = np.repeat(which, robots)
        self.worlds.place(rows, ids.ravel(), x.ravel(), y.ravel(), headings.ravel() * np.pi / 2)
        self.unit_cell[which] = self._first_cells
        self.unit_at[which] = -1
        self.unit_at[which[:, None], self._first_cells] = np.arange(self.units)
        self.cycle[which] = 0
        self.delivered[which] = 0
        self._served[which] = False
        self._see(which)
        self.bound_for[which] = self.cell[which]
        self.turning[which] = False
        self.goals.begin(which)

    # --- decisions

    def masks(self):
        """(n, robots, 5) bool, read-only: which actions are possible now."""
        if self._masks is None:
            self._masks = self._possible()
            self._masks.flags.writeable = False
        return self._masks

    def _possible(self):
        grid = self.grid
        out = np.empty((self.n, self.robots, 5), bool)
        free, loaded = ~self.busy, self.load >= 0
        ahead = self._ahead()
        open_ = grid.passable[ahead]
        if self.options.reserve:
            open_ &= ~self._held().take(self._floor + ahead)
        open_ &= ~(loaded & self._has_unit(ahead))
        out[..., Action.WAIT] = True
        out[..., Action.FORWARD] = free & open_
        out[..., Action.LEFT] = out[..., Action.RIGHT] = free
        out[..., Action.LIFT] = free & self._may_lift()
        return out

    def check(self, actions):
        """(n, robots) of Action as they are, or ActionError; of wheels, (n, robots, 3)."""
        given = np.asarray(actions)
        if self.options.continuous:
            return self._check_wheels(given)
        if given.shape != (self.n, self.robots):
            raise ActionError(
                f"actions: shape {(self.n, self.robots)} was expected, one for each robot of each"
                f" world, not {given.shape}"
            )
        if given.dtype.kind not in "iu":
            whole = given.dtype.kind == "f" and np.isfinite(given).all()
            if not whole or (given != np.rint(given)).any():
                raise ActionError(self._complaint(given, ~np.equal(given, np.rint(given))))
        bad = (given < 0) | (given > 4)
        if bad.any():
            raise ActionError(self._complaint(given, bad))
        return given.astype(np.int8)

    def _check_wheels(self, given):
        if given.shape != (self.n, self.robots, 3) or given.dtype.kind not in "iuf":
            raise ActionError(
                f"actions: numbers of shape {(self.n, self.robots, 3)} were expected, left wheel,"
                f" right wheel and lift, not {given.dtype} of shape {given.shape}"
            )
        bad = ~(np.isfinite(given) & (np.abs(given) <= 1)).all(-1)
        if bad.any():
            raise ActionError(self._complaint(given, bad, "three numbers from -1 to 1"))
        return given.astype(float)

    def _complaint(self, given, bad, expected="a whole number from 0 to 4"):
        w, robot = np.argwhere(bad)[0]
        return (
            f"robot_{robot + 1} of world {w}: action {given[w, robot]!r}; {expected} was expected"
        )

    def step(self, actions):
        """One decision of every robot. Returns rewards (n, robots) and what happened by robot:
        {name: (n, robots)}. ActionError if an action is none."""
        actions = self.check(actions)
        done = (self._begin_wheels if self.options.continuous else self._begin)(actions)
        load, goal = self.load.copy(), self.goals.cell.copy()
        before = self.goals.distance() if self._rewards["approached"] else 0
        if self._fixed:
            self.worlds.step(self._fixed)
        else:
            self.worlds.step(self._limit, until_idle=True)
        self._see(slice(None))
        self.cycle += 1
        counts = self.worlds.counts
        collided = counts[..., EventKind.COLLISION] > 0
        if collided.any():
            self._look_at_units(np.flatnonzero(collided.any(1)))
        happened = self._tasks(load)
        happened["refused"] = ~done & ~self.busy | (counts[..., EventKind.REFUSED] > 0)
        happened["collided"] = collided
        self.goals.renew()
        rewards = self._reward(happened)
        if self._rewards["approached"]:
            nearer = np.where(goal == self.goals.cell, before - self.goals.distance(), 0)
            rewards += np.float32(self._rewards["approached"]) * nearer
        return rewards, happened

    def _reward(self, happened):
        rewards = np.full((self.n, self.robots), self._rewards["step"], np.float32)
        for name, events in happened.items():
            if self._rewards[name]:
                rewards += np.float32(self._rewards[name]) * events
        return rewards

    def _ahead(self):
        return self.cell + self.grid.steps[self.heading]

    def _held(self):
        """(n * cells,) bool: where a robot stands or goes."""
        out = np.zeros(self.n * self.grid.cells, bool)
        out[self._floor + self.cell] = True
        out[self._floor + self.bound_for] = True
        return out

    def _has_unit(self, cells):
        """(n, robots) bool: whether a unit stands in those cells."""
        return self.unit_at.take(self._floor + cells) >= 0

    def _may_lift(self):
        """(n, robots) bool: whether it stands where it can lift or put down."""
        return np.where(self.load < 0, self._has_unit(self.cell), self.grid.storage[self.cell])

    def _begin(self, actions):
        """Posts what is possible; returns who does what it was told, (n, robots) bool."""
        each = 5 * np.arange(self.n * self.robots).reshape(actions.shape)
        possible = self.masks().take(each + actions)
        forward = possible & (actions == Action.FORWARD)
        ahead = self._ahead()
        if self.options.reserve:
            # Of several that want into one cell, the first goes.
            target = self._floor + np.where(forward, ahead, 0)
            first = np.empty(self.n * self.grid.cells, np.int32)
            first[target[:, ::-1]] = np.arange(self.robots)[::-1]
            forward &= first.take(target) == np.arange(self.robots)
        turn = possible & ((actions == Action.LEFT) | (actions == Action.RIGHT))
        turn &= ~self._beside_a_turn(turn)
        lift = possible & (actions == Action.LIFT)
        self.bound_for = np.where(forward, ahead, np.where(self.busy, self.bound_for, self.cell))
        self.turning = turn | (self.turning & self.busy)
        self._post(forward, turn, lift, actions)
        return forward | turn | lift | (actions == Action.WAIT)

    def _begin_wheels(self, actions):
        """The same of wheel speeds; a robot that is to lift or put down stops for it."""
        standing = np.hypot(self.worlds.vx, self.worlds.vy) < STANDS
        loaded = self.load >= 0
        up = (actions[..., 2] > 0.5) & ~loaded
        down = (actions[..., 2] < -0.5) & loaded
        wants = (up | down) & ~self.busy
        speeds = np.where(wants[..., None], 0, actions[..., :2]) * self.top_wheel_speed
        self.worlds.drive(speeds[..., 0], speeds[..., 1])
        lift = wants & self._may_lift() & standing
        none = np.zeros_like(lift)
        self.bound_for = self.cell
        self._post(none, none, lift, np.where(lift, Action.LIFT, Action.WAIT))
        return lift | ~wants | ~standing

    def _beside_a_turn(self, turn):
        """Who must not turn now: one that turns sweeps beyond its cell, and two side by side
        would touch. The first of them may."""
        rank = np.where(turn, np.arange(self.robots), self.robots)
        rank[self.turning & self.busy] = -1
        who = np.full(self.n * self.grid.cells, self.robots, np.int32)
        here = self._floor + self.cell
        who[here] = rank
        first = np.minimum.reduce([who.take(here + step) for step in self.grid.steps.tolist()])
        return turn & (first < np.arange(self.robots))

    def _post(self, forward, turn, lift, actions):
        w, robot = np.nonzero(forward | turn | lift)
        if not len(w):
            return
        rows = np.zeros(len(w), COMMAND)
        rows["kiva_id"] = self._kiva_id[robot]
        heading, action, load = self.heading[w, robot], actions[w, robot], self.load[w, robot]
        lifts = action == Action.LIFT
        rows["kind"] = KIND[action, heading]
        drives = action == Action.FORWARD
        rows["x"] = drives * self._way_x[heading]
        rows["y"] = drives * self._way_y[heading]
        rows["direction"] = np.where(action == Action.LEFT, LEFT, RIGHT)
        rows["lift"] = lifts & (load < 0)
        unit = np.where(load < 0, self.unit_at[w, self.cell[w, robot]], load)
        rows["shelf_id"] = np.where(lifts, self._shelf_id[unit], 0)
        self.worlds.post(w.astype(np.int32), rows)

    # --- what came of it

    def _see(self, which):
        """Takes in where robots are and what they carry."""
        worlds = self.worlds
        self.cell[which], self.heading[which] = self.grid.locate(
            worlds.x[which], worlds.y[which], worlds.yaw[which]
        )
        self.busy[which] = worlds.status[which] != Status.IDLE
        shelf = worlds.shelf_id[which]
        self.load[which] = self._unit_of[shelf]  # of 0: none
        self._masks = None

    def _look_at_units(self, worlds):
        """Where units stand after a collision, which may have pushed some."""
        for w in worlds:
            rows = self.worlds[int(w)].storage_units
            cells = self.grid.cell_of(rows["x"], rows["y"])
            self.unit_cell[w] = np.where(rows["kiva_id"] > 0, -1, cells)
            standing = self.unit_cell[w] >= 0
            self.unit_at[w] = -1
            self.unit_at[w, cells[standing]] = np.flatnonzero(standing)
            self.goals.changed(w)

    def _tasks(self, load):
        """Lifts, deliveries, returns, by what robots carried before."""
        shape = (self.n, self.robots)
        lifted, dropped, stored, delivered = (np.zeros(shape, bool) for _ in range(4))
        for w, robot in np.argwhere(self.load != load):
            unit = self.load[w, robot]
            cell = self.cell[w, robot]
            if unit >= 0:
                self.unit_cell[w, unit] = self.unit_at[w, cell] = -1
                lifted[w, robot] = self.requested[w, unit]
            else:
                unit = load[w, robot]
                self.unit_cell[w, unit], self.unit_at[w, cell] = cell, unit
                dropped[w, robot] = self.requested[w, unit]
                stored[w, robot] = self._served[w, unit]
                self._served[w, unit] = False
            self.goals.end(w, robot)
        there = self.grid.is_station[self.cell] & (self.load >= 0) & ~self.busy
        for w, robot in np.argwhere(there):
            unit = self.load[w, robot]
            if self.requested[w, unit]:
                delivered[w, robot] = self._served[w, unit] = True
                self.delivered[w, robot] += 1
                self._ask_for_another(w, unit)
                self.goals.end(w, robot)
        return {"delivered": delivered, "lifted": lifted, "dropped": dropped, "stored": stored}

    def _ask_for_another(self, w, unit):
        others = ~self.requested[w]
        others[unit] = False
        self.requested[w, self._random[w].choice(np.flatnonzero(others))] = True
        self.requested[w, unit] = False
