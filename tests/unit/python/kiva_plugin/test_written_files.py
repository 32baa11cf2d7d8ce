# SPDX-License-Identifier: Apache-2.0
"""Files that scripts write are those that the scripts would write now."""

import subprocess
import sys

import pytest
from paths import ROOT


@pytest.mark.parametrize("script", ["stubs", "message_enums"])
def test_what_scripts_write_is_up_to_date(script):
    command = [sys.executable, ROOT / "scripts" / script, "--check"]
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
