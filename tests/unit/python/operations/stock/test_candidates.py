# SPDX-License-Identifier: Apache-2.0
"""The units that could serve a station's lines, found in arrays, are those that a look at each bin
finds."""

import numpy as np
import pytest

from warehouse_operations.stock.candidates import Candidates
from warehouse_operations.stock.inventory import Bin, Inventory, Reason
from warehouse_operations.stock.orders import Order
from warehouse_operations.stock.units_by_id import UnitSet

SKUS = [f"sku-{i}" for i in range(6)]


def stocked(rng):
    bins = [
        Bin(i + 1, f"item{i + 1}", int(rng.integers(1, 15)), 12, str(rng.choice(SKUS)))
        for i in range(60)
    ]
    inventory = Inventory(bins)
    for bin_ in bins:
        if pieces := int(rng.integers(0, 6)):
            inventory.move(bin_, bin_.sku, pieces, Reason.INITIAL)
        if bin_.quantity:
            inventory.reserve(bin_, int(rng.integers(0, bin_.quantity + 1)))
    return inventory


def looked_up(lines, inventory, free):
    by_unit = {}
    for line in lines:
        for bin_ in inventory.bins.values():
            if bin_.sku == line.sku and bin_.available and bin_.unit in free:
                there = by_unit.setdefault(bin_.unit, {})
                there[line] = min(line.missing, there.get(line, 0) + bin_.available)
    return by_unit


@pytest.mark.parametrize("seed", range(20))
def test_candidates_are_those_of_the_bins(seed):
    rng = np.random.default_rng(seed)
    inventory = stocked(rng)
    free = UnitSet((*range(1, 15, 2), 4, 8))
    lines = Order(1, [(sku, int(rng.integers(1, 5))) for sku in SKUS[:4]], 0.0).lines
    for _ in range(3):
        expected, candidates = looked_up(lines, inventory, free), Candidates(lines, inventory, free)
        assert {unit: dict(candidates[unit]) for unit in candidates} == expected
        assert len(candidates) == len(expected)
        completed = [sum(n >= line.missing for line, n in expected[u].items()) for u in candidates]
        assert candidates.completes.tolist() == completed
        assert candidates.pieces.tolist() == [sum(expected[unit].values()) for unit in candidates]
        for bin_ in list(inventory.bins.values())[::7]:  # what changes later is seen
            inventory.move(bin_, bin_.sku, bin_.reserved - bin_.quantity, Reason.SHORT)


def test_units_without_the_pieces_are_none():
    inventory = Inventory([Bin(1, "item1", 1, 12, "sku-0")])
    lines = Order(1, [("sku-0", 1), ("sku-5", 1)], 0.0).lines
    assert not Candidates(lines, inventory, UnitSet([1]))
