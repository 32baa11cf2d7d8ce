# SPDX-License-Identifier: Apache-2.0
"""Policies that choose the bin for new stock."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from warehouse_operations.stock.inventory import Bin
from warehouse_operations.stock.orders import Bundle

if TYPE_CHECKING:
    from warehouse_operations.policies.view import View


class Random:
    """Chooses any bin."""

    def choose(self, bundle: Bundle, candidates: Sequence[Bin], view: "View") -> Bin:
        """Returns the bin, one of candidates, that a bundle goes to."""
        return candidates[view.rng.integers(len(candidates))]


class Emptiest:
    """Chooses the emptiest bin of the emptiest unit."""

    def choose(self, bundle: Bundle, candidates: Sequence[Bin], view: "View") -> Bin:
        """Returns the bin, one of candidates, that a bundle goes to."""
        return max(candidates, key=lambda bin_: (view.room(bin_.unit), bin_.room, -bin_.bin_id))


class SameSku:
    """Chooses the fullest bin that has room among those of the same SKU; else the emptiest."""

    def choose(self, bundle: Bundle, candidates: Sequence[Bin], view: "View") -> Bin:
        """Returns the bin, one of candidates, that a bundle goes to."""
        return max(
            candidates,
            key=lambda bin_: (bin_.sku == bundle.sku and not bin_.empty, -bin_.room, -bin_.bin_id),
        )


class Turnover:
    """Stores SKUs with much demand on units near the stations, the others far away."""

    def choose(self, bundle: Bundle, candidates: Sequence[Bin], view: "View") -> Bin:
        """Returns the bin, one of candidates, that a bundle goes to."""
        rank = view.popularity_rank(bundle.sku)

        def distance(bin_: Bin) -> float:
            cell = view.cell(bin_.unit)
            return abs(float(view.place_rank([cell])[0]) - rank) if cell is not None else 1.0

        return min(candidates, key=lambda bin_: (distance(bin_), bin_.bin_id))


NAMES: dict[str, type] = {
    "random": Random,
    "emptiest": Emptiest,
    "same sku": SameSku,
    "turnover": Turnover,
}
