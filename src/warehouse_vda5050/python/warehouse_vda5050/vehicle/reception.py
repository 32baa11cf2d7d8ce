# SPDX-License-Identifier: Apache-2.0
"""Receives orders and their updates: which are accepted, and why others are not."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace

from warehouse_vda5050.driver import Report
from warehouse_vda5050.errors import Error, ErrorType, Predefined
from warehouse_vda5050.grid import Cell, Grid
from warehouse_vda5050.model import MAP_ID, Factsheet, Node, OperatingMode, VehicleOrder
from warehouse_vda5050.validation import MessageError
from warehouse_vda5050.validation.actions import check_actions
from warehouse_vda5050.validation.demands import Robot, check_demands, check_maps, radius
from warehouse_vda5050.validation.orders import cells_of, check_form
from warehouse_vda5050.vehicle.complaints import references
from warehouse_vda5050.vehicle.phase import Phase
from warehouse_vda5050.vehicle.progress import OrderProgress

TAKING_ORDERS = (OperatingMode.AUTOMATIC, OperatingMode.SEMIAUTOMATIC)
REMEMBERED = 1000  # ids of orders that were carried out, against late copies


@dataclass(frozen=True)
class Situation:
    """What decides whether a vehicle accepts an order. `order`: under way, or the last one."""

    report: Report | None
    grid: Grid
    order: OrderProgress | None
    phase: Phase


class Reception:
    """Accepts orders for one vehicle.

    begins_at_zero: whether a new order has to. take() takes the robot from whom commands it else,
    and returns why not, or ''; start(progress, order) begins an order, and extend(nodes) goes on
    with nodes that an update brings. check_zones(order, cells, robot) raises MessageError for an
    order through a zone that the robot must not enter.
    """

    def __init__(
        self,
        sheet: Factsheet,
        *,
        begins_at_zero: bool,
        take: Callable[[], str],
        start: Callable[[OrderProgress, VehicleOrder], None],
        extend: Callable[[tuple[Node, ...]], None],
        check_zones: Callable[[VehicleOrder, list[Cell], Robot], None],
    ) -> None:
        self._sheet, self._begins_at_zero = sheet, begins_at_zero
        self._take_robot, self._start, self._extend = take, start, extend
        self._check_zones = check_zones
        self._done: deque[str] = deque(maxlen=REMEMBERED)

    def accept(self, order: VehicleOrder, now: Situation) -> bool:
        """Takes an order or an update over. Returns False for a copy of what was accepted. Raises
        MessageError, with nothing changed."""
        try:
            return self._accept(order, now)
        except MessageError as invalid:
            invalid.error = _referring(invalid.error, order)
            raise

    def _accept(self, order: VehicleOrder, now: Situation) -> bool:
        check_form(order)
        current = now.order
        if current and current.is_repeated(order):
            return False
        report = _check_robot(order, now)
        is_update = current is not None and order.id == current.id
        yaw = None if is_update else report.yaw
        cells = self._check_content(order, Robot(self._sheet, now.grid, yaw, bool(report.load)))
        if current is not None and is_update:
            self._update(current, order, cells, now, report)
        else:
            self._begin(order, cells, now, report)
        return True

    def _check_content(self, order: VehicleOrder, robot: Robot) -> list[Cell]:
        check_actions(order, self._sheet)
        check_maps(order, MAP_ID)
        cells = cells_of(order, robot.grid)
        check_demands(order, cells, robot)
        self._check_zones(order, cells, robot)
        return cells

    # A new order.

    def _begin(
        self, order: VehicleOrder, cells: list[Cell], now: Situation, report: Report
    ) -> None:
        self._check_free(order, now)
        if self._begins_at_zero and order.update:
            _refuse(
                order,
                f"orderUpdateId is {order.update}; a new order begins with 0",
                ErrorType.ORDER_UPDATE,
                Predefined.VALIDATION_FAILURE,
            )
        if report.busy or report.moving:
            _refuse(
                order,
                "the robot carries out a command from elsewhere",
                precise=Predefined.OTHER_ORDER_ACTIVE,
            )
        _check_start(order, cells[0], now.grid, report)
        self._take(order)
        if now.order:
            self._done.append(now.order.id)
        self._start(OrderProgress(order, cells), order)

    def _check_free(self, order: VehicleOrder, now: Situation) -> None:
        current = now.order
        if current and not now.phase.is_free:
            text = f"order {current.id} is under way"
            if current.cancelled:
                text = f"order {current.id} was cancelled, and the robot is not at a node yet"
            _refuse(order, text, precise=Predefined.OTHER_ORDER_ACTIVE)
        if order.id in self._done:
            text = f"order {order.id} was carried out already"
            _refuse(order, text, precise=Predefined.OUTDATED_ORDER_UPDATE)

    def _take(self, order: VehicleOrder) -> None:
        reason = self._take_robot()
        if reason:
            _refuse(order, reason, precise=Predefined.MOBILE_ROBOT_NOT_AVAILABLE)

    # An update.

    def _update(
        self,
        current: OrderProgress,
        order: VehicleOrder,
        cells: list[Cell],
        now: Situation,
        report: Report,
    ) -> None:
        if now.phase.is_free and order.update > current.update:
            _check_start(order, cells[0], now.grid, report)
            if not current.cancelled:
                self._take(order)
        self._extend(current.stitch(order, cells))


def _check_robot(order: VehicleOrder, now: Situation) -> Report:
    report, away = now.report, Predefined.MOBILE_ROBOT_NOT_AVAILABLE
    if report is None:
        _refuse(order, "the robot has not reported its position", precise=away)
        raise AssertionError
    if not report.localized:
        _refuse(order, "the robot does not know where it is", precise=away)
    if report.mode not in TAKING_ORDERS:
        _refuse(order, f"the operating mode is {report.mode.value}", precise=away)
    if report.declines:
        _refuse(order, report.declines, precise=away)
    if now.phase is Phase.CANCELLING and now.order and order.id == now.order.id:
        following = Predefined.ORDER_UPDATE_FOLLOWING_CANCEL
        _refuse(order, "the order is being cancelled", ErrorType.ORDER_UPDATE, following)
    return report


def _check_start(order: VehicleOrder, cell: Cell, grid: Grid, report: Report) -> None:
    """Refuses an order that does not begin where the robot stands."""
    here = grid.cell_at(report.x, report.y)
    if cell != here:
        text = (
            f"the first node, {order.nodes[0].id}, is not where the robot stands:"
            f" {grid.node_id(here)}"
        )
        _refuse(order, text, ErrorType.NO_ROUTE, Predefined.START_NODE_OUT_OF_RANGE)
    allowed = radius(dict(order.nodes[0].demands).get("allowedDeviationXY"))
    x, y = grid.position(cell)
    far = math.hypot(report.x - x, report.y - y)
    if allowed and far > allowed:
        text = f"the robot is {far:.3f} m off the first node; allowedDeviationXY is {allowed:g}"
        _refuse(order, text, ErrorType.NO_ROUTE, Predefined.START_NODE_OUT_OF_RANGE)


def _refuse(
    order: VehicleOrder,
    text: str,
    type: ErrorType = ErrorType.ORDER,
    precise: Predefined | None = None,
) -> None:
    raise MessageError(text, type.value, references(order), precise)


def _referring(error: Error, order: VehicleOrder) -> Error:
    """Returns the error of an order with all that masters find it by."""
    known = ("topic", "orderId", "orderUpdateId")
    further = [pair for pair in error.references if pair[0] not in known]
    return replace(error, references=(*references(order), *further))
