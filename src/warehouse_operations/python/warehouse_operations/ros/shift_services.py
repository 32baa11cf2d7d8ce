# SPDX-License-Identifier: Apache-2.0
"""The services of a running shift."""

from collections.abc import Callable
from typing import Any, Protocol

import rospy
from sqlalchemy.engine import Engine

from warehouse_client.command_services import CommandServices
from warehouse_layout.message_enums import PickOutcome
from warehouse_msgs import srv
from warehouse_operations.ros.operation_messages import (
    stock_place,
    stored_order_event,
    stored_order_status,
)
from warehouse_operations.shift import order_table
from warehouse_operations.shift.shift import Shift
from warehouse_operations.shift.task_reports import Report
from warehouse_operations.store import queries

LONGEST_ID = 80  # of a report
MOST_EVENTS = 500  # of an order, in an answer


class Host(Protocol):
    """The node whose shift is served."""

    @property
    def shift(self) -> Shift:
        """The shift that runs now."""

    @property
    def engine(self) -> Engine:
        """The engine of its database."""

    def carry_out(self, act: Callable[[Shift], Any]) -> Any:
        """Calls act(shift), waits until the database has its effects, and returns its result."""

    def publish_stations(self) -> None:
        """Publishes the stations at once."""


class ShiftServices:
    """Advertises the services and answers them with the shift of `host`."""

    def __init__(self, host: Host) -> None:
        self._host = host
        commands = CommandServices(rospy)
        for name, kind, call in (
            ("submit_order", srv.SubmitOrder, self._submit),
            ("submit_orders", srv.SubmitOrders, self._submit_table),
            ("cancel_order", srv.CancelOrder, self._cancel),
            ("change_order", srv.ChangeOrder, self._change),
            ("set_station", srv.SetStation, self._set_station),
            ("confirm_pick", srv.ConfirmPick, self._confirm),
            ("report_short", srv.ReportShort, self._report_short),
            ("report_pick", srv.ReportPick, self._report_pick),
            ("undo_write_off", srv.UndoWriteOff, self._undo_write_off),
        ):
            commands.serve(f"warehouse/{name}", kind, call)
        for name, kind, call in (
            ("order_history", srv.OrderHistory, self._history),
            ("find_orders", srv.FindOrders, self._find_orders),
            ("find_stock", srv.FindStock, self._find_stock),
            ("find_skus", srv.FindSkus, self._find_skus),
        ):
            rospy.Service(f"warehouse/{name}", kind, call)

    def _submit(self, request: Any) -> Any:
        lines = [(line.sku, line.quantity) for line in request.lines]
        fields = lines, request.due.to_sec(), request.priority, request.reference
        order, message = self._host.carry_out(lambda shift: shift.submit(*fields))
        return srv.SubmitOrderResponse(order.order_id if order else 0, bool(order), message)

    def _submit_table(self, request: Any) -> Any:
        fields = request.table, request.check_only
        answer = self._host.carry_out(lambda shift: order_table.submit(shift.order_book, *fields))
        line, column, text = zip(*answer.faults) if answer.faults else ((), (), ())
        return srv.SubmitOrdersResponse(
            accepted=not answer.faults,
            message=text[0] if text else "",
            order_ids=answer.order_ids,
            references=answer.references,
            lines=answer.lines,
            pieces=answer.pieces,
            fault_line=line,
            fault_column=column,
            fault_text=text,
        )

    def _cancel(self, request: Any) -> Any:
        return srv.CancelOrderResponse(
            *self._host.carry_out(lambda s: s.cancel_order(request.order_id))
        )

    def _change(self, request: Any) -> Any:
        priority = request.priority if request.set_priority else None
        due = request.due.to_sec() if request.set_due else None
        fields = request.order_id, priority, due
        return srv.ChangeOrderResponse(
            *self._host.carry_out(lambda shift: shift.change_order(*fields))
        )

    def _history(self, request: Any) -> Any:
        rows = queries.order_events(self._host.engine, request.order_id, MOST_EVENTS)
        if not rows:
            return srv.OrderHistoryResponse(False, f"no order {request.order_id}", [], [], 0.0)
        number = request.order_id
        likely, units = self._host.carry_out(lambda shift: shift.likely_completion(number))
        events = [stored_order_event(row) for row in rows]
        return srv.OrderHistoryResponse(True, "", events, units, likely)

    def _set_station(self, request: Any) -> Any:
        if request.mode not in (srv.SetStationRequest.AUTOMATIC, srv.SetStationRequest.MANUAL):
            text = f"mode is {request.mode}; 0 (AUTOMATIC) or 1 (MANUAL) was expected"
            return srv.SetStationResponse(False, text)
        fields = request.station, request.open, request.mode
        return srv.SetStationResponse(
            *self._host.carry_out(lambda shift: shift.set_station(*fields))
        )

    def _confirm(self, request: Any) -> Any:
        fields = request.station, request.sku, request.quantity
        return srv.ConfirmPickResponse(
            *self._host.carry_out(lambda shift: shift.confirm_pick(*fields))
        )

    def _report_short(self, request: Any) -> Any:
        fields = request.station, request.sku, request.quantity, request.damaged
        return srv.ReportShortResponse(
            *self._host.carry_out(lambda shift: shift.report_short(*fields))
        )

    def _report_pick(self, request: Any) -> Any:
        if request.outcome not in PickOutcome.__members__.values():
            text = f"outcome is {request.outcome}; 0 (DONE), 1 (SHORT) or 2 (DAMAGED) was expected"
            return srv.ReportPickResponse(False, text, 0)
        if len(request.id) > LONGEST_ID:
            text = f"the id has {len(request.id)} characters; {LONGEST_ID} at most were expected"
            return srv.ReportPickResponse(False, text, 0)
        fields = request.station, request.order_id, request.item, request.sequence
        report = Report(*fields, request.quantity, PickOutcome(request.outcome), request.id)
        answer = self._host.carry_out(lambda shift: shift.tasks.report(report))
        self._host.publish_stations()
        return srv.ReportPickResponse(answer.success, answer.message, answer.quantity)

    def _undo_write_off(self, request: Any) -> Any:
        done = self._host.carry_out(
            lambda shift: shift.tasks.undo(request.station, request.sequence)
        )
        self._host.publish_stations()
        return srv.UndoWriteOffResponse(*done)

    def _find_orders(self, request: Any) -> Any:
        total, orders = queries.find_orders(
            self._host.engine,
            request.order_id,
            request.search,
            None if request.state < 0 else request.state,
            request.limit,
            request.offset,
            self._host.shift.now if request.late else None,
        )
        return srv.FindOrdersResponse(total, [stored_order_status(*row) for row in orders])

    def _find_stock(self, request: Any) -> Any:
        total, pieces, bins = queries.find_stock(
            self._host.engine, request.sku, request.limit, request.offset
        )
        return srv.FindStockResponse(total, pieces, [stock_place(bin_) for bin_ in bins])

    def _find_skus(self, request: Any) -> Any:
        inventory = self._host.shift.inventory
        matching = queries.matching(self._host.shift.assortment.skus, request.search)
        shown = matching[: min(request.limit, queries.MOST_ROWS)]
        available = [max(0, inventory.available(sku)) for sku in shown]
        return srv.FindSkusResponse(len(matching), shown, available)
