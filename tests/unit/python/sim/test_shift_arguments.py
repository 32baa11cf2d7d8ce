# SPDX-License-Identifier: Apache-2.0
"""What operations.launch is given is checked before anything starts."""

import subprocess
import sys

import pytest
from operations_site import site

from warehouse_layout.file import files
from warehouse_operations import Operations
from warehouse_operations.store.locks import FileLock
from warehouse_sim.launch_arguments import Place, faults, value


@pytest.fixture
def place(tmp_path):
    return Place(tmp_path, files.worlds())


@pytest.mark.parametrize(
    "name, text, content, message",
    [
        ("orders", "bad.csv", b"reference,sku,quantity\nA,sku-1,x\n", "bad.csv:2: quantity is 'x'"),
        ("orders", "none.csv", None, "none.csv: No such file or directory"),
        ("orders", "fill:-1", None, "orders are 'fill:-1'; a number above 0"),
        ("policies", "bad.yaml", b"orders: nonsense", "bad.yaml: orders: there is no 'nonsense'"),
        ("policies", "none.yaml", None, "none.yaml: No such file or directory"),
        ("database", "bad.db", b"nonsense", "bad.db: is not an SQLite database"),
        ("database", "no/such.db", None, "there is no folder"),
        ("database", "oracle-of-delphi://x:secret@y", None, "oracle-of-delphi"),
    ],
)
def test_what_is_wrong_is_told(place, name, text, content, message):
    if content:
        (place.cwd / text).write_bytes(content)
    (said,) = faults({name: text}, place)
    assert said.startswith(f"{name}:=") and message in said
    assert "secret" not in said


def test_what_is_right_is_told_by_its_whole_path(place):
    (place.cwd / "good.csv").write_text("reference,sku,quantity\nA,any,1\n")
    (place.cwd / "good.yaml").write_text("orders: random")
    Operations(site=site(), database=place.cwd / "good.db").close()
    for name, text in (
        ("orders", "good.csv"),
        ("policies", "good.yaml"),
        ("database", "good.db"),
        ("database", "new.db"),
    ):
        assert faults({name: text}, place) == []
        assert value(name, text, place) == str(place.cwd / text)
    for name, text in (("orders", "fill"), ("orders", "poisson:90"), ("database", "")):
        assert faults({name: text}, place) == []
        assert value(name, text, place) == text
    assert not (place.cwd / "new.db").exists()
    with FileLock(place.cwd / "good.db"):
        assert "good.db: is in use by" in faults({"database": "good.db"}, place)[0]


def test_what_most_launches_have_is_checked_without_the_import_of_a_shift():
    program = """
import sys
from pathlib import Path
from warehouse_sim.launch_arguments import Place, faults, value
usual, place = {"orders": "none", "policies": "", "database": ""}, Place(Path.cwd(), Path.cwd())
assert not faults(usual, place)
assert [value(name, text, place) for name, text in usual.items()] == ["none", "", ""]
assert "warehouse_operations.runs" not in sys.modules
"""
    subprocess.run([sys.executable, "-c", program], check=True)
