# SPDX-License-Identifier: Apache-2.0
"""Things that really run, for programs that look at their pages: a shift under ROS, recordings,
scenarios, drawings. Each is a context that gives an address and ends what it started."""

import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
import xmlrpc.client
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PATIENCE = 600.0  # for what is started and for what it does [s, wall]
sys.path.append(str(ROOT / "tests/rostest"))
signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # what was started ends then, too


def wait(true, what):
    """Returns what true() returns once that is something; raises TimeoutError."""
    end = time.monotonic() + PATIENCE
    while not (found := true()):
        if time.monotonic() > end:
            raise TimeoutError(f"{what} did not come in {PATIENCE:g} s")
        time.sleep(0.2)
    return found


@contextmanager
def process(*command, **options):
    """A process that ends with the context, or with this program, however that ends."""
    command = ["setpriv", "--pdeathsig", "TERM", *map(str, command)]
    with subprocess.Popen(command, text=True, **options) as one:
        try:
            yield one
        finally:
            one.terminate()


def program(name):
    """Returns how one of the programs in src/*/nodes is called."""
    return next(ROOT.glob(f"src/*/nodes/{name}"))


def run(name, *arguments):
    """Runs a program of ours to its end; raises CalledProcessError where it fails."""
    command = [program(name), *map(str, arguments)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


@contextmanager
def served(node, *arguments):
    """The address that a program of the viewer tells: edit, replay or whatif."""
    with process(program(node), *arguments, "--port", 0, stdout=subprocess.PIPE) as one:
        yield re.search(r"http://\S+", one.stdout.readline())[0]


@contextmanager
def shift(folder, **arguments):
    """The address of a shift under ROS; `arguments` are those of operations.launch."""
    port = free_port()
    given = {"viewer_port": 0, "database": folder / "shift.db"} | arguments
    command = ["roslaunch", "-p", port, "warehouse_sim", "operations.launch"]
    environment = os.environ | {"ROS_MASTER_URI": f"http://localhost:{port}", "ROS_HOME": folder}
    told = [f"{name}:={value}" for name, value in given.items()]
    with process(*command, *told, env=environment, stdout=subprocess.DEVNULL) as one:
        master = xmlrpc.client.ServerProxy(environment["ROS_MASTER_URI"])
        yield wait(lambda: one.poll() is None and _parameter(master, "/viewer/address"), "a shift")


def _parameter(master, name):
    try:
        code, _, value = master.getParam("/running", name)
    except OSError:  # there is no master yet
        return None
    return value if code == 1 else None


def free_port():
    """Returns a port of this machine that is not in use."""
    with socket.socket() as one:
        one.bind(("localhost", 0))
        return one.getsockname()[1]


def ask(address, body=None, method=None):
    """Returns the JSON of an address, None where it does not answer yet; POST where there is a
    body."""
    data = None if body is None else json.dumps(body).encode()
    request = urllib.request.Request(
        address, data, {"content-type": "application/json"}, method=method
    )
    try:
        with urllib.request.urlopen(request, timeout=PATIENCE) as answer:
            return json.load(answer)
    except urllib.error.URLError:
        return None


def compare(address, scenarios):
    """Has a what-if server run {name: settings}, to the end of the last."""
    for name, settings in scenarios.items():
        ask(f"{address}/scenarios", {"name": name, "settings": settings})
        ask(f"{address}/scenarios/{urllib.request.quote(name)}/run", {})

    def done():
        told = ask(f"{address}/scenarios")
        return told and not told["running"] + told["waiting"]

    wait(done, "the last run's end")
