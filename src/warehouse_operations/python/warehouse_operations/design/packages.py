# SPDX-License-Identifier: Apache-2.0
"""Finds Optuna, which the search needs, in the environment of the learning packages too."""

import sys
from importlib.machinery import PathFinder
from pathlib import Path

VERSION = f"python{sys.version_info.major}.{sys.version_info.minor}"
# The workspace, seen from this file's folder in its sources and in an install space within it.
ROOTS = Path(__file__).resolve().parents[5:7]
ENVIRONMENTS = tuple(root / ".venv" / "lib" / VERSION / "site-packages" for root in ROOTS)


def lack_of_optuna(program: str = "design") -> str:
    """Returns a sentence on how to install Optuna; "" where it is there.

    program: the one that has to be started by the interpreter of another environment.
    """
    if PathFinder.find_spec("optuna", [*sys.path, *map(str, ENVIRONMENTS)]):
        return ""
    scripts = [root / "scripts" / "learning_packages" for root in ROOTS]
    todo = next((str(script) for script in scripts if script.exists()), "")
    return "the search needs Optuna, which is not installed. Install it: " + (
        todo
        or "python3 -m venv --system-site-packages VENV && VENV/bin/pip install optuna, then start"
        f" {program} by VENV/bin/python3"
    )


def use_environments() -> None:
    """Lets this process import what lies in the environments of the learning packages alone."""
    sys.path += [str(path) for path in ENVIRONMENTS if str(path) not in sys.path]
