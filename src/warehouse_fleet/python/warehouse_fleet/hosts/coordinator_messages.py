# SPDX-License-Identifier: Apache-2.0
"""The state of a fleet as the coordinator's messages."""

import math
from collections.abc import Collection, Iterable
from typing import Any, Protocol

import numpy as np
import rospy

from warehouse_fleet.hosts.controller import FleetController
from warehouse_fleet.robots.failures import OUT_OF_ORDER, names_of
from warehouse_fleet.robots.robot_table import NOWHERE
from warehouse_fleet.traffic.traffic import Releases
from warehouse_fleet.transports.obstructions import in_the_way
from warehouse_fleet.transports.transport_book import Step, TransportEvent
from warehouse_fleet.transports.waiting import DOES, Waiting
from warehouse_layout.message_enums import RobotMode
from warehouse_msgs.msg import CoordinatorPaths, CoordinatorState, FleetFollow
from warehouse_msgs.msg import TransportEvent as TransportEventMessage


class Watch(Protocol):
    """What is known of a warehouse beside its robots."""

    collisions: int
    fleet: Any  # FleetState
    objects: Any  # WarehouseObjects
    reasons: dict[str, str]  # why robots are broken, in their own words, by model

    def refusals(self, now: float) -> dict[str, str]:
        """Returns why robots refused what they were sent a short time ago, by model."""

    @property
    def by_hand(self) -> Collection[str]:
        """The names of stations where a person works."""


def follow_message(releases: Releases) -> FleetFollow:
    """Returns the message of what is released."""
    return FleetFollow(*(column.tolist() for column in releases))


def event_message(event: TransportEvent) -> TransportEventMessage:
    """Returns the message of an event."""
    message = TransportEventMessage(
        transport_id=event.transport_id,
        kind=event.kind,
        kiva_id=event.kiva_id,
        shelf_id=event.shelf_id,
        station=event.station,
        text=event.text,
    )
    message.header.stamp = rospy.Time.from_sec(event.stamp)
    return message


def state_message(
    controller: FleetController, watch: Watch, timeline: int, left_out: str
) -> CoordinatorState:
    """Returns the state of the fleet; `left_out` says which part of the floor it can't serve."""
    robots, traffic, transports = controller.robots, controller.traffic, controller.transports
    state = CoordinatorState(timeline=timeline)
    state.header.stamp = rospy.Time.from_sec(traffic.time)
    _count_modes(state, controller)
    waiting = Waiting(traffic, transports, watch.by_hand)
    doing = waiting.doing()
    state.doing_kiva, state.doing = list(doing), list(doing.values())
    for name in ("idle", *DOES.values()):
        setattr(state, name, state.doing.count(name))
    state.open = sum(t.step == Step.OPEN for t in transports)
    state.under_way = sum(t.step != Step.OPEN for t in transports)
    totals = transports.totals
    state.delivered, state.stored, state.failed = totals.delivered, totals.stored, totals.failed
    state.executed_over_planned = totals.executed_over_planned
    if traffic.plans.seconds:
        spent = 1e3 * np.percentile(traffic.plans.seconds.all(), (50, 99))
        state.plan_p50, state.plan_p99 = spent.tolist()
    state.station = list(transports.stations)
    state.queue = [transports.waiting(name) for name in state.station]
    long = waiting.long()
    state.waiting_text = [text for _, text in long]
    state.waiting_kiva = [int(robots.kiva_ids[robot]) for robot, _ in long]
    state.waiting_for = [_id_of(controller, waiting.behind(robot)) for robot, _ in long]
    state.waiting_since = [float(robots.still_since[robot]) for robot, _ in long]
    state.collisions, state.blocked = watch.collisions, traffic.blocked
    state.watchdog = traffic.watchdog.count
    state.alarms = [
        *_alarms(controller, watch.reasons, watch.refusals(traffic.time)),
        *_lost(controller, watch.fleet),
        *waiting.for_people(),
        *_fallen(watch.objects),
        *in_the_way(controller.plan, traffic, transports.units),
        *(text for text in (traffic.plans.alarm, left_out) if text),
    ]
    return state


def _count_modes(state: CoordinatorState, controller: FleetController) -> None:
    robots = controller.robots

    def ids(mode: RobotMode) -> list[int]:
        return robots.kiva_ids[(robots.mode == mode) & ~robots.gone].tolist()

    state.manual_kiva, state.out_of_service_kiva = (
        ids(RobotMode.MANUAL),
        ids(RobotMode.OUT_OF_SERVICE),
    )
    state.automatic = len(ids(RobotMode.AUTOMATIC))
    state.manual, state.out_of_service = len(state.manual_kiva), len(state.out_of_service_kiva)


def _alarms(
    controller: FleetController, reasons: dict[str, str], refusals: dict[str, str]
) -> Iterable[str]:
    robots = controller.robots
    for robot in np.flatnonzero(robots.failures):
        name, what = f"kiva{robots.kiva_ids[robot]}", names_of(robots.failures[robot])
        if robots.failures[robot] >> OUT_OF_ORDER & 1 and name in reasons:
            what = f"{what} ({reasons[name]})"
        yield f"{name}: {what}"
    for kiva in robots.kiva_ids[robots.stalled & ~robots.broken].tolist():
        name = f"kiva{kiva}"
        because = f": it refuses what it is sent ({refusals[name]})" if name in refusals else ""
        yield f"{name} does not move{because}"


def _lost(controller: FleetController, fleet: Any) -> Iterable[str]:
    robots = controller.robots
    if not robots.lost.any():
        return
    places = dict(zip(fleet.kiva_id, zip(fleet.x, fleet.y)))
    for kiva in robots.kiva_ids[robots.lost].tolist():
        x, y = places.get(kiva, (math.nan, math.nan))
        if controller.plan.cell_of(x, y) == NOWHERE:
            what = f"is off the floor, at {x:.1f}, {y:.1f} m: put it back"
        else:
            what = "was pushed and does not find back: put it straight"
        yield f"kiva{kiva} {what}, then set it AUTOMATIC"


def _fallen(objects: Any) -> Iterable[str]:
    for item, unit in zip(objects.fallen_item, objects.fallen_from):
        yield f"{objects.items[item]} lies on the floor, off {objects.storage_units[unit]}"


def paths_message(controller: FleetController) -> CoordinatorPaths:
    """Returns the released and planned paths of all robots under way."""
    robots, traffic = controller.robots, controller.traffic
    message = CoordinatorPaths(stamp=rospy.Time.from_sec(traffic.time))
    cells: list[int] = []
    for robot in np.flatnonzero(robots.automatic):
        held, planned = traffic.paths(robot)
        waits_for = int(robots.waits_for[robot])
        if len(held) + len(planned) < 2 and waits_for == NOWHERE:
            continue
        message.kiva_id.append(int(robots.kiva_ids[robot]))
        message.released.append(len(held))
        message.planned.append(len(planned))
        message.waits_for.append(_id_of(controller, waits_for))
        goal_x, goal_y = _point_of(controller, int(robots.goal[robot]))
        message.goal_x.append(goal_x)
        message.goal_y.append(goal_y)
        cells += held + planned
    x, y = controller.plan.point_of(np.array(cells, np.int32))
    message.x, message.y = x.tolist(), y.tolist()
    return message


def _id_of(controller: FleetController, robot: int) -> int:
    return int(controller.robots.kiva_ids[robot]) if robot != NOWHERE else 0


def _point_of(controller: FleetController, cell: int) -> tuple[float, float]:
    """The centre of a cell [m]; NaN for NOWHERE."""
    if cell == NOWHERE:
        return math.nan, math.nan
    x, y = controller.plan.point_of(cell)
    return float(x), float(y)
