# SPDX-License-Identifier: Apache-2.0
"""conform finds what breaks a rule. MUTANTS=all takes all of them, by default each sixth."""

import os

import pytest
from mutants import MUTANTS, found_by

STRIDE = 1 if os.environ.get("MUTANTS") == "all" else 6


def test_there_are_many_each_of_another_rule():
    rules = {mutant.rule for mutant in MUTANTS.values()}
    assert len(MUTANTS) > 150 and len(rules) > 0.9 * len(MUTANTS)


@pytest.mark.parametrize("name", [*MUTANTS][::STRIDE])
def test_found(name):
    assert found_by(MUTANTS[name]), MUTANTS[name].rule
