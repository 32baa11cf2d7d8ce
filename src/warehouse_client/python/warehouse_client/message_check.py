# SPDX-License-Identifier: Apache-2.0
"""Subscribers that check the fields of each message.

Any program may publish on a topic. A message with arrays of different lengths, undefined kinds or
numbers that are not finite is dropped here with a warning: the code behind a subscriber gets valid
ones alone. Nodes subscribe by subscribe(), and by nothing else.
"""

import math
import time
from collections.abc import Callable, Iterator, Sequence
from functools import cache
from typing import Any

import numpy as np
from roslib.message import get_message_class

from warehouse_client.message_contracts import CONTRACTS, Contract, Kinds

MOST = 1e12  # largest magnitude of a number: its square is finite, and its rounded value an int64
AGAIN = 60.0  # between two warnings about a topic [s, wall]
FLOATS = ("float32", "float64")
SHOWN = 40  # characters of a value in a warning
NO_CONTRACT = Contract()

Check = Callable[[Any], str]  # returns the fault of a message, or ""


def subscribe(
    ros: Any, topic: str, kind: Any, take: Callable[..., object], *args: Any, **options: Any
) -> Any:
    """Returns a rospy.Subscriber that calls take(message, *args) for each sound message.

    ros: rospy, or what stands in for it in a test. options: those of rospy.Subscriber, but
    tcp_nodelay is True by default: without it the publisher holds a message back for up to 40 ms,
    until the subscriber's system has acknowledged the message before it.
    """
    options.setdefault("tcp_nodelay", True)
    gate = Gate(ros, topic, kind, lambda message: take(message, *args))
    gate.subscriber = ros.Subscriber(topic, kind, gate.pass_on, **options)
    return gate.subscriber


def wait_for(ros: Any, topic: str, kind: Any, timeout: float) -> Any:
    """Returns the next sound message of a topic. Raises rospy.ROSException after `timeout` [s]."""
    end = time.monotonic() + timeout
    while True:
        message = ros.wait_for_message(topic, kind, max(0.001, end - time.monotonic()))
        if not fault(message):
            return message


class Gate:
    """Passes the sound messages of a topic on to take(message); warns of others.

    Messages of the world, the coordinator or a shift are accepted from that node alone while it
    publishes, and events of robots behind a broker from their master: a valid message of another
    program would replace its state until the next one.
    """

    def __init__(self, ros: Any, topic: str, kind: Any, take: Callable[[Any], object]) -> None:
        self._ros, self._topic, self._take = ros, topic, take
        contract = CONTRACTS.get(kind._type, NO_CONTRACT)
        self._source, self._beside = contract.source, contract.beside
        self._next = -math.inf  # when to warn again
        self.subscriber: Any = None  # rospy's, once there is one

    def pass_on(self, message: Any) -> None:
        """Takes a message as rospy brings it."""
        reason = fault(message) or self._foreign(message)
        if not reason:
            self._take(message)
        elif time.monotonic() >= self._next:
            self._next = time.monotonic() + AGAIN
            self._ros.logwarn(f"{self._topic}: a message is dropped: {reason}")

    def _foreign(self, message: Any) -> str:
        """Returns why a message of a foreign publisher is ignored; "" if it is accepted."""
        header = getattr(message, "_connection_header", None)
        subscription = getattr(self.subscriber, "impl", None)  # None before and after it
        if not self._source or not header or subscription is None:
            return ""
        sender, source = header.get("callerid"), self._ros.resolve_name(self._source)
        heard = {connection.callerid_pub for connection in subscription.connections}
        accepted = {source, *map(self._ros.resolve_name, self._beside)}
        is_foreign = sender not in accepted and source in heard
        return f"it is from {sender}; {source} publishes this topic" if is_foreign else ""


def fault(message: Any) -> str:
    """Returns the fault of a message: field, value, what was expected; "" for a valid one."""
    return next(filter(None, (check(message) for check in _checks(message._type))), "")


def fit(objects: Any, states: Any) -> bool:
    """Returns whether a WarehouseObjects and a UnitStates are of the same revision; False for None.

    Between the two messages of a change the revisions differ; the second is on its way.
    """
    if objects is None or states is None or objects.revision != states.revision:
        return False
    are_items = all(0 <= item < len(objects.items) for item in states.loose_item)
    return are_items and len(objects.storage_units) == len(states.carrier)


@cache
def _checks(message_type: str) -> tuple[Check, ...]:
    """Returns the checks of a message type; () if any content is valid."""
    kind = get_message_class(message_type)
    contract = CONTRACTS.get(message_type, NO_CONTRACT)
    fields = zip(kind.__slots__, kind._slot_types)
    return (
        *(check for name, type_ in fields for check in _field_checks(name, type_, contract)),
        *(_table_check(table, contract.optional) for table in contract.tables),
        *(_total_check(name, parts) for name, parts in contract.totals.items()),
        *(_index_check(name, *bounds) for name, bounds in contract.indices.items()),
    )


def _field_checks(name: str, type_: str, contract: Contract) -> Iterator[Check]:
    base, _, array = type_.partition("[")
    if base in FLOATS and name not in contract.any_number:
        yield _of_values(name, array, _number_fault)
    if name in contract.positive:
        yield _of_values(name, array, _positive_fault)
    if name in contract.kinds:
        yield _of_values(name, array, _kind_fault, contract.kinds[name])
    if name in contract.names:
        yield _of_values(name, array, _name_fault, contract.names[name])
    if name in contract.ids:
        yield _of_values(name, array, _id_fault)
    if "/" in base and _checks(base):
        yield _of_messages(name, array)


def _of_values(name: str, array: str, find: Callable[..., str], *args: Any) -> Check:
    """Returns the check of a field by find(values, *args)."""

    def check(message: Any) -> str:
        value = getattr(message, name)
        reason = find(value if array else (value,), *args)
        return reason and f"{name} {reason}"

    return check


def _of_messages(name: str, array: str) -> Check:
    """Returns the check of a field that holds messages."""

    def check(message: Any) -> str:
        value = getattr(message, name)
        for i, inner in enumerate(value if array else (value,)):
            if reason := fault(inner):
                return f"{name}[{i}].{reason}" if array else f"{name}.{reason}"
        return ""

    return check


def _number_fault(values: Sequence[float]) -> str:
    # The norm of all values is at least the largest magnitude, and NaN if any value is: a tenth of
    # the time of a check of each.
    if isinstance(values, tuple | list) and math.hypot(*values) <= MOST:
        return ""
    array = np.asarray(values, float)
    wrong = ~(np.abs(array) <= MOST)
    return _said(array[wrong][0], f"a finite number up to {MOST:.0e}") if wrong.any() else ""


def _positive_fault(values: Sequence[float]) -> str:
    wrong = [value for value in values if not value > 0]
    return _said(wrong[0], "a number above 0") if wrong else ""


def _kind_fault(values: Sequence[Any], kinds: Kinds) -> str:
    wrong = set(values) - kinds.keys()
    choices = ", ".join(str(k) if k == n else f"{k} ({n})" for k, n in kinds.items())
    return _said(min(wrong), f"one of {choices}") if wrong else ""


def _name_fault(values: Sequence[str], prefix: str) -> str:
    for value in values:
        number = value.removeprefix(prefix)
        if not value.startswith(prefix) or not (number.isascii() and number.isdigit()):
            return _said(value, f"{prefix} and a number")
    return "" if len(set(values)) == len(values) else "holds a name twice; each once was expected"


def _id_fault(values: Sequence[int]) -> str:
    if len(values) and min(values) < 1:
        return _said(min(values), "a number above 0")
    return "" if len(set(values)) == len(values) else "holds a number twice; each once was expected"


def _table_check(table: str, optional: frozenset[str]) -> Check:
    """Returns the check of the lengths of a table's columns: "carrier pose:7"."""
    columns = (column.partition(":") for column in table.split())
    widths = {name: int(width or 1) for name, _, width in columns}
    first = next(iter(widths))

    def check(message: Any) -> str:
        rows = len(getattr(message, first))
        for name, width in widths.items():
            length = len(getattr(message, name))
            if length != rows * width and (length or name not in optional):
                text = f"{rows * width} for the {rows} in {first}"
                return f"{name} has {length} entries; {text} were expected"
        return ""

    return check


def _total_check(name: str, parts: Sequence[str]) -> Check:
    """Returns the check of a field's length, which is the sum of other fields."""

    def check(message: Any) -> str:
        length, total = len(getattr(message, name)), sum(sum(getattr(message, p)) for p in parts)
        text = f"{total}, the sum of {' and '.join(parts)}, were expected"
        return f"{name} has {length} entries; {text}" if length != total else ""

    return check


def _index_check(name: str, lowest: int, of: str) -> Check:
    """Returns the check of a field of indices into another one."""

    def check(message: Any) -> str:
        value, end = getattr(message, name), len(getattr(message, of))
        values = (value,) if isinstance(value, int) else value
        if not len(values) or (min(values) >= lowest and max(values) < end):
            return ""
        wrong = min(values) if min(values) < lowest else max(values)
        return f"{name} {_said(wrong, f'{lowest} to {end - 1}, an index into {of},')}"

    return check


def _said(value: Any, expected: str) -> str:
    shown = repr(value[:SHOWN]) if isinstance(value, str) else value
    return f"is {shown}; {expected} was expected"
