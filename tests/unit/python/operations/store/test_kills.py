# SPDX-License-Identifier: Apache-2.0
"""A warehouse at work under ROS whose nodes are killed, one or all, at random moments: no order,
piece or unit is lost or done twice, and work goes on. KILLS says how often; 0, the default, skips
it."""

import os
import random
import signal
import socket
import subprocess
import time
from pathlib import Path

import pytest
from sqlalchemy import text

from warehouse_operations.store import check
from warehouse_operations.store.database import open_engine

KILLS = int(os.environ.get("KILLS", "0"))
PATIENCE = 180.0  # [s, wall]
EVERYTHING = "everything"
# roslaunch brings back those before the world; with the world, or all, it ends.
VICTIMS = ("operations", "coordinator", "both", "gazebo", EVERYTHING)

pytestmark = pytest.mark.skipif(not KILLS, reason="KILLS is 0; make test-long runs it")


class Warehouse:
    """operations.launch as a process, with a master of its own."""

    def __init__(self, folder):
        self.folder, self.database = folder, str(folder / "run.db")
        with socket.socket() as free:
            free.bind(("localhost", 0))
            port = free.getsockname()[1]
        self._environment = os.environ | {
            "ROS_MASTER_URI": f"http://localhost:{port}",
            "ROS_HOSTNAME": "localhost",
            "ROS_HOME": str(folder),
        }
        self._launch, self._port = None, port

    def start(self):
        command = ["roslaunch", "-p", str(self._port), "warehouse_sim", "operations.launch"]
        arguments = ["size:=small", "rtf:=10", "viewer:=false", "orders:=fill:40", "autosave:=5"]
        with open(self.folder / "launch.log", "ab") as log:
            self._launch = subprocess.Popen(
                [*command, *arguments, f"database:={self.database}"],
                env=self._environment,
                stdout=log,
                stderr=log,
            )

    def kill(self, victim):
        """Sends SIGKILL; starts the process again unless another does."""
        whole = victim == EVERYTHING
        names = {"both": ("operations", "coordinator")}.get(victim, (victim,))
        processes = _descendants(self._launch.pid)
        killed = [pid for pid in processes if whole or _node(pid) in names]
        assert killed, f"{victim} does not run"
        for pid in [self._launch.pid, *killed] if whole else killed:
            os.kill(pid, signal.SIGKILL)
        if victim in ("gazebo", EVERYTHING):
            self._launch.wait(PATIENCE)
            self.start()

    def stop(self):
        if not self.runs():
            return
        processes = _descendants(self._launch.pid)
        self._launch.send_signal(signal.SIGINT)
        try:
            self._launch.wait(PATIENCE)
        finally:
            for pid in processes:
                if Path(f"/proc/{pid}").exists():
                    os.kill(pid, signal.SIGKILL)

    def runs(self):
        return self._launch.poll() is None


def _descendants(pid):
    processes = []
    for task in Path(f"/proc/{pid}/task").iterdir():
        for child in (task / "children").read_text().split():
            processes += [int(child), *_descendants(int(child))]
    return processes


def _node(pid):
    """The name that roslaunch gave a process; empty if none."""
    words = Path(f"/proc/{pid}/cmdline").read_bytes().decode().split("\0")
    return next((w.removeprefix("__name:=") for w in words if w.startswith("__name:=")), "")


def kept(engine):
    """What there is: (units and bins, orders, those that are complete, moves)."""
    with engine.connect() as connection:

        def rows(query):
            return set(connection.execute(text(query)).all())

        return (
            rows("SELECT id, item, unit FROM bin"),
            rows("SELECT id FROM orders"),
            rows("SELECT id FROM orders WHERE state = 2"),
            rows("SELECT id, bin, sku, quantity FROM move"),
        )


def work(engine, warehouse, pieces):
    """Waits until so many pieces more were picked or put in."""
    before, end = None, time.monotonic() + PATIENCE
    while before is None or _moved(engine) < before + pieces:
        before = _moved(engine) if before is None else before
        assert warehouse.runs(), f"the launch has ended: {warehouse.folder}/launch.log"
        assert time.monotonic() < end, f"no {pieces} pieces in {PATIENCE} s"
        time.sleep(0.05)


def _moved(engine):
    query = "SELECT COUNT(*) FROM move WHERE reason <> 'initial'"
    with engine.connect() as connection:
        return connection.execute(text(query)).scalar()


def test_nothing_is_lost_whoever_is_killed(tmp_path):
    chance = random.Random(KILLS)
    warehouse = Warehouse(tmp_path)
    engine = open_engine(warehouse.database)
    warehouse.start()
    try:
        known = (set(), set(), set(), set())
        for _ in range(KILLS):
            work(engine, warehouse, chance.randint(1, 12))
            time.sleep(chance.uniform(0, 1))
            victim = chance.choice(VICTIMS)
            warehouse.kill(victim)
            assert check.faults(engine) == [], victim
            there = kept(engine)
            for before, after in zip(known, there):
                assert before <= after, victim
            assert not known[0] or known[0] == there[0], victim
            known = there
            print(victim, [len(rows) for rows in known], flush=True)
        work(engine, warehouse, 20)
    finally:
        warehouse.stop()
    assert check.faults(engine) == []
