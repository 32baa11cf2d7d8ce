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
    for one in bins:
        if pieces := int(rng.integers(0, 6)):
            inventory.move(one, one.sku, pieces, Reason.INITIAL)
        if one.quantity:
            inventory.reserve(one, int(rng.integers(0, one.quantity + 1)))
    return inventory


def looked_up(lines, inventory, free):
    found = {}
    for line in lines:
        for one in inventory.bins.values():
            if one.sku == line.sku and one.available and one.unit in free:
                there = found.setdefault(one.unit, {})
                there[line] = min(line.missing, there.get(line, 0) + one.available)
    return found


@pytest.mark.parametrize("seed", range(20))
def test_candidates_are_those_of_the_bins(seed):
    rng = np.random.default_rng(seed)
    inventory = stocked(rng)
    free = UnitSet((*range(1, 15, 2), 4, 8))
    lines = Order(1, [(sku, int(rng.integers(1, 5))) for sku in SKUS[:4]], 0.0).lines
    for _ in range(3):
        wanted, found = looked_up(lines, inventory, free), Candidates(lines, inventory, free)
        assert {unit: dict(found[unit]) for unit in found} == wanted
        assert len(found) == len(wanted)
        completed = [sum(n >= line.missing for line, n in wanted[u].items()) for u in found]
        assert found.completes.tolist() == completed
        assert found.pieces.tolist() == [sum(wanted[unit].values()) for unit in found]
        for one in list(inventory.bins.values())[::7]:  # what changes later is seen
            inventory.move(one, one.sku, one.reserved - one.quantity, Reason.SHORT)


def test_units_without_the_pieces_are_none():
    inventory = Inventory([Bin(1, "item1", 1, 12, "sku-0")])
    lines = Order(1, [("sku-0", 1), ("sku-5", 1)], 0.0).lines
    assert not Candidates(lines, inventory, UnitSet([1]))
