# SPDX-License-Identifier: Apache-2.0
"""The actions Move and Carry of warehouse_msgs, composed of robots' commands.

A robot works on one goal at a time. A cancelled goal sends no further command: the robot is free
once its present command ends.
"""

import queue
import time
from collections.abc import Callable
from dataclasses import dataclass
from types import ModuleType
from typing import Any, TypeAlias

from actionlib import ActionServer
from actionlib.server_goal_handle import ServerGoalHandle
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Pose2D
from rospy.numpy_msg import numpy_msg

from warehouse_client import tracking
from warehouse_client.commands import COMMANDS
from warehouse_client.latest import LatestMessages
from warehouse_client.message_check import subscribe
from warehouse_client.routes import point
from warehouse_msgs.msg import (
    CarryAction,
    CarryFeedback,
    CarryGoal,
    CarryResult,
    Event,
    FleetState,
    Lift,
    MoveAction,
    MoveFeedback,
    MoveGoal,
    MoveResult,
    MoveTo,
    UnitStates,
    WarehouseObjects,
)

Feedback: TypeAlias = "MoveFeedback | CarryFeedback"
Result: TypeAlias = "MoveResult | CarryResult"

FEEDBACK_GAP = 0.2  # [s, wall]
PATIENCE = 3.0  # wait for the place of a new storage unit [s, wall]


@dataclass(frozen=True)
class Step:
    """One command of a goal: a message for a topic of COMMANDS, with which the robot goes to
    `target` (x, y) [m]."""

    topic: str
    message: Any
    target: tuple
    phase: int = 0


def move(goal: MoveGoal) -> list[Step]:
    """Returns the Steps of a MoveGoal."""
    return [_go(goal.kiva_id, (goal.x, goal.y))]


def carry(goal: CarryGoal, unit: tuple[int, int]) -> list[Step]:
    """Returns the Steps of a CarryGoal, whose storage unit is at the grid point `unit` [m]."""
    kiva, target = goal.kiva_id, (goal.x, goal.y)
    lift, drop = (
        Lift(kiva_id=kiva, status=status, shelf_id=goal.shelf_id)
        for status in (Lift.CARRY, Lift.DROP)
    )
    return [
        _go(kiva, unit, CarryFeedback.FETCHING),
        Step("lift", lift, unit, CarryFeedback.LIFTING),
        _go(kiva, target, CarryFeedback.CARRYING),
        Step("lift", drop, target, CarryFeedback.DROPPING),
    ]


def _go(kiva: int, target: tuple, phase: int = 0) -> Step:
    return Step("mov", MoveTo(kiva_id=kiva, x=target[0], y=target[1]), target, phase)


class Work:
    """A goal on which a robot works: `handle` is actionlib's, `steps` are the remaining ones."""

    def __init__(
        self, handle: ServerGoalHandle, steps: list[Step], feedback: Feedback, result: Result
    ) -> None:
        self.handle, self.steps = handle, steps
        self.feedback, self.result = feedback, result
        self.command = None  # number of the first step's command, once accepted

    @property
    def robot(self) -> str:
        """The name of its robot."""
        return f"kiva{self.handle.get_goal().kiva_id}"

    def hears(self, event: Event) -> bool:
        """Handles an event of its robot; returns whether it ends the present command."""
        if self.command is None:
            if event.kind == Event.ACCEPTED:
                self.command = event.command
            return event.kind == Event.REFUSED
        return event.command == self.command and event.kind in (Event.DONE, Event.BLOCKED)


def _is_cancelled(handle: ServerGoalHandle) -> bool:
    return handle.get_goal_status().status == GoalStatus.PREEMPTING


class RobotActions:
    """Serves /warehouse/move and /warehouse/carry. `ros` is rospy."""

    def __init__(self, ros: ModuleType) -> None:
        self._ros = ros
        self._inbox: queue.Queue[Any] = queue.Queue()
        self._works: dict[Any, Any] = {}
        self._fleet, self._hearing = None, None
        self._publishers = {t: ros.Publisher(t, k, queue_size=10) for t, k in COMMANDS.items()}
        self._places = LatestMessages(
            ros,
            objects=("warehouse/objects", numpy_msg(WarehouseObjects)),
            states=("warehouse/unit_states", numpy_msg(UnitStates)),
        )
        subscribe(ros, "warehouse/events", Event, self._on_event, queue_size=1000)
        self._servers = [
            ActionServer(name, kind, self._on_goal(begin), auto_start=False)
            for name, kind, begin in (
                ("warehouse/move", MoveAction, self._begin_move),
                ("warehouse/carry", CarryAction, self._begin_carry),
            )
        ]
        ros.set_param("~actionlib_status_frequency", 0)  # its timer ends when time goes back
        for server in self._servers:
            server.start()

    # --- ROS's threads queue messages; one worker handles them
    def _on_goal(self, begin: Callable[[Any], None]) -> Callable[[Any], None]:
        return lambda handle: self._inbox.put((begin, handle))

    def _on_event(self, event: Event) -> None:
        if event.model in self._works:
            self._inbox.put((self._take, event))

    def _on_fleet(self, fleet: FleetState) -> None:
        self._fleet = fleet

    def run(self) -> None:
        """Serves goals until shutdown."""
        while not self._ros.is_shutdown():
            try:
                act, what = self._inbox.get(timeout=FEEDBACK_GAP)
                act(what)
            except queue.Empty:
                self._publish_feedback()
                for server in self._servers:
                    server.publish_status()

    # --- goals
    def _begin_move(self, handle: ServerGoalHandle) -> None:
        self._begin(handle, move(handle.get_goal()), MoveFeedback(), MoveResult())

    def _begin_carry(self, handle: ServerGoalHandle) -> None:
        goal = handle.get_goal()
        unit = self._place(f"storage_unit{goal.shelf_id}")
        if unit is None:
            self._reject(handle, CarryResult(), f"there is no storage_unit{goal.shelf_id}")
        else:
            self._begin(handle, carry(goal, unit), CarryFeedback(), CarryResult())

    def _place(self, name: str) -> tuple[int, int] | None:
        """The grid point of a storage unit, or None."""
        end = time.monotonic() + PATIENCE
        while (place := self._tracked_place(name)) is None and time.monotonic() < end:
            self._places.wait(end - time.monotonic())
        return place

    def _tracked_place(self, name: str) -> tuple[int, int] | None:
        known = self._places.units_and_objects
        units = tracking.storage_units(*known) if known else tracking.Tracked()
        return point(units.pose[units.names.index(name)]) if name in units.names else None

    def _begin(
        self, handle: ServerGoalHandle, steps: list[Step], feedback: Feedback, result: Result
    ) -> None:
        work = Work(handle, steps, feedback, result)
        if work.robot in self._works:
            self._reject(handle, result, f"{work.robot} works on another goal")
            return
        handle.set_accepted()
        self._works[work.robot] = work
        self._hear_fleet()
        self._send(work)

    @staticmethod
    def _reject(handle: ServerGoalHandle, result: Result, text: str) -> None:
        result.text, result.kind = text, Event.REFUSED
        handle.set_rejected(result, text)

    def _send(self, work: Work) -> None:
        work.command = None
        step = work.steps[0]
        self._publishers[step.topic].publish(step.message)

    def _take(self, event: Event) -> None:
        work = self._works.get(event.model)
        if not work or not work.hears(event):
            return
        work.steps.pop(0)
        is_cancelled = bool(work.steps) and _is_cancelled(work.handle)
        if event.kind == Event.DONE and work.steps and not is_cancelled:
            self._send(work)
        else:
            self._end(work, event, is_cancelled)

    def _end(self, work: Work, event: Event, is_cancelled: bool) -> None:
        del self._works[work.robot]
        work.result.kind, work.result.text = event.kind, event.text
        work.result.pose = self._pose(work) or Pose2D()
        self._hear_fleet()
        if event.kind == Event.DONE and is_cancelled:
            work.handle.set_canceled(work.result, "cancelled before all of it was done")
        elif event.kind == Event.DONE:
            work.handle.set_succeeded(work.result)
        else:
            work.handle.set_aborted(work.result, event.text)

    # --- feedback between two events
    def _hear_fleet(self) -> None:
        """Subscribes to the fleet while any robot works on a goal."""
        if self._works and not self._hearing:
            self._hearing = subscribe(
                self._ros, "warehouse/fleet", FleetState, self._on_fleet, queue_size=1
            )
        elif not self._works and self._hearing:
            self._hearing.unregister()
            self._hearing = self._fleet = None

    def _pose(self, work: Work) -> Pose2D | None:
        fleet, kiva = self._fleet, work.handle.get_goal().kiva_id
        if fleet is None or kiva not in fleet.kiva_id:
            return None
        i = fleet.kiva_id.index(kiva)
        return Pose2D(fleet.x[i], fleet.y[i], fleet.yaw[i])

    def _publish_feedback(self) -> None:
        for work in self._works.values():
            pose = self._pose(work)
            if pose is None:
                continue
            step, feedback = work.steps[0], work.feedback
            feedback.pose = pose
            feedback.distance = abs(step.target[0] - pose.x) + abs(step.target[1] - pose.y)
            if hasattr(feedback, "phase"):
                feedback.phase = step.phase
            work.handle.publish_feedback(feedback)
