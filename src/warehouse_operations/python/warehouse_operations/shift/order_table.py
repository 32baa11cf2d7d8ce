# SPDX-License-Identifier: Apache-2.0
"""Orders that come as a table in CSV: all of them are accepted, or none."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from warehouse_operations.shift.order_book import TOO_MANY
from warehouse_operations.stock import acceptance
from warehouse_operations.stock.order_file import Fault, Wanted, parse_csv

if TYPE_CHECKING:
    from warehouse_operations.shift.shift import Shift

MOST_ORDERS = 5_000  # of a table


@dataclass
class TableAnswer:
    """What became of a table. `order_ids` is empty where it was only checked, or has faults."""

    faults: list[Fault]
    references: list[str] = field(default_factory=list)
    order_ids: list[int] = field(default_factory=list)
    lines: int = 0
    pieces: int = 0


def submit(shift: "Shift", table: str, check_only: bool = False) -> TableAnswer:
    """Takes the orders of a table into a shift; see order_file. None of them with check_only, or
    where anything is wrong."""
    wanted, faults = parse_csv(table, set(shift.assortment.skus), shift.inventory.capacity)
    faults = faults or _faults_of_all(wanted, shift)
    answer = TableAnswer(
        faults,
        [one.reference for one in wanted],
        lines=sum(len(one.lines) for one in wanted),
        pieces=sum(pieces for one in wanted for _, pieces in one.lines),
    )
    if faults or check_only:
        return answer
    for one in wanted:
        order, why = shift.submit(one.lines, one.due, one.priority, one.reference)
        if order:
            answer.order_ids.append(order.order_id)
        else:  # what was checked above forbids it
            answer.faults.append(Fault(0, "", f"{one.reference} is refused: {why}"))
    return answer


def _faults_of_all(wanted: list[Wanted], shift: "Shift") -> list[Fault]:
    """Returns what is wrong with the orders together."""
    if not wanted:
        return [Fault(0, "", "there is no order in it")]
    if len(wanted) > MOST_ORDERS:
        return [Fault(0, "", f"{len(wanted)} orders; {MOST_ORDERS} or fewer were expected")]
    late = [one.reference for one in wanted if one.at]
    if late:
        text = f"orders that are sent come at once; leave the column at out, or 0 ({late[0]})"
        return [Fault(0, "at", text)]
    if shift.backlog.lines + sum(len(one.lines) for one in wanted) > acceptance.MOST_WAITING:
        return [Fault(0, "", TOO_MANY)]
    return []
