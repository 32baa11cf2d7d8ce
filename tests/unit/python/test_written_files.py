# SPDX-License-Identifier: Apache-2.0
"""The type stubs of extension modules say what the built modules do."""

import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).parents[3]


def test_the_committed_stubs_are_those_of_the_built_modules():
    command = [sys.executable, REPOSITORY / "scripts" / "stubs", "--check"]
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
