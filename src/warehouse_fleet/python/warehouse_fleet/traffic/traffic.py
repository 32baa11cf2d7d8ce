# SPDX-License-Identifier: Apache-2.0
"""Drives a fleet over the floor: from the goal of each robot to paths that are released to it cell
by cell. Neither ROS nor physics: the host hands in what robots report, and sends the releases.

    traffic = Traffic(plan, kiva_ids)
    every 0.1 s of simulated time:
        traffic.update_robots(time, reports)      # (n,) of robot_table.REPORT
        traffic.robots.send(robot, cell)          # robots are indices into kiva_ids
        world.follow(*traffic.releases())         # the arrays of FleetFollow
"""

from typing import Any, NamedTuple

import numpy as np

from warehouse_fleet import Execution
from warehouse_fleet.planners.plan_loop import PlanLoop
from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_fleet.robots.robot_table import NOWHERE, Reports, RobotTable
from warehouse_fleet.traffic.closed_zones import ClosedZones
from warehouse_fleet.traffic.cut_off import CutOff
from warehouse_fleet.traffic.elevators import Elevators, Move
from warehouse_fleet.traffic.obstacles import ObstacleLog
from warehouse_fleet.traffic.people import zone_around
from warehouse_fleet.traffic.standing_robots import StandingRobots
from warehouse_fleet.traffic.station_ways import StationWays, short_cuts
from warehouse_fleet.traffic.watchdog import Watchdog
from warehouse_layout.floor.floor_edges import FloorEdges
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.floor.landings import Landings
from warehouse_layout.floor.plan_reader import is_taken
from warehouse_layout.message_enums import RobotMode, Status

MANUAL, OUT_OF_SERVICE, IDLE = (
    int(RobotMode.MANUAL),
    int(RobotMode.OUT_OF_SERVICE),
    int(Status.IDLE),
)
FOREIGN = 3  # reports after which a robot that is busy with something else is MANUAL
MAP_PERIOD = 1.0  # time between two reads of the world's map [s]
STANDS = 5.0  # after which the cause is looked up why a robot has no way [s]
STAYS = 2.5  # an obstacle is assumed to stay this long after it was seen [s]


class Releases(NamedTuple):
    """Paths, and the released part of each: the arrays of FleetFollow."""

    kiva_id: np.ndarray  # (m,) int32
    path_id: np.ndarray  # (m,) uint32
    first: np.ndarray  # (m,) uint32: the index on its path of the first point that is sent
    points: np.ndarray  # (m,) uint32: how many points are sent
    x: np.ndarray  # [m] in the frame world, of all points in a row
    y: np.ndarray  # [m]
    released: np.ndarray  # (m,) uint32: how many points of the path may be passed


class Traffic:
    """Execution of plans for the robots of a RobotTable, on the floor of a FloorPlan.

    `latency` [s] passes from a report until what is released for it has reached the robot. While
    the fleet `takes_over`, all robots are obstacles: paths that another coordinator sent them are
    not over yet. For `planner`, `lag` and `threads` see PlanLoop. Raises FloorError where robots
    could not come to an elevator of the floor, or past it.
    """

    def __init__(
        self,
        plan: FloorPlan,
        kiva_ids: np.ndarray,
        kinematics: Kinematics | None = None,
        seed: int = 1,
        planner: Any = None,
        *,
        latency: float = 0.25,
        attempts: int = 0,
        lag: float = 0.1,
        threads: int = 0,
    ) -> None:
        kinematics = kinematics or Kinematics()
        self.plan = plan
        landings = Landings(plan)
        landings.check()
        self.floor = plan.floor(lane=plan.lane | landings.lane)
        self.robots = RobotTable(kiva_ids)
        self.time = 0.0  # of the last reports [s]
        self.takes_over = False
        self._execution = Execution(
            self.floor,
            origin=plan.origin,
            spacing=plan.spacing,
            speed=kinematics.speed,
            acceleration=kinematics.acceleration,
            quarter=kinematics.quarter_turn,
            latency=latency,
        )
        self.elevators: Elevators | None = None
        if plan.elevators:
            self.elevators = Elevators(
                plan, landings, self.floor, self.robots, self._execution, kinematics
            )
        self.plans = PlanLoop(
            self.floor,
            self._execution,
            [f"kiva{kiva}" for kiva in self.robots.kiva_ids],
            tick=plan.spacing / kinematics.speed,
            lag=lag,
            seed=seed,
            planner=planner,
            attempts=attempts,
            threads=threads,
            # Tiers beside each other share regions, whose middles are on one of them only.
            whole_up_to=plan.passable.size if plan.elevators else 0,
        )
        self._settled = np.zeros(len(self.robots), bool)  # has been idle since this began
        self._foreign = np.zeros(len(self.robots), np.uint8)  # reports in a row
        self._dropped = np.zeros(len(self.robots), bool)  # on paths that were given up
        self._gave_up = np.zeros(len(self.robots), bool)  # found no way back, by the last reports
        self.watchdog = Watchdog(self.robots, np.asarray(plan.lane, bool).ravel(), self.all_ahead)
        self._after = np.full(plan.passable.size, NOWHERE, np.int32)  # next cell of a lane, by cell
        for station in plan.stations:
            self._after[station.cells[:-1]] = station.cells[1:]
        self._short_cuts = short_cuts(plan)
        self._ways = StationWays(plan)
        edges = FloorEdges(self.floor)
        self._cut_off = CutOff(edges)
        self._next_map = 0.0
        self.obstacles = ObstacleLog()
        self.people_zone = np.zeros(0, np.int32)  # cells where people are or are about to be
        self.zones = ClosedZones(plan, edges, self._execution.set_closed_zone)
        self.standing = StandingRobots(plan, edges, self.zones, self.robots, self._held)
        self._had_people = False
        self._fallen = 0  # items on the floor

    def close(self) -> None:
        """Ends the planner's thread."""
        self.plans.close()

    def is_stale(self, time: float) -> bool:
        """Returns whether a later report than one of that time [s] has been taken in."""
        return time < self.time

    def update_robots(self, time: float, reports: Reports) -> None:
        """Updates from the robots' reports at a time [s]: aligned, (n,) of REPORT."""
        robots, execution = self.robots, self._execution
        self.time = time
        robots.update_health(reports)
        execution.set_broken(robots.broken)
        execution.update(
            time,
            reports["x"],
            reports["y"],
            reports["yaw"],
            reports["vx"],
            reports["vy"],
            reports["status"],
            reports["state"],
            reports["path_id"],
            reports["reached"],
            reports["left"],
            # One that gave up begins afresh, even if it was set AUTOMATIC since.
            robots.automatic & (not self.takes_over) & ~self._gave_up,
            self._stay,
            robots.loaded,
        )
        states = execution.states()
        robots.cell, robots.stands, robots.stalled, robots.astray = states[:4]
        self._gave_up, robots.still_since, foreign, self._dropped = states[4:]
        robots.stalled_since = np.where(
            robots.stalled, np.minimum(robots.stalled_since, time), np.inf
        )
        robots.lost = (robots.lost & (robots.mode == OUT_OF_SERVICE)) | self._gave_up
        robots.lost &= ~robots.gone
        robots.mode[robots.lost] = OUT_OF_SERVICE
        self._find_foreign(reports, foreign)
        if self.elevators:
            robots.rides = self.elevators.waits
        self.watchdog.update(time)
        self.standing.update(time)

    def unwanted(self, reports: Reports) -> np.ndarray:
        """Returns (n,) bool: robots on paths that are to end. They have been on them since before
        this began, or the paths were given up, and copies came late."""
        inherited = ~self._settled & (reports["path_id"] != 0) & (reports["status"] != IDLE)
        return inherited | (self._dropped & self.robots.automatic)

    def _find_foreign(self, reports: Reports, foreign: np.ndarray) -> None:
        """Sets robots MANUAL that were idle and are busy with a person's command, or that a client
        drives by velocities."""
        robots = self.robots
        robots.mode[robots.steered & robots.automatic] = MANUAL
        foreign = foreign & self._settled & robots.automatic
        if not self.takes_over:
            self._settled |= reports["status"] == IDLE
        self._foreign = (self._foreign + 1) * foreign
        if foreign.any():
            robots.mode[self._foreign >= FOREIGN] = MANUAL

    def all_ahead(self) -> np.ndarray:
        """Returns, (n,), the robot that each robot waits for: by the plan, because it holds the
        next cell of the lane or the end of its short cut, or because it stands where this one has
        to go, or in the only way there; or NOWHERE."""
        robots = self.robots
        ahead = robots.waits_for.copy()
        after = np.where(robots.cell != NOWHERE, self._after[robots.cell], NOWHERE)
        asks = np.flatnonzero((ahead == NOWHERE) & ~robots.busy & (after != NOWHERE))
        by = self._execution.holders(after[asks])
        ahead[asks] = np.where(by != asks, by, NOWHERE)  # it may hold that cell itself
        self._look_at_short_cuts(ahead)
        closed = self._execution.closed()
        if len(closed):
            self._look_for_barring(ahead, closed)
            self._look_for_cutting(ahead, closed)
        return ahead

    def _look_at_short_cuts(self, ahead: np.ndarray) -> None:
        """Has robots without one `ahead` wait for that which holds the end of a short cut."""
        robots, (ends, goals) = self.robots, self._short_cuts
        ways = np.where(robots.cell != NOWHERE, ends[robots.cell], NOWHERE)
        wait = (ahead == NOWHERE) & ~robots.busy & (ways != NOWHERE)
        asks = np.flatnonzero(wait & (robots.goal == goals[robots.cell]))
        by = self._execution.holders(ways[asks])
        ahead[asks] = np.where(by != asks, by, NOWHERE)

    def _look_for_barring(self, ahead: np.ndarray, closed: np.ndarray) -> None:
        """Has robots without one `ahead` wait for that in a `closed` cell which bars their goal."""
        robots, cells = self.robots, closed.tolist()
        bars = {**dict(zip(cells, cells)), **self._ways.barring(set(cells))}  # by goal
        wait = (ahead == NOWHERE) & ~robots.busy & (robots.goal != robots.cell)
        wait = np.flatnonzero(wait & np.isin(robots.goal, list(bars)))
        by = self._execution.holders([bars[goal] for goal in robots.goal[wait].tolist()])
        ahead[wait] = np.where(by != wait, by, NOWHERE)

    def _look_for_cutting(self, ahead: np.ndarray, closed: np.ndarray) -> None:
        """Has robots that have stood a while without one `ahead` wait for the one in a `closed`
        cell that leaves them no way to their goal, as it does not drive."""
        robots, by = self.robots, self._execution.holders(closed)
        stays = (by != NOWHERE) & (robots.broken | ~robots.automatic)[by]
        if not stays.any():
            return
        self._cut_off.set_obstacles(closed[stays], self.plan.passable.size)
        goals = self._goals()
        wait = (ahead == NOWHERE) & robots.stands & ~robots.busy & (robots.cell != NOWHERE)
        wait &= (goals != NOWHERE) & (goals != robots.cell)
        wait &= self.time - robots.still_since > STANDS
        for robot in np.flatnonzero(wait).tolist():
            cell, goal = int(robots.cell[robot]), int(goals[robot])
            obstacles = self._cut_off.obstacles(cell, goal, bool(robots.loaded[robot]))
            if len(obstacles):
                ahead[robot] = self._execution.holder(int(obstacles[0]))

    def _goals(self) -> np.ndarray:
        """Returns (n,) the cells to which robots drive now: goals, or elevators on the way."""
        return self.elevators.goals() if self.elevators else self.robots.goal

    def _held(self) -> dict[int, int]:
        """Returns the robot by the cell that no other may enter, as this one stands there."""
        closed = self._execution.closed()
        by = self._execution.holders(closed)
        return dict(zip(closed[by != NOWHERE].tolist(), by[by != NOWHERE].tolist()))

    def holder(self, cell: int) -> int:
        """Returns the robot that a cell has been released to, or that stands there; or NOWHERE."""
        return self._execution.holder(int(cell))

    def arrived(self, among: np.ndarray) -> np.ndarray:
        """Returns the robots that stand at their goal, of those `among`, (n,) bool."""
        robots = self.robots
        there = robots.stands & ~robots.busy & (robots.cell == robots.goal)
        return (there & among).nonzero()[0]

    def shortest(self, begin: int, end: int, loaded: bool = False) -> int:
        """Returns the cells of the shortest path from `begin` to `end`; rides count none."""
        tier = self.plan.tier.flat
        if self.elevators and tier[begin] != tier[end]:
            return self.elevators.shortest(begin, end, loaded)
        return self.floor.shortest(begin, end, loaded=loaded)

    def on_refused(self, model: str) -> None:
        """Notes that a robot, by its model's name, has refused its path."""
        robot = self.robots.index(int(model.removeprefix("kiva")))
        if robot != NOWHERE:
            self._execution.refused(robot)

    def shut(self, cell: int, until: float) -> None:
        """Closes a cell for all robots until that time [s]."""
        self._execution.close(cell, until)
        self.obstacles.note(cell, self.time, until)

    @property
    def closed(self) -> np.ndarray:
        """The cells that no robot may enter now."""
        closed = self._execution.closed()
        return np.union1d(closed, self.zones.cells).astype(np.int32) if len(self.zones) else closed

    @property
    def is_cut(self) -> np.ndarray:
        """(cells,) bool: in closed zones, held by robots that stand there for long, or cut off by
        either."""
        return self.standing.is_cut

    @property
    def wants_map(self) -> bool:
        """Whether update_map() is due: only while something is in the way."""
        return self.time >= self._next_map and bool(self._execution.closing or self._fallen)

    def update_map(self, occupancy: np.ndarray | None) -> None:
        """Closes the cells where something stands, by the world's map (h, w) uint8, until the map
        shows them free. None: there is no map now."""
        self._next_map = self.time + MAP_PERIOD
        if occupancy is None or occupancy.shape != self.plan.shape:
            return
        for cell in np.flatnonzero(is_taken(occupancy) & self.plan.passable).tolist():
            self.shut(cell, self.time + STAYS)
            if self._fallen:  # too low for lasers
                self._execution.recall(cell)

    def update_fallen(self, count: int) -> None:
        """Notes how many items lie on the floor: while some do, the map is looked at."""
        if count != self._fallen:
            self._next_map = self.time
        self._fallen = count

    def update_people(self, people: Any) -> None:
        """Closes a zone around each person, and opens it behind; see `people`.

        Robots at its edge wait for them.
        """
        if not people.name and not self._had_people:
            return
        self._had_people = bool(people.name)
        self.people_zone = zone_around(self.plan, people)
        self._execution.set_zone(self.people_zone)
        edge = self.plan.beside(self.people_zone) if len(self.people_zone) else self.people_zone
        robots = self.robots
        robots.slowed_for_people = np.isin(robots.kiva_ids, [*people.slowed, *people.stopped])
        robots.slowed_for_people |= np.isin(robots.cell, edge)

    def set_units(self, cells: Any) -> None:
        """Closes cells for loaded robots: units stand there, off the storage places."""
        self._execution.set_units(np.asarray(cells, np.int32))

    @property
    def _stay(self) -> np.ndarray:
        """(n,) bool: robots that do not drive on now, as they are busy or ride."""
        busy = self.robots.busy
        return busy | self.elevators.busy if self.elevators else busy

    def take_moves(self) -> list[Move]:
        """Returns the robots that an elevator has brought to another tier: the host is to set them
        down there before the next report."""
        return self.elevators.take_moves() if self.elevators else []

    def journey(self, robot: int) -> tuple[float, float, int]:
        """Returns (seconds driven, seconds planned, cells) since the last call for that robot."""
        driven, planned, cells = self._execution.take_journey(robot)
        return driven, planned, cells

    @property
    def blocked(self) -> int:
        """How often a robot was BLOCKED before a cell of its own."""
        return self._execution.blocked

    def releases(self) -> Releases:
        """Returns the releases to send; adopts and begins plans that are due."""
        robots = self.robots
        if self.elevators:
            self.elevators.advance(self.time)
        self._execution.set_work(self._stay, robots.loaded)
        self.plans.adopt_due(self.time)
        index, path_id, first, points, cells, released = self._execution.release()
        robots.waits_for = self._execution.waits_for()
        self.plans.begin_due(self.time, self._goals(), robots.home)
        x, y = self.plan.point_of(cells)
        return Releases(robots.kiva_ids[index], path_id, first, points, x, y, released)

    def paths(self, robot: int) -> tuple[list[int], list[int]]:
        """Returns (the cells that a robot holds, the cells planned beyond)."""
        return self._execution.released(robot), self._execution.planned(robot)
