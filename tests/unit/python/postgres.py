# SPDX-License-Identifier: Apache-2.0
"""A PostgreSQL server of Debian's, on a port and in a folder of its own."""

import contextlib
import os
import shutil
import socket
import subprocess
import tempfile
from pathlib import Path

USER = "nobody"  # the server does not run as root


class Server:
    """One that runs; `url` is that of an empty database."""

    def __init__(self, folder, port, control, quiet):
        self.url = f"postgresql://shift@127.0.0.1:{port}/postgres"
        self._control, self._quiet = control, quiet
        self._options = f"-p {port} -k {folder} -c listen_addresses=127.0.0.1 -c fsync=off"

    def start(self):
        """Returns when it answers."""
        command = [*self._control, "-o", self._options, "start"]
        subprocess.run(command, check=True, **self._quiet)

    def stop(self):
        """Ends it at once, as a crash would."""
        command = [*self._control, "-m", "immediate", "stop"]
        subprocess.run(command, check=True, **self._quiet)


@contextlib.contextmanager
def running():
    """Yields a Server, which ends with the block."""
    programs = max(Path("/usr/lib/postgresql").glob("*/bin"), key=lambda p: int(p.parent.name))
    as_user = {"user": USER} if os.geteuid() == 0 else {}
    folder = tempfile.mkdtemp(prefix="postgres-")
    if as_user:
        shutil.chown(folder, USER)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    quiet = {"stdout": subprocess.DEVNULL, "cwd": folder, **as_user}
    data = f"{folder}/data"
    control = [programs / "pg_ctl", "-D", data, "-w", "-s", "-l", f"{folder}/log"]
    try:
        subprocess.run(
            [programs / "initdb", "-D", data, "-U", "shift", "-A", "trust"], check=True, **quiet
        )
        server_ = Server(folder, port, control, quiet)
        server_.start()
        try:
            yield server_
        finally:
            with contextlib.suppress(subprocess.CalledProcessError):  # it may be stopped already
                server_.stop()
    finally:
        shutil.rmtree(folder)


@contextlib.contextmanager
def server():
    """Yields the URL of an empty database; its server ends with the block."""
    with running() as server_:
        yield server_.url
