# SPDX-License-Identifier: Apache-2.0
"""Runs blocks of Python, and has YAML read by the program that it is for."""

import contextlib
import io
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import yaml

from examples.blocks import Example, SkippedError, check

OUTSIDE = ("gymnasium", "pettingzoo", "ray", "torch", "stable_baselines3")  # of Debian


class Pythons:
    """Runs Python; blocks of a page share their names."""

    def __init__(self) -> None:
        self._page, self._names = None, {}

    def run(self, example: Example) -> None:
        """Runs a block. Raises what it raises; SkippedError where a package is missing."""
        if example.page != self._page:
            self._page, self._names = example.page, {"__name__": "example"}
        check(example)
        try:
            for text in (example.notes.get("before", ""), example.text):
                with contextlib.redirect_stdout(io.StringIO()):
                    exec(compile(text, example.place, "exec"), self._names)
        except ModuleNotFoundError as error:
            if error.name.partition(".")[0] in OUTSIDE:
                raise SkippedError(f"{error.name} is not in Debian") from error
            raise


def read_yaml(example: Example) -> None:
    """Has the reader of a YAML file read a block. Raises what that raises."""
    check(example)
    given = yaml.safe_load(example.text)
    reader = next((read for mark, read in READERS.items() if mark in given), None)
    if reader is None and all(isinstance(key, int) for key in given):
        reader = _robots
    if reader is None:
        raise ValueError(f"no reader is known for the keys {', '.join(map(str, given))}")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "example.layout.yaml"
        file.write_text(example.text)
        reader(file)


def _layout(file):
    from warehouse_layout import file_check, layout_file

    faults = file_check.faults(layout_file.read(file))
    if faults:
        raise ValueError("; ".join(map(str, faults)))


def _policies(file):
    sys.path.insert(0, "")  # a policy of the page's own
    try:
        from warehouse_operations.policies import Policies

        Policies.read(file)
    finally:
        sys.path.remove("")


def _realism(file):
    from kiva_plugin_cpp import World

    World.preset("empty", realism=str(file))


def _sweep(file):
    from warehouse_operations import sweep

    sweep.read(file)


def _layers(file):
    from warehouse_layout.formats import dxf_layers

    dxf_layers.read(file)


def _robots(file):
    from warehouse_vda5050.master.robots_file import read

    read(file)


READERS: dict[str, Callable[[Path], None]] = {
    "layout": _layout,
    "seeds": _sweep,
    "orders": _policies,
    "localisation": _realism,
    "walls": _layers,
}
