# SPDX-License-Identifier: Apache-2.0
"""What items weigh by the SKU master: an item is a bin, and weighs its pieces."""

import math
from collections.abc import Mapping
from pathlib import Path

from warehouse_layout.file import sku_master

EMPTY_KG = 0.1  # an item without pieces
MOST_KG = 1e6  # of an item


class ItemWeights:
    """Masses of items by their SKUs. weights: of a piece [kg], by SKU."""

    def __init__(self, weights: Mapping[str, float]) -> None:
        self._weights = weights

    @classmethod
    def read(cls, path: str | Path) -> "ItemWeights":
        """Reads a SKU master. Raises SkuMasterError."""
        skus = sku_master.read(path)
        return cls({name: sku.weight for name, sku in skus.items() if sku.weight})

    def of(self, sku: str, pieces: int) -> float:
        """Returns the mass of an item with pieces of a SKU [kg]; NaN for a SKU without a weight:
        the item weighs as its model."""
        weight = self._weights.get(sku)
        if weight is None:
            return math.nan
        return min(max(weight * pieces, EMPTY_KG), MOST_KG)
