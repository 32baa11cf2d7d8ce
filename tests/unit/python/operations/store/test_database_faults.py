# SPDX-License-Identifier: Apache-2.0
"""What a shift's database outlives: a kill within a transaction, a server that goes and comes
back; and what is said of one that can't be written."""

import os
import signal
import subprocess
import sys

import pytest
from operations_site import site
from paths import HELPERS
from postgres import running, server
from sqlalchemy import func, select

from warehouse_operations import Operations
from warehouse_operations.store import check, schema
from warehouse_operations.store.database import DatabaseError, open_engine

# Dies when its writer has sent all rows of a transaction and is about to commit it.
KILLED = """
import os, signal, sys
sys.path.insert(0, sys.argv[1])
from operations_site import site
from sqlalchemy import event
from warehouse_operations import Operations
ops = Operations(site=site(), database=sys.argv[2], orders="fill:40")
ops.run(seconds=200)
ops.database.flush()
event.listen(ops.database.engine, "commit", lambda _: os.kill(os.getpid(), signal.SIGKILL))
ops.run(seconds=200)
ops.database.flush()
"""


def rows(database, table):
    with open_engine(database).connect() as connection:
        return connection.execute(select(func.count()).select_from(table)).scalar()


def work(database, seconds):
    """A shift goes on with the database for so long [s], and ends."""
    with Operations(site=site(), database=database, orders="fill:40") as ops:
        ops.run(seconds=seconds)


def go_on_after_kills(database):
    moves = 0
    for _ in range(3):
        command = [sys.executable, "-c", KILLED, str(HELPERS), str(database)]
        assert subprocess.run(command, check=False).returncode == -signal.SIGKILL
        assert check.faults(open_engine(database)) == []
        before, moves = moves, rows(database, schema.move)
        assert moves > before  # up to the last commit all is there
    work(database, 200)
    assert check.faults(open_engine(database)) == []
    assert rows(database, schema.move) > moves


def test_a_kill_within_a_transaction_costs_that_alone(tmp_path):
    go_on_after_kills(tmp_path / "run.db")


def test_a_kill_within_a_transaction_of_a_server_costs_that_alone():
    with server() as url:
        go_on_after_kills(url)


def test_a_server_that_goes_is_told_and_work_goes_on_when_it_is_back():
    with running() as postgres:
        work(postgres.url, 200)
        moves = rows(postgres.url, schema.move)
        ops = Operations(site=site(), database=postgres.url, orders="fill:40")
        postgres.stop()
        with pytest.raises(DatabaseError, match="postgresql://") as raised:
            for _ in range(20):
                ops.run(seconds=30)
                ops.database.flush()
        assert "\n" not in str(raised.value)
        with pytest.raises(DatabaseError):
            ops.close()
        with pytest.raises(DatabaseError, match="postgresql://"):
            Operations(site=site(), database=postgres.url)
        postgres.start()
        work(postgres.url, 200)
        assert check.faults(open_engine(postgres.url)) == []
        assert rows(postgres.url, schema.move) > moves


# Root is held to permissions like any other user, and still finds what it may only read.
HELD = ["setpriv", "--bounding-set=-dac_override"] if os.geteuid() == 0 else []


@pytest.mark.parametrize("protected", ["file", "folder"])
def test_what_can_not_be_written_is_told_in_a_sentence(tmp_path, protected):
    folder = tmp_path / "shift"
    folder.mkdir()
    work(folder / "run.db", 60)
    if protected == "folder":
        (folder / "run.db").unlink()
    else:
        (folder / "run.db").chmod(0o444)
    folder.chmod(0o555)
    command = ["rosrun", "warehouse_operations", "simulate", "--size", "small", "--minutes", "1"]
    out = tmp_path / "out"
    done = subprocess.run(
        [*HELD, *command, "--no-physics", "--out", out, "--database", folder / "run.db"],
        capture_output=True,
        text=True,
        check=False,
    )
    folder.chmod(0o755)
    said = done.stdout + done.stderr
    assert done.returncode == 1 and "Traceback" not in said, said
    assert f"{folder / 'run.db'}: " in said or "run.db" in said.splitlines()[-1], said
