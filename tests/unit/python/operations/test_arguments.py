# SPDX-License-Identifier: Apache-2.0
"""What operations.launch is given is checked before anything starts."""

import subprocess

import pytest
from operations_site import site

from warehouse_operations import Operations
from warehouse_operations.locks import FileLock


def checked(folder, name, value):
    """(exit code, what is printed, what is said) by the check that roslaunch runs."""
    command = ["rosrun", "warehouse_fleet", "argument_check", name, value]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout, done.stderr


@pytest.mark.parametrize(
    "name, value, content, message",
    [
        ("orders", "bad.csv", b"reference,sku,quantity\nA,sku-1,x\n", "bad.csv:2: quantity is 'x'"),
        ("orders", "none.csv", None, "none.csv: No such file or directory"),
        ("orders", "fill:-1", None, "orders are 'fill:-1'; a number above 0"),
        ("policies", "bad.yaml", b"orders: nonsense", "bad.yaml: orders: there is no 'nonsense'"),
        ("policies", "none.yaml", None, "none.yaml: No such file or directory"),
        ("database", "bad.db", b"nonsense", "bad.db: is no SQLite database"),
        ("database", "no/such.db", None, "there is no folder"),
        ("database", "oracle-of-delphi://x:secret@y", None, "oracle-of-delphi"),
    ],
)
def test_what_is_wrong_is_told(tmp_path, name, value, content, message):
    if content:
        (tmp_path / value).write_bytes(content)
    code, _, said = checked(tmp_path, name, value)
    assert code == 1 and f"operations.launch: {name}:= " in said and message in said
    assert "Traceback" not in said and "secret" not in said


def test_what_is_right_is_told_by_its_whole_path(tmp_path):
    (tmp_path / "good.csv").write_text("reference,sku,quantity\nA,any,1\n")
    (tmp_path / "good.yaml").write_text("orders: random")
    Operations(site=site(), database=tmp_path / "good.db").close()
    for name, value in (
        ("orders", "good.csv"),
        ("policies", "good.yaml"),
        ("database", "good.db"),
        ("database", "new.db"),
    ):
        assert checked(tmp_path, name, value) == (0, f"{tmp_path / value}", "")
    for name, value in (("orders", "fill"), ("orders", "poisson:90"), ("database", "")):
        assert checked(tmp_path, name, value) == (0, value, "")
    assert not (tmp_path / "new.db").exists()
    with FileLock(tmp_path / "good.db"):
        assert "good.db: is in use by" in checked(tmp_path, "database", "good.db")[2]
