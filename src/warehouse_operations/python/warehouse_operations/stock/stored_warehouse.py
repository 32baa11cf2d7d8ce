# SPDX-License-Identifier: Apache-2.0
"""A warehouse at rest: the start of a shift after the last one ended or was killed."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from warehouse_operations.stock.assortment import Assortment
from warehouse_operations.stock.inventory import Bin
from warehouse_operations.stock.orders import Order


@dataclass(frozen=True)
class Stored:
    """A warehouse at rest: nothing is promised or under way, units stand, orders wait.

    former: the ids of bins that are gone, by item. last_bin, last_order: the highest ids so far.
    orders: those that are not over, with the times of a run that begins at `now`. layout: what
    returning.layout_of gave the last run; None where an older version wrote the database.
    """

    assortment: Assortment
    bins: list[Bin]
    former: dict[str, int]
    last_bin: int
    orders: list[Order]
    last_order: int
    layout: list[Any] | None


@dataclass(frozen=True)
class Changes:
    """The differences between the bins of a warehouse and of its database.

    gone: bins of the database that have left the warehouse. new: empty bins that the database
    lacks. moved: bins on another unit than before.
    """

    gone: list[Bin]
    new: list[Bin]
    moved: list[Bin]

    def __str__(self) -> str:
        sentences = []
        if self.gone:
            pieces = sum(bin_.quantity + (bin_.fallen or 0) for bin_ in self.gone)
            sentences.append(f"{_named(self.gone)} gone: {pieces} pieces are written off")
        if self.new:
            sentences.append(f"{_named(self.new)} new, and still empty")
        if self.moved:
            sentences.append(f"{_named(self.moved)} on another storage unit than before")
        return "; ".join(sentences)


def _named(bins: Sequence[Bin]) -> str:
    """Returns words for bins with the first units by name, and the verb."""
    units = sorted({bin_.unit for bin_ in bins})
    names = ", ".join(map(str, units[:5])) + (f" and {len(units) - 5} more" if units[5:] else "")
    which = f"{len(bins)} bins" if len(bins) > 1 else bins[0].item
    where = f"storage unit{'s' if len(units) > 1 else ''} {names}"
    return f"{which} of {where} {'are' if len(bins) > 1 else 'is'}"
