# SPDX-License-Identifier: Apache-2.0
"""Orders that come as a table in CSV: all of them are accepted, or none."""

from dataclasses import dataclass, field

from warehouse_operations.shift.order_book import TOO_MANY, OrderBook
from warehouse_operations.stock import acceptance
from warehouse_operations.stock.order_file import Fault, Wanted, parse_csv

MOST_ORDERS = 5_000  # of a table


@dataclass
class TableAnswer:
    """What became of a table. `order_ids` is empty where it was only checked, or has faults."""

    faults: list[Fault]
    references: list[str] = field(default_factory=list)
    order_ids: list[int] = field(default_factory=list)
    lines: int = 0
    pieces: int = 0


def submit(book: OrderBook, table: str, check_only: bool = False) -> TableAnswer:
    """Takes the orders of a table into an OrderBook; see order_file. None of them with check_only,
    or where anything is wrong."""
    wanted, faults = parse_csv(table, set(book.skus), book.capacity)
    faults = faults or _faults_of_all(wanted, book)
    answer = TableAnswer(
        faults,
        [one.reference for one in wanted],
        lines=sum(len(one.lines) for one in wanted),
        pieces=sum(pieces for one in wanted for _, pieces in one.lines),
    )
    if faults or check_only:
        return answer
    for one in wanted:
        order, why = book.submit(one.lines, one.due, one.priority, one.reference)
        if order:
            answer.order_ids.append(order.order_id)
        else:  # what was checked above forbids it
            answer.faults.append(Fault(0, "", f"{one.reference} is refused: {why}"))
    return answer


def _faults_of_all(wanted: list[Wanted], book: OrderBook) -> list[Fault]:
    """Returns what is wrong with the orders together."""
    if not wanted:
        return [Fault(0, "", "there is no order in it")]
    if len(wanted) > MOST_ORDERS:
        return [Fault(0, "", f"{len(wanted)} orders; {MOST_ORDERS} or fewer were expected")]
    late = [one.reference for one in wanted if one.at]
    if late:
        text = f"orders that are sent come at once; leave the column at out, or 0 ({late[0]})"
        return [Fault(0, "at", text)]
    if book.backlog.lines + sum(len(one.lines) for one in wanted) > acceptance.MOST_WAITING:
        return [Fault(0, "", TOO_MANY)]
    return []
