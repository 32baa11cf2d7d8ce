# SPDX-License-Identifier: Apache-2.0
"""Receives orders and their updates: which are accepted, and why others are not."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import replace
from typing import TYPE_CHECKING

from warehouse_vda5050.errors import Error, ErrorType, Predefined
from warehouse_vda5050.grid import Cell
from warehouse_vda5050.model import MAP_ID, OperatingMode, VehicleOrder
from warehouse_vda5050.validation import MessageError
from warehouse_vda5050.validation.actions import check_actions
from warehouse_vda5050.validation.demands import Robot, check_demands, check_maps, radius
from warehouse_vda5050.validation.orders import cells_of, check_form
from warehouse_vda5050.vehicle.complaints import references
from warehouse_vda5050.vehicle.phase import Phase
from warehouse_vda5050.vehicle.progress import OrderProgress

if TYPE_CHECKING:
    from warehouse_vda5050.driver import Report
    from warehouse_vda5050.vehicle.vehicle import Vehicle

TAKING_ORDERS = (OperatingMode.AUTOMATIC, OperatingMode.SEMIAUTOMATIC)
REMEMBERED = 1000  # ids of orders that were carried out, against late copies


class Reception:
    """Accepts orders for one vehicle."""

    def __init__(self, vehicle: Vehicle) -> None:
        self._vehicle = vehicle
        self._done: deque[str] = deque(maxlen=REMEMBERED)

    def accept(self, order: VehicleOrder) -> bool:
        """Takes an order or an update over. Returns False for a copy of what was accepted. Raises
        MessageError, with nothing changed."""
        try:
            return self._accept(order)
        except MessageError as invalid:
            invalid.error = _referring(invalid.error, order)
            raise

    def _accept(self, order: VehicleOrder) -> bool:
        check_form(order)
        current = self._vehicle.order
        if current and current.is_repeated(order):
            return False
        report = self._check_robot(order)
        is_update = current is not None and order.id == current.id
        cells = self._check_content(order, report, is_update)
        if current is not None and is_update:
            self._update(current, order, cells)
        else:
            self._begin(order, cells, report)
        return True

    def _check_robot(self, order: VehicleOrder) -> Report:
        vehicle, report = self._vehicle, self._vehicle.report
        away = Predefined.MOBILE_ROBOT_NOT_AVAILABLE
        if report is None:
            _refuse(order, "the robot has not told where it is", precise=away)
            raise AssertionError
        if not report.localized:
            _refuse(order, "the robot does not know where it is", precise=away)
        if report.mode not in TAKING_ORDERS:
            _refuse(order, f"the operating mode is {report.mode.value}", precise=away)
        cancelling = vehicle.phase is Phase.CANCELLING
        if cancelling and vehicle.order and order.id == vehicle.order.id:
            following = Predefined.ORDER_UPDATE_FOLLOWING_CANCEL
            _refuse(order, "the order is being cancelled", ErrorType.ORDER_UPDATE, following)
        return report

    def _check_content(self, order: VehicleOrder, report: Report, is_update: bool) -> list[Cell]:
        vehicle = self._vehicle
        check_actions(order, vehicle.sheet)
        check_maps(order, MAP_ID)
        cells = cells_of(order, vehicle.grid)
        yaw = None if is_update else report.yaw
        check_demands(order, cells, Robot(vehicle.sheet, vehicle.grid, yaw, bool(report.load)))
        return cells

    # A new order.

    def _begin(self, order: VehicleOrder, cells: list[Cell], report: Report) -> None:
        vehicle = self._vehicle
        self._check_free(order)
        if vehicle.settings.begins_at_zero and order.update:
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
        self._check_start(order, cells[0], report)
        self._take(order)
        if vehicle.order:
            self._done.append(vehicle.order.id)
        vehicle.start(OrderProgress(order, cells), order)

    def _check_free(self, order: VehicleOrder) -> None:
        vehicle, current = self._vehicle, self._vehicle.order
        if current and not vehicle.is_free:
            text = f"order {current.id} is under way"
            if current.cancelled:
                text = f"order {current.id} was cancelled, and the robot is not at a node yet"
            _refuse(order, text, precise=Predefined.OTHER_ORDER_ACTIVE)
        if order.id in self._done:
            text = f"order {order.id} was carried out already"
            _refuse(order, text, precise=Predefined.OUTDATED_ORDER_UPDATE)

    def _take(self, order: VehicleOrder) -> None:
        reason = self._vehicle.take()
        if reason:
            _refuse(order, reason, precise=Predefined.MOBILE_ROBOT_NOT_AVAILABLE)

    # An update.

    def _update(self, current: OrderProgress, order: VehicleOrder, cells: list[Cell]) -> None:
        vehicle = self._vehicle
        assert vehicle.report
        if vehicle.is_free and order.update > current.update:
            self._check_start(order, cells[0], vehicle.report)
            if not current.cancelled:
                self._take(order)
        vehicle.extend(current.stitch(order, cells))

    def _check_start(self, order: VehicleOrder, cell: Cell, report: Report) -> None:
        """Refuses an order that does not begin where the robot stands."""
        grid = self._vehicle.grid
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
