# SPDX-License-Identifier: Apache-2.0
"""Orders that come as a table in CSV: all of them are accepted, or none."""

from dataclasses import dataclass, field

from warehouse_operations.shift.order_book import TOO_MANY, OrderBook
from warehouse_operations.stock import acceptance
from warehouse_operations.stock.order_file import Fault, OrderDraft, parse_csv

MOST_ORDERS = 5_000  # of a table


@dataclass
class TableAnswer:
    """The result of a table. `order_ids` is empty where it was only checked, or has faults."""

    faults: list[Fault]
    references: list[str] = field(default_factory=list)
    order_ids: list[int] = field(default_factory=list)
    lines: int = 0
    pieces: int = 0


def submit(book: OrderBook, table: str, check_only: bool = False) -> TableAnswer:
    """Submits the orders of a table to an OrderBook (see order_file): all, or none if any is faulty
    or with check_only."""
    drafts, faults = parse_csv(table, set(book.skus), book.capacity)
    faults = faults or _faults_of_all(drafts, book)
    answer = TableAnswer(
        faults,
        [draft.reference for draft in drafts],
        lines=sum(len(draft.lines) for draft in drafts),
        pieces=sum(pieces for draft in drafts for _, pieces in draft.lines),
    )
    if faults or check_only:
        return answer
    for draft in drafts:
        order, why = book.submit(draft.lines, draft.due, draft.priority, draft.reference)
        if order:
            answer.order_ids.append(order.order_id)
        else:  # impossible after the check above
            answer.faults.append(Fault(0, "", f"{draft.reference} is refused: {why}"))
    return answer


def _faults_of_all(drafts: list[OrderDraft], book: OrderBook) -> list[Fault]:
    """Returns the faults of the orders as a whole."""
    if not drafts:
        return [Fault(0, "", "there is no order in it")]
    if len(drafts) > MOST_ORDERS:
        return [Fault(0, "", f"{len(drafts)} orders; {MOST_ORDERS} or fewer were expected")]
    late = [draft.reference for draft in drafts if draft.at]
    if late:
        text = f"orders that are sent come at once; leave the column at out, or 0 ({late[0]})"
        return [Fault(0, "at", text)]
    if book.backlog.lines + sum(len(draft.lines) for draft in drafts) > acceptance.MOST_WAITING:
        return [Fault(0, "", TOO_MANY)]
    return []
