# SPDX-License-Identifier: Apache-2.0
"""Where the module can't be imported it says why."""

import shutil
import subprocess
import sys
from pathlib import Path

import kiva_plugin_cpp


def test_another_python_is_told_which_one_it_needs(tmp_path):
    package = tmp_path / "kiva_plugin_cpp"
    package.mkdir()
    shutil.copy(Path(kiva_plugin_cpp.__file__).resolve(), package / "__init__.py")
    (package / "_core.cpython-399-x86_64-linux-gnu.so").touch()
    command = [sys.executable, "-c", "import kiva_plugin_cpp"]
    done = subprocess.run(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True, check=False)
    assert "built for Python 3.99, this is 3." in done.stderr
