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

ROOT = Path(__file__).resolve().parents[2]
PATIENCE = 600.0  # for what is started and for what it does [s, wall]
signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # what was started ends then, too


def wait(true, what):
    """Returns what true() returns once that is something; raises TimeoutError."""
    end = time.monotonic() + PATIENCE
    while not (result := true()):
        if time.monotonic() > end:
            raise TimeoutError(f"{what} did not come in {PATIENCE:g} s")
        time.sleep(0.2)
    return result


@contextmanager
def process(*command, **options):
    """A process that ends with the context, or with this program, however that ends."""
    command = ["setpriv", "--pdeathsig", "TERM", *map(str, command)]
    with subprocess.Popen(command, text=True, **options) as running:
        try:
            yield running
        finally:
            running.terminate()


def program(name):
    """Returns where one of the programs in src/*/nodes is; PACKAGE/NAME, as two may have a name.
    Raises LookupError where that is not one program."""
    package, _, node = name.rpartition("/")
    places = sorted(ROOT.glob(f"src/{package or '*'}/nodes/{node}"))
    if len(places) != 1:
        packages = ", ".join(each.parents[1].name for each in places) or "no package"
        raise LookupError(f"{name}: {packages} has it; name one program as PACKAGE/NAME")
    return places[0]


def run(name, *arguments):
    """Runs a program of ours to its end; raises CalledProcessError where it fails."""
    command = [program(name), *map(str, arguments)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


@contextmanager
def served(node, *arguments):
    """The address that a program of the viewer tells: edit, replay or whatif."""
    with process(program(node), *arguments, "--port", 0, stdout=subprocess.PIPE) as server:
        line = server.stdout.readline()
        address = re.search(r"http://\S+", line)
        if address is None:
            raise RuntimeError(f"{node} gave no address: {line.strip() or 'it ended at once'}")
        yield address[0]


def replayed(recording):
    """The address of the page that plays a recording, as of served()."""
    return served("warehouse_viewer/replay", recording, "--no-browser")


@contextmanager
def shift(folder, **arguments):
    """The address of a shift under ROS; `arguments` are those of operations.launch."""
    settings = {"database": folder / "shift.db"} | arguments
    with launched("operations.launch", folder, {}, settings) as (running, uri):
        master = xmlrpc.client.ServerProxy(uri)
        yield wait(lambda: _parameter(running, master, "/viewer/address"), "a shift")


@contextmanager
def warehouse(folder, environment, **arguments):
    """The ROS master's address of a warehouse; `arguments` are those of warehouse.launch."""
    with launched("warehouse.launch", folder, environment, arguments) as (running, uri):
        master = xmlrpc.client.ServerProxy(uri)
        wait(lambda: _parameter(running, master, "/viewer/address"), "a warehouse")
        yield uri


@contextmanager
def launched(file, folder, environment, arguments):
    """A launch on a free port, and its ROS master's address."""
    port = free_port()
    uri = f"http://localhost:{port}"
    own = {"ROS_MASTER_URI": uri, "ROS_HOME": str(folder)}
    words = [f"{name}:={value}" for name, value in ({"viewer_port": 0} | arguments).items()]
    command = ["roslaunch", "-p", port, "warehouse_sim", file, *words]
    options = {"env": os.environ | own | environment, "stdout": subprocess.DEVNULL}
    with process(*command, **options) as running:
        yield running, uri


def node(uri, name):
    """Returns a ROS node's address, None where there is none."""
    code, _, address = xmlrpc.client.ServerProxy(uri).lookupNode("/running", name)
    return address if code == 1 else None


def _parameter(launch, master, name):
    """Returns a ROS parameter, None as long as there is none."""
    if launch.poll() is not None:
        raise RuntimeError(f"roslaunch has ended with {launch.returncode}")
    try:
        code, _, value = master.getParam("/running", name)
    except OSError:  # there is no master yet
        return None
    return value if code == 1 else None


def free_port():
    """Returns a port of this machine that is not in use."""
    with socket.socket() as listener:
        listener.bind(("localhost", 0))
        return listener.getsockname()[1]


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
        scenarios = ask(f"{address}/scenarios")
        return scenarios and not scenarios["running"] + scenarios["waiting"]

    wait(done, "the last run's end")
