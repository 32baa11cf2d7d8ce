# SPDX-License-Identifier: Apache-2.0
"""The errors that a vehicle reports: of messages, of the order under way, of the robot."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from dataclasses import replace

from warehouse_vda5050.driver import Report
from warehouse_vda5050.errors import Error, ErrorLevel, ErrorType, Predefined
from warehouse_vda5050.model import ActionState, ActionStatus, VehicleOrder
from warehouse_vda5050.topics import Kind
from warehouse_vda5050.vehicle.journal import Journal
from warehouse_vda5050.vehicle.progress import OrderProgress

KEPT = 10
HINT = "cancelOrder, then a new order"
RETRY_HINT = "retry, skipRetry or cancelOrder"


class Complaints:
    """Errors of messages, until the next order or update is accepted, and those that hold now."""

    def __init__(self, journal: Journal) -> None:
        self._journal = journal
        self._noted: deque[Error] = deque(maxlen=KEPT)

    def note(self, error: Error) -> None:
        """Adds an error of a message."""
        if error not in self._noted:
            self._noted.append(error)
            self._journal.write(f"{error.type}: {error.description}")

    def note_unknown(self, topic: Kind, fields: tuple[str, ...]) -> None:
        """Adds fields of a message that no version has; the message counts all the same."""
        if fields:
            names = ", ".join(fields[:5]) + (" …" if len(fields) > 5 else "")
            kind, refer = ErrorType.UNKNOWN_FIELD.value, (("topic", topic.value),)
            self.note(Error(kind, description=f"ignored: {names}", references=refer))

    def clear(self) -> None:
        """Forgets what was noted: an order was accepted."""
        self._noted.clear()

    def __len__(self) -> int:
        return len(self._noted)

    def all(self, report: Report | None, of_order: Iterable[Error]) -> tuple[Error, ...]:
        """Returns all errors: those noted, those of the robot's report, and the order's."""
        errors = [*self._noted, *(report.errors if report else ())]
        if report and report.silent:
            errors.append(Error(ErrorType.SILENT.value, ErrorLevel.FATAL, report.silent))
        errors += of_order
        return tuple(replace(error, description=error.description[:500]) for error in errors)


def of_order(order: OrderProgress, fault: str, failed: Iterable[ActionState]) -> Iterable[Error]:
    """Yields the errors of an order: `fault`, why it is not driven, and its `failed` actions."""
    if fault:
        yield _order_fault(order, fault)
    yield from (_action_fault(order, state) for state in failed)


def _order_fault(order: OrderProgress, text: str) -> Error:
    refer, precise = references(order), Predefined.NODE_UNREACHABLE
    return Error(ErrorType.ORDER.value, ErrorLevel.WARNING, text, HINT, refer, precise)


def _action_fault(order: OrderProgress, state: ActionState) -> Error:
    text = f"{state.type} failed{'' if order.is_driven else _STAYS}: {state.result}"
    refer = (*references(order), ("actionId", state.id[:100]))
    hint = "" if order.is_driven else HINT
    if state.status is ActionStatus.RETRIABLE:
        text, hint = f"{state.type} failed, and may be retried: {state.result}", RETRY_HINT
    return Error(ErrorType.ORDER_ACTION.value, ErrorLevel.WARNING, text, hint, refer)


_STAYS = ", and the robot stays where it is"


def references(order: VehicleOrder | OrderProgress) -> tuple[tuple[str, str], ...]:
    """Returns what masters find an order's errors by."""
    topic = ("topic", Kind.ORDER.value)
    return topic, ("orderId", order.id[:100]), ("orderUpdateId", str(order.update))
