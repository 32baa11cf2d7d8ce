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


@contextlib.contextmanager
def server():
    """Yields the URL of an empty database; the server ends with the block."""
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
    options = f"-p {port} -k {folder} -c listen_addresses=127.0.0.1 -c fsync=off"
    try:
        subprocess.run(
            [programs / "initdb", "-D", data, "-U", "shift", "-A", "trust"], check=True, **quiet
        )
        subprocess.run([*control, "-o", options, "start"], check=True, **quiet)
        try:
            yield f"postgresql://shift@127.0.0.1:{port}/postgres"
        finally:
            subprocess.run([*control, "-m", "immediate", "stop"], check=True, **quiet)
    finally:
        shutil.rmtree(folder)
