# SPDX-License-Identifier: Apache-2.0
"""The phases of both sides follow one another as their tables say, and as those are documented."""

import re

import pytest

from warehouse_vda5050.master import remote_vehicle
from warehouse_vda5050.vehicle import phase


@pytest.mark.parametrize("module", [phase, remote_vehicle])
def test_the_documented_table_is_the_one_that_holds(module):
    rows = re.findall(r"^ {4}([A-Z_, ]+?) {2,}\S.*? +([A-Z_]+)$", module.Phase.__doc__, re.M)
    documented = {
        (before, after) for left, after in rows for before in left.replace(",", "").split()
    }
    held = {(a.name, b.name) for a, following in module.FOLLOWS.items() for b in following}
    assert documented == held and set(module.FOLLOWS) == set(module.Phase)


@pytest.mark.parametrize("module", [phase, remote_vehicle])
def test_each_phase_is_reached_and_left(module):
    reached = {b for following in module.FOLLOWS.values() for b in following}
    assert reached == set(module.Phase) and all(module.FOLLOWS.values())
