# SPDX-License-Identifier: Apache-2.0
"""A fleet works in whatever warehouse the check of layout files passes; LAYOUTS=200 for more."""

import os

import pytest
from random_layout import layout

from kiva_plugin_cpp import World
from warehouse_layout.file import layout_file
from warehouse_layout.place import file_check
from warehouse_operations import Operations
from warehouse_operations.runs import layout_site
from warehouse_operations.stock.site import Site

LAYOUTS = int(os.environ.get("LAYOUTS", "30"))
WITH_PHYSICS = 10 if LAYOUTS <= 30 else 1  # of so many, one is run with physics too
MINUTES = 10


@pytest.mark.parametrize("seed", range(LAYOUTS))
def test_a_fleet_works_in_what_the_check_passes(seed, tmp_path):
    path = tmp_path / "random.layout.yaml"
    layout_file.write(layout(seed), path)
    file = layout_file.read(path)
    faults = file_check.faults(file)
    if faults:
        assert all(len(fault.text) > 20 and fault.text[0] != "[" for fault in faults)
        with pytest.raises(ValueError) as refused:
            World.layout(path)
        assert len(str(refused.value).splitlines()) == len(faults)
        return
    works(path, file, physics=False)
    if seed % WITH_PHYSICS == 0:
        works(path, file, physics=True)


def works(path, file, physics):
    world = World.layout(path)
    site = layout_site.of_file(Site.of_world(world), file)
    with Operations(world, site=site, physics=physics) as ops:
        ops.run(minutes=MINUTES)
        kpis = ops.kpis()
        assert not kpis["collisions"] and not ops.fleet.stuck
        # Orders wait all the time: pieces are picked in the second half as in the first.
        assert sum(n for minute, n in ops.shift.tally.picked_in.items() if minute >= MINUTES / 2)


def test_enough_of_them_pass_for_that_to_mean_something():
    passing = [seed for seed in range(LAYOUTS) if not file_check.faults(layout(seed))]
    assert len(passing) >= LAYOUTS / 10 and len(passing) < LAYOUTS / 2
