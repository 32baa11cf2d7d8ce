# SPDX-License-Identifier: Apache-2.0
"""Runs blocks of Python, and has YAML read by the program that it is for."""

import contextlib
import io
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from pathlib import Path

import yaml

from examples.blocks import ROOT, Example, SkippedError, check

OUTSIDE = ("gymnasium", "pettingzoo", "ray", "torch", "stable_baselines3")  # of Debian


class Pythons:
    """Runs Python; blocks of a page share their names."""

    def __init__(self) -> None:
        self._page, self._names, self._so_far = None, {}, ""

    def run(self, example: Example) -> None:
        """Runs a block. Raises what it raises; SkippedError where a package is missing."""
        if example.page != self._page:
            self._page, self._names, self._so_far = example.page, {"__name__": "example"}, ""
        check(example)
        text = f"{example.notes.get('before', '')}\n{example.text}"
        self._so_far += text
        try:
            with contextlib.redirect_stdout(io.StringIO()):
                exec(compile(text, example.place, "exec"), self._names)
        except ModuleNotFoundError as error:
            if error.name.partition(".")[0] not in OUTSIDE:
                raise
            self._run_outside(error.name)

    def _run_outside(self, package):
        """Runs the page so far in .venv, into which scripts/learning_packages brings packages."""
        python = ROOT / ".venv/bin/python"
        if not any(ROOT.glob(f".venv/lib/*/site-packages/{package.partition('.')[0]}")):
            raise SkippedError(f"{package} is not in Debian; scripts/learning_packages brings some")
        command = [python, "-c", self._so_far]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise ValueError(done.stderr[-2000:])


def read_xml(example: Example) -> None:
    """Parses a part of a world's or a model's file. Raises ParseError."""
    check(example)
    ElementTree.fromstring(f"<part>{example.text}</part>")


def read_yaml(example: Example) -> None:
    """Has the reader of a YAML file read a block. Raises what that raises."""
    check(example)
    document = yaml.safe_load(example.text)
    reader = next((read for mark, read in READERS.items() if mark in document), None)
    if reader is None and all(isinstance(key, int) for key in document):
        reader = _robots
    if reader is None and isinstance(document, list):
        reader = _faults if "fault" in document[0] else _events
    if reader is None:
        raise ValueError(f"no reader is known for the keys {', '.join(map(str, document))}")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "example.layout.yaml"
        file.write_text(example.text)
        reader(file)


@contextlib.contextmanager
def _found(folder):
    """Has modules of a folder found."""
    sys.path.insert(0, folder)
    try:
        yield
    finally:
        sys.path.remove(folder)


def _layout(file):
    from warehouse_layout.file import layout_file
    from warehouse_layout.place import file_check

    faults = file_check.faults(layout_file.read(file))
    if faults:
        raise ValueError("; ".join(map(str, faults)))


def _policies(file):
    from warehouse_operations.policies import Policies

    with _found(""):  # a policy of the page's own
        Policies.read(file)


def _realism(file):
    from kiva_plugin_cpp import World

    World.preset("empty", realism=str(file))


def _sweep(file):
    from warehouse_operations.runs import sweep

    sweep.read(file)


def _layers(file):
    from warehouse_layout.convert.dxf import layers as dxf_layers

    dxf_layers.read(file)


def _robots(file):
    from warehouse_vda5050.master.robots_file import read

    read(file)


def _faults(file):
    from warehouse_vda5050.faults.script import read

    read(file)


def _events(file):
    from warehouse_operations.runs import event_file

    event_file.read(file)


def _planner(file):
    import numpy as np

    from warehouse_fleet import Floor, Rules
    from warehouse_fleet.planners.planner_plugins import make_planner

    with _found("src/warehouse_fleet/examples"):
        make_planner(Floor(np.ones((4, 4), bool)), Rules(), 1, yaml.safe_load(file.read_text()))


def _costs(file):
    from warehouse_operations.sizing import costs

    costs.read(file)


def _prices(file):
    from warehouse_operations.sizing import prices

    prices.read(file)


READERS: dict[str, Callable[[Path], None]] = {
    "layout": _layout,
    "seeds": _sweep,
    "orders": _policies,
    "localisation": _realism,
    "walls": _layers,
    "planner": _planner,
    "currency": _costs,
    "robot": _prices,
}
