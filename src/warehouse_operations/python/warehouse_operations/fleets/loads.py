# SPDX-License-Identifier: Apache-2.0
"""The masses of items and of what lies on storage units, as pieces come and go."""

import math

from warehouse_layout.file.item_weights import ItemWeights
from warehouse_operations.stock.inventory import Bin, Inventory

ITEM_KG = 1.5  # of worlds/models/item


class Loads:
    """The masses of a stock. weights: by SKU; None: all items weigh as their model."""

    def __init__(self, inventory: Inventory, weights: ItemWeights | None = None) -> None:
        self._inventory, self._weights = inventory, weights

    def of_item(self, bin_: Bin) -> float:
        """Returns the mass of an item [kg]."""
        pieces = bin_.quantity if bin_.fallen is None else bin_.fallen
        mass = self._weights.of(bin_.sku, pieces) if self._weights else math.nan
        return ITEM_KG if math.isnan(mass) else mass

    def of_unit(self, unit: int) -> float:
        """Returns the mass of the items on a storage unit [kg]."""
        return sum(map(self.of_item, self._inventory.of_unit.get(unit, ())))
