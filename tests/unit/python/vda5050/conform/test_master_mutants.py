# SPDX-License-Identifier: Apache-2.0
"""conform --master finds what breaks a rule. MUTANTS=all takes all of them, by default each
tenth."""

import os

import pytest
from master_mutants import MUTANTS, found_by

STRIDE = 1 if os.environ.get("MUTANTS") == "all" else 10


def test_there_are_many_each_of_another_rule():
    rules = {mutant.rule for mutant in MUTANTS.values()}
    assert len(MUTANTS) > 60 and len(rules) == len(MUTANTS)


@pytest.mark.parametrize("name", [*MUTANTS][::STRIDE])
def test_found(name):
    assert found_by(MUTANTS[name]), MUTANTS[name].rule
