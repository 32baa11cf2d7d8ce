# SPDX-License-Identifier: Apache-2.0
"""The states that a vehicle sends: at every event, and periodically without one."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from warehouse_vda5050.driver import Report
from warehouse_vda5050.errors import Error
from warehouse_vda5050.grid import Grid
from warehouse_vda5050.model import (
    MAP_ID,
    ActionState,
    AgvPosition,
    Battery,
    Factsheet,
    Load,
    VehicleState,
    Velocity,
    Visualization,
)
from warehouse_vda5050.paths import PlannedPath, Waypoint
from warehouse_vda5050.vehicle.progress import OrderProgress
from warehouse_vda5050.vehicle.settings import VehicleSettings
from warehouse_vda5050.zones.zone import ZoneRequest, ZoneSetState

REACTION = 1.0  # what a master may take to send more [s]


@dataclass(frozen=True)
class Situation:
    """What a state is made of. `order`: under way, or, of a free vehicle, the last one."""

    report: Report | None
    grid: Grid
    order: OrderProgress | None
    is_free: bool
    paused: bool
    actions: tuple[ActionState, ...]
    errors: tuple[Error, ...]
    zone_sets: tuple[ZoneSetState, ...] = ()
    zone_requests: tuple[ZoneRequest, ...] = ()
    planned: PlannedPath | None = None
    intermediate: tuple[Waypoint, ...] = ()


class StateReporter:
    """Makes the states of one vehicle."""

    def __init__(self, sheet: Factsheet, settings: VehicleSettings) -> None:
        self._sheet, self._settings = sheet, settings
        self._published: VehicleState | None = None  # without what changes all the time
        self.due = -math.inf  # when the next state is sent, if nothing happens before
        self._requested = False
        self._factsheet_due = True
        self._shown: Visualization | None = None
        self._shown_at = -math.inf
        self._deceleration = max(0.1, sheet.max_deceleration)
        self._top_speed = sheet.max_speed

    def request(self) -> None:
        """Lets the next take() return a state in any case."""
        self._requested = True

    def request_factsheet(self) -> None:
        """Lets the next take_factsheet() return the factsheet."""
        self._factsheet_due = True

    def take_factsheet(self) -> Factsheet | None:
        """Returns the factsheet if it is due."""
        due, self._factsheet_due = self._factsheet_due, False
        return self._sheet if due else None

    def take(self, situation: Situation, now: float) -> VehicleState | None:
        """Returns the state after an event, when it is due, or on request."""
        if situation.report is None:
            return None
        state = self.state(situation)
        lasting = _lasting(state)
        due = now >= self.due
        if lasting == self._published and not due and not self._requested:
            return None
        settings = self._settings
        interval = min(settings.moving, settings.interval) if state.driving else settings.interval
        # A state that comes a little late does not delay the next.
        self.due = interval + (self.due if due and now < self.due + interval else now)
        self._published, self._requested = lasting, False
        return state

    def take_visualization(self, report: Report | None, now: float) -> Visualization | None:
        """Returns position and speed if they changed and are due."""
        interval = self._settings.visualization
        if report is None or not interval or now - self._shown_at < interval:
            return None
        visualization = Visualization(_position(report), _velocity(report))
        if visualization == self._shown:
            return None
        self._shown, self._shown_at = visualization, now
        return visualization

    def state(self, situation: Situation) -> VehicleState:
        """Returns the state of a situation."""
        state = VehicleState(
            actions=situation.actions,
            paused=situation.paused,
            errors=situation.errors,
            maps=(MAP_ID,),
            zone_sets=situation.zone_sets,
            zone_requests=situation.zone_requests,
            planned=situation.planned,
            intermediate=situation.intermediate,
        )
        if situation.report is None:
            return state
        with_report = _with_report(state, situation.report)
        return self._with_order(with_report, situation, situation.report)

    def _with_order(self, state: VehicleState, now: Situation, report: Report) -> VehicleState:
        grid, order = now.grid, now.order
        here = grid.cell_at(report.x, report.y)
        if order is None:
            return replace(state, last_node=grid.node_id(here))
        # Once the order is over others may move the robot.
        away = now.is_free and here != order.cells[0]
        x, y = grid.position(order.cells[0])
        return replace(
            state,
            order_id=order.id,
            order_update=order.update,
            last_node=grid.node_id(here) if away else order.last.id,
            last_node_sequence=order.last.sequence,
            nodes=order.node_states(),
            edges=order.edge_states(),
            new_base_request=self._needs_base(order, grid, report),
            distance_since_last_node=round(abs(report.x - x) + abs(report.y - y), 3),
        )

    def _needs_base(self, order: OrderProgress, grid: Grid, report: Report) -> bool:
        """Returns whether the robot is about to brake for the end of its base."""
        if not order.has_horizon:
            return False
        speed = self._top_speed
        ahead = speed * REACTION + speed * speed / (2 * self._deceleration) + grid.spacing
        here = (report.x, report.y)
        for cell in order.cells[1 : order.base_end + 1]:
            there = grid.position(cell)
            ahead -= abs(there[0] - here[0]) + abs(there[1] - here[1])
            if ahead < 0:
                return False
            here = there
        return True


def _with_report(state: VehicleState, report: Report) -> VehicleState:
    charge = round(min(100.0, max(0.0, report.battery.charge)), 2)
    return replace(
        state,
        driving=report.moving,
        position=_position(report),
        velocity=_velocity(report),
        loads=(Load(report.load),) if report.load else (),
        battery=Battery(charge, report.battery.charging),
        mode=report.mode,
        emergency_stop=report.stopped,
        field_violation=report.blocked,
    )


def _position(report: Report) -> AgvPosition:
    # In [-π, π]: peers drop a state whose heading is rounded beyond that.
    yaw = max(-math.pi, min(round(math.remainder(report.yaw, math.tau), 4), math.pi))
    return AgvPosition(round(report.x, 4), round(report.y, 4), yaw, initialized=report.localized)


def _velocity(report: Report) -> Velocity:
    c, s = math.cos(report.yaw), math.sin(report.yaw)
    ahead, aside = c * report.vx + s * report.vy, c * report.vy - s * report.vx
    return Velocity(round(ahead, 3), round(aside, 3), round(report.omega, 3))


def _lasting(state: VehicleState) -> VehicleState:
    """Returns a state without what changes all the time and is not an event."""
    position = state.position
    known = position and replace(position, x=0.0, y=0.0, theta=0.0)
    battery = Battery(0.0, state.battery.charging)
    return replace(
        state,
        position=known,
        velocity=None,
        battery=battery,
        distance_since_last_node=None,
        planned=None,
        intermediate=(),
    )
