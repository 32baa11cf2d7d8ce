# SPDX-License-Identifier: Apache-2.0
"""Programs that pictures and films are taken of start, or say why they did not."""

import importlib.util
import signal

import pytest
from paths import ROOT


@pytest.fixture(scope="module")
def running():
    spec = importlib.util.spec_from_file_location("running", ROOT / "scripts/pages/running.py")
    module, before = importlib.util.module_from_spec(spec), signal.getsignal(signal.SIGTERM)
    spec.loader.exec_module(module)
    signal.signal(signal.SIGTERM, before)
    return module


def test_of_programs_with_the_same_name_the_package_says_which(running):
    assert running.program("edit") == ROOT / "src/warehouse_viewer/nodes/edit"
    for package in ("warehouse_viewer", "warehouse_vda5050"):
        assert running.program(f"{package}/replay") == ROOT / f"src/{package}/nodes/replay"
    with pytest.raises(LookupError, match="warehouse_vda5050, warehouse_viewer has it"):
        running.program("replay")
    with pytest.raises(LookupError, match="no package"):
        running.program("warehouse_viewer/absent")


def test_a_program_that_ends_without_an_address_says_so(running, tmp_path):
    with (
        pytest.raises(RuntimeError, match="warehouse_viewer/replay gave no address"),
        running.served("warehouse_viewer/replay", tmp_path / "absent", "--no-browser"),
    ):
        pass
