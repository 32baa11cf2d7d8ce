# SPDX-License-Identifier: Apache-2.0
"""conform --master finds what breaks a rule of zones or planned paths. MUTANTS=all takes all, by
default each fourth."""

import os

import pytest
from master_mutants import found_by
from master_zone_mutants import CHAPTERS, MUTANTS

STRIDE = 1 if os.environ.get("MUTANTS") == "all" else 4


@pytest.mark.parametrize("name", [*MUTANTS][::STRIDE])
def test_found(name):
    assert found_by(MUTANTS[name], "3.0.0", CHAPTERS), MUTANTS[name].rule
