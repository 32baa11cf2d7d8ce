# SPDX-License-Identifier: Apache-2.0
"""Bounds on orders, which keep one order, or a flood of them, from stopping a shift."""

import math
from collections.abc import Sequence
from typing import Any

from warehouse_layout.file.csv_table import shown

MOST_LINES = 1_000  # of one order
MOST_WAITING = 100_000  # lines of all orders without a station
REFERENCE_LENGTH = 200  # characters, as the database has room for
LAST_MOMENT = 1e10  # latest due time [s]: some 300 years


def fault_of_lines(lines: Sequence[tuple[str, int]], skus: Any, capacity: float) -> str:
    """Returns the reason to refuse an order of these (sku, pieces), a sentence; "" for an
    acceptable one.

    skus: the assortment of the warehouse. capacity: pieces that all of its bins can hold.
    """
    if not lines:
        return "an order has one line or more"
    if len(lines) > MOST_LINES:
        return f"an order of {len(lines)} lines; {MOST_LINES} or fewer were expected"
    for sku, pieces in lines:
        if sku not in skus:
            return f"there is no SKU '{shown(sku)}'"
        if not pieces > 0:
            return f"{pieces} pieces of {sku}; 1 or more was expected"
    return fault_of_pieces(sum(pieces for _, pieces in lines), capacity)


def fault_of_pieces(pieces: int, capacity: float) -> str:
    """Returns the reason to refuse an order of a number of pieces; "" for an acceptable one."""
    if pieces > capacity:
        return f"an order of {pieces} pieces; all bins of the warehouse together hold {capacity}"
    return ""


def fault_of_head(reference: str, due: float = 0.0, priority: int = 0) -> str:
    """Returns the reason to refuse the head of an order; "" for an acceptable one."""
    if len(reference) > REFERENCE_LENGTH:
        return (
            f"the reference has {len(reference)} characters; {REFERENCE_LENGTH} or fewer were "
            "expected"
        )
    if not reference.isprintable():
        return f"the reference {shown(reference)!a} has characters that can't be printed"
    if not (math.isfinite(due) and 0 <= due <= LAST_MOMENT):
        return f"due is {due:g}; 0 (at any time) to {LAST_MOMENT:g} s was expected"
    if not 0 <= priority <= 255:
        return f"priority is {priority}; 0 to 255 was expected"
    return ""
