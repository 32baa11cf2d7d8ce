# SPDX-License-Identifier: Apache-2.0
"""Drives a fleet over the floor: from where each robot is to go, to paths that are released to it
cell by cell. Neither ROS nor physics; whoever has robots tells what they report, and sends what is
released.

    traffic = Traffic(plan, kiva_ids)
    every 0.1 s of simulated time:
        traffic.observe(time, reports)            # x, y, yaw, …: the arrays of FleetState
        traffic.send(robot, cell)                 # robots are indices into kiva_ids
        world.follow(*traffic.releases())         # the arrays of FleetFollow
"""

import collections
import concurrent.futures
import time as clock
from enum import IntEnum
from types import SimpleNamespace

import numpy as np

from warehouse_fleet import Execution, Rules, epibt
from warehouse_fleet.failures import LIFTS_NOT, STANDS
from warehouse_fleet.kinematics import Kinematics
from warehouse_fleet.people import zone_around
from warehouse_fleet.planner_plugins import PlanRefusedError, make_planner
from warehouse_layout.floor_plan import is_taken

NOWHERE = -1
IDLE = 0  # KivaStatus.STATUS_IDLE
HORIZON = 7  # ticks
GUIDANCE = {  # measured
    "turn_ticks": 2,
    "crowd": 10,
    "resting": 8,
    "at_lanes": 1,
    "memory": 50,
    "patience": 15,
}
FOREIGN = 3  # reports after which a robot that is busy with something else is MANUAL
TRAPPED = 15.0  # without progress where something is in the way: others drive around it [s]
STUCK = 30.0  # without progress, after which the watchdog counts a robot [s]
WAITS = 5.0  # without progress, from when on it is looked at whom a robot waits for [s]
MOVES_UP = 10.0  # who has moved in a lane within this is about to be served, or leaves [s]
LOOK = 1.0  # between two looks at that map [s]
STAYS = 2.5  # for which what was seen is taken to stay [s]
REPORTED = (  # of FleetState, beside kiva_id
    *("x", "y", "yaw", "vx", "vy"),
    *("status", "state", "shelf_id", "path_id", "reached", "left"),
    *("failures", "charge"),
)


class Mode(IntEnum):
    """Who commands a robot."""

    AUTOMATIC = 0
    MANUAL = 1
    OUT_OF_SERVICE = 2


class Traffic:
    """Who is where, who goes where, and by which plan.

    Arrays with an element a robot: `goal`, `home` (cells), `loaded`, `busy` (it lifts, or is at
    work: it stays), `mode`, `gone` (it was deleted: its mode counts for nothing), `broken` (it
    stands, or is not heard) and `lifts_not`, by what it reports of itself, `minds` (it is slow, or
    waits, for people's sake). `planner` is what a YAML file says of one, see
    warehouse_fleet.planner_plugins; None: the one of the house. `latency` [s] passes from a report
    until what is released for it has reached the robot. While it `takes_over` all robots are
    obstacles: what others told them is not
    over yet. A plan is begun every tick on a thread of its own, and taken up `lag` seconds later,
    whenever it is ready: so a run does not depend on the machine.
    """

    def __init__(
        self,
        plan,
        kiva_ids,
        kinematics=None,
        seed=1,
        planner=None,
        *,
        latency=0.25,
        attempts=0,
        lag=0.1,
    ):
        self.plan, self.kiva_ids = plan, np.asarray(kiva_ids, np.int32)
        kinematics = kinematics or Kinematics()
        self.floor = plan.floor()
        # Whose turn it is to turn, Execution decides: robots turn when they may drive on.
        rules = Rules(turning=True)
        if planner is None:
            self.planner = epibt(self.floor, rules, seed, horizon=HORIZON, **GUIDANCE)
        else:
            names = [f"kiva{kiva}" for kiva in self.kiva_ids]
            self.planner = make_planner(self.floor, rules, seed, planner, names)
        self.refused_plans = 0
        self.alarm = ""  # why the last plan was refused
        self.attempts, self.lag = attempts, lag
        self.tick = plan.spacing / kinematics.speed
        count = len(self.kiva_ids)
        self.goal = np.full(count, NOWHERE, np.int32)
        self.home = np.full(count, NOWHERE, np.int32)
        self.loaded = np.zeros(count, bool)
        self.busy = np.zeros(count, bool)
        self.mode = np.zeros(count, np.uint8)
        self.gone = np.zeros(count, bool)
        self.failures = np.zeros(count, np.uint8)  # what is broken, as in FleetState
        self.charge = np.ones(count, np.float32)  # of batteries, 0…1
        self.broken = np.zeros(count, bool)
        self.lifts_not = np.zeros(count, bool)
        self.minds = np.zeros(count, bool)
        self.cell = np.full(count, NOWHERE, np.int32)  # where each stands, or stood last
        self.stands = np.zeros(count, bool)  # with nothing before it
        self.waits_for = np.full(count, NOWHERE, np.int32)  # a robot
        self.still_since = np.zeros(count)
        self.stalled = np.zeros(count, bool)  # does not drive although it may
        self.stalled_since = np.full(count, np.inf)  # [s]
        self.astray = np.zeros(count, bool)  # was pushed off the middle of its cell
        self.lost = np.zeros(count, bool)  # and did not find back: it is OUT_OF_SERVICE since then
        self.plan_seconds = collections.deque(maxlen=10000)  # computing time of the last plans
        self.watchdog = 0  # how often a robot made no progress for STUCK
        self.takes_over = False
        self._settled = np.zeros(count, bool)  # has been idle since this began
        self._foreign = np.zeros(count, np.uint8)  # reports in a row
        self._stuck = np.zeros(count, bool)
        self._excused = np.full(count, -np.inf)  # when it was seen to wait for work last [s]
        self.time = 0.0
        self._execution = Execution(
            self.floor,
            origin=plan.origin,
            spacing=plan.spacing,
            speed=kinematics.speed,
            acceleration=kinematics.acceleration,
            quarter=kinematics.quarter_turn,
            latency=latency,
        )
        self._after = {}  # the next cell of a lane, by cell
        for station in plan.stations:
            cells = station.cells.tolist()
            self._after.update(zip(cells, cells[1:]))
        self._thread = concurrent.futures.ThreadPoolExecutor(1, "planner")
        self._plan, self._due, self._next = None, 0.0, 0.0
        self._next_look = self._obstructed_until = 0.0
        self._units = np.zeros(0, np.int32)
        self._somebody = False  # was there when people were told last
        self._fallen = 0  # items on the floor

    def close(self):
        """Ends the planner's thread."""
        self._thread.shutdown()

    def is_stale(self, time):
        """Whether a report of that time was overtaken by another."""
        return time < self.time

    def aligned(self, report):
        """Returns the report with an element for each of `kiva_ids`. Robots that are gone stand
        nowhere and are OUT_OF_SERVICE; those that come back are in the mode that they report."""
        ids = np.asarray(report.kiva_id)
        if np.array_equal(ids, self.kiva_ids):
            gone = np.zeros(len(ids), bool)
        else:
            gone = ~np.isin(self.kiva_ids, ids)
            report = self._spread(report, ids, gone)
        back = self.gone & ~gone
        self.mode[gone] = Mode.OUT_OF_SERVICE
        self.mode[back] = np.asarray(getattr(report, "mode", np.zeros_like(self.mode)))[back]
        self.gone = gone
        return report

    def _spread(self, report, ids, gone):
        order = np.argsort(ids)
        at = order[np.searchsorted(ids[order], self.kiva_ids[~gone])]
        out = SimpleNamespace(kiva_id=self.kiva_ids)
        for name in (*REPORTED, "mode"):
            if not hasattr(report, name):
                continue  # a world in this process keeps no modes
            values = np.asarray(getattr(report, name))
            column = np.zeros(len(gone), values.dtype)
            column[~gone] = values[at]
            setattr(out, name, column)
        out.x[gone] = out.y[gone] = np.nan
        return out

    def observe(self, time, report):
        """Takes in what all robots report: an object with the arrays of FleetState."""
        self.time = time
        self.charge = np.array(report.charge)
        self._see_failures(np.asarray(report.failures))
        self._execution.observe(
            time,
            report.x,
            report.y,
            report.yaw,
            report.vx,
            report.vy,
            report.status,
            report.state,
            report.path_id,
            report.reached,
            report.left,
            (self.mode == Mode.AUTOMATIC) & (not self.takes_over),
            self.busy,
            self.loaded,
        )
        self.cell = self._execution.cell()
        self.stands = self._execution.stands()
        self.stalled = self._execution.stalled()
        self.stalled_since = np.where(self.stalled, np.minimum(self.stalled_since, time), np.inf)
        self.astray = self._execution.astray()
        self.lost = (self.lost & (self.mode == Mode.OUT_OF_SERVICE)) | self._execution.lost()
        self.lost &= ~self.gone
        self.mode[self.lost] = Mode.OUT_OF_SERVICE
        self.still_since = self._execution.still_since()
        self._find_foreign(report)
        self._watch()
        self._avoid_trapped()

    def _see_failures(self, failures):
        self.failures = failures
        self.broken = (failures & STANDS) != 0
        self.lifts_not = (failures & LIFTS_NOT) != 0
        self._execution.set_broken(self.broken)

    def inherited(self, report):
        """Which robots have been on paths since before this began, by what they report."""
        return ~self._settled & (report.path_id != 0) & (report.status != IDLE)

    def _find_foreign(self, report):
        """A robot that was idle and is busy with something else is commanded by a person."""
        foreign = self._execution.foreign() & self._settled & (self.mode == Mode.AUTOMATIC)
        if not self.takes_over:
            self._settled |= np.asarray(report.status) == IDLE
        self._foreign = np.where(foreign, self._foreign + 1, 0).astype(np.uint8)
        self.mode[self._foreign >= FOREIGN] = Mode.MANUAL

    def _watch(self):
        """Counts who makes no progress; waiting for who is at work in a station, or broken, is none
        of it."""
        self._excused[self.broken | self.minds] = self.time
        for robot in np.flatnonzero(self.stuck_for > WAITS):
            if self._waits_for_work(robot):
                self._excused[robot] = self.time
        stuck = self.stuck_for > STUCK
        self.watchdog += int(np.count_nonzero(stuck & ~self._stuck))
        self._stuck = stuck

    @property
    def stuck_for(self):
        """How long each has made no progress although it waits for nobody at work [s]; WAITS is
        the first moment at which that is looked at."""
        return self.time - np.maximum(self.still_since, self._excused)

    def _avoid_trapped(self):
        """Loaded robots can't turn back in a one-way street that ends before an obstacle. Whoever
        is to take that away comes another way."""
        if not len(self._units) and self.time > self._obstructed_until:
            return
        trapped = (self.time - self.still_since > TRAPPED) & ~self.stalled & ~self.busy
        trapped &= (self.mode == Mode.AUTOMATIC) & ~self.plan.lane.ravel()[self.cell]
        for cell in self.cell[trapped]:
            self._execution.close(int(cell), self.time + LOOK)

    def _waits_for_work(self, robot):
        seen = set()
        while robot != NOWHERE and robot not in seen:
            seen.add(robot)
            robot = self.ahead_of(robot)
            if robot != NOWHERE and (self.busy[robot] or self.mode[robot] != Mode.AUTOMATIC):
                return True
            if robot != NOWHERE and (self.broken[robot] or self.minds[robot]):
                return True
            if robot != NOWHERE and self._moves_up(robot):
                return True
        return False

    def _moves_up(self, robot):
        """Whether it has just moved in a lane, which all pass in their order."""
        in_lane = self.plan.lane.flat[self.cell[robot]]
        return in_lane and self.time - self.still_since[robot] < MOVES_UP

    def ahead_of(self, robot):
        """Whom it waits for: by the plan, or who holds the next cell of its lane; or NOWHERE."""
        ahead = int(self.waits_for[robot])
        if ahead != NOWHERE or self.busy[robot]:
            return ahead
        after = self._after.get(int(self.cell[robot]), NOWHERE)
        return self.holder(after) if after != NOWHERE else NOWHERE

    def holder(self, cell):
        """The robot that a cell has been released to, or that stands there; or NOWHERE."""
        return self._execution.holder(int(cell))

    @property
    def arrived(self):
        """Which robots stand where they were sent."""
        return np.flatnonzero(self.stands & ~self.busy & (self.cell == self.goal))

    def send(self, robot, cell, home=NOWHERE):
        """A robot is to go there; `home` is a storage place that it may enter with a load."""
        self.goal[robot], self.home[robot] = cell, home

    def index(self, kiva_id):
        """Which robot that is; NOWHERE if there is none."""
        return next(iter(np.flatnonzero(self.kiva_ids == kiva_id).tolist()), NOWHERE)

    def refused(self, model):
        """A robot, by its model's name, has refused its path."""
        robot = self.index(int(model.removeprefix("kiva")))
        if robot != NOWHERE:
            self._execution.refused(robot)

    def shut(self, cell, until):
        """Nobody may enter a cell for so long."""
        self._execution.close(cell, until)
        self._obstructed_until = max(self._obstructed_until, until)

    @property
    def closed(self):
        """Cells that nobody may enter now."""
        return self._execution.closed()

    @property
    def wants_map(self):
        """Whether to look what stands on the floor now: only while something is in the way."""
        if self.time < self._next_look or not (self._execution.closing or self._fallen):
            return False
        self._next_look = self.time + LOOK
        return True

    def see(self, cells):
        """What stands on the floor, (h, w) of the world's map: nobody may enter where something
        does, until it is seen no more."""
        cells = np.asarray(cells)
        if cells.shape == self.plan.shape:
            for cell in np.flatnonzero(is_taken(cells) & self.plan.passable).tolist():
                self.shut(cell, self.time + STAYS)
                if self._fallen:  # too low for lasers
                    self._execution.recall(cell)

    def see_fallen(self, count):
        """So many items lie on the floor: the cells where the map has them are closed while they
        do, from now on."""
        if count != self._fallen:
            self._next_look = self.time
        self._fallen = count

    def see_people(self, people):
        """Who walks on the floor, as warehouse_fleet.people has them: a zone is closed around each,
        and opened behind. Whoever stands at its edge waits for them."""
        if not people.name and not self._somebody:
            return
        self._somebody = bool(people.name)
        zone = zone_around(self.plan, people)
        self._execution.set_zone(zone)
        edge = self.plan.beside(zone) if len(zone) else zone
        self.minds = np.isin(self.kiva_ids, [*people.slowed, *people.stopped])
        self.minds |= np.isin(self.cell, edge)

    def set_units(self, cells):
        """Units stand in these cells beyond storage places: nobody passes there with a load."""
        self._units = np.asarray(cells, np.int32)
        self._execution.set_units(self._units)

    def journey(self, robot):
        """(seconds driven, seconds planned, cells) since the last call."""
        return self._execution.take_journey(robot)

    @property
    def blocked(self):
        """How often a robot was BLOCKED before a cell of its own."""
        return self._execution.blocked

    def releases(self):
        """What is to be sent now, as the arrays of FleetFollow: kiva_id, path_id, first, points, x,
        y, released. Plans as well, when it is time."""
        self._execution.set_work(self.busy, self.loaded)
        if self._plan is not None and self.time >= self._due - 1e-9:
            actions = self._take_plan()
            if actions is not None:
                self._execution.adopt(actions)
        robots, path_id, first, points, cells, released = self._execution.release()
        self.waits_for = self._execution.waits_for()
        if self._plan is None and self.time >= self._next - 1e-9:
            self._begin_plan()
        x, y = self.plan.point_of(cells)
        return self.kiva_ids[robots], path_id, first, points, x, y, released

    def _begin_plan(self):
        fleet = self._execution.fleet(self.goal, self.home, HORIZON)
        self._next = max(self._next + self.tick, self.time)
        if len(fleet):
            self._plan = self._thread.submit(self._think, fleet)
            self._due = self.time + self.lag

    def _think(self, fleet):
        begin = clock.thread_time()
        actions = self.planner.plan(fleet, attempts=self.attempts)
        self.plan_seconds.append(clock.thread_time() - begin)
        return actions

    def _take_plan(self):
        """The plan's actions; None if it was refused: robots go on with what they have then."""
        plan, self._plan = self._plan, None
        self.alarm = ""
        try:
            return plan.result()
        except PlanRefusedError as error:
            self.alarm = f"a plan was refused: {error}"
            self.refused_plans += 1
            return None

    def paths(self, robot):
        """(cells that it holds, cells planned beyond)."""
        return self._execution.released(robot), self._execution.planned(robot)
