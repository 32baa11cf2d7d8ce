# SPDX-License-Identifier: Apache-2.0
"""The cases of zones find what breaks a rule of zones. MUTANTS=all takes all, by default each
third."""

import os

import pytest
from mutants import found_by
from zone_mutants import MUTANTS

from warehouse_vda5050.conform.cases import zones

STRIDE = 1 if os.environ.get("MUTANTS") == "all" else 3


@pytest.mark.parametrize("name", [*MUTANTS][::STRIDE])
def test_found(name):
    case = found_by(MUTANTS[name], zones.chapter.cases, "3.0.0")
    assert case and case[0] != "begin", MUTANTS[name].rule
