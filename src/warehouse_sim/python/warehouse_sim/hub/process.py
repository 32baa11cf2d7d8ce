# SPDX-License-Identifier: Apache-2.0
"""A roslaunch with a master, ports, a ROS_HOME and a log of its own."""

import http.client
import os
import re
import signal
import socket
import subprocess
import time
import xmlrpc.client
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import IO, Any

from warehouse_sim.hub.wish import Wish
from warehouse_viewer.server import invitation

PATIENCE = 8.0  # for roslaunch to end its nodes [s, wall]
# In the environment of all processes of a simulation: its folder. roslaunch gives each node a
# session of its own, and one that is ended while it starts nodes may leave some behind.
MARK = "WAREHOUSE_HUB_SIMULATION"
SWEEPS, SWEEP_GAP = 20, 0.1  # [s, wall]
TIMEOUT = 2.0  # for the master to answer [s, wall]
COLOURS = re.compile(r"\x1b\[[0-9;]*m|\x1b\]2;[^\x07]*\x07")
END = "Initiating shutdown!"  # of roslaunch, once a required process has died
# Lines of roslaunch without a cause.
NOISE = re.compile(
    r"\s*$|.*(log file|logging to|done checking|press ctrl-c|started roslaunch|REQUIRED process|"
    r"Initiating shutdown|shutting down|killing on exit|shutting down processing monitor|^done$|"
    r"The traceback for the exception|^\[[\w-]+\] (restarting|process has finished))",
    re.IGNORECASE,
)


def free_port() -> int:
    """Returns a free port of this machine."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Process:
    """A running roslaunch, which ends with this program, even if that is killed."""

    def __init__(self, wish: Wish, folder: Path, environment: Mapping[str, str]) -> None:
        """Starts it. Raises OSError."""
        sweep(folder)
        port = free_port()
        self._folder = folder
        self.master = f"http://localhost:{port}"
        self._log = folder / "log.txt"
        self.environment = {
            **environment,
            "ROS_MASTER_URI": self.master,
            "ROS_HOME": str(folder),
            "ROS_LOG_DIR": str(folder / "log"),
            "ROS_HOSTNAME": "localhost",
            "PYTHONUNBUFFERED": "1",
            "SETUPTOOLS_USE_DISTUTILS": "stdlib",
            MARK: str(folder),
        }
        with self._log.open("ab") as log:
            self._popen = self._start(wish, port, folder, log)

    def _start(self, wish: Wish, port: int, folder: Path, log: IO[bytes]) -> subprocess.Popen:
        arguments = {**wish.arguments, "viewer": "true", "viewer_port": "0"}
        words = [f"{name}:={text}" for name, text in arguments.items()]
        # roslaunch gets SIGTERM at any end of this program, and ends its nodes.
        dies_with_us = ["setpriv", "--pdeathsig", "TERM"]
        options = ["-p", str(port), "--sigint-timeout=4", "--sigterm-timeout=2"]
        return subprocess.Popen(
            [*dies_with_us, "roslaunch", *options, "warehouse_sim", wish.file, *words],
            stdin=subprocess.DEVNULL,
            stdout=log,
            stderr=log,
            cwd=folder,
            env=self.environment,
            start_new_session=True,  # Ctrl-C in the hub's terminal is for the hub
        )

    def exit_code(self) -> int | None:
        """Returns its exit code, None while it runs."""
        return self._popen.poll()

    def ask_to_end(self) -> None:
        """Asks it to end with its nodes."""
        if self.exit_code() is None:
            self._popen.send_signal(signal.SIGINT)

    def end(self) -> None:
        """Waits until it has ended, and kills remaining processes after PATIENCE."""
        self.ask_to_end()
        try:
            self._popen.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self._popen.kill()
            self._popen.wait()
        sweep(self._folder)

    def viewer(self) -> str:
        """Returns the address of its pages, "" while they are not served. Blocks for TIMEOUT."""
        with suppress(OSError, xmlrpc.client.Error):
            master: Any = xmlrpc.client.ServerProxy(self.master, transport=_Transport())
            code, _, value = master.getParam("/hub", "/viewer/address")
            return str(value).rstrip("/") if code == 1 else ""
        return ""

    def memory(self) -> int:
        """Returns the memory of its processes [bytes]; shared pages count for each."""
        page = os.sysconf("SC_PAGE_SIZE")
        return sum(_resident(number) * page for number in (self._popen.pid, *self.tree()))

    def tree(self) -> dict[int, str]:
        """Returns its processes as descendants() does."""
        return descendants(self._popen.pid)

    def reason(self) -> str:
        """Returns the last lines of its log that may name a cause, as one text."""
        with suppress(OSError):
            text = COLOURS.sub("", self._log.read_text(errors="replace")[-20_000:])
            text = text.partition(END)[0]  # other nodes end after it, some with tracebacks
            _, invited, after = text.rpartition(invitation.OPENING)
            text = after.partition("\n")[2] if invited else after  # until then all was well
            lines = [line.strip() for line in text.splitlines() if not NOISE.match(line)]
            return "\n".join(lines[-6:])[-1000:]
        return ""


def marked(folder: Path) -> list[int]:
    """Returns the processes of the simulation in a folder, or of all simulations beneath it."""
    mark = f"\0{MARK}={folder}".encode()
    out = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            with suppress(OSError):
                _, has, after = (b"\0" + (entry / "environ").read_bytes()).partition(mark)
                if has and after[:1] in (b"\0", b"/", b""):
                    out.append(int(entry.name))
    return out


def sweep(folder: Path) -> None:
    """Kills what is left of the simulation in a folder, also what starts meanwhile."""
    for _ in range(SWEEPS):
        numbers = marked(folder)
        if not numbers:
            return
        for number in numbers:
            with suppress(ProcessLookupError):
                os.kill(number, signal.SIGKILL)
        time.sleep(SWEEP_GAP)


class _Transport(xmlrpc.client.Transport):
    def make_connection(self, host: str | tuple[str, dict[str, str]]) -> http.client.HTTPConnection:
        connection = super().make_connection(host)
        connection.timeout = TIMEOUT
        return connection


def descendants(root: int) -> dict[int, str]:
    """Returns the processes below a process: {number: time of start, its identity}."""
    parents: dict[int, int] = {}
    starts: dict[int, str] = {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit() and (fields := _fields(int(entry.name))):
            parents[int(entry.name)], starts[int(entry.name)] = int(fields[1]), fields[19]
    out: dict[int, str] = {}
    level = {root}
    while level:
        level = {number for number, parent in parents.items() if parent in level}
        out.update((number, starts[number]) for number in level)
    return out


def _fields(number: int) -> list[str]:
    """Returns the fields of /proc/N/stat after the name; [] if there is no such process."""
    with suppress(OSError):
        return Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()
    return []


def _resident(number: int) -> int:
    with suppress(OSError, IndexError):
        return int(Path(f"/proc/{number}/statm").read_text().split()[1])
    return 0
