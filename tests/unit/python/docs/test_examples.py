# SPDX-License-Identifier: Apache-2.0
"""Examples that need no warehouse run as they stand; `make docs-test` runs the others."""

import subprocess
import sys

from paths import ROOT


def run(*arguments):
    command = [sys.executable, ROOT / "scripts/docs_examples", *arguments]
    return subprocess.run(command, text=True, capture_output=True, check=False)


def test_python_and_yaml_run():
    done = run("--kind", "python", "yaml")
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count(": ran") > 12
    for line in done.stdout.splitlines():
        assert ": skipped:" not in line or line.split(": skipped: ")[1], line


def test_a_wrong_example_is_told(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("# A page\n\n```python\n1 / 0\n```\n\n```yaml\norders: no such policy\n```\n")
    done = run(page)
    assert done.returncode == 1
    assert "ZeroDivisionError" in done.stdout and "there is no 'no such policy'" in done.stdout
    assert "2 failed" in done.stdout
