# SPDX-License-Identifier: Apache-2.0
"""A hub in a process of its own. The assistant's environment has none of the hub's modules."""

import json
import os
import re
import signal
import subprocess
import time
import urllib.error
import urllib.request
from pathlib import Path

PATIENCE = 120.0  # [s, wall]
PROGRAM = ["rosrun", "warehouse_sim", "hub", "--port", "0"]


def until(condition, what):
    end = time.monotonic() + PATIENCE
    while not (result := condition()):
        assert time.monotonic() < end, what
        time.sleep(0.1)
    return result


def children(number):
    """Returns the processes that a process has started and that live."""
    files = Path(f"/proc/{number}/task").glob("*/children")
    return [int(child) for file in files for child in file.read_text().split()]


class ServedHub:
    def __init__(self, home, *options):
        self.home = home
        environment = os.environ | {"ROS_HOME": str(home)}
        environment.pop("WAREHOUSE_TOKEN", None)
        self.log = home / "hub_stderr.txt"
        with self.log.open("a") as log:
            self.process = subprocess.Popen(
                [*PROGRAM, *options], stdout=subprocess.PIPE, stderr=log, text=True, env=environment
            )
        lines = iter(self.process.stdout.readline, "")
        self.url = next(m[0] for line in lines if (m := re.search(r"http://\S+[^/\s]", line)))

    def ask(self, method, path, body=None):
        """Returns (status, JSON)."""
        data = None if body is None else json.dumps(body).encode()
        headers = {"content-type": "application/json"}
        request = urllib.request.Request(self.url + path, data, headers, method=method)
        try:
            with urllib.request.urlopen(request, timeout=PATIENCE) as answer:
                return answer.status, json.loads(answer.read())
        except urllib.error.HTTPError as error:
            return error.code, json.loads(error.read())

    def wait_for(self, name, *states):
        """Waits for a state of a simulation; returns its row, also of one that has failed."""

        def row():
            out = self.ask("GET", f"/api/v1/simulations/{name}")[1]
            return out if out["state"] in (*states, "FAILED") else None

        return until(row, f"{name} is not {states}")

    def end(self, number=signal.SIGINT):
        """Ends the hub; returns the processes that it had started itself."""
        below = children(self.process.pid)
        self.process.send_signal(number)
        self.process.wait(PATIENCE)
        return below
