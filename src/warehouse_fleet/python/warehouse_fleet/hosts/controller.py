# SPDX-License-Identifier: Apache-2.0
"""Controls a fleet: makes a Decision from each Observation.

    controller = FleetController(plan, kiva_ids)
    controller.transports.submit(17, "pick3")
    every 0.1 s of simulated time:
        decision = controller.tick(Observation(time, reports, ...))

The host translates and decides nothing: the coordinator between messages and these, FleetDriver
between a world in this process and these.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from warehouse_fleet.robots.kinematics import Kinematics
from warehouse_fleet.robots.robot_table import NOWHERE, Reports
from warehouse_fleet.traffic.closed_zones import ClosedZone
from warehouse_fleet.traffic.elevators import Move
from warehouse_fleet.traffic.people import NO_PEOPLE
from warehouse_fleet.traffic.takeover import Handover, Takeover
from warehouse_fleet.traffic.traffic import STAYS, Releases, Traffic
from warehouse_fleet.transports.towing import Towing, TowingService, TowOrder
from warehouse_fleet.transports.transports import LiftOrder, Transports
from warehouse_fleet.transports.unit_map import UnitPoses
from warehouse_layout.floor.floor_plan import FloorPlan
from warehouse_layout.message_enums import RobotMode

CANCEL_PERIOD = 1.0  # time between two checks of the paths that others commanded [s]


def _nothing() -> None:
    return None


@dataclass(frozen=True)
class Observation:
    """What is known of a warehouse at a time [s]."""

    time: float
    robots: Reports  # (m,), of robot_table.REPORT; robots may be missing
    people: Any = field(default_factory=lambda: NO_PEOPLE)  # as warehouse_msgs/People
    fallen: int = 0  # items on the floor
    refused: Sequence[str] = ()  # models of robots that have refused a path since the last tick
    # (kiva id, unit, reason) of robots that have said that they can't carry a unit
    rejected: Sequence[tuple[int, int, str]] = ()
    units: UnitPoses | None = None  # where units stand, if that may have changed
    # Asked when the controller wants to look: the world's map, (h, w) uint8, and where units stand
    # then. None: there is no answer now.
    look_at_map: Callable[[], np.ndarray | None] = _nothing
    look_at_units: Callable[[], UnitPoses | None] = _nothing


@dataclass
class Decision:
    """The commands of one tick. Events of transports stay in the book, since requests between two
    ticks cause some as well: the host takes them by transports.take_events()."""

    releases: Releases
    lifts: list[LiftOrder] = field(default_factory=list)
    cancels: list[int] = field(default_factory=list)  # kiva ids whose paths are to end
    tows: list[TowOrder] = field(default_factory=list)
    moves: list[Move] = field(default_factory=list)  # of elevators


class FleetController:
    """The controller of the robots `kiva_ids` on a FloorPlan. `transports` takes the requests,
    `traffic` drives; `robots` is the RobotTable of both.

    Numbers of transports begin after `last`. Robots that are lost, or broken in others' way, are
    towed after `tow_after` [s]; None: when tow() is called. takes_over_at: the time [s] from which
    on robots are taken over that may be on another coordinator's paths; None: there was no other.
    For the rest see Traffic.
    """

    def __init__(
        self,
        plan: FloorPlan,
        kiva_ids: np.ndarray,
        kinematics: Kinematics | None = None,
        seed: int = 1,
        planner: Any = None,
        *,
        last: int = 0,
        tow_after: float | None = None,
        takes_over_at: float | None = None,
        latency: float = 0.25,
        lag: float = 0.1,
        threads: int = 0,
    ) -> None:
        self.plan = plan
        self.traffic = Traffic(
            plan, kiva_ids, kinematics, seed, planner, latency=latency, lag=lag, threads=threads
        )
        self.robots = self.traffic.robots
        self.transports = Transports(plan, self.traffic, last)
        self._towing = Towing(
            plan,
            self.transports.aside,
            self.traffic,
            self.transports.distances,
            self.transports.taken,
        )
        self._tows = None
        if tow_after is not None:
            self._tows = TowingService(self._towing, self.robots, tow_after)
        self._takeover = None
        if takes_over_at is not None:
            self._takeover = Takeover(self.traffic, takes_over_at)
        self._handover = Handover()
        self.ended_zones: list[ClosedZone] = []  # opened by themselves in the last tick
        self._next_cancels = -np.inf
        begin = takes_over_at or 0.0
        for cell in np.flatnonzero(plan.obstructed).tolist():
            self.traffic.shut(cell, begin + STAYS)

    def close(self) -> None:
        """Ends the planner's thread."""
        self.traffic.close()

    def is_stale(self, time: float) -> bool:
        """Returns whether a later observation than one of that time [s] has been taken in."""
        return self.traffic.is_stale(time)

    def tick(self, observation: Observation) -> Decision:
        """Returns the Decision for an Observation."""
        traffic, gone = self.traffic, self.robots.gone
        reports = self.robots.align(observation.robots)
        for model in observation.refused:
            traffic.on_refused(model)
        for rejection in observation.rejected:
            self.transports.reject(*rejection)
        if observation.units is not None:
            self.transports.update_units(observation.units)
        traffic.update_robots(observation.time, reports)
        cancels = self._cancels(observation.time, reports)
        if traffic.takes_over and self._takeover:
            self._takeover.advance(reports)
        traffic.update_people(observation.people)
        self.ended_zones = traffic.zones.end_due(traffic.time)
        tows = self._tows.due(traffic.time) if self._tows else []
        traffic.update_fallen(observation.fallen)
        looks = traffic.wants_map
        if looks:
            traffic.update_map(observation.look_at_map())
        if not traffic.takes_over:
            self.transports.advance(reports)
        if looks or gone is not self.robots.gone:
            units = observation.look_at_units()
            if units is not None:
                self.transports.update_units(units)
        releases = traffic.releases()
        lifts, moves = self.transports.take_lifts(), traffic.take_moves()
        return Decision(releases, lifts, cancels, tows, moves)

    def _cancels(self, time: float, reports: Reports) -> list[int]:
        """Returns the robots whose paths are to end: others gave them out, they were given up, or
        the robots have left the fleet. They end where the robots can stop."""
        if self._next_cancels - CANCEL_PERIOD <= time < self._next_cancels:
            return []
        self._next_cancels = time + CANCEL_PERIOD
        robots = np.flatnonzero(self.traffic.unwanted(reports)).tolist()
        robots += self._handover.waiting(time, reports)
        return self.robots.kiva_ids[robots].tolist()

    def set_mode(self, kiva_id: int, mode: RobotMode) -> list[int]:
        """Sets the side that commands a robot; returns the ids of those whose paths are to end at
        once. Raises ValueError as check_mode()."""
        self.check_mode(kiva_id, mode)
        robot = self._present(kiva_id)
        self._handover.end(robot)
        self.robots.mode[robot] = mode
        if mode == RobotMode.AUTOMATIC:
            return []
        self._handover.begin(robot)
        return [] if self.robots.stands[robot] else [kiva_id]

    def check_mode(self, kiva_id: int, mode: RobotMode) -> None:
        """Raises ValueError if there is no such robot, if it is gone, or if it is to be AUTOMATIC
        while a client drives it by velocities."""
        robot = self._present(kiva_id)
        if mode == RobotMode.AUTOMATIC and self.robots.steered[robot]:
            raise ValueError(
                f"kiva{kiva_id} is driven by /kiva{kiva_id}/cmd_vel: give it back to the grid "
                "first, by /warehouse/set_cmd_vel"
            )

    def _present(self, kiva_id: int) -> int:
        robot = self.robots.index(kiva_id)
        if robot == NOWHERE:
            raise ValueError(f"there is no kiva{kiva_id}")
        if self.robots.gone[robot]:
            raise ValueError(f"kiva{kiva_id} was removed from the world")
        return robot

    def tow(self, kiva_id: int) -> TowOrder:
        """Returns the order to tow a broken or lost robot. Raises ValueError: it works, or there is
        no place for it."""
        return self._towing.order(kiva_id)
