# SPDX-License-Identifier: Apache-2.0
"""One program at a time works on a database or a folder; a program that dies holds nothing."""

import multiprocessing
import os
import signal
import subprocess
import sys

import pytest
from operations_site import site
from paths import HELPERS
from postgres import server

from warehouse_operations import Operations
from warehouse_operations.store import check
from warehouse_operations.store.database import DatabaseError, open_engine
from warehouse_operations.store.locks import FileLock, InUseError

SINCE = r"since \d{4}-\d\d-\d\d \d\d:\d\d:\d\d"
HOLDER = """
import sys
sys.path.insert(0, sys.argv[1])
from operations_site import site
from warehouse_operations import Operations
ops = Operations(site=site(), database=sys.argv[2], orders="fill:40")
while True:
    ops.run(seconds=20)
    ops.database.flush()
    print("running", flush=True)
"""


@pytest.fixture
def hold():
    """Has a process of its own run a shift on a database; it is killed in the end."""
    held = []

    def begin(database):
        command = [sys.executable, "-c", HOLDER, str(HELPERS), str(database)]
        process = subprocess.Popen(command, stdout=subprocess.PIPE)
        held.append(process)
        assert process.stdout.readline()
        return process

    yield begin
    for process in held:
        process.kill()
        process.wait()
        process.stdout.close()


def runs_on(process):
    return all(process.stdout.readline() for _ in range(3)) and process.poll() is None


def test_a_second_shift_on_a_file_is_refused_and_the_first_goes_on(tmp_path, hold):
    database = tmp_path / "run.db"
    link = tmp_path / "link.db"
    link.symlink_to(database)
    first = hold(database)
    sentence = (
        rf"run.db: is in use by -c \(process {first.pid} on \S+\), {SINCE}; end that first, or"
    )
    for name in (database, link, f"sqlite:///{database}"):
        with pytest.raises(DatabaseError, match=sentence):
            Operations(site=site(), database=name)
    assert runs_on(first)
    assert check.faults(open_engine(database)) == []  # who reads alone may do so
    os.kill(first.pid, signal.SIGKILL)
    first.wait()
    with Operations(site=site(), database=database) as ops:
        ops.run(seconds=30)
    assert check.faults(open_engine(database)) == []
    assert not list(tmp_path.glob("*.lock"))


def test_a_second_shift_on_a_server_is_refused(hold):
    with server() as url:
        first = hold(url)
        sentence = rf"is in use by -c \(process {first.pid} on \S+\), {SINCE}; end that first"
        with pytest.raises(DatabaseError, match=sentence):
            Operations(site=site(), database=url)
        assert runs_on(first)
        os.kill(first.pid, signal.SIGKILL)
        first.wait()
        for _ in range(100):  # the server has to notice
            try:
                ops = Operations(site=site(), database=url)
                break
            except DatabaseError:
                continue
        ops.close()
        again = Operations(site=site(), database=url)
        again.close()


def test_a_database_that_can_not_be_opened_is_not_held(tmp_path):
    (tmp_path / "run.db").write_bytes(b"no database")
    for _ in range(2):
        with pytest.raises(DatabaseError, match="is not an SQLite database"):
            Operations(site=site(), database=tmp_path / "run.db")
    assert not list(tmp_path.glob("*.lock"))


def simulate(folder, *args):
    command = ["rosrun", "warehouse_operations", "simulate", "--size", "small", "--no-physics"]
    return subprocess.Popen(
        [*command, "--out", str(folder), *args], stderr=subprocess.PIPE, stdout=subprocess.DEVNULL
    )


def test_two_simulations_do_not_share_a_folder(tmp_path):
    out = tmp_path / "out"
    with FileLock(tmp_path), simulate(tmp_path, "--minutes", "1") as second:
        said = second.communicate()[1].decode()
        assert second.returncode == 1 and "Traceback" not in said
        assert f"{tmp_path}: is in use by " in said and f"(process {os.getpid()} on " in said
    assert not list(tmp_path.iterdir())
    with simulate(out, "--minutes", "10") as running:
        assert running.communicate()[1] is not None and running.returncode == 0
    with FileLock(out / "run.db"), simulate(out, "--minutes", "1") as other:
        said = other.communicate()[1].decode()
        assert other.returncode == 1 and "run.db: is in use by" in said
    assert check.summary(open_engine(out / "run.db"))["completed"] > 0
    assert not list(out.glob("*.lock"))


def test_what_was_forked_holds_nothing(tmp_path):
    lock = FileLock(tmp_path)
    asleep = multiprocessing.get_context("fork").Process(target=signal.pause)
    asleep.start()
    try:
        with pytest.raises(InUseError):
            FileLock(tmp_path)
        lock.release()
        with FileLock(tmp_path):
            assert asleep.is_alive()
    finally:
        asleep.kill()
        asleep.join()


def test_a_lock_file_that_was_left_behind_is_no_lock(tmp_path):
    (tmp_path / ".lock").write_text("simulate (process 1 on nowhere), since 1999-01-01 00:00:00\n")
    with FileLock(tmp_path):
        pass
    assert not list(tmp_path.iterdir())
