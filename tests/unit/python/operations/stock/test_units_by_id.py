# SPDX-License-Identifier: Apache-2.0
"""Sets of units and their cells act as a set and a dictionary do, and answer for many at once."""

import numpy as np
import pytest

from warehouse_operations.stock.units_by_id import UnitCells, UnitSet


@pytest.mark.parametrize("seed", range(5))
def test_a_set_of_units_is_a_set(seed):
    rng = np.random.default_rng(seed)
    plain, units = {3, 7}, UnitSet([3, 7])
    for unit in rng.integers(1, 40, 100).tolist():
        chosen = rng.choice(["add", "discard"])
        getattr(plain, chosen)(unit)
        getattr(units, chosen)(unit)
        assert units == plain and len(units) == len(plain) and list(units) == sorted(plain)
    asked = np.arange(60)
    assert units.among(asked).tolist() == [unit in plain for unit in asked.tolist()]
    units -= {3, *range(20)}
    assert units == plain - {3, *range(20)} and -1 not in units


def test_cells_of_units_are_a_dictionary():
    cells = UnitCells({2: 10, 5: 0})
    cells[9] = 4
    assert cells.pop(2) == 10 and cells.pop(2, None) is None and cells.get(100) is None
    assert cells == {5: 0, 9: 4} and len(cells) == 2 and 2 not in cells
    assert cells.of(np.array([9, 2, 5, 77])).tolist() == [4, -1, 0, -1]
    with pytest.raises(KeyError):
        del cells[2]


def test_nothing_asked_is_nothing_answered():
    none = np.zeros(0, int)
    assert not len(UnitSet([1]).among(none)) and not len(UnitCells({}).of(none))
